//! The header of a path or of rotations: `# bezier duration=20`, a kind and what is said
//! of it in `key=value` words.

use super::Order;
use super::header::{Line, looks_like_a_number};
use super::refusal::Problem;
use super::words::{number, quoted};
use crate::orient::Frame;
use crate::path::Kind as PathKind;

/// What a file holds if not keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Path(PathKind),
    Euler,
    EulerBezier,
    QuatBezier,
}

/// The first word of a header, and what it says.
const KINDS: [(&str, Kind); 8] = [
    ("bezier", Kind::Path(PathKind::Bezier)),
    ("catmull-rom", Kind::Path(PathKind::CatmullRom)),
    ("catmull-rom-centripetal", Kind::Path(PathKind::CatmullRomCentripetal)),
    ("catmull-rom-chordal", Kind::Path(PathKind::CatmullRomChordal)),
    ("polyline", Kind::Path(PathKind::Polyline)),
    ("euler", Kind::Euler),
    ("euler-bezier", Kind::EulerBezier),
    ("quat-bezier", Kind::QuatBezier),
];

/// The keys of `key=value` words.
const KEYS: [&str; 3] = ["duration", "degree", "frame"];

impl Kind {
    /// As headers spell it.
    pub(super) fn name(self) -> &'static str {
        let degreeless = match self {
            Kind::Path(PathKind::BezierDegree(_)) => Kind::Path(PathKind::Bezier),
            kind => kind,
        };
        KINDS.iter().find(|(_, kind)| *kind == degreeless).map_or("", |(name, _)| name)
    }

    fn knows(self, key: &str) -> bool {
        KEYS.contains(&key) && (key != "degree" || self == Kind::Path(PathKind::Bezier))
    }

    /// Whether rows may hold quaternions.
    fn has_quaternions(self) -> bool {
        matches!(self, Kind::Path(_) | Kind::QuatBezier)
    }
}

/// What a header says. Places are bytes of its line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    pub(super) kind: Kind,
    /// Where the kind stands.
    pub(super) at: usize,
    /// Where the duration stands, and its seconds.
    pub(super) duration: Option<(usize, f64)>,
    /// Where the degree stands, and the degree, 1 or more.
    pub(super) degree: Option<(usize, usize)>,
    pub(super) frame: Option<Frame>,
    pub(super) order: Option<Order>,
}

/// Reads the words of a line after its `#`. It is a header if the first is a kind and
/// all others are numbers, `key=value` or an order of parts.
pub(super) fn parse(words: &[(usize, &[u8])]) -> Line {
    let Some((&(at, name), rest)) = words.split_first() else { return Line::Comment(None) };
    let Some(kind) = KINDS.iter().find(|(known, _)| known.as_bytes() == name).map(|(_, kind)| *kind) else {
        return Line::Comment(near_miss(at, name));
    };
    if let Some(&(at, word)) = rest.iter().find(|(_, word)| !belongs(word)) {
        let reason = format!("{} is neither a duration in seconds nor key=value", quoted(word));
        return Line::Comment(Some((at, reason)));
    }
    let mut header = Header { kind, at, duration: None, degree: None, frame: None, order: None };
    for &(at, word) in rest {
        if let Err((at, problem)) = header.take(at, word) {
            return Line::Wrong(at, problem);
        }
    }
    if let Some((_, degree)) = header.degree {
        header.kind = Kind::Path(PathKind::BezierDegree(degree));
    }
    Line::Kind(header)
}

/// Whether a word can stand in a header, be it right or wrong.
fn belongs(word: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(word) else { return false };
    text.contains('=')
        || looks_like_a_number(word)
        || Order::from_name(text).is_some()
        || KEYS.contains(&text)
}

fn near_miss(at: usize, name: &[u8]) -> Option<(usize, String)> {
    let near = nearest(std::str::from_utf8(name).ok()?, KINDS.map(|(known, _)| known))?;
    Some((at, format!("{} is no kind of file (did you mean '{near}'?)", quoted(name))))
}

type Wrong = (usize, Problem);

