//! Where a frame differs from the one before.

use image::RgbaImage;

/// Pixels in rows and columns of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Area {
    pub left: u32,
    pub top: u32,
    pub width: u32,
    pub height: u32,
}

impl Area {
    /// All of a picture.
    pub(super) fn whole(frame: &RgbaImage) -> Area {
        Area { left: 0, top: 0, width: frame.width(), height: frame.height() }
    }

    /// The smallest area outside of which nothing changed; a single pixel where
    /// nothing did.
    pub(super) fn changed(frame: &RgbaImage, before: Option<&RgbaImage>) -> Area {
        let Some(before) = before.filter(|before| before.dimensions() == frame.dimensions()) else {
            return Area::whole(frame);
        };
        let stride = frame.width() as usize * 4;
        let rows = || frame.chunks_exact(stride).zip(before.chunks_exact(stride));
        Area::around(rows().map(|(row, old)| {
            if row == old {
                return None;
            }
            let pairs = || row.as_chunks::<4>().0.iter().zip(old.as_chunks::<4>().0);
            let differ = |(a, b): (&[u8; 4], &[u8; 4])| a != b;
            Some((pairs().position(differ)?, pairs().rposition(differ)?))
        }))
    }

    /// The smallest area outside of which nothing is seen; a single pixel where
    /// nothing is.
    pub(super) fn seen(frame: &RgbaImage, is_seen: impl Fn(&[u8; 4]) -> bool) -> Area {
        let rows = frame.chunks_exact(frame.width() as usize * 4);
        Area::around(rows.map(|row| {
            let pixels = || row.as_chunks::<4>().0.iter();
            Some((pixels().position(&is_seen)?, pixels().rposition(&is_seen)?))
        }))
    }

    /// The area that holds the first and last columns of rows.
    fn around(rows: impl Iterator<Item = Option<(usize, usize)>>) -> Area {
        let (mut top, mut bottom, mut left, mut right) = (usize::MAX, 0, usize::MAX, 0);
        for (y, (first, last)) in rows.enumerate().filter_map(|(y, row)| Some((y, row?))) {
            (top, bottom) = (top.min(y), y + 1);
            (left, right) = (left.min(first), right.max(last + 1));
        }
        if bottom == 0 {
            return Area { left: 0, top: 0, width: 1, height: 1 };
        }
        Area {
            left: left as u32,
            top: top as u32,
            width: (right - left) as u32,
            height: (bottom - top) as u32,
        }
    }

    /// The area with its corner on even numbers, as WebP wants it.
    pub(super) fn even(self) -> Area {
        let (left, top) = (self.left & !1, self.top & !1);
        Area { left, top, width: self.width + self.left - left, height: self.height + self.top - top }
    }

    /// The rows of a picture within the area.
    pub(super) fn rows<'a>(self, frame: &'a RgbaImage) -> impl Iterator<Item = &'a [[u8; 4]]> + use<'a> {
        let (stride, columns) = (frame.width() as usize * 4, self.left as usize * 4..);
        let (top, height, length) = (self.top as usize, self.height as usize, self.width as usize * 4);
        let rows = frame.chunks_exact(stride).skip(top).take(height);
        rows.map(move |row| row[columns.start..columns.start + length].as_chunks().0)
    }

    /// The pixels within the area one after another, with or without alpha.
    pub(super) fn bytes(self, frame: &RgbaImage, with_alpha: bool) -> Vec<u8> {
        let pixels = self.width as usize * self.height as usize;
        let mut bytes = Vec::with_capacity(pixels * if with_alpha { 4 } else { 3 });
        for row in self.rows(frame) {
            match with_alpha {
                true => bytes.extend_from_slice(row.as_flattened()),
                false => row.iter().for_each(|p| bytes.extend_from_slice(&p[..3])),
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn the_smallest_area_is_found() {
        let before = RgbaImage::new(9, 7);
        let mut frame = before.clone();
        let area = |left, top, width, height| Area { left, top, width, height };
        assert_eq!(Area::changed(&frame, Some(&before)), area(0, 0, 1, 1));
        assert_eq!(Area::changed(&frame, None), area(0, 0, 9, 7));
        frame.put_pixel(3, 2, Rgba([1; 4]));
        assert_eq!(Area::changed(&frame, Some(&before)), area(3, 2, 1, 1));
        frame.put_pixel(8, 6, Rgba([1; 4]));
        frame.put_pixel(5, 5, Rgba([1; 4]));
        let changed = Area::changed(&frame, Some(&before));
        assert_eq!(changed, area(3, 2, 6, 5));
        assert_eq!(changed.even(), area(2, 2, 7, 5));
        assert_eq!(Area::seen(&frame, |p| p[3] > 0), changed);
        let rows: Vec<usize> = changed.rows(&frame).map(<[_]>::len).collect();
        assert_eq!(rows, [6; 5]);
        assert_eq!(changed.bytes(&frame, false).len(), 6 * 5 * 3);
        assert_eq!(changed.bytes(&frame, true)[..4], [1; 4]);
    }
}
