//! A path: its curve with its timing.

use super::knots::{self, SHORTEST, Spacing};
use super::piece::Piece;
use super::pieces::{self, Part};
use super::segments::{self, Segments};
use super::{Course, Ease, Error, Kind, Options, PathEnds};
use glam::DVec3;

/// Coordinates up to here leave room for their squares and for rates.
const LARGEST: f64 = 1e150;

/// The longest duration, seconds.
const LONGEST: f64 = 1e12;

/// Directions (unit vectors) and velocities (relative) that differ by less do not jump.
const JUMP: f64 = 1e-6;

/// A position as a function of time.
///
/// Times outside 0..=duration are clamped. Where velocity or acceleration jumps, its
/// value is the later one; the methods that end in `_before` give the earlier one.
#[derive(Clone, Debug)]
pub struct Path {
    control_points: Vec<DVec3>,
    key_points: Vec<DVec3>,
    key_times: Vec<f64>,
    pub(super) duration: f64,
    closed: bool,
    /// Everything in `pieces` is in this unit, a power of two, and about 1 at most.
    pub(super) unit: f64,
    /// Length in that unit.
    pub(super) length: f64,
    /// Constant speed, shaped by the easing; else segments take the time between keys.
    pub(super) steady: Option<Ease>,
    /// In order, the first from 0 on; never empty.
    pub(super) pieces: Vec<Piece>,
    corners: Vec<f64>,
    jumps: Vec<f64>,
}

impl Path {
    /// The path of a kind through or along `points`.
    ///
    /// `times`, if there are any, are seconds, one for each key point: each point, or
    /// each end of a Bézier segment. They may start at any time.
    pub fn new(
        kind: Kind,
        points: &[DVec3],
        times: Option<&[f64]>,
        options: &Options,
    ) -> Result<Path, Error> {
        segments::check_count(kind, points.len())?;
        let unit = unit(points)?;
        if let Some(times) = times {
            knots::check_times(times, segments::key_indices(kind, points.len()).len())?;
        }
        let plan = knots::plan(kind, times.is_some(), options)?;
        let scaled: Vec<DVec3> = points.iter().map(|p| *p / unit).collect();
        let Segments { keys, steps, curves } =
            segments::segments(kind, &scaled, times, plan.spacing, options.ends)?;
        let parts = pieces::parts(curves, plan.constant_speed);
        let length = parts.last().map_or(0.0, |part| part.behind);
        let keyed_times = times.filter(|_| plan.spacing == Spacing::Times && !plan.constant_speed);
        let seconds = duration(options, times, keyed_times.is_some(), length * unit, steps.len())?;
        let mut path = Path {
            control_points: points.to_vec(),
            key_points: keys.iter().map(|p| *p * unit).collect(),
            key_times: Vec::new(),
            duration: seconds,
            closed: options.ends == PathEnds::Closed,
            unit,
            length,
            // A path that is all one point, but for rounding, has no speed.
            steady: (plan.constant_speed && parts.iter().any(Part::moves)).then_some(options.ease),
            pieces: Vec::new(),
            corners: Vec::new(),
            jumps: Vec::new(),
        };
        path.run(parts, &steps, keyed_times);
        Ok(path)
    }

    /// Gives the parts their times, and finds what jumps.
    fn run(&mut self, parts: Vec<Part>, steps: &[f64], times: Option<&[f64]>) {
        if let Some(ease) = self.steady {
            let (length, duration) = (self.length, self.duration);
            let time_at = |s: f64| duration * ease.inverse((s / length).min(1.0));
            self.key_times = pieces::steady_key_times(&parts, self.key_points.len(), time_at);
            self.pieces = pieces::steady(parts, time_at);
        } else {
            self.key_times = pieces::key_times(steps, times, self.duration);
            self.pieces = pieces::keyed(parts, &self.key_times, steps, self.duration);
        }
        self.corners = self.meetings(|before, after| {
            let (a, b) = (before.last_direction().or(before.held), after.first_direction());
            matches!((a, b), (Some(a), Some(b)) if a.distance(b) > JUMP)
        });
        self.jumps = self.meetings(|before, after| {
            let ([a, _], [b, _]) = (self.derivatives(before, f64::INFINITY), self.derivatives(after, 0.0));
            a.distance(b) > JUMP * a.length().max(b.length())
        });
    }

    /// Times at which two pieces meet in a certain way.
    fn meetings(&self, so: impl Fn(&Piece, &Piece) -> bool) -> Vec<f64> {
        let meeting = self.pieces.windows(2).filter(|two| so(&two[0], &two[1]));
        let mut times: Vec<f64> = meeting.map(|two| two[1].start).collect();
        times.dedup();
        times
    }

    /// How long the path takes, seconds.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// How long the curve is, to a relative 1e-9 at least.
    pub fn length(&self) -> f64 {
        self.length * self.unit
    }

    /// When the path passes its key points, seconds from 0. Points that coincide under a
    /// timing by chords, or under constant speed, are passed at the same time.
    pub fn key_times(&self) -> &[f64] {
        &self.key_times
    }

