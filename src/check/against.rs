//! Compares how a file plays with a curve it should follow.
//!
//! The file is played as the specification says; where it should be is for
//! the caller to say, as a function of time. Keys are streamed: memory does
//! not grow with the file.

use serde::Serialize;

use crate::asset::play::{Channel, Clip, Interpolation, Keys, Property, at_key, between, slerp};
use crate::asset::{Asset, Error};
use gltf::json::Node;

/// Where between two samples the file is compared, as parts of the interval.
const BETWEEN: [f64; 3] = [0.25, 0.5, 0.75];

/// In how many parts an interval is looked at over time.
const PARTS: u32 = 32;

/// The largest difference at some kind of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Largest {
    /// The angle between file and curve, degrees, or their distance, units.
    pub off: f64,
    /// When, seconds.
    pub time: f64,
    /// How many times were compared.
    pub compared: u64,
}

/// How far a node's rotation or place strays from a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Difference {
    /// At the input's keys.
    pub keys: Largest,
    /// At the file's keys.
    pub samples: Largest,
    /// Between neighbouring keys of the file.
    pub between: Largest,
}

impl Largest {
    fn note(&mut self, off: f64, time: f64) {
        self.compared += 1;
        if off > self.off || self.compared == 1 {
            *self = Largest { off, time, ..*self };
        }
    }
}

impl Difference {
    /// The largest of all.
    pub fn largest(&self) -> Largest {
        let [first, rest @ ..] = [self.keys, self.samples, self.between];
        rest.into_iter().fold(first, |a, b| if b.off > a.off { b } else { a })
    }
}

/// What a node does by a curve, at a time in seconds.
pub enum Curve<'a> {
    /// It turns: a quaternion x y z w.
    Rotation(&'a dyn Fn(f64) -> [f64; 4]),
    /// It is moved.
    Translation(&'a dyn Fn(f64) -> [f64; 3]),
}

impl Curve<'_> {
    fn property(&self) -> Property {
        match self {
            Curve::Rotation(_) => Property::Rotation,
            Curve::Translation(_) => Property::Translation,
        }
    }

    /// What a node has that nothing moves.
    fn resting(&self, node: &Node) -> Vec<f64> {
        match self {
            Curve::Rotation(_) => node.rotation.unwrap_or_default().0.map(f64::from).to_vec(),
            Curve::Translation(_) => node.translation.unwrap_or_default().map(f64::from).to_vec(),
        }
    }

    /// How far a value is off at a time, degrees or units.
    fn off(&self, value: &[f64], t: f64) -> f64 {
        match self {
            Curve::Rotation(curve) => degrees(four(value), curve(t)),
            Curve::Translation(curve) => {
                let wanted = curve(t);
                let part = |i: usize| value.get(i).copied().unwrap_or(f64::NAN) - wanted[i];
                libm::hypot(libm::hypot(part(0), part(1)), part(2))
            }
        }
    }
}

/// Compares what `clip` does to `node` with a curve: at the times of the file's keys,
/// between them, and at `keys`, the input's key times in rising order.
///
/// A node that the clip does not move stays as it is.
pub fn compare(
    asset: &mut Asset,
    clip: &Clip,
    node: usize,
    keys: &[f64],
    curve: &Curve,
) -> Result<Difference, Error> {
    let mut difference = Difference::default();
    let mut note = |at: At, time: f64, off: f64| match at {
        At::Key => difference.keys.note(off, time),
        At::Sample => difference.samples.note(off, time),
        At::Between => difference.between.note(off, time),
    };
    visit(asset, clip, node, &Look { keys, between: &BETWEEN, curve }, &mut note)?;
    Ok(difference)
}

/// How far off a node is over time: times in rising order, each with degrees or units, at
/// the file's keys and at every 32nd part of the way between them. A node that the clip does
/// not move is looked at in the same way between `keys`.
pub fn over_time(
    asset: &mut Asset,
    clip: &Clip,
    node: usize,
    keys: &[f64],
    curve: &Curve,
    note: &mut dyn FnMut(f64, f64),
) -> Result<(), Error> {
    let moved = clip.channels.iter().any(|c| c.node == node && c.property == curve.property());
    let keys = if moved { &[] } else { keys };
    let between: Vec<f64> = (1..PARTS).map(|i| f64::from(i) / f64::from(PARTS)).collect();
    let look = Look { keys, between: &between, curve };
    visit(asset, clip, node, &look, &mut |_, time, off| note(time, off))
}

/// When to look, and what there should be.
struct Look<'a> {
    keys: &'a [f64],
    between: &'a [f64],
    curve: &'a Curve<'a>,
}

/// What kind of time is looked at.
enum At {
    Key,
    Sample,
    Between,
}

