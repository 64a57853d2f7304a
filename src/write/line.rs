//! Lines through space, coloured from point to point.

use glam::Vec3;

/// A line from point to point.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its name in the file.
    pub name: String,
    /// Place and colour (red, green, blue as shares of light, 255 being all) of each of
    /// two points or more.
    pub points: Vec<(Vec3, [u8; 3])>,
}

impl Line {
    /// Bytes of a point: three float32 numbers, and four bytes of colour.
    pub(super) const STRIDE: usize = 16;

    /// The points as they stand in the buffer.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let point = |&(place, [r, g, b]): &(Vec3, [u8; 3])| {
            let [x, y, z] = place.to_array().map(f32::to_le_bytes);
            [x, y, z, [r, g, b, 255]].concat()
        };
        self.points.iter().flat_map(point).collect()
    }
}
