//! The command line: commands, options, help.

mod check;
mod compare;
mod convert;
mod diff;
mod example;
mod flags;
mod inspect;
mod keys;
mod path;
#[cfg(any(feature = "render", feature = "plot-png"))]
mod pixels;
#[cfg(feature = "plot-png")]
mod plot;
mod reduce;
mod sample;
#[cfg(feature = "render")]
mod thumbnail;
mod words;

pub(crate) use check::Check;
use clap::{Parser, Subcommand};
pub(crate) use compare::Compare;
pub(crate) use convert::Convert;
pub(crate) use diff::Diff;
pub(crate) use example::{Example, Kind};
pub(crate) use inspect::Inspect;
#[cfg(feature = "plot-png")]
pub(crate) use plot::Plot;
pub(crate) use reduce::Reduce;
pub(crate) use sample::Sample;
use std::ffi::{OsStr, OsString};
use std::path::Path;
#[cfg(feature = "render")]
pub(crate) use thumbnail::Thumbnail;

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 input refused, 2 usage, 3 output failed its check, 4 environment \
(a full disk, a missing permission, no graphics adapter).";

const CONVERT_EXAMPLES: &str = "\
Examples:
  dat2glb convert clip.dat -o clip.glb
  dat2glb convert clip.dat --path flight.dat --tolerance 0.01 -o flight.glb";

const CHECK_EXAMPLES: &str = "Example:\n  dat2glb check clip.glb --against clip.dat";

const DIFF_EXAMPLES: &str = "Example:\n  dat2glb diff old.glb new.glb --max-error 0.1";

#[cfg(feature = "render")]
const THUMBNAIL_EXAMPLES: &str = "\
Examples:
  dat2glb thumbnail clip.glb -o clip.png --time 50%
  dat2glb thumbnail clip.glb -o clip.gif --turntable";

const INSPECT_EXAMPLES: &str = "Example:\n  dat2glb inspect clip.dat";

const REDUCE_EXAMPLES: &str = "Example:\n  dat2glb reduce clip.glb -o small.glb --tolerance 0.05";

const SAMPLE_EXAMPLES: &str = "Example:\n  dat2glb sample clip.dat -o clip.csv --fps 60 --as euler";

const COMPARE_EXAMPLES: &str = "Example:\n  dat2glb compare clip.dat --scheme slerp,squad,bessel";

#[cfg(feature = "plot-png")]
const PLOT_EXAMPLES: &str = "\
Examples:
  dat2glb plot clip.dat -o clip.svg --scheme slerp,bessel
  dat2glb plot clip.glb --show error --against clip.dat -o error.png";

const EXAMPLE_EXAMPLES: &str = "Example:\n  dat2glb example chain > chain.dat";

const COMPLETIONS_EXAMPLES: &str = "Example:\n  dat2glb completions bash > dat2glb.bash";

const MAN_EXAMPLES: &str = "Example:\n  dat2glb man > dat2glb.1";

/// Converts quaternion keyframes to glTF animations that play correctly in every viewer.
#[derive(Debug, Parser)]
#[command(name = "dat2glb", version, arg_required_else_help = true, after_help = EXIT_CODES)]
#[command(
    override_usage = "dat2glb <COMMAND> …\n       dat2glb <IN.dat> [OUT.glb] [OPTIONS]    short for convert"
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Convert keyframes to an animated .glb or .gltf, then load it back and check it
    ///
    /// `dat2glb IN.dat [OUT.glb]` is short for `dat2glb convert IN.dat [-o OUT.glb]`.
    #[command(before_help = CONVERT_EXAMPLES)]
    Convert(Convert),
    /// Check a .glb or .gltf, and compare its playback with its input
    #[command(after_help = CHECK_EXAMPLES)]
    Check(Check),
    /// Find the largest motion differences between two .glb or .gltf files
    ///
    /// Clips and nodes are matched by name, unnamed or duplicate nodes by their path, then by
    /// order. Both files are played back as the glTF specification defines, with any
    /// interpolation; a shorter clip holds its last pose. Local motion is relative to the
    /// parent node, world motion is that of the node's axes and origin. Without limits the
    /// differences are reported and the exit code is 0; above a limit it is 3. Whatever is
    /// present in only one file fails with --strict.
    #[command(after_help = DIFF_EXAMPLES)]
    Diff(Diff),
    /// Render a .glb or .gltf: a frame, a contact sheet, ghosted poses or an animation
    #[cfg(feature = "render")]
    #[command(after_help = THUMBNAIL_EXAMPLES)]
    Thumbnail(Thumbnail),
    /// Summarize a file: keyframes, .glb or .gltf
    #[command(after_help = INSPECT_EXAMPLES)]
    Inspect(Inspect),
    /// Reduce the keyframes of a .glb or .gltf, leaving everything else unchanged
    #[command(after_help = REDUCE_EXAMPLES)]
    Reduce(Reduce),
    /// Write the motion as CSV, one row per sample
    #[command(after_help = SAMPLE_EXAMPLES)]
    Sample(Sample),
    /// Compare schemes: speed, smoothness, overshoot, keys needed
    ///
    /// Prints one row per scheme: max and RMS angular speed and acceleration; max jump of
    /// angular velocity and acceleration at a key; how far the motion goes beyond its keys
    /// (overshoot) and off the arc between them (stray), in degrees; the number of keys
    /// needed for a given playback error, and their size in bytes.
    #[command(after_help = COMPARE_EXAMPLES)]
    Compare(Compare),
    /// Plot curves as SVG or PNG
    ///
    /// Quaternion components over time, speeds, a path from several sides, axis directions, or
    /// the playback error of a file; several schemes in one plot.
    #[cfg(feature = "plot-png")]
    #[command(after_help = PLOT_EXAMPLES)]
    Plot(Plot),
    /// Print a small sample input
    #[command(after_help = EXAMPLE_EXAMPLES)]
    Example(Example),
    /// Print a shell completion script
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// Shell to generate the script for
        shell: clap_complete::Shell,
    },
    /// Print the manual page
    #[command(after_help = MAN_EXAMPLES)]
    Man,
}

