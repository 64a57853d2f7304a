//! What was worked out for the segments that were last asked for.

use std::sync::{Arc, Mutex, PoisonError};

/// How many segments are remembered: all of most courses, and on long ones those about which
/// others are asked next.
const SEGMENTS: usize = 1024;

/// The segment whose value is here, if any.
type Room<T> = Mutex<Option<(usize, Arc<T>)>>;

/// One value a segment, worked out again where another has taken its room. It is the same
/// each time, so nobody can tell.
pub(super) struct Recent<T> {
    rooms: Vec<Room<T>>,
}

impl<T> Recent<T> {
    pub(super) fn new(segments: usize) -> Self {
        Recent { rooms: (0..segments.clamp(1, SEGMENTS)).map(|_| Mutex::new(None)).collect() }
    }

    /// The value of a segment.
    pub(super) fn get(&self, segment: usize, work_out: impl FnOnce() -> T) -> Arc<T> {
        let room = &self.rooms[segment % self.rooms.len()];
        let lock = || room.lock().unwrap_or_else(PoisonError::into_inner);
        match &*lock() {
            Some((holds, value)) if *holds == segment => return Arc::clone(value),
            _ => {}
        }
        // Others may ask for other segments meanwhile.
        let value = Arc::new(work_out());
        *lock() = Some((segment, Arc::clone(&value)));
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_segment_has_its_own_value() {
        let recent = Recent::new(3 * SEGMENTS);
        for i in [0, 1, SEGMENTS, 0, 2 * SEGMENTS + 1, 1] {
            assert_eq!(*recent.get(i, || 10 * i), 10 * i);
        }
        // What is there is not worked out again.
        assert_eq!(*recent.get(1, || 0), 10);
    }
}
