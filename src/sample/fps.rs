//! Frame rates, exact: 60, 23.976, 30000/1001.

use std::fmt;
use std::str::FromStr;

/// A frame rate as a fraction, frames per second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fps {
    frames: u64,
    seconds: u64,
}

impl Default for Fps {
    fn default() -> Fps {
        Fps { frames: 60, seconds: 1 }
    }
}

/// A text that is no frame rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected frames per second, such as 60, 23.976 or 30000/1001")]
pub struct NotARate;

impl Fps {
    /// The default: 60 frames per second.
    pub const DEFAULT: Fps = Fps { frames: 60, seconds: 1 };

    /// The largest rate of at most `rate` frames a second that is easily said: a whole
    /// number, or a whole number of seconds for a frame. None where that would have more
    /// digits than a rate may have.
    pub(crate) fn at_most(rate: f64) -> Option<Fps> {
        let (frames, seconds) = if rate >= 1.0 { (rate.floor(), 1.0) } else { (1.0, (1.0 / rate).ceil()) };
        let sayable = |x: f64| x.is_finite() && x < 1e12;
        let frames = frames.min(1e12 - 1.0);
        sayable(seconds).then_some(Fps { frames: frames as u64, seconds: seconds as u64 })
    }

    /// The time of a frame, seconds; frame 0 is at 0.
    pub fn time(self, frame: u64) -> f64 {
        // Whole products below 2^53 are exact, so only the quotient rounds.
        frame as f64 * self.seconds as f64 / self.frames as f64
    }

    /// Time from frame to frame, seconds.
    pub fn interval(self) -> f64 {
        self.seconds as f64 / self.frames as f64
    }

    /// The first frame at or after a time, or one next to it.
    pub(super) fn frame_near(self, time: f64) -> u64 {
        (time * self.frames as f64 / self.seconds as f64) as u64
    }
}

impl FromStr for Fps {
    type Err = NotARate;

    fn from_str(text: &str) -> Result<Fps, NotARate> {
        let whole = |text: &str| {
            let digits = text.len() <= 12 && text.bytes().all(|b| b.is_ascii_digit());
            text.parse::<u64>().ok().filter(|_| digits).ok_or(NotARate)
        };
        let (frames, seconds) = match (text.split_once('/'), text.split_once('.')) {
            (Some((frames, seconds)), None) => (whole(frames)?, whole(seconds)?),
            (None, Some((whole_part, decimals))) => {
                let digits =
                    if whole_part.is_empty() { decimals } else { &format!("{whole_part}{decimals}") };
                (whole(digits)?, 10u64.pow(decimals.len() as u32))
            }
            (None, None) => (whole(text)?, 1),
            _ => return Err(NotARate),
        };
        if frames == 0 || seconds == 0 {
            return Err(NotARate);
        }
        let common = greatest_common_divisor(frames, seconds);
        Ok(Fps { frames: frames / common, seconds: seconds / common })
    }
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

impl fmt::Display for Fps {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.seconds {
            1 => write!(f, "{}", self.frames),
            seconds => write!(f, "{}/{seconds}", self.frames),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings() {
        let parsed = |text: &str| text.parse::<Fps>().map(|fps| fps.to_string());
        assert_eq!(parsed("60"), Ok("60".into()));
        assert_eq!(parsed("30000/1001"), Ok("30000/1001".into()));
        assert_eq!(parsed("23.976"), Ok("2997/125".into()));
        assert_eq!(parsed("60.0"), Ok("60".into()));
        assert_eq!(parsed(".5"), Ok("1/2".into()));
        for text in
            ["", "0", "-1", "60fps", "1/0", "0/1", "1/2/3", "1.5/2", "nan", "inf", "1e3", "9999999999999"]
        {
            assert_eq!(parsed(text), Err(NotARate), "{text}");
        }
    }

    #[test]
    fn rates_for_messages_can_be_asked_for() {
        let said = |rate: f64| Fps::at_most(rate).map(|fps| fps.to_string());
        let cases = [
            (512.0, "512"),
            (59.9, "59"),
            (1.0, "1"),
            (0.9, "1/2"),
            (1.0 / 64.0, "1/64"),
            (1e300, "999999999999"),
        ];
        for (rate, text) in cases {
            assert_eq!(said(rate).as_deref(), Some(text));
            assert_eq!(text.parse(), Ok(Fps::at_most(rate).unwrap()));
        }
        assert_eq!(said(1e-13), None);
        assert_eq!(said(0.0), None);
    }

    #[test]
    fn frames_are_exact() {
        let ntsc: Fps = "30000/1001".parse().unwrap();
        assert_eq!(ntsc.time(30_000), 1001.0);
        assert_eq!(Fps::DEFAULT.time(90), 1.5);
    }
}
