//! Where axes point over time, as traces on the unit sphere.

use super::figure::{Axis, Dot, Entry, Figure, Layer, Panel, Sign};
use super::style::{Ink, Stroke, of_scheme};
use super::subject::{Subject, entries};
use super::{Asked, Error, Line, Point};
use crate::clip::Body;
use crate::curve::Scheme;
use crate::moves::{Move, Mover};
use crate::orient::Axis as Nose;
use glam::{DQuat, DVec3};

/// In how many steps of time a trace is looked at: eight for each key, within these.
const STEPS: [usize; 2] = [2000, 20_000];

/// More keys than this are not marked.
const MOST_KEYS: usize = 200;

/// How far the view is turned aside from the middle of what is seen.
const ASIDE: f64 = 0.5;

/// Directions at some times.
type Directions = Vec<DVec3>;

/// A panel for each thing that turns, or for the chosen one.
pub(super) fn figure(subject: &Subject, asked: &Asked) -> Result<Figure, Error> {
    let turned = turned(subject);
    if turned.is_empty() {
        return Err(Error::NoRotations("sphere", "--orient tangent turns the object with it"));
    }
    let chosen: Vec<usize> = match asked.only {
        None => (0..turned.len()).collect(),
        Some(found) if (1..=turned.len()).contains(&found) => vec![found - 1],
        Some(found) => return Err(Error::Box { last: turned.len(), found }),
    };
    let schemes = schemes(subject);
    let (times, keys) = times(subject);
    let traces: Vec<Vec<Directions>> = schemes
        .iter()
        .map(|scheme| directions(subject, scheme.unwrap_or(subject.schemes[0]), &times))
        .collect();
    let at_keys = directions(subject, subject.schemes[0], &keys);
    let seen = chosen.iter().flat_map(|&i| &traces[0][i]);
    let view = View::towards(seen.sum());
    let panels = chosen.iter().map(|&i| {
        let of = |trace: &Vec<Directions>| trace[i].clone();
        let traces: Vec<_> = schemes.iter().copied().zip(traces.iter().map(of)).collect();
        let keys = at_keys.get(i).map_or([].as_slice(), Vec::as_slice);
        panel(subject.named(turned[i]), &view, &traces, keys)
    });
    let mut legend = entries(schemes.iter());
    for entry in legend.iter_mut().filter(|_| !subject.ground.has_schemes()) {
        entry.label = if subject.clip().is_some() { entry.label.clone() } else { "path".to_owned() };
    }
    if !keys.is_empty() {
        legend.push(Entry { label: "keys".to_owned(), sign: Sign::Dot(Dot::Key) });
    }
    let what = match subject.clip().map(|clip| clip.body) {
        Some(Body::Chain { .. }) => "where boxes hang",
        _ => "where the nose points",
    };
    let panels: Vec<Panel> = panels.collect();
    let (columns, side) = match panels.len() {
        1 => (1, 720.0),
        2 => (2, 540.0),
        3 | 4 => (2, 520.0),
        5..=9 => (3, 420.0),
        _ => (4, 360.0),
    };
    let shares = [Vec::new(), Vec::new()];
    let title = format!("{}: {what}", subject.name);
    Ok(Figure { title, legend, ramp: None, panels, columns, shares, cell: [side, side] })
}

/// What turns, by keys or with the path.
fn turned(subject: &Subject) -> Vec<Mover> {
    let moves = subject.ground.moves(subject.schemes[0]);
    moves.iter().filter(|(_, a_move)| a_move.travel().is_none()).map(|(mover, _)| *mover).collect()
}

/// By which schemes; one that has no name where none makes a difference.
fn schemes(subject: &Subject) -> Vec<Option<Scheme>> {
    if subject.ground.has_schemes() {
        subject.schemes.iter().copied().map(Some).collect()
    } else {
        vec![None]
    }
}

/// When traces are looked at, and the times of keys that are marked.
fn times(subject: &Subject) -> (Vec<f64>, Vec<f64>) {
    let moves = subject.ground.moves(subject.schemes[0]);
    let keys = moves.iter().find_map(|(_, a_move)| match a_move {
        Move::Keys(motion) => Some(motion.times().to_vec()),
        _ => None,
    });
    let keys = keys.unwrap_or_default();
    let count = (8 * keys.len()).clamp(STEPS[0], STEPS[1]);
    let duration = subject.ground.duration();
    let mut times: Vec<f64> = (0..=count).map(|i| duration * i as f64 / count as f64).collect();
    let marked = if keys.len() > MOST_KEYS { Vec::new() } else { keys };
    times.extend(&marked);
    times.sort_by(f64::total_cmp);
    (times, marked)
}

