//! Whole-flow tests, a file a subject. Those of the command line run the real program.

mod clips;
mod clips_played;
mod hostile_motion;
mod mutator;
mod reference;
mod scipy;
mod support;
mod unsafe_code;

#[cfg(feature = "cli")]
mod check;
#[cfg(feature = "cli")]
mod compare;
#[cfg(feature = "cli")]
mod convert;
#[cfg(feature = "cli")]
mod convert_motion;
#[cfg(feature = "cli")]
mod convert_outputs;
#[cfg(feature = "cli")]
mod diff;
#[cfg(feature = "cli")]
mod example;
#[cfg(all(feature = "cli", feature = "render", feature = "plot-png", target_os = "linux"))]
mod faults;
#[cfg(all(feature = "cli", feature = "render", feature = "plot-png", target_os = "linux"))]
mod faults_inputs;
#[cfg(all(feature = "cli", feature = "render", feature = "plot-png", target_os = "linux"))]
mod faults_killed;
#[cfg(feature = "cli")]
mod fewest;
#[cfg(all(feature = "cli", feature = "plot-png", feature = "render"))]
mod gallery;
#[cfg(all(feature = "cli", feature = "render", feature = "plot-png"))]
mod golden;
#[cfg(feature = "cli")]
mod help;
#[cfg(all(feature = "cli", feature = "render", feature = "plot-png", target_os = "linux"))]
mod hostile;
#[cfg(feature = "cli")]
mod inspect;
#[cfg(feature = "cli")]
mod interpolation;
#[cfg(all(feature = "cli", feature = "plot-png", target_os = "linux"))]
mod long_inputs;
#[cfg(all(feature = "cli", feature = "render"))]
mod moving;
#[cfg(feature = "cli")]
mod outdated;
#[cfg(feature = "cli")]
mod paths;
#[cfg(all(feature = "cli", feature = "plot-png"))]
mod plot;
#[cfg(all(feature = "cli", feature = "plot-png"))]
mod plot_outputs;
#[cfg(feature = "cli")]
mod reduce;
#[cfg(feature = "cli")]
mod refused;
#[cfg(feature = "cli")]
mod reports;
#[cfg(feature = "cli")]
mod sample;
#[cfg(all(feature = "cli", feature = "render"))]
mod scenery;
#[cfg(all(feature = "cli", feature = "render"))]
mod thumbnail;