impl Header {
    fn take(&mut self, at: usize, word: &[u8]) -> Result<(), Wrong> {
        if let Some(equals) = memchr::memchr(b'=', word) {
            let value = (at + equals + 1, &word[equals + 1..]);
            return match &word[..equals] {
                b"duration" => self.take_duration(at, value),
                b"degree" if self.kind.knows("degree") => self.take_degree(at, value),
                b"frame" => self.take_frame(at, value),
                key => Err((at, self.unknown(key, word))),
            };
        }
        let text = String::from_utf8_lossy(word);
        if KEYS.contains(&&*text) {
            let problem = Problem::new(format!("expected '=' after {}, found none", quoted(word)));
            return Err((at + word.len(), problem.hint("key=value is written without spaces")));
        }
        match Order::from_name(&text) {
            Some(order) => self.take_order(at, order),
            None => self.take_duration(at, (at, word)),
        }
    }

    fn take_duration(&mut self, at: usize, (value_at, value): (usize, &[u8])) -> Result<(), Wrong> {
        if self.duration.is_some() {
            return Err((at, Problem::new("expected one duration, found a second")));
        }
        if value.is_empty() {
            return Err((value_at, Problem::new("expected a duration in seconds after '=', found nothing")));
        }
        let (seconds, _) = number(value, 0).map_err(|problem| (value_at, problem))?;
        if seconds <= 0.0 {
            let problem = format!("expected a positive duration in seconds, found {}", quoted(value));
            return Err((value_at, Problem::new(problem)));
        }
        self.duration = Some((at, seconds));
        Ok(())
    }

    fn take_degree(&mut self, at: usize, (value_at, value): (usize, &[u8])) -> Result<(), Wrong> {
        if self.degree.is_some() {
            return Err((at, Problem::new("expected one degree, found a second")));
        }
        let whole = value.iter().all(u8::is_ascii_digit);
        match std::str::from_utf8(value).ok().and_then(|text| text.parse::<u32>().ok()) {
            Some(degree @ 1..) if whole => {
                self.degree = Some((at, degree as usize));
                Ok(())
            }
            _ => {
                let found = quoted(value);
                let problem = format!("expected a degree, a whole number from 1 on, found {found}");
                Err((value_at, Problem::new(problem)))
            }
        }
    }

    fn take_frame(&mut self, at: usize, (value_at, value): (usize, &[u8])) -> Result<(), Wrong> {
        if self.frame.is_some() {
            return Err((at, Problem::new("expected one frame, found a second")));
        }
        self.frame = std::str::from_utf8(value).ok().and_then(Frame::from_name);
        if self.frame.is_none() {
            let problem = format!("expected the frame gltf, frd or flu, found {}", quoted(value));
            return Err((value_at, Problem::new(problem)));
        }
        Ok(())
    }

    fn take_order(&mut self, at: usize, order: Order) -> Result<(), Wrong> {
        let problem = if self.order.is_some() {
            "expected one component order of quaternions, found a second".to_owned()
        } else if !self.kind.has_quaternions() {
            let name = self.kind.name();
            format!("expected no component order of quaternions: a file '{name}' has no quaternions")
        } else {
            self.order = Some(order);
            return Ok(());
        };
        Err((at, Problem::new(problem)))
    }

    fn unknown(&self, key: &[u8], word: &[u8]) -> Problem {
        let known: Vec<&str> = KEYS.into_iter().filter(|key| self.kind.knows(key)).collect();
        let list = known.iter().map(|key| format!("{key}=")).collect::<Vec<_>>().join(", ");
        let (name, found) = (self.kind.name(), quoted(word));
        let problem = Problem::new(format!("expected a word that '{name}' knows ({list}), found {found}"));
        match nearest(&String::from_utf8_lossy(key), known) {
            Some(near) => problem.hint(format!("did you mean '{near}='?")),
            None => problem,
        }
    }
}

/// The known name that was probably meant: a slip or two away, more only in long names.
fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name: Vec<char> = name.chars().take(40).flat_map(char::to_lowercase).collect();
    let near = known.into_iter().filter_map(|known| {
        let few = (known.len() / 4).max(1);
        // More letters over or missing than slips are allowed: no need to count.
        let alike = known.len().abs_diff(name.len()) <= few;
        let slips = alike.then(|| slips(&name, &known.chars().collect::<Vec<_>>()))?;
        (slips <= few).then_some((slips, known))
    });
    near.min_by_key(|(slips, _)| *slips).map(|(_, known)| known)
}