/// Compares what a clip does to a node, or how the node rests where it does nothing.
fn visit(
    asset: &mut Asset,
    clip: &Clip,
    node: usize,
    look: &Look,
    note: &mut dyn FnMut(At, f64, f64),
) -> Result<(), Error> {
    let property = look.curve.property();
    let channel = clip.channels.iter().find(|channel| channel.node == node && channel.property == property);
    match (channel, asset.root().nodes.get(node)) {
        (Some(channel), _) => played(asset, channel, look, note),
        (None, Some(stored)) => {
            rested(&look.curve.resting(stored), look, note);
            Ok(())
        }
        (None, None) => Err(Error::data(format!("/nodes/{node}"), "there is no such node")),
    }
}

/// A key of the file: its time and the numbers stored for it.
struct Sample {
    time: f64,
    stored: Vec<f64>,
}

fn played(
    asset: &mut Asset,
    channel: &Channel,
    look: &Look,
    note: &mut dyn FnMut(At, f64, f64),
) -> Result<(), Error> {
    let off = |value: &[f64], t: f64| look.curve.off(value, t);
    let mut keys = look.keys.iter().copied().peekable();
    let mut previous: Option<Sample> = None;
    let mut blocks = Keys::new(channel);
    while let Some(block) = blocks.next(asset)? {
        let values = block.values.chunks_exact(channel.stored_width());
        for (&time, stored) in block.times.iter().zip(values) {
            let sample =
                Sample { time: f64::from(time), stored: stored.iter().copied().map(f64::from).collect() };
            let value = at_key(channel, &sample.stored).to_vec();
            if let Some(previous) = &previous {
                for u in look.between {
                    let time = previous.time + u * (sample.time - previous.time);
                    let got = at(channel, previous, &sample, time);
                    note(At::Between, time, off(&got, time));
                }
            }
            note(At::Sample, sample.time, off(&value, sample.time));
            // Keys up to this sample: before the first it holds.
            while let Some(key) = keys.next_if(|&key| key <= sample.time) {
                let got = match &previous {
                    Some(previous) if key < sample.time => at(channel, previous, &sample, key),
                    _ => value.clone(),
                };
                note(At::Key, key, off(&got, key));
            }
            previous = Some(sample);
        }
    }
    if let Some(last) = previous {
        let value = at_key(channel, &last.stored).to_vec();
        keys.for_each(|key| note(At::Key, key, off(&value, key)));
    }
    Ok(())
}

/// The channel's value at a time between two neighbouring keys.
fn at(channel: &Channel, from: &Sample, to: &Sample, time: f64) -> Vec<f64> {
    let length = to.time - from.time;
    let u = (time - from.time) / length;
    match (channel.interpolation, &channel.property) {
        (Interpolation::Linear, Property::Rotation) => {
            slerp(four(&from.stored), four(&to.stored), u).to_vec()
        }
        _ => between(channel, &from.stored, &to.stored, u, length),
    }
}

fn rested(value: &[f64], look: &Look, note: &mut dyn FnMut(At, f64, f64)) {
    for (i, &key) in look.keys.iter().enumerate() {
        note(At::Key, key, look.curve.off(value, key));
        for u in look.keys.get(i + 1).into_iter().flat_map(|_| look.between) {
            let time = key + u * (look.keys[i + 1] - key);
            note(At::Between, time, look.curve.off(value, time));
        }
    }
}

fn four(q: &[f64]) -> [f64; 4] {
    std::array::from_fn(|i| q.get(i).copied().unwrap_or(f64::NAN))
}

/// The angle of the rotation that leads from one to the other, degrees.
///
/// Neither needs to be of unit length. The arc tangent is accurate for the
/// tiniest angles, where a cosine would round them to zero. What is no
/// rotation, zero or not finite, is as far as can be.
pub fn degrees(a: [f64; 4], b: [f64; 4]) -> f64 {
    let (sine, cosine) = half_angle(a, b);
    2.0 * libm::atan2(sine, cosine).to_degrees()
}

