//! Sheets, ghosts, clips side by side, cameras, films.

use super::load::{File, options, plain_house, style};
use crate::render::*;
use image::RgbaImage;
use image::imageops::crop_imm;
use serde_json::json;

const SIZE: (u32, u32) = (120, 90);

/// A house that slides and, as another clip, one that rises for twice as long.
fn two_clips() -> File {
    let mut file = plain_house();
    file.animate("slide", 0, "translation", &[0.0, 0.0, 0.0, 5.0, 0.0, 0.0]);
    file.animate("rise", 0, "translation", &[0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 6.0, 0.0]);
    file
}

fn session(file: &File) -> (Session, crate::asset::Asset) {
    let mut asset = file.asset();
    (Session::new(&mut asset, Renderer::Cpu).unwrap(), asset)
}

/// Whether pictures are the same below the first line of words.
fn same_below_words(a: &RgbaImage, b: &RgbaImage) -> bool {
    let below = |image: &RgbaImage| crop_imm(image, 0, 24, image.width(), image.height() - 24).to_image();
    a.dimensions() == b.dimensions() && below(a) == below(b)
}

/// A cell of a picture whose cells have two pixels between them.
fn cell(whole: &RgbaImage, column: u32, row: u32) -> RgbaImage {
    let (x, y) = (column * (SIZE.0 + 2), row * (SIZE.1 + 2));
    crop_imm(whole, x, y, SIZE.0, SIZE.1).to_image()
}

#[test]
fn cells_of_a_sheet_are_the_single_pictures() {
    let (mut session, mut asset) = session(&two_clips());
    let style = style(SIZE);
    let sheet = session.sheet(&mut asset, &[Some(1)], (3, 2), &style).unwrap().pixels;
    assert_eq!(sheet.dimensions(), (3 * 120 + 4, 2 * 90 + 2));
    for i in 0..6 {
        let time = Time::Fraction(f64::from(i) / 5.0);
        let single = session.picture(&mut asset, Some(1), time, &style).unwrap().pixels;
        let cell = cell(&sheet, i % 3, i / 3);
        assert!(same_below_words(&cell, &single), "{i}");
        assert!(cell != single, "{i} has its time");
    }
}

#[test]
fn clips_side_by_side_keep_step_in_one_view() {
    let (mut session, mut asset) = session(&two_clips());
    let (style, clips) = (style(SIZE), [Some(0), Some(1)]);
    let mut at = |time| session.abreast(&mut asset, &clips, time, &style).unwrap().pixels;
    let (start, late, end) = (at(Time::Seconds(0.0)), at(Time::Seconds(1.5)), at(Time::Seconds(2.0)));
    assert_eq!(start.dimensions(), (2 * 120 + 2, 90));
    assert!(same_below_words(&cell(&start, 0, 0), &cell(&start, 1, 0)), "both begin alike");
    assert!(cell(&late, 0, 0) == cell(&end, 0, 0), "the shorter clip rests at its end");
    assert!(cell(&late, 1, 0) != cell(&end, 1, 0));
    let sheet = session.sheet(&mut asset, &clips, (3, 1), &style).unwrap().pixels;
    assert_eq!(sheet.dimensions(), (3 * 120 + 4, 2 * 90 + 2), "a row a clip");
    assert!(same_below_words(&cell(&sheet, 2, 0), &cell(&end, 0, 0)));
    assert!(same_below_words(&cell(&sheet, 2, 1), &cell(&end, 1, 0)));
}

#[test]
fn sheets_too_large_for_a_picture_are_errors() {
    let (mut session, mut asset) = session(&plain_house());
    let error = session.sheet(&mut asset, &[None], (200, 3), &style(SIZE)).unwrap_err();
    assert!(error.to_string().starts_with("200x3 cells of 120x90 pixels"), "{error}");
}

