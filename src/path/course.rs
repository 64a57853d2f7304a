//! What orientation needs of a path.

use glam::DVec3;

/// A position that runs along a curve over time, 0 to [`Course::duration`] seconds.
///
/// A *place* is a number that grows along the course, from 0 on. At a place the course's
/// direction is told at once, where for a time it may first have to be sought, as at constant
/// speed. Unless a course knows better, places are times.
pub trait Course: Sync {
    /// How long the course takes, seconds.
    fn duration(&self) -> f64;
    /// When the course passes its key points, seconds; the first is 0.
    fn key_times(&self) -> &[f64];
    /// Whether the end runs into the start.
    fn is_closed(&self) -> bool;
    /// Position at t.
    fn position(&self, t: f64) -> DVec3;
    /// Velocity at t, units a second; where it jumps, the later one.
    fn velocity(&self, t: f64) -> DVec3;
    /// Acceleration at t, units a second squared; where it jumps, the later one.
    fn acceleration(&self, t: f64) -> DVec3;
    /// Velocity and acceleration at t, for the price of one where that is less.
    fn rates(&self, t: f64) -> [DVec3; 2] {
        [self.velocity(t), self.acceleration(t)]
    }
    /// The place at t; at key times and corners of a course exactly where it changes.
    fn place(&self, t: f64) -> f64 {
        t
    }
    /// When the course is at a place, seconds; at key times and corners exactly.
    fn time(&self, place: f64) -> f64 {
        place
    }
    /// First and second derivative of position by place, in any unit of length, of whose numbers
    /// the third powers are numbers; where one jumps, the later value.
    fn rates_at(&self, place: f64) -> [DVec3; 2] {
        self.rates(place)
    }
    /// Unit direction of travel at a place, as for a time.
    fn direction_at(&self, place: f64) -> Option<DVec3> {
        self.direction(place)
    }
    /// Unit direction of travel at t; where the speed is zero, the limit from inside, else the last
    /// defined one; None if the whole course has none.
    fn direction(&self, t: f64) -> Option<DVec3>;
    /// Times where the direction jumps, increasing.
    fn corners(&self) -> &[f64];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::{Ease, Kind, Options, Path, Timing};

    fn paths() -> impl Iterator<Item = Path> {
        let points = [[0.0; 3], [1.0, 2.0, 0.0], [1.0, 2.0, 0.0], [4.0, -1.0, 2.0], [2.0, 0.0, 0.5]];
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from_array).collect();
        // The fourth is reached by a segment so long that its last places round to the next.
        let times = [0.0, 1e-6, 2e-6, 1.0, 1.5];
        let keyed = Options::default();
        let steady = Options { timing: Some(Timing::ConstantSpeed), ease: Ease::InOut, ..keyed };
        let kinds = [Kind::CatmullRom, Kind::CatmullRomCentripetal, Kind::Polyline];
        let own = kinds.into_iter().flat_map(move |kind| [(kind, None, keyed), (kind, None, steady)]);
        let timed = [Kind::CatmullRom, Kind::Polyline].map(|kind| (kind, Some(times), keyed));
        own.chain(timed).map(move |(kind, times, options)| {
            Path::new(kind, &points, times.as_ref().map(|t| &t[..]), &options).unwrap()
        })
    }

    #[test]
    fn at_a_place_a_path_is_as_at_its_time() {
        for path in paths() {
            let duration = path.duration();
            let even = (0..=1000).map(|i| duration * f64::from(i) / 1000.0);
            let marks = path.key_times().iter().chain(path.corners());
            let beside = marks.flat_map(|&t| [t.next_down(), t, t.next_up()]);
            let mut times: Vec<f64> = even.chain(beside).map(|t| t.clamp(0.0, duration)).collect();
            times.sort_by(f64::total_cmp);
            let mut last = 0.0;
            for t in times {
                let place = path.place(t);
                assert!(place >= last, "{t}");
                last = place;
                // Rounding of a place is 1e-15 of a segment, which is up to 10 long.
                let off = path.position(path.time(place)).distance(path.position(t));
                assert!(off < 1e-13, "{t}: {off:e}");
                let [here, there] = [path.direction(t), path.direction_at(place)].map(Option::unwrap);
                assert!((here - there).length() < 1e-12, "{t}: {here} {there}");
                let [velocity, rate] = [path.velocity(t), path.rates_at(place)[0]];
                let across = velocity.cross(rate).length();
                assert!(across <= 1e-11 * velocity.length() * rate.length(), "{t}: {across:e}");
            }
        }
    }

    #[test]
    fn keys_and_corners_have_places_of_their_own() {
        for path in paths() {
            let marks: Vec<f64> = path.key_times().iter().chain(path.corners()).copied().collect();
            assert!(marks.iter().all(|&t| path.time(path.place(t)) == t && path.place(t).fract() == 0.0));
            assert!(path.corners().iter().all(|&t| path.place(t.next_down()) < path.place(t)));
        }
    }
}
