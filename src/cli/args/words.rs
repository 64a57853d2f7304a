//! What the values of options may be: names that the help text lists, and numbers.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use dat2glb::curve::{Ends, Scheme};
use dat2glb::orient::{Axis, Frame};
use dat2glb::report::Format;

pub(super) fn axis() -> ValueParser {
    named(Axis::from_name, Axis::ALL.iter().map(|axis| (axis.name(), "")).collect())
}

pub(super) fn frame() -> ValueParser {
    named(
        Frame::from_name,
        vec![
            ("gltf", "x left, y up, z forward"),
            ("frd", "aerospace: x forward, y right, z down"),
            ("flu", "ROS: x forward, y left, z up"),
        ],
    )
}

pub(super) fn finite(text: &str) -> Result<f64, String> {
    let value: Option<f64> = text.parse().ok();
    value.filter(|value| value.is_finite()).ok_or_else(|| "expected a number".to_owned())
}

pub(super) fn one_at_most(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value.abs() <= 1.0 { Ok(value) } else { Err("expected a number from -1 to 1".to_owned()) }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value > 0.0 { Ok(value) } else { Err("expected a number above 0".to_owned()) }
}

pub(super) fn step(text: &str) -> Result<f64, String> {
    let value = positive(text)?;
    if value < 180.0 { Ok(value) } else { Err("expected degrees below 180".to_owned()) }
}

/// One word of `--scheme`: a scheme, or all of them.
#[derive(Clone, Debug)]
pub(super) struct Schemes(&'static [Scheme]);

/// The schemes of several words, each once, in the order given.
pub(super) fn each_once(asked: &[Schemes]) -> Vec<Scheme> {
    let mut schemes = Vec::new();
    for scheme in asked.iter().flat_map(|asked| asked.0.iter().copied()) {
        if !schemes.contains(&scheme) {
            schemes.push(scheme);
        }
    }
    schemes
}

/// A parser of names that the help text lists.
pub(super) fn named<T: Clone + Send + Sync + 'static>(
    from_name: fn(&str) -> Option<T>,
    names: Vec<(&'static str, &'static str)>,
) -> ValueParser {
    let value = |(name, help): (&'static str, &'static str)| match help {
        "" => PossibleValue::new(name),
        help => PossibleValue::new(name).help(help),
    };
    let values = PossibleValuesParser::new(names.into_iter().map(value));
    ValueParser::new(values.map(move |name| from_name(&name).expect("only listed names get here")))
}

pub(super) fn scheme_names() -> Vec<(&'static str, &'static str)> {
    Scheme::EVERY.iter().map(|scheme| (scheme.name(), scheme.summary())).collect()
}

pub(super) fn scheme() -> ValueParser {
    named(Scheme::from_name, scheme_names())
}

pub(super) fn schemes() -> ValueParser {
    let from_name = |name: &str| match name {
        "all" => Some(Schemes(Scheme::ALL)),
        name => Scheme::EVERY.iter().position(|s| s.name() == name).map(|i| Schemes(&Scheme::EVERY[i..=i])),
    };
    named(from_name, scheme_names().into_iter().chain([("all", "all but step")]).collect())
}

pub(super) fn ends() -> ValueParser {
    let values = [
        ("natural", "zero acceleration at both ends"),
        ("clamped", "zero velocity at both ends"),
        ("repeat", "the end key is repeated"),
        ("closed", "loop: the last key connects to the first"),
        ("periodic", "alias of closed"),
        ("hold", "each end segment holds its first key; the first then jumps"),
        ("chord", "end tangents are the mean velocity of the first and last segment"),
    ];
    named(Ends::from_name, values.to_vec())
}

pub(super) fn formats() -> ValueParser {
    let names = Format::ALL.iter().map(|format| (format.name(), format.summary()));
    named(Format::from_name, names.collect())
}

pub(super) fn degrees(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "expected degrees or units, a number".to_owned())?;
    if value >= 0.0 { Ok(value) } else { Err("expected degrees or units, 0 or more".to_owned()) }
}

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
    value.ok_or_else(|| "expected a number above 0, such as 0.01".to_owned())
}