#[test]
fn ghosts_are_the_last_pose_over_fainter_ones() {
    let (mut session, mut asset) = session(&two_clips());
    let style = Style { background: Background::Plain([0; 3]), ..style((200, 100)) };
    let mut ghost = |n| session.ghost(&mut asset, &[Some(0)], n, Time::Fraction(1.0), &style).unwrap().pixels;
    let (one, three) = (ghost(1), ghost(3));
    let last = session.picture(&mut asset, Some(0), Time::Fraction(1.0), &style).unwrap().pixels;
    let grey = |image: &RgbaImage, x: u32| {
        let column = (0..100).map(|y| image[(x, y)]).filter(|p| p[0] == p[1] && p[1] == p[2]);
        column.map(|p| p[0]).max().unwrap()
    };
    // The house slides to the right: its middle now, half way, and at first.
    let middles: Vec<u32> = [1.0, 0.5, 0.0]
        .map(|share| {
            let at = session.picture(&mut asset, Some(0), Time::Fraction(share), &style).unwrap().pixels;
            let lit = |x: &u32| (0..100).any(|y| at[(*x, y)][0] > 60);
            let columns: Vec<u32> = (0..200).filter(lit).collect();
            (columns[0] + columns.last().unwrap()) / 2
        })
        .to_vec();
    let levels: Vec<u8> = middles.iter().map(|x| grey(&three, *x)).collect();
    assert!(levels[0] > levels[1] + 20 && levels[1] > levels[2] + 20 && levels[2] > 20, "{levels:?}");
    assert_eq!(levels[0], grey(&last, middles[0]));
    assert_eq!(grey(&one, middles[2]), 0, "a single pose has no ghosts");
    // The trace alone: what is coloured.
    let coloured = |image: &RgbaImage| image.pixels().filter(|p| p[2] > p[0] + 40).count();
    assert!(coloured(&one) > 50 && coloured(&last) == 0);
}

/// The house before a camera that looks at its tip.
fn with_camera(camera: serde_json::Value) -> File {
    let mut file = plain_house();
    file.push("cameras", camera);
    file.push("nodes", json!({"name": "beside", "camera": 0, "translation": [0.0, 1.5, 10.0]}));
    file
}

fn seen_through(file: &File, camera: &str, size: (u32, u32)) -> Result<RgbaImage, Error> {
    let style = Style { camera: Some(camera.to_owned()), background: Background::Transparent, ..style(size) };
    thumbnail(&mut file.asset(), &Options { style, ..options() }).map(|picture| picture.pixels)
}

#[test]
fn cameras_of_the_file_see_what_they_look_at_in_the_middle() {
    let perspective =
        json!({"type": "perspective", "name": "eye", "perspective": {"yfov": 1.0, "znear": 0.1}});
    let orthographic = json!({
        "type": "orthographic", "name": "eye",
        "orthographic": {"xmag": 3.0, "ymag": 3.0, "znear": 0.1, "zfar": 20.0},
    });
    for camera in [perspective, orthographic] {
        let file = with_camera(camera);
        let picture = seen_through(&file, "beside", (100, 100)).unwrap();
        let drawn = |p: &image::Rgba<u8>| p[3] > 128;
        let top = picture.enumerate_pixels().find(|(.., p)| drawn(p)).unwrap();
        assert!(top.1 == 50 || top.1 == 51, "the tip of the roof is in the middle: {top:?}");
        assert!(top.0.abs_diff(50) <= 1, "{top:?}");
        assert!(seen_through(&file, "eye", (100, 100)).unwrap() == picture, "the camera's own name");
    }
}

#[test]
fn an_orthographic_camera_has_its_scale_and_its_far_plane() {
    let camera = |far: f64| json!({"type": "orthographic", "orthographic": {"xmag": 4.0, "ymag": 2.0, "znear": 0.1, "zfar": far}});
    // The house is 2 wide; 8 units are 200 pixels.
    let picture = seen_through(&with_camera(camera(20.0)), "beside", (200, 100)).unwrap();
    let width = (0..200).filter(|x| (0..100).any(|y| picture[(*x, y)][3] > 128)).count();
    assert_eq!(width, 50);
    let beyond = seen_through(&with_camera(camera(9.0)), "beside", (200, 100)).unwrap();
    assert!(beyond.pixels().all(|p| p[3] == 0), "the house stands behind the far plane");
}

