//! `--camera`: what is asked for, and the files that it names.

use super::exit::Failure;
use super::files::{self, display_name};
use dat2glb::moves::{Camera, View, camera_keys};
use dat2glb::orient::Frame;
use dat2glb::read::{Input, Keyframes};
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// One `--camera`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CameraSpec {
    /// As it was said.
    pub(crate) said: String,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Path { path: PathBuf, look_at: Option<Target>, rotation: Option<PathBuf> },
    Follow { offset: Option<DVec3> },
    Keys,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    Root,
    Point(DVec3),
}

/// What the words of a camera begin with.
const WORDS: [&str; 3] = ["look-at=", "rotation=", "offset="];

impl FromStr for CameraSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<CameraSpec, String> {
        let (name, words) = split(text);
        if let Some(word) = stray(&name) {
            return Err(format!("expected {}, found '{word}='", WORDS.join(", ")));
        }
        let (mut look_at, mut rotation, mut offset) = (None, None, None);
        for word in &words {
            let (key, value) = word.split_once('=').expect("split found it");
            let again = match key {
                "look-at" => look_at.replace(target(value)?).is_some(),
                "rotation" => rotation.replace(file(value)?).is_some(),
                _ => offset.replace(point(value)?).is_some(),
            };
            if again {
                return Err(format!("expected {key}= once, found it twice"));
            }
        }
        let kind = match name.as_str() {
            "follow" => Kind::Follow { offset: offset.take() },
            "keys" => Kind::Keys,
            path => Kind::Path { path: file(path)?, look_at: look_at.take(), rotation: rotation.take() },
        };
        let left =
            [("look-at", look_at.is_some()), ("rotation", rotation.is_some()), ("offset", offset.is_some())];
        if let Some((key, _)) = left.into_iter().find(|(_, left)| *left) {
            return Err(format!("{key}= does not go with '{name}'"));
        }
        if matches!(&kind, Kind::Path { look_at: Some(_), rotation: Some(_), .. }) {
            return Err("expected look-at= or rotation=, found both: a camera has one aim".to_owned());
        }
        Ok(CameraSpec { said: text.to_owned(), kind })
    }
}

/// The name, which may hold commas, and the `key=value` words after it.
fn split(text: &str) -> (String, Vec<String>) {
    let (mut name, mut words): (String, Vec<String>) = (String::new(), Vec::new());
    for (i, part) in text.split(',').enumerate() {
        if i > 0 && WORDS.iter().any(|word| part.starts_with(word)) {
            words.push(part.to_owned());
            continue;
        }
        let open = words.last_mut().unwrap_or(&mut name);
        if i > 0 {
            open.push(',');
        }
        open.push_str(part);
    }
    (name, words)
}

/// What looks like a word after a name, and is none that is known.
fn stray(name: &str) -> Option<&str> {
    let key = |part: &str| part.bytes().all(|b| b.is_ascii_lowercase() || b == b'-' || b == b'_');
    let words = name.split(',').skip(1).filter_map(|part| part.split_once('='));
    words.map(|(word, _)| word).find(|word| !word.is_empty() && key(word))
}

fn file(text: &str) -> Result<PathBuf, String> {
    match text {
        "" => Err("expected the name of a file, found nothing".to_owned()),
        "-" => Err("a camera's file needs a name; standard input is the main input's".to_owned()),
        name => Ok(PathBuf::from(name)),
    }
}

fn target(text: &str) -> Result<Target, String> {
    if text == "root" { Ok(Target::Root) } else { point(text).map(Target::Point) }
}

fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(':').map_while(|number| number.parse().ok()).collect();
    let complete = numbers.len() == text.split(':').count();
    match numbers[..] {
        [x, y, z] if complete && numbers.iter().all(|x| x.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err(format!("expected a point X:Y:Z, such as 0:2.5:-8, found '{text}'")),
    }
}

impl CameraSpec {
    /// The files that it names.
    pub(super) fn files(&self) -> Vec<&Path> {
        match &self.kind {
            Kind::Path { path, rotation, .. } => {
                std::iter::once(path).chain(rotation).map(PathBuf::as_path).collect()
            }
            Kind::Follow { .. } | Kind::Keys => Vec::new(),
        }
    }

    /// The same with what is in its files.
    pub(super) fn read(&self, frame: Option<Frame>) -> Result<Camera, Failure> {
        let Kind::Path { path, look_at, rotation } = &self.kind else {
            return Ok(match self.kind {
                Kind::Follow { offset } => Camera::Follow { offset },
                _ => Camera::Keys,
            });
        };
        let Input::Path(file) = files::input(path, None)? else {
            let name = display_name(path);
            return Err(Failure::refused(format!(
                "{name}: expected the path of a camera, found rotations; use --camera PATH.dat,rotation={name}"
            )));
        };
        let view = match (look_at, rotation) {
            (_, Some(rotation)) => View::Turned(Box::new(rotations(rotation, frame)?)),
            (Some(Target::Root), None) => View::Root,
            (Some(Target::Point(point)), None) => View::Point(*point),
            (None, None) => View::Ahead,
        };
        Ok(Camera::Path { file: Box::new(file), view })
    }
}

/// The rotations of a camera, which is one object.
fn rotations(path: &Path, frame: Option<Frame>) -> Result<Keyframes, Failure> {
    let refuse = |found: String| {
        let name = display_name(path);
        Failure::refused(format!("{name}: expected the rotations of one camera, found {found}"))
    };
    match files::input(path, None)? {
        Input::Keyframes(keyframes) if keyframes.clip.tracks.len() == 1 => Ok(keyframes),
        Input::Keyframes(keyframes) => Err(refuse(format!("{} boxes", keyframes.clip.tracks.len()))),
        Input::Rotations(file) => Ok(camera_keys(file, frame)),
        Input::Path(_) => Err(refuse("a path".to_owned())),
        _ => Err(refuse("another kind of input".to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(text: &str) -> Result<Kind, String> {
        text.parse().map(|spec: CameraSpec| spec.kind)
    }

    #[test]
    fn every_form_is_understood() {
        assert_eq!(kind("keys"), Ok(Kind::Keys));
        assert_eq!(kind("follow"), Ok(Kind::Follow { offset: None }));
        let offset = Some(DVec3::new(0.0, 2.0, -8.5));
        assert_eq!(kind("follow,offset=0:2:-8.5"), Ok(Kind::Follow { offset }));
        let (path, rotation) = (PathBuf::from("a,b.dat"), Some(PathBuf::from("r,1.dat")));
        assert_eq!(kind("a,b.dat,rotation=r,1.dat"), Ok(Kind::Path { path, look_at: None, rotation }));
        let (path, rotation) = (PathBuf::from("./keys"), None);
        let look_at = Some(Target::Root);
        assert_eq!(kind("./keys,look-at=root"), Ok(Kind::Path { path, look_at, rotation }));
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        for (text, named) in [
            ("", "name of a file"),
            ("follow,offset=1:2", "X:Y:Z"),
            ("follow,offset=1:2:nan", "X:Y:Z"),
            ("follow,look-at=root", "look-at= does not go with 'follow'"),
            ("p.dat,offset=1:2:3", "offset= does not go with"),
            ("p.dat,look-at=root,rotation=r.dat", "found both"),
            ("p.dat,look-at=root,look-at=1:2:3", "twice"),
            ("-", "standard input"),
            ("p.dat,lookat=root", "found 'lookat='"),
        ] {
            let error = kind(text).unwrap_err();
            assert!(error.contains(named), "{text}: {error}");
        }
    }
}
