//! How fast each stage is: `cargo bench`. Throughput is per item: bytes parsed, rotations
//! evaluated, sampled or written.

use dat2glb::convert::{Options, Plan, Sampling};
use dat2glb::curve::{Arc, Ends, Motion, Scheme};
use dat2glb::math::{Quat, Vec3};
use dat2glb::moves::{Ground, Inputs, Shape};
use dat2glb::read::{self, Keyframes};
use dat2glb::reduce::{self, Turning};
use dat2glb::sample::{Fps, Rotation, Timeline, rotations};
use divan::counter::{BytesCount, ItemsCount};
use divan::{Bencher, black_box};
use std::fmt::Write;
use std::io::Cursor;

fn main() {
    divan::main();
}

const SCHEMES: &[&str] = &["slerp", "squad", "catmull-rom", "bessel-overhauser", "bessel"];

/// A chain of `boxes` that sways smoothly, as text: keys 30 to 90 ms apart.
fn text(boxes: usize, keys: usize) -> String {
    let mut text = format!("# {boxes} 3.0\n");
    let mut t = 0.0;
    for key in 0..keys {
        write!(text, "{t:.6}").unwrap();
        for index in 0..boxes {
            let phase = t + index as f64;
            let v = Vec3::new(0.4 * phase.sin(), 0.3 * (1.3 * phase).cos(), 0.5 * (0.7 * phase).sin());
            for part in Quat::exp(v).to_wxyz() {
                write!(text, " {part:.9e}").unwrap();
            }
        }
        text.push('\n');
        t += 0.03 + 0.02 * (key % 4) as f64;
    }
    text
}

fn keyframes(boxes: usize, keys: usize) -> Keyframes {
    read::keyframes("bench.dat", text(boxes, keys).as_bytes(), None).unwrap()
}

#[divan::bench(args = [(1, 100_000), (4, 25_000), (100, 1_000)])]
fn parse(bencher: Bencher, (boxes, keys): (usize, usize)) {
    let text = text(boxes, keys);
    bencher
        .counter(BytesCount::of_str(&text))
        .bench(|| read::keyframes("bench.dat", black_box(text.as_bytes()), None).unwrap());
}

/// One core, ten samples a segment, float64.
#[divan::bench(args = SCHEMES)]
fn curve(bencher: Bencher, scheme: &str) {
    let clip = keyframes(1, 10_000).clip;
    let motion = Motion::new(&clip.times, &clip.tracks[0], Scheme::from_name(scheme).unwrap(), Ends::Natural);
    let segments = clip.times.len() - 1;
    bencher.counter(ItemsCount::new(10 * segments)).bench(|| {
        for i in 0..segments {
            let piece = motion.piece(i, clip.times[i]);
            for k in 0..10 {
                black_box(piece.at(0.1 * f64::from(k)));
            }
        }
    });
}

/// One core, float64: many samples at once, so many a segment.
#[divan::bench(args = SCHEMES, consts = [1, 3, 10])]
fn curve_at_all<const PER: usize>(bencher: Bencher, scheme: &str) {
    let clip = keyframes(1, 10_000).clip;
    let motion = Motion::new(&clip.times, &clip.tracks[0], Scheme::from_name(scheme).unwrap(), Ends::Natural);
    let places = clip.times.windows(2).flat_map(|key| {
        (0..PER).map(|i| (key[0] + (key[1] - key[0]) * (0.37 + i as f64) / PER as f64) as f32)
    });
    let times: Vec<f32> = places.collect();
    bencher.counter(ItemsCount::new(times.len())).bench(|| motion.at_all(black_box(&times)));
}

/// All cores, with the bound on playback's deviation.
#[divan::bench(args = SCHEMES)]
fn sample(bencher: Bencher, scheme: &str) {
    let clip = keyframes(4, 10_000).clip;
    let scheme = Scheme::from_name(scheme).unwrap();
    let timeline = Timeline::new(&clip.times, None, Fps::DEFAULT, true).unwrap();
    let motion = |track| Rotation::Motion(Motion::new(&clip.times, track, scheme, Ends::Natural));
    let motions: Vec<Rotation> = clip.tracks.iter().map(|track| motion(track)).collect();
    bencher.counter(ItemsCount::new(4 * timeline.len())).bench(|| {
        rotations(&motions, &timeline, Default::default(), |chunk| {
            black_box(chunk.to_vec());
            Ok::<(), ()>(())
        })
        .unwrap()
    });
}

/// One core: the fewest keys within a tolerance in degrees, with the proof; by input keys.
#[divan::bench(args = [0.1, 0.01, 0.001])]
fn fewest_keys(bencher: Bencher, tolerance: f64) {
    let clip = keyframes(1, 10_000).clip;
    let motion = Motion::new(&clip.times, &clip.tracks[0], Scheme::Bessel, Ends::Natural);
    let curve = Turning::new(motion);
    let options = reduce::Options { max_step: Some(18.0), ..reduce::Options::new(tolerance) };
    bencher
        .counter(ItemsCount::new(clip.times.len()))
        .bench(|| reduce::rotation(&curve, black_box(&options)).unwrap());
}

/// Sampling and writing a .glb to memory.
#[divan::bench(args = SCHEMES)]
fn write(bencher: Bencher, scheme: &str) {
    let keyframes = keyframes(4, 10_000);
    let options = Options {
        quat_order: None,
        cameras: Vec::new(),
        path_colour: None,
        name: "bench".into(),
        inputs: vec!["bench.dat".into()],
        schemes: vec![Scheme::from_name(scheme).unwrap()],
        sampling: Sampling::Rate { fps: Fps::DEFAULT, key_times: true },
        writing: Default::default(),
    };
    let inputs = Inputs { keyframes: Some(keyframes), path: None, cameras: Vec::new() };
    let ground = Ground::new(&inputs, Shape::default(), &options.schemes).unwrap();
    let plan = Plan::new(&ground, "bench.dat", &options).unwrap();
    bencher
        .counter(ItemsCount::new(plan.samples()))
        .bench(|| plan.write_glb(Cursor::new(Vec::new()), |_| ()).unwrap());
}
