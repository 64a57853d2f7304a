//! What a plot can show.

/// What a plot shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// The numbers of rotations, or the places of a path, over time.
    #[default]
    Components,
    /// Angular speed, or speed along a path.
    Speed,
    /// Angular acceleration, or the acceleration of a path.
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
            Show::Components => "quaternion components over time, or x, y and z of a path",
            Show::Speed => "angular speed, or speed along a path",
            Show::Acceleration => "angular acceleration, or the acceleration of a path",
            Show::Jerk => "angular jerk: rate of change of acceleration",
            Show::Curvature => "curvature of a path",
            Show::Path => "a path in three orthographic views and an oblique one",
            Show::Error => "playback error of a .glb; needs --against",
            Show::Sphere => "direction of each box's axis on the unit sphere",
        }
    }

    /// What a name stands for, if anything.
    pub fn from_name(name: &str) -> Option<Show> {
        Show::ALL.into_iter().find(|show| show.name() == name)
    }
}
