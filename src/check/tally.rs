//! Many findings of one kind, drawn together into one.

/// How often something was found, and where it was worst.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub(super) count: u64,
    worst: Option<Worst>,
}

/// The worst place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worst {
    /// Number of the key or element, from 0.
    pub(super) key: usize,
    /// Its time, seconds.
    pub(super) time: f64,
    /// How bad; larger is worse.
    pub(super) measure: f64,
}

impl Tally {
    pub(super) fn note(&mut self, key: usize, time: f64, measure: f64) {
        self.count += 1;
        if self.worst.is_none_or(|worst| measure > worst.measure) {
            self.worst = Some(Worst { key, time, measure });
        }
    }

    /// The worst place, if there was any.
    pub(super) fn worst(&self) -> Option<Worst> {
        self.worst
    }
}

impl std::fmt::Display for Worst {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Times are float32 in the file: more digits would be noise.
        write!(f, "key {} at {} s", self.key, self.time as f32)
    }
}