/// How many letters are missing, over, wrong, or swapped with their neighbour.
fn slips(a: &[char], b: &[char]) -> usize {
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            if i == 0 || j == 0 {
                rows[i][j] = i + j;
                continue;
            }
            let wrong = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = wrong.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = least;
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::header;

    fn line(text: &str) -> Line {
        header::parse(text.as_bytes())
    }

    fn kind(text: &str) -> Header {
        match line(text) {
            Line::Kind(header) => header,
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn headers() {
        for (name, known) in KINDS {
            let header = kind(&format!("# {name}"));
            assert_eq!((header.kind, header.at), (known, 2));
            assert_eq!(header.kind.name(), name);
        }
        assert_eq!(kind("# bezier duration=20").duration, Some((9, 20.0)));
        assert_eq!(kind("#catmull-rom 20").duration, Some((13, 20.0)));
        assert_eq!(kind("# polyline +.5e1 frame=flu").frame, Some(Frame::Flu));
        let degree = kind("  #\tbezier degree=5 2");
        assert_eq!(degree.kind, Kind::Path(PathKind::BezierDegree(5)));
        assert_eq!((degree.kind.name(), degree.degree), ("bezier", Some((11, 5))));
        assert_eq!(kind("# quat-bezier xyzw").order, Some(Order::Xyzw));
        assert_eq!(kind("# polyline wxyz").order, Some(Order::Wxyz));
    }

    #[test]
    fn comments_and_near_misses() {
        for text in
            ["# the path of the glider", "# 2026-11-22", "# x y z", "## bezier", "# loop=3", "# \u{e9}"]
        {
            assert_eq!(line(text), Line::Comment(None), "{text}");
        }
        let near = |text: &str| match line(text) {
            Line::Comment(Some((at, reason))) => (at, reason),
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(
            near("# besier 20"),
            (2, "'besier' is no kind of file (did you mean 'bezier'?)".to_owned())
        );
        for (text, meant) in [
            ("# Bezier", "bezier"),
            ("# b\u{e9}zier", "bezier"),
            ("# bezeir", "bezier"),
            ("# catmullrom", "catmull-rom"),
            ("# catmull_rom 3", "catmull-rom"),
            ("# catmull-rom-centripedal", "catmull-rom-centripetal"),
            ("# poliline", "polyline"),
            ("# quatbezier", "quat-bezier"),
        ] {
            assert!(near(text).1.contains(&format!("'{meant}'")), "{text}: {:?}", near(text));
        }
        assert_eq!(near("# bezier of the left wing").0, 9);
        assert_eq!(near("# bezier 20s").1, "'20s' is neither a duration in seconds nor key=value");
        assert!(!line(&format!("# {}", "bezier".repeat(10_000))).eq(&line("# bezier")));
    }

    #[test]
    fn mistakes() {
        let wrong = |text: &str| match line(text) {
            Line::Wrong(at, problem) => {
                (at, format!("{} | {}", problem.text, problem.hint.unwrap_or_default()))
            }
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(
            wrong("# bezier duraton=2"),
            (
                9,
                "expected a word that 'bezier' knows (duration=, degree=, frame=), found 'duraton=2' | \
                 did you mean 'duration='?"
                    .to_owned()
            )
        );
        assert_eq!(
            wrong("# polyline degree=2").1,
            "expected a word that 'polyline' knows (duration=, frame=), found 'degree=2' | "
        );
        for (text, at, part) in [
            ("# bezier =2", 9, "found '=2'"),
            ("# bezier 0", 9, "a positive duration in seconds, found '0'"),
            ("# bezier duration=-3", 18, "found '-3'"),
            ("# bezier duration=", 18, "found nothing"),
            ("# bezier duration = 20", 17, "expected '=' after 'duration'"),
            ("# bezier duration=2s", 18, "expected a number, found '2s'"),
            ("# bezier 2,5", 9, "write 2.5"),
            ("# bezier nan", 9, "expected a finite number"),
            ("# bezier 2 duration=2", 11, "one duration, found a second"),
            ("# bezier 2 3", 11, "one duration, found a second"),
            ("# bezier degree=0", 16, "from 1 on, found '0'"),
            ("# bezier degree=+2", 16, "found '+2'"),
            ("# bezier degree=2.5", 16, "found '2.5'"),
            ("# bezier degree=99999999999", 16, "from 1 on"),
            ("# bezier degree=", 16, "found ''"),
            ("# bezier degree=2 degree=2", 18, "one degree"),
            ("# euler frame=ned", 14, "the frame gltf, frd or flu, found 'ned'"),
            ("# euler frame=frd frame=frd", 18, "one frame"),
            ("# quat-bezier wxyz xyzw", 19, "one component order"),
            ("# euler wxyz", 8, "has no quaternions"),
        ] {
            let (place, message) = wrong(text);
            assert!(place == at && message.contains(part), "{text}: {place}: {message}");
        }
    }
}
