//! Options that several commands have.

use super::words::{formats, named, one_at_most};
use clap::Args;
use dat2glb::curve::Tcb;
use dat2glb::read::Order;
use dat2glb::report::Format;

/// What shapes the tangents of `kochanek-bartels`.
#[derive(Args, Debug)]
pub(crate) struct Tangents {
    /// kochanek-bartels: tangent length at keys: 1 stops, -1 doubles the speed
    #[arg(
        long,
        value_name = "T",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = one_at_most
    )]
    tension: f64,
    /// kochanek-bartels: corner at keys: -1 tight, +1 inverted
    #[arg(
        long,
        value_name = "C",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = one_at_most
    )]
    continuity: f64,
    /// kochanek-bartels: 1: tangent of the incoming segment, -1: of the outgoing
    #[arg(
        long,
        value_name = "B",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = one_at_most
    )]
    bias: f64,
}

impl Tangents {
    pub(crate) fn tcb(&self) -> Tcb {
        Tcb { tension: self.tension, continuity: self.continuity, bias: self.bias }
    }
}

#[derive(Args, Debug)]
pub(crate) struct OrderFlag {
    /// Component order of quaternions (overrides the header)
    #[arg(long = "quat-order", value_name = "ORDER", value_parser = named(Order::from_name, vec![("wxyz", ""), ("xyzw", "")]))]
    pub(crate) order: Option<Order>,
}

/// How findings are told.
#[derive(Args, Debug)]
pub(crate) struct ReportFlag {
    /// Format of the report on standard output
    #[arg(long, value_name = "FORMAT", default_value = "text", value_parser = formats())]
    report: Format,
    /// Short for --report json
    #[arg(long, conflicts_with = "report")]
    json: bool,
    /// Print only read errors; see the exit code
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

impl ReportFlag {
    pub(crate) fn format(&self) -> Format {
        if self.json { Format::Json } else { self.report }
    }
}

#[cfg(feature = "render")]
#[derive(Args, Debug)]
pub(crate) struct RendererFlag {
    /// Renderer backend
    #[arg(long, default_value = "auto", value_parser = named(renderer_named, vec![
        ("auto", "wgpu if there is an adapter, else cpu"),
        ("wgpu", "GPU, or a software adapter"),
        ("cpu", "built-in software renderer, same pixels on every machine"),
    ]))]
    pub(crate) renderer: dat2glb::render::Renderer,
}

#[cfg(feature = "render")]
fn renderer_named(name: &str) -> Option<dat2glb::render::Renderer> {
    use dat2glb::render::Renderer;
    match name {
        "auto" => Some(Renderer::Auto),
        "wgpu" => Some(Renderer::Wgpu),
        "cpu" => Some(Renderer::Cpu),
        _ => None,
    }
}
