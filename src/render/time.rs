//! Times of a clip, as people give them.

use std::str::FromStr;

/// A time of a clip; as text a number of seconds, `2.5`, or a share, `50%`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Time {
    /// From the clip's time 0.
    Seconds(f64),
    /// From 0, the clip's time 0, to 1, its last key.
    Fraction(f64),
}

impl FromStr for Time {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse().ok().filter(|t: &f64| t.is_finite());
        let time = match text.trim().strip_suffix('%') {
            Some(share) => number(share).map(|percent| Time::Fraction(percent / 100.0)),
            None => number(text).map(Time::Seconds),
        };
        time.ok_or_else(|| format!("expected seconds, 2.5, or a share, 50%; found `{text}`"))
    }
}

impl Time {
    /// Seconds within a clip, and a note when they had to be brought there.
    pub(super) fn within(self, duration: f64) -> (f64, Option<String>) {
        let (t, asked) = match self {
            Time::Seconds(t) => (t, format!("{t} s")),
            Time::Fraction(share) => (share * duration, format!("{} %", share * 100.0)),
        };
        if t >= 0.0 && t <= duration {
            return (t, None);
        }
        // Also where `t` is no number.
        let (at, side, end) = match t > duration {
            true => (duration, "after the clip's end", "end"),
            false => (0.0, "before the clip's start", "start"),
        };
        let note = format!("{asked} is {side} (it lasts {duration} s): drew its {end}");
        (at, Some(note))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_and_shares_are_told_apart() {
        assert_eq!("2.5".parse(), Ok(Time::Seconds(2.5)));
        assert_eq!("50%".parse(), Ok(Time::Fraction(0.5)));
        assert_eq!(" 12.5 % ".parse(), Ok(Time::Fraction(0.125)));
        for wrong in ["", "%", "half", "1,5", "nan", "inf%", "5%%"] {
            let error = wrong.parse::<Time>().unwrap_err();
            assert!(error.ends_with(&format!("found `{wrong}`")), "{error}");
        }
    }

    #[test]
    fn times_beyond_a_clip_are_clamped_and_said() {
        for (time, expected, said) in [
            (Time::Seconds(1.5), 1.5, ""),
            (Time::Seconds(9.0), 2.0, "9 s is after the clip's end (it lasts 2 s): drew its end"),
            (Time::Seconds(-1.0), 0.0, "-1 s is before the clip's start"),
            (Time::Fraction(0.25), 0.5, ""),
            (Time::Fraction(1.5), 2.0, "150 % is after"),
            (Time::Seconds(f64::NAN), 0.0, "NaN s is before"),
        ] {
            let (t, note) = time.within(2.0);
            assert_eq!(t, expected);
            assert!(note.as_deref().unwrap_or("").starts_with(said), "{note:?}");
            assert_eq!(note.is_some(), !said.is_empty());
        }
    }
}