/// Where each thing that turns points at some times, in the world's axes.
fn directions(subject: &Subject, scheme: Scheme, times: &[f64]) -> Vec<Directions> {
    let moves = subject.ground.moves(scheme);
    let turns: Vec<_> = moves.iter().filter(|(_, a_move)| a_move.travel().is_none()).collect();
    // The root comes last in files, but turns all others.
    let root = turns.iter().find(|(mover, _)| *mover == Mover::Root);
    let axis = axis(subject);
    let mut found = vec![Vec::with_capacity(times.len()); turns.len()];
    for &t in times {
        let mut world = root.map_or(DQuat::IDENTITY, |(_, a_move)| a_move.turned(t).into());
        for ((mover, a_move), found) in turns.iter().zip(&mut found) {
            match mover {
                Mover::Root => found.push(DQuat::from(a_move.turned(t)) * nose(subject)),
                Mover::Track(_) => {
                    world *= DQuat::from(a_move.turned(t));
                    found.push(world * axis);
                }
            }
        }
    }
    found
}

/// The axis of what keys turn: a box's runs down from its hinge, a body's to its nose.
fn axis(subject: &Subject) -> DVec3 {
    match subject.clip().map(|clip| clip.body) {
        Some(Body::Chain { .. }) => DVec3::NEG_Y,
        _ => DVec3::Z,
    }
}

/// The axis of what a path turns.
fn nose(subject: &Subject) -> DVec3 {
    match subject.ground.shape().model_forward {
        Nose::X => DVec3::X,
        Nose::Y => DVec3::Y,
        Nose::Z => DVec3::Z,
        Nose::MinusX => DVec3::NEG_X,
        Nose::MinusY => DVec3::NEG_Y,
        Nose::MinusZ => DVec3::NEG_Z,
    }
}

/// From where the sphere is seen: three axes, to the right, up and to the eye.
struct View {
    right: DVec3,
    up: DVec3,
    eye: DVec3,
}

impl View {
    /// Somewhat aside from a direction, of any length.
    fn towards(middle: DVec3) -> View {
        let middle = middle.try_normalize().unwrap_or(DVec3::Z);
        let aside = if middle.z.abs() < 0.8 { DVec3::Z } else { DVec3::new(0.6, 0.8, 0.0) };
        let eye = (middle + ASIDE * aside.reject_from(middle).normalize()).normalize();
        let hint = if eye.y.abs() < 0.98 { DVec3::Y } else { DVec3::Z };
        let up = hint.reject_from(eye).normalize();
        View { right: up.cross(eye), up, eye }
    }

    fn place(&self, v: DVec3) -> Point {
        [v.dot(self.right), v.dot(self.up)]
    }

    /// A trace in what lies on the front half and what on the back half. Where it passes
    /// the rim between two places, both halves get the rim's.
    fn halves(&self, trace: impl Iterator<Item = DVec3>) -> [Line; 2] {
        let mut halves = [Line::new(), Line::new()];
        let mut before: Option<DVec3> = None;
        for v in trace {
            let half = usize::from(v.dot(self.eye) < 0.0);
            match before.filter(|b| usize::from(b.dot(self.eye) < 0.0) != half) {
                Some(b) => {
                    let (near, far) = (b.dot(self.eye), v.dot(self.eye));
                    let rim = self.place(b.lerp(v, near / (near - far)).normalize_or_zero());
                    if let Some(stretch) = halves[1 - half].last_mut() {
                        stretch.push(rim);
                    }
                    halves[half].push(vec![rim]);
                }
                None if before.is_none() => halves[half].push(Vec::new()),
                None => {}
            }
            if let Some(stretch) = halves[half].last_mut() {
                stretch.push(self.place(v));
            }
            before = Some(v);
        }
        halves
    }
}

fn panel(title: String, view: &View, traces: &[(Option<Scheme>, Directions)], keys: &[DVec3]) -> Panel {
    let mut layers = globe(view);
    let halves: Vec<_> =
        traces.iter().map(|(scheme, trace)| (*scheme, view.halves(trace.iter().copied()))).collect();
    for (scheme, [_, back]) in &halves {
        layers.push(Layer::Trace(back.clone(), of_scheme(*scheme).faint()));
    }
    for (scheme, [front, _]) in &halves {
        layers.push(Layer::Trace(front.clone(), of_scheme(*scheme)));
    }
    let front = keys.iter().filter(|v| v.dot(view.eye) >= 0.0);
    layers.push(Layer::Dots(front.map(|&v| view.place(v)).collect(), Dot::Key));
    let range = [-1.22, 1.22];
    Panel { title, x: Axis::bare(range), y: Axis::bare(range), equal: false, layers }
}

