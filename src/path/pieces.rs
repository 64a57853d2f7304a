//! Segments to pieces with their times.

use super::arc_length::ArcLength;
use super::bezier::Bezier;
use super::cusps::cusps;
use super::knots::COINCIDENT;
use super::piece::Piece;

/// A part of a segment that does not rest inside, and how far along the path it is.
pub(super) struct Part {
    segment: usize,
    /// Where it begins and ends in the segment, 0..=1.
    within: (f64, f64),
    curve: Bezier,
    /// Its own arc length, where that is to be found again from lengths.
    arc: Option<ArcLength>,
    /// Length of the path up to where it begins, and up to where it ends.
    pub(super) before: f64,
    pub(super) behind: f64,
}

impl Part {
    /// Whether it leads anywhere, as far as rounding lets one tell.
    pub(super) fn moves(&self) -> bool {
        self.curve.fastest() > COINCIDENT
    }
}

/// Cuts segments where they rest inside, and measures the parts: so that places can be found by
/// their length where the speed is `steady`.
pub(super) fn parts(curves: Vec<Option<Bezier>>, steady: bool) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::with_capacity(curves.len());
    for (segment, curve) in curves.into_iter().enumerate() {
        let Some(curve) = curve else { continue };
        for (within, curve) in cut(curve) {
            let arc = ArcLength::new(&curve);
            let before = parts.last().map_or(0.0, |part| part.behind);
            let behind = before + arc.length();
            parts.push(Part { segment, within, curve, arc: steady.then_some(arc), before, behind });
        }
    }
    parts
}

fn cut(curve: Bezier) -> Vec<((f64, f64), Bezier)> {
    let cusps = cusps(&curve);
    if cusps.is_empty() {
        return vec![((0.0, 1.0), curve)];
    }
    let marks: Vec<f64> = [0.0].into_iter().chain(cusps).chain([1.0]).collect();
    marks.windows(2).map(|m| ((m[0], m[1]), curve.part(m[0], m[1]))).collect()
}

/// Pieces whose segments take the times between the keys.
pub(super) fn keyed(parts: Vec<Part>, key_times: &[f64], steps: &[f64], duration: f64) -> Vec<Piece> {
    let total: f64 = steps.iter().sum();
    let timed = parts.into_iter().map(|part| {
        // From the step: a difference of two late times has lost digits.
        let seconds = steps[part.segment] / total * duration;
        let (from, to) = part.within;
        let start = key_times[part.segment] + from * seconds;
        let end = if to < 1.0 { key_times[part.segment] + to * seconds } else { key_times[part.segment + 1] };
        let Part { before, curve, .. } = part;
        Piece { start, end, duration: (to - from) * seconds, before, curve, arc: None, held: None }
    });
    with_directions(timed.collect())
}

/// Pieces under constant speed; those without length take no time and are left out.
/// `time_at`: when so much of the path is done.
pub(super) fn steady(parts: Vec<Part>, time_at: impl Fn(f64) -> f64) -> Vec<Piece> {
    let timed = parts.into_iter().map(|part| {
        let Part { before, behind, curve, arc, .. } = part;
        let (start, end) = (time_at(before), time_at(behind));
        Piece { start, end, duration: end - start, before, curve, arc, held: None }
    });
    with_directions(timed.filter(|piece| !piece.rests() && piece.duration > 0.0).collect())
}

/// Gives every piece the direction that holds while it rests.
fn with_directions(mut pieces: Vec<Piece>) -> Vec<Piece> {
    let mut held = pieces.iter().find_map(Piece::first_direction);
    for piece in &mut pieces {
        piece.held = held;
        held = piece.last_direction().or(held);
    }
    pieces
}

/// When the path passes each key, seconds: the steps summed up, the last exactly at the
/// end. Times that came with the points stay as they are.
pub(super) fn key_times(steps: &[f64], times: Option<&[f64]>, duration: f64) -> Vec<f64> {
    if let Some(times) = times {
        return times.iter().map(|t| t - times[0]).collect();
    }
    let total: f64 = steps.iter().sum();
    let behind = steps.iter().scan(0.0, |sum, h| {
        *sum += h;
        Some(*sum / total * duration)
    });
    [0.0].into_iter().chain(behind).collect()
}

/// When the path passes each key under constant speed: `time_at` the length up to it.
pub(super) fn steady_key_times(parts: &[Part], keys: usize, time_at: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut times = vec![0.0; keys];
    let mut next = parts.iter().peekable();
    for key in 1..keys {
        times[key] = times[key - 1];
        while let Some(part) = next.next_if(|part| part.segment < key) {
            times[key] = time_at(part.behind);
        }
    }
    times
}
