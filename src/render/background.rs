//! What lies behind the parts.

use std::str::FromStr;

/// What lies behind the parts; as text `studio`, `transparent`, `#rgb`,
/// `#rrggbb` or the name of a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Background {
    /// A light grey that darkens towards the floor.
    #[default]
    Studio,
    /// One sRGB colour.
    Plain([u8; 3]),
    /// Nothing: the picture keeps its alpha channel.
    Transparent,
}

/// Grey levels of the studio, at the top and at the bottom.
const STUDIO: [f32; 2] = [244.0, 206.0];

/// The sixteen names of CSS 2.1, and orange.
const NAMES: [(&str, [u8; 3]); 17] = [
    ("black", [0, 0, 0]),
    ("silver", [192, 192, 192]),
    ("gray", [128, 128, 128]),
    ("white", [255, 255, 255]),
    ("maroon", [128, 0, 0]),
    ("red", [255, 0, 0]),
    ("purple", [128, 0, 128]),
    ("fuchsia", [255, 0, 255]),
    ("green", [0, 128, 0]),
    ("lime", [0, 255, 0]),
    ("olive", [128, 128, 0]),
    ("yellow", [255, 255, 0]),
    ("navy", [0, 0, 128]),
    ("blue", [0, 0, 255]),
    ("teal", [0, 128, 128]),
    ("aqua", [0, 255, 255]),
    ("orange", [255, 165, 0]),
];

impl Background {
    /// The colour of a row of a picture; `None` where there is none.
    pub(super) fn row(self, y: usize, height: u32) -> Option<[u8; 3]> {
        match self {
            Background::Transparent => None,
            Background::Plain(colour) => Some(colour),
            Background::Studio => {
                let down = (y as f32 + 0.5) / height as f32;
                let level = STUDIO[0] + (STUDIO[1] - STUDIO[0]) * down * down;
                Some([(level + 0.5) as u8; 3])
            }
        }
    }

    /// Whether dark lines and letters are seen better on it than light ones.
    pub(super) fn is_light(self) -> bool {
        match self {
            Background::Studio | Background::Transparent => true,
            // Rec. 601 luma.
            Background::Plain([r, g, b]) => {
                299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b) > 110_000
            }
        }
    }
}

impl FromStr for Background {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let lower = text.trim().to_ascii_lowercase();
        let named = || NAMES.iter().find(|(name, _)| *name == lower.replace("grey", "gray"));
        let found = match lower.as_str() {
            "studio" => Some(Background::Studio),
            "transparent" | "none" => Some(Background::Transparent),
            other => match other.strip_prefix('#') {
                Some(digits) => hexadecimal(digits).map(Background::Plain),
                None => named().map(|(_, colour)| Background::Plain(*colour)),
            },
        };
        found.ok_or_else(|| {
            let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
            format!(
                "expected studio, transparent, #rgb, #rrggbb or one of {}; found `{text}`",
                names.join(", ")
            )
        })
    }
}

/// `rgb` or `rrggbb`.
fn hexadecimal(digits: &str) -> Option<[u8; 3]> {
    let values: Option<Vec<u8>> = digits.chars().map(|c| c.to_digit(16).map(|d| d as u8)).collect();
    match values?[..] {
        [r, g, b] => Some([r * 17, g * 17, b * 17]),
        [r, s, g, h, b, c] => Some([r * 16 + s, g * 16 + h, b * 16 + c]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_said_in_several_ways() {
        let plain = |r, g, b| Ok(Background::Plain([r, g, b]));
        assert_eq!("#fA0".parse(), plain(255, 170, 0));
        assert_eq!("#102030".parse(), plain(16, 32, 48));
        assert_eq!("Grey".parse(), plain(128, 128, 128));
        assert_eq!("white".parse(), plain(255, 255, 255));
        assert_eq!("studio".parse(), Ok(Background::Studio));
        assert_eq!("transparent".parse(), Ok(Background::Transparent));
        for wrong in ["", "#", "#12", "#12345", "#ggg", "#ééé", "beige-ish", "123456"] {
            let error = wrong.parse::<Background>().unwrap_err();
            assert!(error.contains("#rrggbb") && error.ends_with(&format!("found `{wrong}`")), "{error}");
        }
    }

    #[test]
    fn dark_letters_belong_on_light_colours() {
        let light = |text: &str| text.parse::<Background>().unwrap().is_light();
        assert!(light("white") && light("yellow") && light("studio") && light("silver"));
        assert!(!light("black") && !light("navy") && !light("blue") && !light("maroon"));
    }
}