#[test]
fn cameras_that_are_not_there_are_named_with_those_that_are() {
    let file = with_camera(json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    let error = seen_through(&file, "above", (9, 9)).unwrap_err();
    assert_eq!(error.to_string(), "there is no camera named `above`: the file has `beside`");
    let error = seen_through(&plain_house(), "above", (9, 9)).unwrap_err();
    assert_eq!(error.to_string(), "there is no camera named `above`: the file has none with a name");
}

#[test]
fn a_camera_moves_with_its_node() {
    let mut file = with_camera(json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    file.animate("fly", 1, "translation", &[0.0, 0.0, 10.0, 100.0, 0.0, 10.0]);
    let (mut session, mut asset) = session(&file);
    let style = Style { camera: Some("beside".into()), ..style(SIZE) };
    let mut covered = |t| session.picture(&mut asset, Some(0), Time::Seconds(t), &style).unwrap().covered;
    assert!(covered(0.0) > 0.01 && covered(1.0) == 0.0);
}

#[test]
fn the_floor_lies_under_what_is_drawn() {
    let file = two_clips();
    let (mut session, mut asset) = session(&file);
    let black = Background::Plain([0; 3]);
    let mut drawn = |floor, background| {
        let style = Style { floor, background, ..style((160, 160)) };
        session.picture(&mut asset, Some(0), Time::Seconds(0.0), &style).unwrap()
    };
    let (plain, floored) = (drawn(false, black), drawn(true, black));
    assert!(floored.covered > plain.covered + 0.02, "{} {}", floored.covered, plain.covered);
    let strong = |picture: &Picture, channel: usize| {
        let leads = |p: &&image::Rgba<u8>| {
            (0..3).all(|other| other == channel || i32::from(p[channel]) > i32::from(p[other]) + 25)
        };
        picture.pixels.pixels().filter(leads).count()
    };
    for channel in 0..3 {
        assert!(strong(&floored, channel) > 5, "axis {channel}");
        assert_eq!(strong(&plain, channel), 0);
    }
}

#[test]
fn a_turntable_shows_all_sides_in_view_and_comes_back() {
    let mut file = plain_house();
    file.json["nodes"][0]["translation"] = json!([30, 0, 0]);
    file.push("materials", json!({"doubleSided": true}));
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    file.push("nodes", json!({"mesh": 0, "translation": [0, 0, 7], "scale": [0.5, 1, 1]}));
    let (mut session, mut asset) = session(&file);
    let style = Style { background: Background::Transparent, ..style((128, 80)) };
    let film = session.film(&mut asset, &[None], &style, "8".parse().unwrap(), true).unwrap();
    assert!(film.closed() && film.frames() == 32 && film.seconds() == 4.0);
    let frames: Vec<RgbaImage> = (0..32).map(|i| session.frame(&mut asset, &film, i).unwrap()).collect();
    for (i, frame) in frames.iter().enumerate() {
        assert!(frame.pixels().any(|p| p[3] > 0), "{i}");
        for (x, y, pixel) in frame.enumerate_pixels() {
            assert!(pixel[3] == 0 || ((3..125).contains(&x) && (2..78).contains(&y)), "{i}: {x} {y}");
        }
        assert!(i == 0 || *frame != frames[0], "{i}");
    }
    let error = session.film(&mut asset, &[None], &style, "8".parse().unwrap(), false).unwrap_err();
    assert!(matches!(error, Error::NothingMoves), "{error}");
}

#[test]
fn films_are_closed_when_the_last_pose_meets_the_first() {
    let mut file = two_clips();
    file.animate("there and back", 0, "translation", &[0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let (mut session, mut asset) = session(&file);
    let mut film = |clips: &[Which]| {
        session.film(&mut asset, clips, &style(SIZE), "25".parse().unwrap(), false).unwrap()
    };
    let (open, closed) = (film(&[Some(0)]), film(&[Some(2)]));
    assert_eq!((open.closed(), open.frames()), (false, 26));
    assert_eq!((closed.closed(), closed.frames()), (true, 50));
    assert!(!film(&[Some(0), Some(2)]).closed(), "one of them jumps");
    let end = session.picture(&mut asset, Some(0), Time::Fraction(1.0), &style(SIZE)).unwrap();
    assert!(session.frame(&mut asset, &open, 25).unwrap() == end.pixels);
}

#[test]
fn a_film_has_the_frames_that_were_drawn() {
    let (mut session, mut asset) = session(&two_clips());
    let film = session.film(&mut asset, &[Some(0)], &style(SIZE), "10".parse().unwrap(), false).unwrap();
    let (mut bytes, mut count) = (Vec::new(), 0);
    let out = std::io::Cursor::new(&mut bytes);
    let format = encode::Format::of_ending("APNG").unwrap();
    encode::film((&mut session, &mut asset), &film, (format, false), out, || count += 1).unwrap();
    assert_eq!(count, film.frames());
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(&bytes)).unwrap();
    let frames = image::AnimationDecoder::into_frames(decoder.apng().unwrap());
    for (i, frame) in frames.enumerate() {
        let drawn = session.frame(&mut asset, &film, i).unwrap();
        assert!(frame.unwrap().into_buffer() == drawn, "{i}");
    }
}
