//! `dat2glb sample`: motion as CSV.

use super::args::Sample;
use super::exit::{Exit, Failure};
use super::files::{self, display_name, is_standard};
use super::output::Output;
use dat2glb::orient::Frame;
use dat2glb::table::Table;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

pub(super) fn run(options: &Sample) -> Result<Exit, Failure> {
    let name = display_name(&options.input);
    let paths: Vec<&Path> =
        std::iter::once(&options.input).chain(&options.path).map(PathBuf::as_path).collect();
    let gathered = files::gather(&paths, options.order.order, options.frame)?;
    let shape = options.along.shape(options.ends, options.tangents.tcb(), options.time_scale, options.frame);
    let ground = gathered.ground(&name, options.along.is_asked(), shape, &[options.scheme])?;
    let table = Table::new(&ground, options.scheme, options.notation, gathered.frame.unwrap_or(Frame::Gltf));
    let output = match &options.output {
        Some(path) if !is_standard(path) => {
            Output::create(path, &paths.iter().map(|p| p.to_path_buf()).collect::<Vec<_>>())?
        }
        _ => Output::standard_output()?,
    };
    let failed = |error| Failure::environment(format!("{name}: the table cannot be written: {error}"));
    let mut out = BufWriter::new(output.file());
    writeln!(out, "{}", table.header().join(",")).map_err(failed)?;
    for t in times(options, ground.duration()) {
        let row: Vec<String> = table.row(t).iter().map(f64::to_string).collect();
        writeln!(out, "{}", row.join(",")).map_err(failed)?;
    }
    out.flush().map_err(failed)?;
    drop(out);
    output.commit()?;
    Ok(Exit::Done)
}

/// An even grid and the last time, or so many steps.
fn times(options: &Sample, duration: f64) -> Box<dyn Iterator<Item = f64> + '_> {
    if let Some(count) = options.count {
        return Box::new((0..=count).map(move |i| duration * i as f64 / count as f64));
    }
    let fps = options.fps;
    let grid = (0u64..).map(move |frame| fps.time(frame)).take_while(move |&t| t < duration);
    Box::new(grid.chain([duration]))
}
