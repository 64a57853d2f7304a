//! How long moving pictures take, against drawing and encoding alone:
//! `cargo run --release --example moving_pictures IN.glb [FPS]`, 512×512 in software.
//!
//! Core-seconds are what one thread takes. For each format: the whole, its ratio to
//! drawing alone on all cores, and its ratio to (core-seconds of drawing and of
//! encoding) / cores, which nothing that keeps all cores busy can be far below.

use dat2glb::asset::{Asset, NoFiles};
use dat2glb::render::encode::{self, Apng, Encode, Format, Gif, Head, Webp};
use dat2glb::render::{Film, Renderer, Session, Style};
use image::RgbaImage;
use rayon::ThreadPoolBuilder;
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, Cursor};
use std::time::Instant;

/// Times everything is done; the fastest counts, as others use the machine too.
const ROUNDS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, rest @ ..] = &arguments[..] else {
        return Err("usage: moving_pictures IN.glb [FPS]".into());
    };
    let fps = rest.first().map_or("12", String::as_str).parse()?;
    let mut asset = Asset::open(Box::new(BufReader::new(File::open(input)?)), Box::new(NoFiles))?;
    let mut session = Session::new(&mut asset, Renderer::Cpu)?;
    let clip = session.clip(None)?;
    let film = session.film(&mut asset, &[clip], &Style::default(), fps, false)?;
    let cores = rayon::current_num_threads();
    let (all, one) = (ThreadPoolBuilder::new().build()?, ThreadPoolBuilder::new().num_threads(1).build()?);

    let drawing = fastest(|| all.install(|| draw(&mut session, &mut asset, &film)));
    let alone = fastest(|| one.install(|| draw(&mut session, &mut asset, &film)));
    println!("{} frames on {cores} cores", film.frames());
    println!("drawing: {:.0} ms, {:.0} core-ms", drawing * 1e3, alone * 1e3);
    let frames: Vec<RgbaImage> =
        (0..film.frames()).map(|i| session.frame(&mut asset, &film, i)).collect::<Result<_, _>>()?;
    for (name, format) in [("GIF", Format::Gif), ("APNG", Format::Apng), ("WebP", Format::Webp)] {
        let encoding = fastest(|| match format {
            Format::Gif => encode_all::<Gif<_>>(&film, &frames),
            Format::Apng => encode_all::<Apng<_>>(&film, &frames),
            _ => encode_all::<Webp<_>>(&film, &frames),
        });
        let mut bytes = 0;
        let whole = fastest(|| {
            let mut file = Vec::new();
            let out = Cursor::new(&mut file);
            encode::film((&mut session, &mut asset), &film, (format, true), out, || {})
                .expect("memory can be written to");
            bytes = file.len();
        });
        println!(
            "{name}: {:.0} ms, {} kB; encoding {:.0} core-ms; {:.2} of drawing, {:.2} of (drawing + encoding) / cores",
            whole * 1e3,
            bytes / 1000,
            encoding * 1e3,
            whole / drawing,
            whole / ((alone + encoding) / cores as f64),
        );
    }
    Ok(())
}

fn draw(session: &mut Session, asset: &mut Asset, film: &Film) {
    for index in 0..film.frames() {
        session.frame(asset, film, index).expect("it was drawn before");
    }
}

/// Packs and writes all frames on this thread.
fn encode_all<E: Encode<Cursor<Vec<u8>>>>(film: &Film, frames: &[RgbaImage]) {
    let head = Head { size: film.size(), frames: frames.len() as u32, repeats: true, transparent: false };
    let delays = film.delays(E::PER_SECOND);
    let mut file = E::new(Cursor::new(Vec::new()), head).expect("memory can be written to");
    for (i, frame) in frames.iter().enumerate() {
        let before = i.checked_sub(1).map(|before| &frames[before]);
        file.write(E::pack(head, frame, before), delays[i]).expect("memory can be written to");
    }
    file.finish().expect("memory can be written to");
}

/// Seconds of the fastest of some rounds.
fn fastest(mut work: impl FnMut()) -> f64 {
    let round = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}
