//! Prints a long clip of any number of boxes: the input that speed is measured with.
//!
//! ```sh
//! cargo run --release --example long_clip -- 1000000 4 > long.dat
//! ```
//!
//! Rows at uneven times of about 60 Hz; every box swings smoothly about an axis of its own
//! by sums of sines. Twelve digits a number, the same bytes every time.

use dat2glb::math::{Quat, Vec3};
use std::f64::consts::TAU;
use std::io::{self, BufWriter, Write};

fn main() -> io::Result<()> {
    let mut numbers = std::env::args().skip(1).map(|word| word.parse::<u64>());
    let (Some(Ok(rows)), Some(Ok(boxes))) = (numbers.next(), numbers.next()) else {
        eprintln!("usage: long_clip ROWS BOXES");
        std::process::exit(2);
    };
    let mut out = BufWriter::with_capacity(1 << 20, io::stdout().lock());
    writeln!(out, "# {boxes} 2.000000")?;
    for row in 0..rows {
        let t = time(row);
        write!(out, "{t:.9}")?;
        for index in 0..boxes {
            let [w, x, y, z] = rotation(index as f64, t).to_wxyz();
            write!(out, " {w:.12} {x:.12} {y:.12} {z:.12}")?;
        }
        writeln!(out)?;
    }
    out.flush()
}

/// A sixtieth of a second a row, up to a quarter of that early or late.
fn time(row: u64) -> f64 {
    // Weyl's sequence: even over [0, 1), and of no period.
    let uneven = (row as f64 * 0.618_033_988_749_894_9).fract() - 0.5;
    (row as f64 + 0.5 * uneven + 0.25) / 60.0
}

/// Steps of up to some 5° from row to row.
fn rotation(index: f64, t: f64) -> Quat {
    let swing = |rate: f64, phase: f64| (TAU * (rate * t + phase * (index + 1.0))).sin();
    Quat::exp(Vec3::new(0.8 * swing(0.31, 0.1), 0.5 * swing(0.53, 0.2), 0.7 * swing(0.23, 0.3)))
}
