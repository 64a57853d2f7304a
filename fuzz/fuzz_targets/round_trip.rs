//! Any keys and options, as text, to a file that is checked against the text.

#![no_main]

use arbitrary::Arbitrary;
use dat2glb::asset::{Asset, NoFiles};
use dat2glb::check::motion::{self, Given};
use dat2glb::check::{Code, Report};
use dat2glb::convert::{Fewest, Sampling};
use dat2glb::curve::{Ends, Scheme, Tcb};
use dat2glb::moves::{Inputs, Shape};
use dat2glb::read;
use dat2glb::sample::{Encoding, Writing};
use dat2glb_fuzz::convert::{Asked, Outcome, convert, said};
use dat2glb_fuzz::memory::measured;
use libfuzzer_sys::fuzz_target;
use std::fmt::Write as _;
use std::io::Cursor;

#[derive(Arbitrary, Debug)]
struct Trip {
    boxes: u8,
    length: Option<u16>,
    start: f32,
    xyzw: bool,
    scheme: u8,
    ends: u8,
    tcb: [i8; 3],
    rate: u8,
    key_times: bool,
    fewest: Option<u8>,
    coded: bool,
    rows: Vec<(Gap, [Part; 4])>,
}

/// Time to the next key.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Gap {
    Even,
    Milliseconds(u16),
    Microseconds(u8),
    Any(f32),
    Years(u8),
}

/// A part of a quaternion.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Part {
    Nought,
    One,
    Coarse(i8),
    Near(i8),
    Any(f32),
    Tiny(f64),
}

impl Gap {
    fn seconds(self) -> f64 {
        match self {
            Gap::Even => 0.25,
            Gap::Milliseconds(n) => f64::from(n) * 1e-3,
            Gap::Microseconds(n) => f64::from(n) * 1e-6,
            Gap::Any(seconds) => f64::from(seconds),
            Gap::Years(n) => f64::from(n) * 31_557_600.0,
        }
    }
}

impl Part {
    fn value(self) -> f64 {
        match self {
            Part::Nought => 0.0,
            Part::One => 1.0,
            Part::Coarse(n) => f64::from(n) / 127.0,
            Part::Near(n) => 1.0 + f64::from(n) * 1e-11,
            Part::Any(x) => f64::from(x),
            Part::Tiny(x) => x,
        }
    }
}

fuzz_target!(|trip: Trip| measured(8 * (trip.rows.len() + 8) * 5, || trip.run().unwrap_or(0)));

impl Trip {
    fn run(&self) -> Option<usize> {
        let keyframes = said(read::keyframes("fuzz.dat", self.text().as_bytes(), None))?;
        let inputs = Inputs { keyframes: Some(keyframes), path: None, cameras: Vec::new() };
        let outcome = convert(&inputs, self.asked()?);
        let Outcome::File(bytes) = outcome else { return Some(outcome.size()) };
        let mut asset = Asset::open(Box::new(Cursor::new(bytes.clone())), Box::new(NoFiles)).expect("opens");
        let mut report = Report::default();
        motion::compare(&mut asset, &inputs, Given::default(), &mut report)
            .expect("the file says how it was made");
        assert_eq!(report.count_of(Code::MotionDiffers), 0, "{}", report.text("fuzz.glb"));
        Some(bytes.len())
    }

    fn text(&self) -> String {
        let boxes = usize::from(self.boxes % 4) + 1;
        let length = self.length.map_or("2".to_owned(), |length| (f64::from(length) / 100.0).to_string());
        let mut text = format!("# {boxes} {length} {}\n", if self.xyzw { "xyzw" } else { "wxyz" });
        let mut time = f64::from(self.start);
        for row in self.rows.chunks_exact(boxes) {
            let _ = write!(text, "{time}");
            row.iter().flat_map(|(_, parts)| parts).for_each(|part| {
                let _ = write!(text, " {:?}", part.value());
            });
            text.push('\n');
            time += row[0].0.seconds();
        }
        text
    }

    fn asked(&self) -> Option<Asked> {
        let [tension, continuity, bias] = self.tcb.map(|x| f64::from(x) / 128.0);
        let of = |index: u8, count: usize| usize::from(index) % count;
        let scheme = Scheme::EVERY[of(self.scheme, Scheme::EVERY.len())];
        let fps = ["60", "24", "1", "30000/1001", "1000", "1/100000"][of(self.rate, 6)].parse().ok()?;
        let encoding = if self.coded { Encoding::Normalized16 } else { Encoding::Float };
        let fewest = |tolerance: u8| Fewest {
            tolerance: f64::from(tolerance.max(1)) / 64.0,
            distance: None,
            max_step: Fewest::MAX_STEP,
            on_curve: self.key_times,
            cubic: false,
        };
        Some(Asked {
            shape: Shape {
                ends: Ends::ALL[of(self.ends, Ends::ALL.len())],
                tcb: Tcb { tension, continuity, bias },
                ..Shape::default()
            },
            scheme,
            sampling: match self.fewest {
                Some(tolerance) => Sampling::Fewest(fewest(tolerance)),
                None => Sampling::Rate { fps, key_times: self.key_times },
            },
            writing: Writing { encoding, ..Writing::default() },
        })
    }
}
