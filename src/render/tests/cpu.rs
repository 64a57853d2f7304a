use super::*;
use crate::render::cpu;
use crate::render::layer::{Layer, covered};
use crate::render::scene::{Draw, Light};

const WHITE: [f32; 4] = [1.0; 4];

/// Triangles given in clip space, drawn as they are: no camera.
fn flat_scene(parts: &[Part], size: (u32, u32)) -> Scene<'_> {
    let identity = DMat4::IDENTITY.to_cols_array_2d().map(|c| c.map(|v| v as f32));
    let draw = |part| Draw {
        part,
        clip: identity,
        normal: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        mirrored: false,
        depth: 0.0,
    };
    Scene {
        parts,
        extras: &[],
        textures: &[],
        draws: (0..parts.len()).map(draw).collect(),
        light: Light::studio(glam::Vec3::Y),
        size,
    }
}

/// Corners in pixels, y down, at a depth; two triangles a rectangle.
fn polygon(corners: &[[f32; 2]], depth: f32, colour: [f32; 4], size: (u32, u32)) -> Part {
    let mut part = empty(Material { double_sided: true, ..Material::default() });
    let (width, height) = (size.0 as f32, size.1 as f32);
    part.vertices.extend(corners.iter().map(|[x, y]| Vertex {
        position: [x / width * 2.0 - 1.0, 1.0 - y / height * 2.0, depth],
        normal: [0.0, 0.0, 1.0],
        colour,
        ..Vertex::default()
    }));
    for k in 2..corners.len() as u32 {
        part.indices.extend([0, k - 1, k]);
    }
    part
}

fn rectangle([x0, y0, x1, y1]: [f32; 4], size: (u32, u32)) -> Part {
    polygon(&[[x0, y0], [x0, y1], [x1, y1], [x1, y0]], 0.5, WHITE, size)
}

fn alphas(layer: &Layer) -> Vec<Vec<u8>> {
    layer.rows().map(|row| row.map(|p| p[3]).collect()).collect()
}

#[test]
fn a_rectangle_covers_its_pixels_and_no_others() {
    let size = (8, 6);
    let layer = cpu::draw(&flat_scene(&[rectangle([2.0, 1.0, 5.0, 4.0], size)], size));
    for (x, y, pixel) in layer.enumerate_pixels() {
        let inside = (2..5).contains(&x) && (1..4).contains(&y);
        assert_eq!(pixel[3], if inside { 255 } else { 0 }, "{x} {y}");
    }
    assert_eq!(covered(&layer), 9.0 / 48.0);
}

#[test]
fn half_a_pixel_is_half_the_samples() {
    let size = (4, 4);
    for (rectangle_, samples) in [
        ([1.0, 1.0, 1.5, 2.0], 2),
        ([1.0, 1.0, 2.0, 1.5], 2),
        ([1.0, 1.0, 1.25, 2.0], 1),
        ([1.0, 1.0, 1.9, 2.0], 4),
        ([1.0, 1.0, 1.5, 1.5], 1),
        ([1.4, 1.4, 1.6, 1.6], 0),
    ] {
        let layer = cpu::draw(&flat_scene(&[rectangle(rectangle_, size)], size));
        let expected = (f32::from(samples as u8) * 255.0 / 4.0 + 0.5) as u8;
        assert_eq!(layer[(1, 1)][3], expected, "{rectangle_:?}");
    }
}

#[test]
fn triangles_that_share_an_edge_draw_each_sample_once() {
    let size = (40, 40);
    let outline = [[3.3, 2.1], [20.5, 1.0], [37.2, 9.7], [38.0, 38.0], [20.5, 33.5], [1.2, 30.9]];
    // The fan meets in a corner that lies exactly on a sample.
    let middle = [20.375, 20.125];
    let material = Material { alpha: Alpha::Blend, double_sided: true, ..Material::default() };
    let parts: Vec<Part> = (0..outline.len())
        .map(|k| {
            let corners = [middle, outline[k], outline[(k + 1) % outline.len()]];
            let mut part = polygon(&corners, 0.5, [1.0, 1.0, 1.0, 0.5], size);
            part.material = material.clone();
            part
        })
        .collect();
    let layer = cpu::draw(&flat_scene(&parts, size));
    // Half transparent: a sample drawn twice would be 191, one left out 0.
    for (x, y, pixel) in
        layer.enumerate_pixels().filter(|(x, y, _)| (6..32).contains(x) && (9..30).contains(y))
    {
        assert_eq!(pixel[3], 128, "{x} {y}");
    }
    assert!(layer.pixels().all(|p| p[3] <= 128));
}

#[test]
fn the_nearer_surface_hides_the_farther_in_any_order() {
    let size = (16, 16);
    let whole = [[0.0, 0.0], [0.0, 16.0], [16.0, 16.0], [16.0, 0.0]];
    let near = polygon(&whole, 0.75, [1.0, 0.0, 0.0, 1.0], size);
    let far = polygon(&whole, 0.25, [0.0, 1.0, 0.0, 1.0], size);
    for parts in [[near.clone(), far.clone()], [far, near]] {
        let layer = cpu::draw(&flat_scene(&parts, size));
        assert!(layer.pixels().all(|p| p[0] > 100 && p[1] == 0));
    }
}

