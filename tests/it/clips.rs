//! Clips made up at random, from text to a checked file, through the library alone.

use dat2glb::asset::{Asset, NoFiles};
use dat2glb::check::motion::{self, Given};
use dat2glb::check::{self, Code, Severity};
use dat2glb::convert::{Options, Plan, Sampling};
use dat2glb::curve::{Ends, Scheme};
use dat2glb::moves::{Ground, Inputs, Shape};
use dat2glb::read;
use dat2glb::sample::{Encoding, Writing};
use proptest::prelude::*;
use std::fmt::Write as _;
use std::io::Cursor;

#[derive(Clone, Debug)]
struct Random {
    start: f64,
    /// Time to each key, and the quaternion of every box at it, as far from unit as files
    /// may have it.
    rows: Vec<(f64, Vec<[f64; 4]>)>,
    loops: bool,
}

fn clips() -> impl Strategy<Value = Random> {
    let part = -1.0..1.0f64;
    let quaternion = prop::array::uniform4(part)
        .prop_filter("too short to have a direction", |q| q.iter().map(|x| x * x).sum::<f64>() > 0.01);
    let gap = prop_oneof![4 => 0.05..1.5f64, 1 => 2e-3..0.05f64];
    (1..=4usize).prop_flat_map(move |boxes| {
        let row = (gap.clone(), prop::collection::vec(quaternion.clone(), boxes));
        let rows = prop::collection::vec(row, 2..=12);
        (prop_oneof![Just(0.0), -100.0..1000.0f64], rows, any::<bool>())
            .prop_map(|(start, rows, loops)| Random { start, rows, loops })
    })
}

impl Random {
    fn text(&self, order: &str) -> String {
        let boxes = self.rows[0].1.len();
        let mut text = format!("# {boxes} 2.5 {order}\n");
        let mut time = self.start;
        let last = self.rows.len() - 1;
        for (i, (gap, quaternions)) in self.rows.iter().enumerate() {
            let quaternions = if self.loops && i == last { &self.rows[0].1 } else { quaternions };
            write!(text, "{time}").unwrap();
            quaternions.iter().flatten().for_each(|part| write!(text, " {part}").unwrap());
            text.push('\n');
            time += gap;
        }
        text
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    /// The file is sound, and no playback strays further than the file itself says.
    #[test]
    fn become_sound_files_within_the_bound_that_they_state(
        clip in clips(),
        order in prop::sample::select(vec!["", "wxyz", "xyzw"]),
        scheme in prop::sample::select(Scheme::ALL.to_vec()),
        ends in prop::sample::select(Ends::ALL.to_vec()),
        fps in prop::sample::select(vec!["60", "24", "10", "30000/1001", "240"]),
        key_times in any::<bool>(),
        encoding in prop::sample::select(vec![Encoding::Float, Encoding::Normalized16]),
    ) {
        let keyframes = read::keyframes("random.dat", clip.text(order).as_bytes(), None).unwrap();
        let ends = if ends.accept(&keyframes.clip).is_ok() { ends } else { Ends::Natural };
        let options = Options {
            quat_order: None,
            cameras: Vec::new(),
            path_colour: None,
            name: "random".into(),
            inputs: vec!["random.dat".into()],
            schemes: vec![scheme],
            sampling: Sampling::Rate { fps: fps.parse().unwrap(), key_times },
            writing: Writing { encoding, ..Writing::default() },
        };
        let boxes = keyframes.clip.tracks.len();
        let inputs = Inputs { keyframes: Some(keyframes), path: None, cameras: Vec::new() };
        let shape = Shape { ends, ..Shape::default() };
        let ground = Ground::new(&inputs, shape, &options.schemes).unwrap();
        let plan = Plan::new(&ground, "random.dat", &options).unwrap();
        let (file, facts) = plan.write_glb(Cursor::new(Vec::new()), |_| ()).unwrap();
        let mut asset = Asset::open(Box::new(file), Box::new(NoFiles)).unwrap();

        let mut report = check::asset(&mut asset);
        prop_assert!(report.worst() < Some(Severity::Error), "{}", report.text("random.glb"));
        // Large steps are the clip's own; everything else would be the writer's.
        let unexpected = report.findings().iter().find(|finding| {
            !matches!(finding.code, Code::RotationLargeStep | Code::RotationJump)
        });
        prop_assert!(unexpected.is_none(), "{}", report.text("random.glb"));

        let compared = motion::compare(&mut asset, &inputs, Given::default(), &mut report).unwrap();
        prop_assert_eq!(report.count_of(Code::MotionDiffers), 0, "{}", report.text("random.glb"));
        prop_assert_eq!(compared[0].boxes.len(), boxes);
        for (found, facts) in compared[0].boxes.iter().zip(&facts[0].tracks) {
            let largest = found.difference.largest();
            // But for the last digits of float64.
            prop_assert!(largest.off <= facts.deviation.unwrap() + 1e-12, "{found:?} {facts:?}");
            let rounding = if encoding == Encoding::Float { 3e-5 } else { encoding.largest_error() };
            prop_assert!(found.difference.samples.off < rounding, "{found:?}");
        }
    }
}
