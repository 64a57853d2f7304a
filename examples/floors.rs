//! What the machine itself takes for a long clip's bytes: the floors that speed is
//! measured against.
//!
//! ```sh
//! cargo run --release --example floors -- read long.dat
//! cargo run --release --example floors -- parse long.dat
//! cargo run --release --example floors -- write long.glb
//! cargo run --release --example floors -- skipping long.dat
//! cargo run --release --example floors -- numbers long.dat
//! cargo run --release --example floors -- keyframes long.dat
//! ```
//!
//! `read` reads a file once in blocks, `parse` runs a bare loop of fast-float2 over it on
//! one core and adds the numbers up, `skipping` is that loop without a try at what is white space,
//! `write` writes a new file of the same length as the one that is named, beside it, and waits for
//! the disk. No floors but dat2glb's own are `numbers`, as `skipping` with its parser of numbers,
//! and `keyframes`, which makes checked keys of the bytes and their hash; with RAYON_NUM_THREADS=1 on
//! one core too. Each prints its own seconds, without the start of the process; those of bytes
//! without reading.

#[path = "../src/read/decimal.rs"]
mod decimal;

use std::fs::File;
use std::io::{self, Read, Write};
use std::time::Instant;

fn main() -> io::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [what, path] = words.as_slice() else { return usage() };
    let seconds = match what.as_str() {
        "read" => read(path)?,
        "parse" => parse(&std::fs::read(path)?, |text| fast_float2::parse_partial(text).ok()),
        "skipping" => {
            parse(&std::fs::read(path)?, |text| word(text, |text| fast_float2::parse_partial(text).ok()))
        }
        "numbers" => parse(&std::fs::read(path)?, |text| word(text, number)),
        "write" => write(path)?,
        "keyframes" => keyframes(&std::fs::read(path)?),
        _ => return usage(),
    };
    println!("{seconds:.6}");
    Ok(())
}

fn usage() -> io::Result<()> {
    eprintln!("usage: floors read|parse|skipping|write|numbers|keyframes FILE");
    std::process::exit(2);
}

fn read(path: &str) -> io::Result<f64> {
    let start = Instant::now();
    let (mut file, mut block) = (File::open(path)?, vec![0; 1 << 20]);
    while file.read(&mut block)? > 0 {}
    Ok(start.elapsed().as_secs_f64())
}

/// Adds up the numbers of all lines after the first.
#[inline(always)]
fn parse(text: &[u8], number: impl Fn(&[u8]) -> Option<(f64, usize)>) -> f64 {
    let start = Instant::now();
    let body = text.iter().position(|&byte| byte == b'\n').map_or(text, |end| &text[end..]);
    let (mut sum, mut at) = (0.0, 0);
    while at < body.len() {
        match number(&body[at..]) {
            Some((value, length)) => {
                sum += value;
                at += length;
            }
            None => at += 1,
        }
    }
    std::hint::black_box(sum);
    start.elapsed().as_secs_f64()
}

/// What begins with no white space.
#[inline(always)]
fn word(text: &[u8], number: impl Fn(&[u8]) -> Option<(f64, usize)>) -> Option<(f64, usize)> {
    text.first().filter(|byte| !byte.is_ascii_whitespace()).and_then(|_| number(text))
}

/// A number as dat2glb's reader takes it.
#[inline(always)]
fn number(text: &[u8]) -> Option<(f64, usize)> {
    decimal::plain(text, 0).or_else(|| fast_float2::parse_partial(text).ok())
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
