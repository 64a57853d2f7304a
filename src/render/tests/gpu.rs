use super::*;
use crate::render::Background;
use crate::render::cpu;
use crate::render::error::Error;
use crate::render::gpu::Gpu;
use crate::render::layer::compose;
use image::RgbaImage;

/// Set where an adapter must be found, as CI does.
const REQUIRED: &str = "DAT2GLB_REQUIRE_ADAPTER";

/// The adapter, or nothing after saying so.
fn gpu(stage: &Stage) -> Option<Gpu> {
    match Gpu::new(&stage.parts, &stage.textures) {
        Ok(gpu) => Some(gpu),
        Err(Error::NoAdapter { reason }) => {
            let required = std::env::var_os(REQUIRED).is_some_and(|v| v == "1");
            assert!(!required, "{REQUIRED}=1, but there is no adapter: {reason}");
            eprintln!("NOT RUN for want of a graphics adapter: {reason}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Pixels that differ by more than 8 levels in some channel.
fn differing(a: &RgbaImage, b: &RgbaImage) -> usize {
    let far =
        |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 8);
    assert_eq!(a.dimensions(), b.dimensions());
    a.pixels().zip(b.pixels()).filter(|pair| far(*pair)).count()
}

#[test]
fn both_renderers_draw_the_same() {
    for (name, stage) in stages() {
        for size in [(512, 512), (301, 97)] {
            let Some(mut gpu) = gpu(&stage) else {
                return;
            };
            let scene = stage.scene(size);
            let layers = [gpu.draw(&scene).unwrap(), cpu::draw(&scene)];
            let pictures = layers.map(|layer| compose(layer, Background::Studio));
            keep(name, size, &pictures);
            let share = differing(&pictures[0], &pictures[1]) as f64 / f64::from(size.0 * size.1);
            eprintln!("{name} {size:?}: {:.4} % differ", share * 100.0);
            assert!(share <= 0.005, "{name} {size:?}: {share}");
        }
    }
}

/// Leaves both pictures to be looked at where this variable names a folder.
fn keep(name: &str, size: (u32, u32), pictures: &[RgbaImage; 2]) {
    let Some(folder) = std::env::var_os("DAT2GLB_KEEP_PICTURES") else {
        return;
    };
    for (renderer, picture) in ["wgpu", "cpu"].iter().zip(pictures) {
        let file = format!("{name} {} {renderer}.png", size.0).replace(' ', "-");
        picture.save(std::path::Path::new(&folder).join(file)).unwrap();
    }
}

#[test]
fn large_pictures_are_drawn_in_passes_without_seams() {
    let stage = chain(4, 3.0);
    let Some(mut gpu) = gpu(&stage) else {
        return;
    };
    let scene = stage.scene((2500, 2100));
    let pictures = [gpu.draw(&scene).unwrap(), cpu::draw(&scene)];
    let share = differing(&pictures[0], &pictures[1]) as f64 / (2500.0 * 2100.0);
    assert!(share <= 0.005, "{share}");
}

#[test]
fn one_adapter_draws_many_poses() {
    let stage = chain(3, 1.0);
    let Some(mut gpu) = gpu(&stage) else {
        return;
    };
    let first = gpu.draw(&stage.scene((64, 64))).unwrap();
    let mut turned = chain(3, 1.0);
    for (_, world) in &mut turned.placed {
        *world = DMat4::from_rotation_z(1.0) * *world;
    }
    assert!(gpu.draw(&turned.scene((64, 64))).unwrap() != first);
    assert!(gpu.draw(&stage.scene((64, 64))).unwrap() == first);
}

#[test]
fn what_the_adapter_refuses_is_an_error_and_no_panic() {
    let stage = chain(2, 1.0);
    let Some(mut gpu) = gpu(&stage) else {
        return;
    };
    let mut scene = stage.scene((8, 8));
    scene.size = (0, 8);
    assert!(matches!(gpu.draw(&scene), Err(Error::Adapter { .. })));
    scene.size = (8, 8);
    assert!(gpu.draw(&scene).is_ok(), "the adapter serves on");
}