/// Circles every 30°, the rim, and the names of axes.
fn globe(view: &View) -> Vec<Layer> {
    let grid = Stroke::solid(Ink::Grid, 1.0);
    let step = 30f64.to_radians();
    let angles = || (0..=120).map(|i| f64::from(i) / 120.0 * std::f64::consts::TAU);
    let meridian = |k: i32| {
        let (sin, cos) = libm::sincos(f64::from(k) * step);
        view.halves(angles().map(move |a| DVec3::new(libm::cos(a) * cos, libm::sin(a), libm::cos(a) * sin)))
    };
    let parallel = |k: i32| {
        let (sin, cos) = libm::sincos(f64::from(k) * step);
        view.halves(angles().map(move |a| DVec3::new(cos * libm::cos(a), sin, cos * libm::sin(a))))
    };
    let circles: Vec<[Line; 2]> = (0..6).map(meridian).chain((-2..=2).map(parallel)).collect();
    let mut layers = Vec::new();
    layers.extend(circles.iter().map(|[_, back]| Layer::Trace(back.clone(), grid.faint())));
    layers.extend(circles.iter().map(|[front, _]| Layer::Trace(front.clone(), grid)));
    let rim = angles().map(|a| [libm::cos(a), libm::sin(a)]).collect();
    layers.push(Layer::Trace(vec![rim], Stroke::solid(Ink::Quiet, 1.1)));
    for (axis, name) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")] {
        for (sign, shown) in [(1.0, format!("+{name}")), (-1.0, format!("−{name}"))] {
            let [x, y] = view.place(sign * axis);
            let length = libm::hypot(x, y);
            // Names of what points to the eye or away would lie over the traces.
            if length > 0.7 {
                let stroke =
                    if sign * axis.dot(view.eye) < 0.0 { grid } else { Stroke::solid(Ink::Quiet, 1.1) };
                let out = |r: f64| [x * r / length, y * r / length];
                layers.push(Layer::Trace(vec![vec![out(length), out(1.05)]], stroke));
                layers.push(Layer::Words(out(1.12), shown));
            }
        }
    }
    layers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_turn_with_those_above_them() {
        // Both boxes turn about z, by 90° at the end: the first then hangs to +x, and the
        // second, which turns once more, stands up.
        let text = "# 2 1\n0 1 0 0 0 1 0 0 0\n1 1 0 0 1 1 0 0 1\n";
        let input = crate::read::keyframes("t.dat", text.as_bytes(), None).unwrap();
        let inputs = crate::moves::Inputs { keyframes: Some(input), path: None, cameras: Vec::new() };
        let schemes = [Scheme::Slerp];
        let ground = crate::moves::Ground::new(&inputs, crate::moves::Shape::default(), &schemes).unwrap();
        let (order, frame) = (crate::read::Order::Wxyz, crate::orient::Frame::Gltf);
        let subject = Subject { name: "t", ground: &ground, schemes: &schemes, order, rows: frame, frame };
        let found = directions(&subject, Scheme::Slerp, &[0.0, 0.5, 1.0]);
        let diagonal = DVec3::new(0.5f64.sqrt(), -(0.5f64.sqrt()), 0.0);
        let wanted = [[DVec3::NEG_Y, diagonal, DVec3::X], [DVec3::NEG_Y, DVec3::X, DVec3::Y]];
        for (found, wanted) in found.iter().flatten().zip(wanted.as_flattened()) {
            assert!((*found - *wanted).length() < 1e-7, "{found} {wanted}");
        }
    }

    #[test]
    fn the_view_is_a_right_handed_frame_near_what_is_seen() {
        for middle in [DVec3::NEG_Y, DVec3::Z, DVec3::new(3.0, -1.0, 2.0), DVec3::ZERO] {
            let view = View::towards(middle);
            assert!((view.right.cross(view.up) - view.eye).length() < 1e-12);
            assert!((view.right.length() - 1.0).abs() < 1e-12 && (view.up.length() - 1.0).abs() < 1e-12);
            assert!(middle == DVec3::ZERO || view.eye.dot(middle.normalize()) > 0.85);
        }
    }

    #[test]
    fn a_circle_through_the_poles_of_the_view_has_two_halves_that_meet_at_the_rim() {
        let view = View { right: DVec3::X, up: DVec3::Y, eye: DVec3::Z };
        let circle = (0..=100).map(|i| {
            let a = f64::from(i) * 0.02 * std::f64::consts::PI;
            DVec3::new(a.sin(), 0.0, a.cos())
        });
        let [front, back] = view.halves(circle);
        assert_eq!((front.len(), back.len()), (2, 1));
        let ends = [back[0][0], back[0][back[0].len() - 1]];
        assert!((ends[0][0] - 1.0).abs() < 1e-9 && (ends[1][0] + 1.0).abs() < 1e-9);
        assert!(front.iter().chain(&back).flatten().all(|p| p[0].hypot(p[1]) <= 1.0 + 1e-12));
    }
}
