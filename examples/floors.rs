//! What the machine itself takes for a long clip's bytes: the floors that speed is
//! measured against.
//!
//! ```sh
//! cargo run --release --example floors -- read long.dat
//! cargo run --release --example floors -- parse long.dat
//! cargo run --release --example floors -- write long.glb
//! cargo run --release --example floors -- keyframes long.dat
//! ```
//!
//! `read` reads a file once in blocks, `parse` runs a bare loop of fast-float2 over it on
//! one core and adds the numbers up, `write` writes a new file of the same length as the
//! one that is named, beside it, and waits for the disk. `keyframes` is no floor but what
//! dat2glb makes of the same bytes as `parse`: checked keys, and the hash of the file; with
//! RAYON_NUM_THREADS=1 on one core too. Each prints its own seconds, without the start of the
//! process; `parse` and `keyframes` without reading.

use std::fs::File;
use std::io::{self, Read, Write};
use std::time::Instant;

fn main() -> io::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [what, path] = words.as_slice() else { return usage() };
    let seconds = match what.as_str() {
        "read" => read(path)?,
        "parse" => parse(&std::fs::read(path)?),
        "write" => write(path)?,
        "keyframes" => keyframes(&std::fs::read(path)?),
        _ => return usage(),
    };
    println!("{seconds:.6}");
    Ok(())
}

fn usage() -> io::Result<()> {
    eprintln!("usage: floors read|parse|write|keyframes FILE");
    std::process::exit(2);
}

fn read(path: &str) -> io::Result<f64> {
    let start = Instant::now();
    let (mut file, mut block) = (File::open(path)?, vec![0; 1 << 20]);
    while file.read(&mut block)? > 0 {}
    Ok(start.elapsed().as_secs_f64())
}

fn parse(text: &[u8]) -> f64 {
    let start = Instant::now();
    let body = text.iter().position(|&byte| byte == b'\n').map_or(text, |end| &text[end..]);
    let (mut sum, mut at) = (0.0, 0);
    while at < body.len() {
        match fast_float2::parse_partial::<f64, _>(&body[at..]) {
            Ok((value, length)) => {
                sum += value;
                at += length;
            }
            Err(_) => at += 1,
        }
    }
    std::hint::black_box(sum);
    start.elapsed().as_secs_f64()
}

fn keyframes(text: &[u8]) -> f64 {
    let start = Instant::now();
    std::hint::black_box(dat2glb::read::keyframes("long.dat", text, None).expect("keyframes"));
    start.elapsed().as_secs_f64()
}

fn write(path: &str) -> io::Result<f64> {
    let bytes = std::fs::read(path)?;
    let beside = format!("{path}.floor");
    let start = Instant::now();
    let mut file = File::create_new(&beside)?;
    file.write_all(&bytes)?;
    file.sync_all()?;
    let seconds = start.elapsed().as_secs_f64();
    std::fs::remove_file(beside)?;
    Ok(seconds)
}
