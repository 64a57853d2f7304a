//! What a plot can show.

/// What a plot shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// The numbers of rotations, or the places of a path, over time.
    #[default]
    Components,
    /// Angular speed, or speed along a path.
    Speed,
    /// Angular acceleration, or acceleration along a path.
    Acceleration,
    /// Angular jerk.
    Jerk,
    /// Curvature of a path.
    Curvature,
    /// A path from three sides and obliquely.
    Path,
    /// How far a file's playback is off its curve.
    Error,
    /// Where axes point, on a sphere.
    Sphere,
}

impl Show {
    /// All of them, in the order of the documentation.
    pub const ALL: [Show; 8] = [
        Show::Components,
        Show::Speed,
        Show::Acceleration,
        Show::Jerk,
        Show::Curvature,
        Show::Path,
        Show::Error,
        Show::Sphere,
    ];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Show::Components => "components",
            Show::Speed => "speed",
            Show::Acceleration => "acceleration",
            Show::Jerk => "jerk",
            Show::Curvature => "curvature",
            Show::Path => "path",
            Show::Error => "error",
            Show::Sphere => "sphere",
        }
    }

    /// What it is, in a line.
    pub fn summary(self) -> &'static str {
        match self {
            Show::Components => "quaternions' parts over time, or a path's x, y and z",
            Show::Speed => "angular speed, or speed along a path",
            Show::Acceleration => "angular acceleration, or that of a path",
            Show::Jerk => "angular jerk: how fast the acceleration changes",
            Show::Curvature => "curvature of a path",
            Show::Path => "a path from three sides and an oblique one",
            Show::Error => "how far a .glb's playback is off its curve; needs --against",
            Show::Sphere => "where each box's axis points, on the unit sphere",
        }
    }

    /// What a name stands for, if anything.
    pub fn from_name(name: &str) -> Option<Show> {
        Show::ALL.into_iter().find(|show| show.name() == name)
    }
}