/// `dat2glb IN.dat [OUT.glb] …` as `dat2glb convert IN.dat [-o OUT.glb] …`.
///
/// A first word that is no command counts as a file where it looks like one; anything
/// else is left for the parser to wonder about.
pub(crate) fn with_convert_spelled_out(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let is_command = |word: &OsStr| {
        let commands = [
            "convert",
            "check",
            "diff",
            "thumbnail",
            "inspect",
            "reduce",
            "sample",
            "compare",
            "plot",
            "example",
            "completions",
            "man",
            "help",
        ];
        commands.iter().any(|command| word == *command)
    };
    let looks_like_a_file = |word: &OsStr| {
        let path = Path::new(word);
        word == "-" || (path.extension().is_some() || path.components().count() > 1 || path.exists())
    };
    let first = &arguments[1];
    let is_flag = |word: &OsStr| word != "-" && word.as_encoded_bytes().starts_with(b"-");
    if is_command(first) || is_flag(first) || !looks_like_a_file(first) {
        return arguments;
    }
    let is_output = |word: &OsStr| {
        let ending = Path::new(word).extension().map(OsStr::to_ascii_lowercase);
        word == "-" || ending.is_some_and(|ending| ending == "glb" || ending == "gltf")
    };
    if arguments.get(2).is_some_and(|word| is_output(word)) {
        arguments.insert(2, "-o".into());
    }
    arguments.insert(1, "convert".into());
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;
    use dat2glb::curve::{Ends, Scheme, Tcb};

    fn parsed(line: &str) -> Result<Cli, clap::Error> {
        Cli::try_parse_from(with_convert_spelled_out(line.split(' ').map(OsString::from).collect()))
    }

    fn convert(line: &str) -> Convert {
        match parsed(line).unwrap().command {
            Command::Convert(convert) => convert,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn definitions_are_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn convert_may_be_left_out() {
        let short = convert("dat2glb in.dat out.glb --fps 30");
        assert_eq!((short.inputs, short.output), (vec!["in.dat".into()], Some("out.glb".into())));
        assert_eq!(convert("dat2glb a.dat b.dat").inputs.len(), 2);
        assert_eq!(convert("dat2glb - -").output, Some("-".into()));
        assert!(parsed("dat2glb chek").is_err());
    }

    #[test]
    fn schemes_are_lists() {
        let schemes = |list: &str| convert(&format!("dat2glb a.dat --scheme {list}")).schemes();
        assert_eq!(schemes("squad,slerp,squad"), [Scheme::Squad, Scheme::Slerp]);
        assert_eq!(schemes("all"), Scheme::ALL);
        assert_eq!(schemes("bessel,all")[0], Scheme::Bessel);
        assert_eq!(convert("dat2glb a.dat --ends periodic").ends, Ends::Closed);
        let tcb = convert("dat2glb a.dat --tension -1 --bias 0.5").tangents.tcb();
        assert_eq!(tcb, Tcb { tension: -1.0, continuity: 0.0, bias: 0.5 });
        assert!(parsed("dat2glb a.dat --continuity 1.1").is_err());
        assert!(parsed("dat2glb a.dat --scheme spline").is_err());
    }
}
