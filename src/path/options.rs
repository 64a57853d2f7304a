//! What a user can choose about a path.

/// How points make a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Cubic Bézier segments in a row: 3n + 1 control points.
    Bezier,
    /// One Bézier curve of this degree N, of N + 1 control points.
    BezierDegree(usize),
    /// Through every point; knots 1 apart, or those of the segments' times.
    CatmullRom,
    /// Through every point; knots the root of the chord apart.
    CatmullRomCentripetal,
    /// Through every point; knots the chord apart.
    CatmullRomChordal,
    /// Straight from point to point.
    Polyline,
}

impl Kind {
    /// The kinds that have a name of their own.
    pub const ALL: [Kind; 5] = [
        Kind::Bezier,
        Kind::CatmullRom,
        Kind::CatmullRomCentripetal,
        Kind::CatmullRomChordal,
        Kind::Polyline,
    ];

    /// The largest degree of a single Bézier curve: computing a point takes the square
    /// of the degree, and a single control point moves less and less of the curve.
    pub const HIGHEST_DEGREE: usize = 100;

    /// The word by which a file names it.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Bezier | Kind::BezierDegree(_) => "bezier",
            Kind::CatmullRom => "catmull-rom",
            Kind::CatmullRomCentripetal => "catmull-rom-centripetal",
            Kind::CatmullRomChordal => "catmull-rom-chordal",
            Kind::Polyline => "polyline",
        }
    }

    /// The kind of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Whether the points are control points, of which only segment ends are passed.
    pub fn is_bezier(self) -> bool {
        matches!(self, Kind::Bezier | Kind::BezierDegree(_))
    }
}

/// What the curve does at its two ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PathEnds {
    /// Starts and stops without acceleration.
    #[default]
    Natural,
    /// Starts and stops at rest.
    Clamped,
    /// The end point counts twice.
    Repeat,
    /// The end runs into the start: a repeated first point is the seam, otherwise a
    /// closing segment is added.
    Closed,
}

impl PathEnds {
    /// Every kind of end, in the order of the documentation.
    pub const ALL: [PathEnds; 4] = [PathEnds::Natural, PathEnds::Clamped, PathEnds::Repeat, PathEnds::Closed];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            PathEnds::Natural => "natural",
            PathEnds::Clamped => "clamped",
            PathEnds::Repeat => "repeat",
            PathEnds::Closed => "closed",
        }
    }

    /// The ends of a name, if there are any; `periodic` is another word for `closed`.
    pub fn from_name(name: &str) -> Option<PathEnds> {
        let name = if name == "periodic" { "closed" } else { name };
        PathEnds::ALL.into_iter().find(|ends| ends.name() == name)
    }
}

/// How time is shared out along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timing {
    /// Every segment takes equally long.
    Uniform,
    /// A segment's time is proportional to the straight distance between its ends.
    Chord,
    /// Equal distances in equal times.
    ConstantSpeed,
    /// The times that came with the points.
    Times,
}

impl Timing {
    /// Every timing, in the order of the documentation.
    pub const ALL: [Timing; 4] = [Timing::Uniform, Timing::Chord, Timing::ConstantSpeed, Timing::Times];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Timing::Uniform => "uniform",
            Timing::Chord => "chord",
            Timing::ConstantSpeed => "constant-speed",
            Timing::Times => "times",
        }
    }

    /// The timing of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Timing> {
        Timing::ALL.into_iter().find(|timing| timing.name() == name)
    }
}

/// At which ends a path under constant speed starts or stops at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ease {
    /// At neither: the speed is constant.
    #[default]
    None,
    /// At the start.
    In,
    /// At the end.
    Out,
    /// At both.
    InOut,
}

