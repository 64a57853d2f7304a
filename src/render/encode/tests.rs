use super::{Apng, Encode, Gif, Head, Webp};
use image::{AnimationDecoder, Rgba, RgbaImage};
use std::io::Cursor;

const SIZE: (u32, u32) = (37, 23);

/// A square that walks over a grey slope, over nothing where `transparent`.
fn frames(count: u32, transparent: bool) -> Vec<RgbaImage> {
    let behind = |y: u32| if transparent { [0; 4] } else { opaque([200 - y as u8; 3]) };
    let frame = |i: u32| {
        RgbaImage::from_fn(SIZE.0, SIZE.1, |x, y| {
            let inside = (i * 3 + 1..i * 3 + 8).contains(&x) && (i..i + 6).contains(&y);
            Rgba(if inside { [(x * 6) as u8, 90, (y * 10) as u8, 255] } else { behind(y) })
        })
    };
    (0..count).map(frame).collect()
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

const DELAYS: [u32; 5] = [3, 4, 3, 300, 7];

fn head(repeats: bool, transparent: bool) -> Head {
    Head { size: SIZE, frames: DELAYS.len() as u32, repeats, transparent }
}

fn encode<'a, E: Encode<Cursor<&'a mut Vec<u8>>>>(frames: &[RgbaImage], head: Head, bytes: &'a mut Vec<u8>) {
    let mut file = E::new(Cursor::new(bytes), head).unwrap();
    for (i, frame) in frames.iter().enumerate() {
        let before = i.checked_sub(1).map(|before| &frames[before]);
        file.write(E::pack(head, frame, before), DELAYS[i]).unwrap();
    }
    file.finish().unwrap();
}

/// Frames, each with its delay, and whether they repeat for ever.
type Read = (Vec<(RgbaImage, u32)>, bool);

/// As the GIF89a specification says: each frame over what the one before left.
fn read_gif(bytes: &[u8]) -> Read {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let mut canvas = RgbaImage::new(decoder.width().into(), decoder.height().into());
    let mut frames = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        let before = canvas.clone();
        for (i, pixel) in frame.buffer.as_chunks::<4>().0.iter().enumerate() {
            let (x, y) = (i as u32 % u32::from(frame.width), i as u32 / u32::from(frame.width));
            if pixel[3] > 0 {
                canvas.put_pixel(x + u32::from(frame.left), y + u32::from(frame.top), Rgba(*pixel));
            }
        }
        frames.push((canvas.clone(), u32::from(frame.delay)));
        match frame.dispose {
            gif::DisposalMethod::Background => canvas = RgbaImage::new(before.width(), before.height()),
            other => assert_eq!(other, gif::DisposalMethod::Keep),
        }
    }
    (frames, decoder.repeat() == gif::Repeat::Infinite)
}

fn read_apng(bytes: &[u8]) -> Read {
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let plays = reader.info().animation_control.unwrap().num_plays;
    let decoder = image::codecs::png::PngDecoder::new(Cursor::new(bytes)).unwrap();
    let frames = decoder.apng().unwrap().into_frames().map(|frame| {
        let frame = frame.unwrap();
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        (frame.into_buffer(), numerator / denominator)
    });
    (frames.collect(), plays == 0)
}

fn read_webp(bytes: &[u8]) -> Read {
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(bytes)).unwrap();
    let (width, height) = decoder.dimensions();
    let mut pixels = vec![0; decoder.output_buffer_size().unwrap()];
    let frames = (0..decoder.num_frames()).map(|_| {
        let delay = decoder.read_frame(&mut pixels).unwrap();
        let image = match pixels.len() == (width * height * 4) as usize {
            true => RgbaImage::from_raw(width, height, pixels.clone()).unwrap(),
            false => {
                let rgba = pixels.as_chunks::<3>().0.iter().flat_map(|p| opaque(*p)).collect();
                RgbaImage::from_raw(width, height, rgba).unwrap()
            }
        };
        (image, delay)
    });
    let frames = frames.collect();
    (frames, decoder.loop_count() == image_webp::LoopCount::Forever)
}

#[test]
fn frames_delays_and_loops_come_back() {
    for transparent in [false, true] {
        for repeats in [false, true] {
            let frames = frames(DELAYS.len() as u32, transparent);
            let expected: Vec<_> = frames.iter().cloned().zip(DELAYS).collect();
            let (mut gif, mut apng, mut webp) = (Vec::new(), Vec::new(), Vec::new());
            let head = head(repeats, transparent);
            encode::<Gif<_>>(&frames, head, &mut gif);
            encode::<Apng<_>>(&frames, head, &mut apng);
            encode::<Webp<_>>(&frames, head, &mut webp);
            for (name, read) in
                [("gif", read_gif(&gif)), ("apng", read_apng(&apng)), ("webp", read_webp(&webp))]
            {
                let case = format!("{name}, transparent {transparent}, repeats {repeats}");
                assert_eq!(read.1, repeats, "{case}");
                assert_eq!(read.0.len(), expected.len(), "{case}");
                for (i, (read, expected)) in read.0.iter().zip(&expected).enumerate() {
                    assert_eq!(read.1, expected.1, "{case}: delay {i}");
                    assert!(read.0 == expected.0, "{case}: frame {i}");
                }
            }
        }
    }
}

#[test]
fn frames_that_do_not_change_are_shown_all_the_same() {
    let still = vec![frames(1, false).remove(0); DELAYS.len()];
    let (mut gif, mut webp) = (Vec::new(), Vec::new());
    encode::<Gif<_>>(&still, head(true, false), &mut gif);
    encode::<Webp<_>>(&still, head(true, false), &mut webp);
    for (frames, _) in [read_gif(&gif), read_webp(&webp)] {
        assert!(frames.iter().map(|(_, delay)| *delay).eq(DELAYS));
        assert!(frames.iter().all(|(frame, _)| *frame == still[0]));
    }
}

#[test]
fn gif_comes_near_pictures_of_many_colours() {
    let many =
        |i: u32| RgbaImage::from_fn(64, 64, |x, y| Rgba([(x * 4) as u8, (y * 4) as u8, (i * 50) as u8, 255]));
    let frames: Vec<RgbaImage> = (0..5).map(many).collect();
    let mut gif = Vec::new();
    encode::<Gif<_>>(&frames, Head { size: (64, 64), ..head(true, false) }, &mut gif);
    for ((read, _), drawn) in read_gif(&gif).0.iter().zip(&frames) {
        // 4096 colours on a square by 255: a patch of 4 by 4 steps of 4.
        let off = read.iter().zip(drawn.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off <= Some(16), "{off:?}");
    }
}
