//! Arguments of `dat2glb thumbnail`.

use super::flags::RendererFlag;
use super::pixels::{pair, size};
use clap::{Args, ValueHint};
use dat2glb::render::{Background, Time};
use dat2glb::sample::Fps;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Thumbnail {
    /// File to render: .glb, .gltf
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// Image (.png) or animation (.gif, .apng, .webp) to write; `-` writes a .png to standard
    /// output [default: FILE.png]
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// Width and height in pixels, per cell [default: 512x512; with --camera, the camera's
    /// aspect ratio]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<(u32, u32)>,
    /// Time in seconds, or percentage of the clip [default: 50%; with --ghost 100%]
    #[arg(long, value_name = "2.5|50%", value_parser = time, allow_hyphen_values = true, conflicts_with = "sheet")]
    pub(crate) time: Option<Time>,
    /// Clip to render [default: the first]
    #[arg(long, value_name = "NAME", conflicts_with = "side_by_side")]
    pub(crate) clip: Option<String>,
    /// All clips side by side, synchronized and labeled; with --sheet, stacked
    #[arg(long)]
    pub(crate) side_by_side: bool,
    /// Contact sheet: a grid of C columns and R rows of frames from start to end of the clip
    #[arg(long, value_name = "CxR", value_parser = sheet, conflicts_with = "ghost")]
    pub(crate) sheet: Option<(u32, u32)>,
    /// Overlay N poses from the start up to --time, older ones fainter, with the trails of
    /// the box corners
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) ghost: Option<u32>,
    /// Frames per second of an animation [default: 25]
    #[arg(long)]
    pub(crate) fps: Option<Fps>,
    /// Animation: orbit the camera once around the scene
    #[arg(long, conflicts_with = "camera")]
    pub(crate) turntable: bool,
    /// Animation: loop even if the last pose differs from the first
    #[arg(long = "loop")]
    pub(crate) repeat: bool,
    /// Render through this camera of the file, by its name or its node's
    #[arg(long, value_name = "NAME")]
    pub(crate) camera: Option<String>,
    /// Background: studio, transparent, #rgb, #rrggbb or a color name
    #[arg(long, value_name = "COLOR", default_value = "studio")]
    pub(crate) background: Background,
    /// Draw a ground grid and the axes: X red, Y green (up), Z blue
    #[arg(long)]
    pub(crate) floor: bool,
    #[command(flatten)]
    pub(crate) renderer: RendererFlag,
    /// Print errors only
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

fn sheet(text: &str) -> Result<(u32, u32), String> {
    pair(text, 1000).ok_or_else(|| "expected columns and rows, 1 to 1000 each, such as 4x3".to_owned())
}

fn time(text: &str) -> Result<Time, String> {
    let number = |text: &str| text.parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0);
    let time = match text.strip_suffix('%') {
        Some(percent) => number(percent).map(|percent| Time::Fraction(percent / 100.0)),
        None => number(text.strip_suffix('s').unwrap_or(text)).map(Time::Seconds),
    };
    time.ok_or_else(|| "expected seconds, such as 2.5, or a percentage of the clip, such as 50%".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_times() {
        assert_eq!(size("640x480"), Ok((640, 480)));
        assert!(["640", "0x5", "5x99999", "x"].into_iter().all(|text| size(text).is_err()));
        assert_eq!(sheet("4x3"), Ok((4, 3)));
        assert!(["4", "0x3", "4x1001", "4x3x2"].into_iter().all(|text| sheet(text).is_err()));
        assert_eq!(time("2.5"), Ok(Time::Seconds(2.5)));
        assert_eq!(time("50%"), Ok(Time::Fraction(0.5)));
        assert!(["", "x", "nan", "-1", "%"].into_iter().all(|text| time(text).is_err()));
    }
}