    /// The points that the path passes at its key times: all points, or the ends of
    /// Bézier segments; where a closing segment was added, the first again.
    pub fn key_points(&self) -> &[DVec3] {
        &self.key_points
    }

    /// The points as they were given.
    pub fn control_points(&self) -> &[DVec3] {
        &self.control_points
    }

    /// Whether the end runs into the start.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Position at t.
    pub fn position(&self, t: f64) -> DVec3 {
        let piece = self.piece_at(t);
        piece.curve.at(self.parameter(piece, t)) * self.unit
    }

    /// Velocity at t, units a second.
    pub fn velocity(&self, t: f64) -> DVec3 {
        self.derivatives(self.piece_at(t), t)[0] * self.unit
    }

    /// Velocity just before t.
    pub fn velocity_before(&self, t: f64) -> DVec3 {
        self.derivatives(self.piece_before(t), t)[0] * self.unit
    }

    /// Acceleration at t, units a second squared. At the tip of a cusp that is run
    /// through at constant speed it has no limit, and only its part along the path counts.
    pub fn acceleration(&self, t: f64) -> DVec3 {
        self.derivatives(self.piece_at(t), t)[1] * self.unit
    }

    /// Acceleration just before t.
    pub fn acceleration_before(&self, t: f64) -> DVec3 {
        self.derivatives(self.piece_before(t), t)[1] * self.unit
    }

    /// Unit direction of travel at t: where the speed is zero its limit from inside;
    /// during a rest the last one before, or if there is none the first one after.
    pub fn direction(&self, t: f64) -> Option<DVec3> {
        let piece = self.piece_at(t);
        piece.direction(self.parameter(piece, t))
    }

    /// Unit direction of travel just before t.
    pub fn direction_before(&self, t: f64) -> Option<DVec3> {
        let piece = self.piece_before(t);
        piece.direction(self.parameter(piece, t))
    }

    /// The Bézier control points of the path from t0 to t1, where it is one polynomial of time
    /// there, cubic at most.
    pub fn cubic(&self, t0: f64, t1: f64) -> Option<[DVec3; 4]> {
        let mut pieces = self.overlapping(t0, t1);
        let (piece, a, b) = pieces.next()?;
        let timed = self.steady.is_none() && pieces.next().is_none() && a < b;
        let points = timed.then(|| piece.curve.part(a, b).cubic())??;
        Some(points.map(|point| point * self.unit))
    }

    /// Times inside at which the direction jumps, increasing. The seam of a closed path
    /// is not among them.
    pub fn corners(&self) -> &[f64] {
        &self.corners
    }

    /// Times inside at which the velocity jumps, increasing: corners that are not passed
    /// at rest, and keys where the speed alone changes.
    pub fn jumps(&self) -> &[f64] {
        &self.jumps
    }

    /// The piece that holds t: of two that meet there, the later one.
    fn piece_at(&self, t: f64) -> &Piece {
        &self.pieces[self.index_at(t)]
    }

    fn index_at(&self, t: f64) -> usize {
        self.pieces.partition_point(|piece| piece.start <= t).saturating_sub(1)
    }

    /// The piece that holds a place, and the place in its curve, 0..=1.
    fn piece_of(&self, place: f64) -> (&Piece, f64) {
        let i = (place.max(0.0) as usize).min(self.pieces.len() - 1);
        (&self.pieces[i], (place - i as f64).clamp(0.0, 1.0))
    }

    /// The piece that holds t: of two that meet there, the earlier one.
    fn piece_before(&self, t: f64) -> &Piece {
        let after = self.pieces.partition_point(|piece| piece.start < t);
        &self.pieces[after.saturating_sub(1)]
    }

    /// The place of t in a piece's curve, 0..=1.
    pub(super) fn parameter(&self, piece: &Piece, t: f64) -> f64 {
        // At the piece's own ends exactly there, whatever rounding says.
        if t <= piece.start {
            return 0.0;
        }
        if t >= piece.end {
            return 1.0;
        }
        match (self.steady, &piece.arc) {
            (Some(ease), Some(arc)) => {
                let way = self.length * ease.at(self.fraction(piece, t))[0];
                arc.parameter(&piece.curve, way - piece.before)
            }
            _ => ((t - piece.start) / piece.duration).clamp(0.0, 1.0),
        }
    }

    /// The fraction of the path's time at t, within the piece.
    fn fraction(&self, piece: &Piece, t: f64) -> f64 {
        (t.clamp(piece.start, piece.end) / self.duration).clamp(0.0, 1.0)
    }

    /// Velocity and acceleration at a time within a piece, in the path's unit.
    fn derivatives(&self, piece: &Piece, t: f64) -> [DVec3; 2] {
        let u = self.parameter(piece, t);
        let [first, second] = piece.curve.derivatives(u);
        let Some(ease) = self.steady else {
            let rate = 1.0 / piece.duration;
            return [first * rate, second * (rate * rate)];
        };
        let [_, speed, change] = ease.at(self.fraction(piece, t));
        let (speed, change) =
            (speed * self.length / self.duration, change * self.length / (self.duration * self.duration));
        let tangent = piece.direction(u).unwrap_or(DVec3::ZERO);
        let turning = if piece.is_straight() { DVec3::ZERO } else { curvature(tangent, first, second) };
        [tangent * speed, tangent * change + turning * (speed * speed)]
    }