#[test]
fn what_passes_the_camera_is_cut_at_the_near_plane() {
    let size = (32, 32);
    // Clip coordinates by a matrix whose w is the vertex's z: a floor that runs
    // from before the eye to behind it.
    let mut part = empty(Material { double_sided: true, ..Material::default() });
    part.vertices.extend([[-1.0, -0.2, 4.0], [1.0, -0.2, 4.0], [0.0, -0.2, -4.0]].map(|position| Vertex {
        position,
        normal: [0.0, 1.0, 0.0],
        colour: WHITE,
        ..Vertex::default()
    }));
    part.indices.extend([0, 1, 2]);
    let parts = [part];
    let mut scene = flat_scene(&parts, size);
    scene.draws[0].clip =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.5, 0.0]];
    let rows: Vec<usize> =
        alphas(&cpu::draw(&scene)).iter().map(|row| row.iter().filter(|a| **a > 0).count()).collect();
    // The far edge is at y = −0.2/4, the near plane meets it at y = −0.2/0.5:
    // 16.8 and 22.4 pixels down.
    let drawn: Vec<usize> = (0..32).filter(|y| rows[*y] > 0).collect();
    assert_eq!(drawn, [16, 17, 18, 19, 20, 21, 22], "{rows:?}");
    assert!((8..=10).contains(&rows[16]) && rows[22] == 32, "{rows:?}");
}

#[test]
fn vertices_far_outside_and_broken_ones_do_no_harm() {
    let size = (16, 16);
    let huge = polygon(&[[-1e9, -1e9], [-1e9, 3e9], [3e9, -1e9]], 0.5, WHITE, size);
    assert_eq!(covered(&cpu::draw(&flat_scene(&[huge], size))), 1.0);
    for bad in [f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX] {
        let broken = polygon(&[[bad, 1.0], [1.0, bad], [5.0, 5.0], [bad, bad]], 0.5, WHITE, size);
        cpu::draw(&flat_scene(&[broken], size));
    }
}

#[test]
fn backs_are_culled_unless_double_sided_and_mirrors_turn_them() {
    let size = (8, 8);
    let mut part = rectangle([0.0, 0.0, 8.0, 8.0], size);
    part.material.double_sided = false;
    let parts = [part];
    let mut scene = flat_scene(&parts, size);
    assert_eq!(covered(&cpu::draw(&scene)), 1.0);
    scene.draws[0].mirrored = true;
    assert_eq!(covered(&cpu::draw(&scene)), 0.0);
}

#[test]
fn pictures_do_not_depend_on_the_number_of_threads() {
    for (name, stage) in stages() {
        let [one, two, seven] = [1, 2, 7].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| cpu::draw(&stage.scene((300, 200))))
        });
        assert!(one == two && one == seven, "{name}");
    }
}

#[test]
fn stages_are_seen_and_fill_the_view() {
    for (name, stage) in stages() {
        let layer = cpu::draw(&stage.scene((200, 200)));
        let share = covered(&layer);
        assert_eq!(share > 0.05, name != "nothing", "{name}: {share}");
        let on_border =
            |(x, y, p): (u32, u32, &image::Rgba<u8>)| p[3] > 0 && (x.min(199 - x) < 5 || y.min(199 - y) < 5);
        assert!(!layer.enumerate_pixels().any(on_border), "{name} touches the border");
    }
}

#[test]
fn scale_does_not_change_the_picture() {
    let stage = chain(4, 3.0);
    let plain = cpu::draw(&stage.scene((128, 128)));
    for scale in [1e-12, 1e12] {
        let mut scaled = chain(4, 3.0);
        for (_, world) in &mut scaled.placed {
            *world = DMat4::from_scale(DVec3::splat(scale)) * *world;
        }
        let other = cpu::draw(&scaled.scene((128, 128)));
        let differ = plain.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count();
        assert!(differ < 20, "{scale}: {differ}");
    }
}

/// All that a pixel can go through: smooth normals, textures, glass, masks,
/// mirrors. Placed without sines, whose last bits are each system's own.
#[test]
fn pictures_are_the_same_on_every_machine() {
    let Stage { parts, .. } = glass();
    let mut stage = textured_boxes();
    let first = stage.parts.len();
    stage.parts.extend(parts);
    let turn = DMat4::from_quat(DQuat::from_xyzw(0.48, 0.36, 0.0, 0.8));
    for part in 0..stage.parts.len() - first {
        let at = DVec3::new(1.5 * part as f64, 0.5, -1.0);
        stage.placed.push((first + part, DMat4::from_translation(at) * turn));
    }
    let layer = cpu::draw(&stage.scene((160, 120)));
    assert!(covered(&layer) > 0.2);
    let hash = blake3::hash(&layer).to_hex();
    // After a change that is meant to alter pictures, look at some, then put
    // the new value here.
    assert_eq!(&hash[..16], "a46258e65983ef75");
}
