//! Draws a .glb to a .png: `cargo run --example thumbnail IN.glb OUT.png [cpu|wgpu]`.

use dat2glb::asset::{Asset, NoFiles};
use dat2glb::render::{Options, Renderer, thumbnail};
use std::error::Error;
use std::fs::File;
use std::io::BufReader;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, rest @ ..] = &arguments[..] else {
        return Err("usage: thumbnail IN.glb OUT.png [cpu|wgpu]".into());
    };
    let renderer = match rest.first().map(String::as_str) {
        Some("cpu") => Renderer::Cpu,
        Some("wgpu") => Renderer::Wgpu,
        _ => Renderer::Auto,
    };
    let file = BufReader::new(File::open(input)?);
    let mut asset = Asset::open(Box::new(file), Box::new(NoFiles))?;
    let options = Options { renderer, ..Options::default() };
    let picture = thumbnail(&mut asset, &options)?;
    std::fs::write(output, picture.png())?;
    println!("{}", picture.renderer);
    picture.notes.iter().for_each(|note| println!("{note}"));
    Ok(())
}