impl Ease {
    /// Every easing, in the order of the documentation.
    pub const ALL: [Ease; 4] = [Ease::None, Ease::In, Ease::Out, Ease::InOut];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Ease::None => "none",
            Ease::In => "in",
            Ease::Out => "out",
            Ease::InOut => "in-out",
        }
    }

    /// The easing of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Ease> {
        Ease::ALL.into_iter().find(|ease| ease.name() == name)
    }

    /// The fraction of the way that lies behind at the fraction τ of the time, with its
    /// first two derivatives by τ: smoothstep 3τ² − 2τ³, of which `in` is the first
    /// half, (3τ² − τ³)/2, and `out` the second, (3τ − τ³)/2.
    pub(super) fn at(self, x: f64) -> [f64; 3] {
        match self {
            Ease::None => [x, 1.0, 0.0],
            Ease::In => [x * x * (1.5 - 0.5 * x), x * (3.0 - 1.5 * x), 3.0 - 3.0 * x],
            Ease::Out => [x * (1.5 - 0.5 * x * x), 1.5 * (1.0 - x) * (1.0 + x), -3.0 * x],
            Ease::InOut => [x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x), 6.0 - 12.0 * x],
        }
    }

    /// The fraction of the time at which the fraction y of the way lies behind.
    pub(super) fn inverse(self, y: f64) -> f64 {
        match self {
            Ease::None => y,
            Ease::In => 2.0 * inverse_smoothstep(0.5 * y),
            Ease::Out => 1.0 - 2.0 * inverse_smoothstep(0.5 * (1.0 - y)),
            Ease::InOut => inverse_smoothstep(y),
        }
    }
}

/// The x in 0..=1 with 3x² − 2x³ = y: 2 cos(π/6 − φ/3) sin(φ/3) where sin²φ = y, the
/// cubic's trigonometric solution ½ − sin(arcsin(1 − 2y)/3) without its cancellation.
fn inverse_smoothstep(y: f64) -> f64 {
    let third = libm::atan2(y.sqrt(), (1.0 - y).max(0.0).sqrt()) / 3.0;
    2.0 * libm::cos(std::f64::consts::FRAC_PI_6 - third) * libm::sin(third)
}

/// Everything about a path but its kind and its points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// What the curve does at its ends. Bézier control points and straight lines know
    /// only whether it is closed.
    pub ends: PathEnds,
    /// How time is shared out; None for the times that came with the points, or the
    /// kind's own timing where none came.
    pub timing: Option<Timing>,
    /// How the speed rises and falls; only under constant speed.
    pub ease: Ease,
    /// How long the path takes, seconds; None for a second a segment.
    pub duration: Option<f64>,
    /// The mean speed, units a second, instead of a duration.
    pub speed: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back() {
        assert!(Kind::ALL.iter().all(|kind| Kind::from_name(kind.name()) == Some(*kind)));
        assert!(PathEnds::ALL.iter().all(|ends| PathEnds::from_name(ends.name()) == Some(*ends)));
        assert!(Timing::ALL.iter().all(|timing| Timing::from_name(timing.name()) == Some(*timing)));
        assert!(Ease::ALL.iter().all(|ease| Ease::from_name(ease.name()) == Some(*ease)));
        assert_eq!(PathEnds::from_name("periodic"), Some(PathEnds::Closed));
        assert_eq!(Kind::from_name("spline"), None);
    }

    #[test]
    fn ease_rests_where_it_says_and_its_derivatives_are_its_own() {
        for ease in Ease::ALL {
            let [start, end] = [ease.at(0.0), ease.at(1.0)];
            assert_eq!([start[0], end[0]], [0.0, 1.0]);
            assert_eq!(start[1] == 0.0, matches!(ease, Ease::In | Ease::InOut));
            assert_eq!(end[1] == 0.0, matches!(ease, Ease::Out | Ease::InOut));
            for i in 1..100 {
                let (x, h) = (f64::from(i) / 100.0, 1e-5);
                let [below, at, above] = [ease.at(x - h), ease.at(x), ease.at(x + h)];
                // Cubics: the central difference errs by h²/6 times at most 12.
                assert!((at[1] - (above[0] - below[0]) / (2.0 * h)).abs() < 1e-9);
                assert!((at[2] - (above[1] - below[1]) / (2.0 * h)).abs() < 1e-9);
                assert!(at[1] > 0.0);
            }
        }
    }

    #[test]
    fn ease_is_inverted_to_rounding() {
        for ease in Ease::ALL {
            for x in [0.0, 1e-9, 1e-4, 0.3, 0.5, 0.9, 0.9999, 1.0] {
                // Where the speed vanishes, 1e-16 of the way is 1e-8 of the time.
                let [y, slope, _] = ease.at(x);
                let limit = (1e-15 / slope.max(1e-300)).min(3e-8);
                assert!((ease.inverse(y) - x).abs() <= limit, "{} {x} {}", ease.name(), ease.inverse(y));
            }
        }
    }
}