    /// The pieces that overlap t0..t1, each with the range of its parameter that does.
    pub(super) fn overlapping(&self, t0: f64, t1: f64) -> impl Iterator<Item = (&Piece, f64, f64)> {
        let first = self.pieces.partition_point(|piece| piece.start <= t0).saturating_sub(1);
        let after = self.pieces.partition_point(|piece| piece.start < t1).max(first + 1);
        let range = move |piece| (piece, self.parameter(piece, t0), self.parameter(piece, t1));
        self.pieces[first..after].iter().map(range)
    }
}

/// The derivative of the unit tangent by arc length, (B″ − (B″·T)T)/|B′|².
fn curvature(tangent: DVec3, first: DVec3, second: DVec3) -> DVec3 {
    let curvature = (second - tangent * second.dot(tangent)) / first.length_squared();
    if curvature.is_finite() { curvature } else { DVec3::ZERO }
}

/// The power of two next below the largest coordinate.
fn unit(points: &[DVec3]) -> Result<f64, Error> {
    let usable = |p: &DVec3| p.is_finite() && p.abs().max_element() <= LARGEST;
    if let Some(point) = points.iter().position(|p| !usable(p)) {
        return Err(Error::Coordinate { point });
    }
    let largest = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let exponent = if largest > 0.0 { libm::log2(largest).floor().clamp(-1074.0, 1000.0) as i32 } else { 0 };
    // In two factors: the smallest powers have no reciprocal.
    let half = exponent / 2;
    Ok(2f64.powi(half) * 2f64.powi(exponent - half))
}

/// How long the path takes: as long as its times, as its speed says, as was asked, or a
/// second a segment.
fn duration(
    options: &Options,
    times: Option<&[f64]>,
    times_rule: bool,
    length: f64,
    segments: usize,
) -> Result<f64, Error> {
    if options.speed.is_some() && options.duration.is_some() {
        return Err(Error::TwoDurations("a speed"));
    }
    if times.is_some() && options.duration.is_some() {
        return Err(Error::TwoDurations("times for the points"));
    }
    if options.speed.is_some() && times_rule {
        return Err(Error::TwoDurations("a speed with times for the points"));
    }
    let own = times.map_or(segments as f64, |t| t[t.len() - 1] - t[0]);
    let seconds = match (options.speed, options.duration) {
        (Some(speed), _) if !(speed > 0.0 && speed.is_finite()) => return Err(Error::Speed(speed)),
        (Some(speed), _) if length > 0.0 => length / speed,
        (_, duration) => duration.unwrap_or(own),
    };
    if (SHORTEST..=LONGEST).contains(&seconds) { Ok(seconds) } else { Err(Error::Duration(seconds)) }
}

impl Course for Path {
    fn duration(&self) -> f64 {
        self.duration()
    }
    fn key_times(&self) -> &[f64] {
        self.key_times()
    }
    fn is_closed(&self) -> bool {
        self.is_closed()
    }
    fn position(&self, t: f64) -> DVec3 {
        self.position(t)
    }
    fn velocity(&self, t: f64) -> DVec3 {
        self.velocity(t)
    }
    fn acceleration(&self, t: f64) -> DVec3 {
        self.acceleration(t)
    }
    fn rates(&self, t: f64) -> [DVec3; 2] {
        self.derivatives(self.piece_at(t), t).map(|rate| rate * self.unit)
    }
    fn direction(&self, t: f64) -> Option<DVec3> {
        self.direction(t)
    }
    /// The number of the piece, and the parameter of its curve.
    fn place(&self, t: f64) -> f64 {
        let i = self.index_at(t);
        let piece = &self.pieces[i];
        let (from, to) = (i as f64, (i + 1) as f64);
        // What is before its end stays before it.
        let last = if t < piece.end { to.next_down() } else { to };
        (from + self.parameter(piece, t)).min(last)
    }
    fn time(&self, place: f64) -> f64 {
        let (piece, u) = self.piece_of(place);
        if u <= 0.0 {
            return piece.start;
        }
        if u >= 1.0 {
            return piece.end;
        }
        let t = match (self.steady, &piece.arc) {
            (Some(ease), Some(arc)) => {
                let way = piece.before + arc.up_to(&piece.curve, u);
                self.duration * ease.inverse((way / self.length).min(1.0))
            }
            _ => piece.start + u * piece.duration,
        };
        t.clamp(piece.start, piece.end)
    }
    fn rates_at(&self, place: f64) -> [DVec3; 2] {
        let (piece, u) = self.piece_of(place);
        piece.curve.derivatives(u)
    }
    fn direction_at(&self, place: f64) -> Option<DVec3> {
        let (piece, u) = self.piece_of(place);
        piece.direction(u)
    }
    fn corners(&self) -> &[f64] {
        self.corners()
    }
}