/// The sine and cosine of half the angle of [`degrees`], both times the same number.
pub(crate) fn half_angle(a: [f64; 4], b: [f64; 4]) -> (f64, f64) {
    let [ax, ay, az, aw] = a;
    let [bx, by, bz, bw] = b;
    // The relative rotation, a⁻¹ b but for its length.
    let x = aw * bx - bw * ax - (ay * bz - az * by);
    let y = aw * by - bw * ay - (az * bx - ax * bz);
    let z = aw * bz - bw * az - (ax * by - ay * bx);
    let w = aw * bw + ax * bx + ay * by + az * bz;
    let sine = (x * x + y * y + z * z).sqrt();
    if !(sine.is_finite() && w.is_finite()) || (sine == 0.0 && w == 0.0) {
        return (1.0, 0.0);
    }
    (sine, w.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::tests::animated;

    fn turn(degrees: f64) -> [f64; 4] {
        let half = degrees.to_radians() / 2.0;
        [half.sin(), 0.0, 0.0, half.cos()]
    }

    fn file(interpolation: &str, times: &[f32], angles: &[f64]) -> Asset {
        let values: Vec<f32> = angles.iter().flat_map(|&a| turn(a)).map(|x| x as f32).collect();
        animated("rotation", interpolation, times, &values)
    }

    fn compared(asset: &mut Asset, keys: &[f64], curve: &dyn Fn(f64) -> [f64; 4]) -> Difference {
        let clip = asset.clips().remove(0);
        compare(asset, &clip, 0, keys, &Curve::Rotation(curve)).unwrap()
    }

    #[track_caller]
    fn near(found: Largest, degrees: f64, time: f64) {
        assert!((found.off - degrees).abs() < 1e-5, "{found:?}");
        assert_eq!(found.time, time, "{found:?}");
    }

    #[test]
    fn angles_are_accurate_from_tiny_to_half_a_turn() {
        for angle in [1e-12, 1e-7, 1e-3, 1.0, 90.0, 179.999, 180.0] {
            for start in [0.0, 33.0] {
                let (a, b) = (turn(start).map(|x| -3.0 * x), turn(start + angle));
                let got = degrees(a, b);
                assert!((got - angle).abs() < 1e-13 + 1e-14 * angle, "{angle}: {got}");
            }
        }
        assert!(degrees(turn(0.0), turn(350.0)) - 10.0 < 1e-12);
        assert_eq!(degrees([0.0; 4], turn(1.0)), 180.0);
        assert_eq!(degrees([f64::NAN; 4], turn(1.0)), 180.0);
    }

    #[test]
    fn a_file_that_follows_the_curve_does_not_stray() {
        let mut asset = file("LINEAR", &[0.0, 0.5, 2.0], &[0.0, 15.0, 60.0]);
        let found = compared(&mut asset, &[0.0, 0.3, 2.0], &|t| turn(30.0 * t));
        assert!(found.largest().off < 1e-5, "{found:?}");
        assert_eq!((found.keys.compared, found.samples.compared, found.between.compared), (3, 3, 6));
    }

    #[test]
    fn each_kind_of_time_has_its_own_largest_angle() {
        // The curve is 40 t² degrees; straight lines stray most half way.
        let mut asset = file("LINEAR", &[0.0, 0.5, 1.0], &[0.0, 10.0, 41.0]);
        let found = compared(&mut asset, &[0.0, 0.2], &|t| turn(40.0 * t * t));
        near(found.samples, 1.0, 1.0);
        near(found.between, 3.0, 0.75);
        near(found.keys, 4.0 - 1.6, 0.2);
        near(found.largest(), 3.0, 0.75);
    }

    #[test]
    fn outside_of_its_keys_the_file_holds() {
        let mut asset = file("LINEAR", &[1.0, 2.0], &[10.0, 20.0]);
        let curve = |t: f64| turn(10.0 * t);
        near(compared(&mut asset, &[0.0], &curve).keys, 10.0, 0.0);
        near(compared(&mut asset, &[5.0], &curve).keys, 30.0, 5.0);
    }

    #[test]
    fn steps_and_resting_nodes() {
        let mut asset = file("STEP", &[0.0, 1.0], &[0.0, 8.0]);
        let found = compared(&mut asset, &[], &|t| turn(8.0 * t));
        near(found.between, 6.0, 0.75);
        let mut asset = animated("translation", "LINEAR", &[0.0], &[0.0; 3]);
        let found = compared(&mut asset, &[0.0, 1.0], &|t| turn(8.0 * t));
        near(found.keys, 8.0, 1.0);
        near(found.between, 6.0, 0.75);
    }

    #[test]
    fn over_time_is_in_order_and_peaks_half_way() {
        let mut asset = file("LINEAR", &[0.0, 0.5, 1.0], &[0.0, 10.0, 40.0]);
        let (clip, mut seen) = (asset.clips().remove(0), Vec::new());
        let curve = |t: f64| turn(40.0 * t * t);
        let mut note = |time: f64, off: f64| seen.push((time, off));
        over_time(&mut asset, &clip, 0, &[0.0, 1.0], &Curve::Rotation(&curve), &mut note).unwrap();
        assert_eq!(seen.len(), 65);
        for (i, (time, off)) in seen.into_iter().enumerate() {
            assert_eq!(time, i as f64 / 64.0);
            let u = 2.0 * time % 1.0;
            assert!((off - 10.0 * u * (1.0 - u)).abs() < 1e-5, "{time}: {off}");
        }
    }
}
