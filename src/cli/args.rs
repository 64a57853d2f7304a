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

/// Turns quaternion keyframes into glTF animations that play right everywhere.
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
    /// Convert keyframes to an animated .glb or .gltf, and check it by loading it back
    ///
    /// `dat2glb IN.dat [OUT.glb]` is short for `dat2glb convert IN.dat [-o OUT.glb]`.
    Convert(Convert),
    /// Check any .glb or .gltf, and compare its motion with its input
    Check(Check),
    /// Find the largest differences between the motions of two .glb or .gltf files
    ///
    /// Clips and nodes are matched by name; those whose names are missing or double by
    /// their path in the tree, then by their order. Both files are played as the glTF
    /// specification says, whatever their interpolation; a shorter clip holds its last
    /// pose. Local motion is a node's relative to its parent, world motion that of its
    /// axes and its origin. Without limits the differences are told and the exit code is
    /// 0; above a limit it is 3. What only one file has fails under --strict.
    Diff(Diff),
    /// Draw a .glb or .gltf: at a time, as a contact sheet, as ghosts, or moving
    #[cfg(feature = "render")]
    Thumbnail(Thumbnail),
    /// Say what a file holds: keyframes, .glb or .gltf
    Inspect(Inspect),
    /// Write a .glb or .gltf again with fewer keys, all else in it as it was
    Reduce(Reduce),
    /// Write the motion as a table: CSV, a row a time
    Sample(Sample),
    /// Compare schemes: speed, smoothness, overshoot, keys needed
    ///
    /// A row a scheme: the largest and the root-mean-square angular speed and acceleration;
    /// by how much angular velocity and acceleration jump at a key at most; how far the
    /// motion goes beyond its keys (overshoot) and off the arc between them (stray), degrees;
    /// how many keys playback needs to stay within so many degrees of it, and their bytes.
    Compare(Compare),
    /// Draw curves as diagrams: SVG or PNG
    ///
    /// Quaternions' parts over time, speeds, a path from its sides, where axes point, or how
    /// far a file's playback is off its curve; several schemes in one frame.
    #[cfg(feature = "plot-png")]
    Plot(Plot),
    /// Print a small input to start from
    Example(Example),
    /// Print a completion script for a shell
    Completions {
        /// Which shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page
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
