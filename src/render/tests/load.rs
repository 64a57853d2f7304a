use crate::asset::Asset;
use crate::asset::tests::{bytes, glb, open};
use crate::render::*;
use serde_json::{Value, json};

const SIZE: (u32, u32) = (96, 96);

/// A file that grows by accessors.
pub(super) struct File {
    pub json: Value,
    bin: Vec<u8>,
}

impl File {
    fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "buffers": [{}], "bufferViews": [], "accessors": [],
            "meshes": [], "nodes": [],
        });
        File { json, bin: Vec::new() }
    }

    pub(super) fn push(&mut self, list: &str, item: Value) -> usize {
        if self.json.get(list).is_none() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(item);
        list.len() - 1
    }

    fn accessor(&mut self, kind: &str, component: u32, data: &[u8], count: usize) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": data.len()});
        let view = self.push("bufferViews", view);
        self.bin.extend(data);
        let accessor = json!({
            "bufferView": view, "componentType": component, "type": kind, "count": count,
            "normalized": component == 5121 && kind != "SCALAR",
        });
        self.push("accessors", accessor)
    }

    fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let width = ["SCALAR", "", "VEC2", "VEC3", "VEC4"].iter().position(|k| *k == kind).unwrap();
        self.accessor(kind, 5126, &bytes(numbers), numbers.len() / width.max(1))
    }

    pub(super) fn asset(&self) -> Asset {
        let mut json = self.json.clone();
        json["buffers"][0]["byteLength"] = json!(self.bin.len());
        open(glb(&json, &self.bin)).unwrap()
    }

    pub(super) fn picture(&self) -> Picture {
        thumbnail(&mut self.asset(), &options()).unwrap()
    }

    pub(super) fn animate(&mut self, name: &str, node: usize, path: &str, keys: &[f32]) {
        let kind = if path == "rotation" { "VEC4" } else { "VEC3" };
        let count = keys.len() / if path == "rotation" { 4 } else { 3 };
        let times: Vec<f32> = (0..count).map(|i| i as f32).collect();
        let (input, output) = (self.floats("SCALAR", &times), self.floats(kind, keys));
        self.push(
            "animations",
            json!({
                "name": name,
                "samplers": [{"input": input, "output": output}],
                "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
            }),
        );
    }
}

pub(super) fn options() -> Options {
    Options { style: style(SIZE), renderer: Renderer::Cpu, ..Options::default() }
}

pub(super) fn style(size: (u32, u32)) -> Style {
    Style { size, ..Style::default() }
}

/// A house-shaped outline as a fan, seen from the front.
const OUTLINE: [[f32; 3]; 5] =
    [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 0.5, 0.0], [0.0, 1.5, 0.0], [-1.0, 0.5, 0.0]];
const AS_TRIANGLES: [usize; 9] = [0, 1, 2, 0, 2, 4, 4, 2, 3];

fn gather(indices: &[usize]) -> Vec<f32> {
    indices.iter().flat_map(|i| OUTLINE[*i]).collect()
}

/// One mesh of one primitive, shown by node 0.
fn house(mode: u32, vertices: &[usize], indices: Option<&[u8]>) -> File {
    let mut file = File::new();
    let positions = file.floats("VEC3", &gather(vertices));
    let mut primitive = json!({"attributes": {"POSITION": positions}, "mode": mode});
    if let Some(indices) = indices {
        primitive["indices"] = json!(file.accessor("SCALAR", 5121, indices, indices.len()));
    }
    file.push("meshes", json!({"primitives": [primitive]}));
    file.push("nodes", json!({"mesh": 0}));
    file
}

pub(super) fn plain_house() -> File {
    house(4, &AS_TRIANGLES, None)
}

#[test]
fn strips_fans_and_indices_draw_the_same() {
    let plain = plain_house().picture();
    assert!(plain.covered > 0.2 && plain.notes.is_empty(), "{plain:?}");
    for (name, file) in [
        ("indexed", house(4, &[0, 1, 2, 3, 4], Some(&AS_TRIANGLES.map(|i| i as u8)))),
        ("strip", house(5, &[0, 1, 4, 2, 3], None)),
        ("indexed strip", house(5, &[0, 1, 2, 3, 4], Some(&[0, 1, 4, 2, 3]))),
        ("fan", house(6, &[0, 1, 2, 3, 4], None)),
    ] {
        let other = file.picture();
        let differ = plain.pixels.pixels().zip(other.pixels.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 0, "{name}");
    }
}

#[test]
fn faces_are_flat_without_normals_and_mirrors_keep_their_fronts() {
    let plain = plain_house();
    let mut given = plain_house();
    let normals: Vec<f32> = (0..9).flat_map(|_| [0.0, 0.0, 1.0]).collect();
    let normals = given.floats("VEC3", &normals);
    given.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    assert!(given.picture().pixels == plain.picture().pixels);

    let mut mirrored = plain_house();
    mirrored.json["nodes"][0]["scale"] = json!([-1, 1, 1]);
    assert!(mirrored.picture().pixels == plain.picture().pixels, "the house is symmetric");
}

#[test]
fn backs_show_only_when_double_sided() {
    let mut file = plain_house();
    file.json["nodes"][0]["rotation"] = json!([0, 1, 0, 0]);
    assert_eq!(file.picture().covered, 0.0);
    file.push("materials", json!({"doubleSided": true}));
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    assert!(file.picture().covered > 0.2);
}

#[test]
fn a_matrix_and_its_steps_place_alike() {
    let mut steps = plain_house();
    steps.json["nodes"][0] = json!({
        "mesh": 0, "translation": [3, 4, 5], "rotation": [0, 0, 0.6, 0.8], "scale": [2, 1, 1],
    });
    let mut matrix = plain_house();
    matrix.json["nodes"][0] = json!({
        "mesh": 0,
        "matrix": [0.56, 1.92, 0, 0, -0.96, 0.28, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1],
    });
    let (a, b) = (steps.picture().pixels, matrix.picture().pixels);
    let differ = a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
    assert!(differ < 5, "{differ}");
}

/// The colour most of the drawn pixels have, over black.
fn main_colour(file: &File) -> [u8; 3] {
    let background = Background::Plain([0; 3]);
    let style = Style { background, ..style(SIZE) };
    let picture = thumbnail(&mut file.asset(), &Options { style, ..options() }).unwrap();
    let mut counts = std::collections::HashMap::new();
    for pixel in picture.pixels.pixels().filter(|p| p.0[..3] != [0; 3]) {
        *counts.entry([pixel[0], pixel[1], pixel[2]]).or_insert(0) += 1;
    }
    counts.into_iter().max_by_key(|(_, n)| *n).expect("something is drawn").0
}

#[test]
fn factor_vertex_colour_and_texture_multiply() {
    let mut file = plain_house();
    file.push("materials", json!({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 0, 1]}}));
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let [r, g, b] = main_colour(&file);
    assert!(r > 100 && r == g && b == 0, "factor: {r} {g} {b}");

    let colours: Vec<u8> = (0..9).flat_map(|_| [255, 128, 255, 255]).collect();
    let colours = file.accessor("VEC4", 5121, &colours, 9);
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colours);
    let [r, g, b] = main_colour(&file);
    assert!(r > 100 && g < r - 30 && g > 60 && b == 0, "vertex colour: {r} {g} {b}");

    let texture = image::RgbImage::from_pixel(4, 4, image::Rgb([0, 255, 255]));
    let mut png = std::io::Cursor::new(Vec::new());
    texture.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let png = png.into_inner();
    let accessor = file.accessor("SCALAR", 5121, &png, png.len());
    let view = file.json["accessors"][accessor]["bufferView"].clone();
    file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    file.push("textures", json!({"source": 0}));
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
    let uv = file.floats("VEC2", &[0.5; 18]);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uv);
    let [r, g, b] = main_colour(&file);
    assert!(r == 0 && g > 60 && b == 0, "texture: {r} {g} {b}");
}

#[test]
fn a_broken_texture_is_named_and_the_rest_drawn() {
    let mut file = plain_house();
    let junk = file.accessor("SCALAR", 5121, b"no picture", 10);
    let view = file.json["accessors"][junk]["bufferView"].clone();
    file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    file.push("textures", json!({"source": 0}));
    let pbr = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    file.push("materials", pbr);
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let picture = file.picture();
    assert!(picture.covered > 0.2);
    assert!(picture.notes[0].starts_with("left out: /images/0"), "{:?}", picture.notes);
}

#[test]
fn an_image_that_takes_far_more_memory_than_its_bytes_is_left_out() {
    let mut bomb = Vec::new();
    let mut encoder = png::Encoder::new(&mut bomb, 16384, 8192);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    encoder.write_header().unwrap().write_image_data(&vec![0; 16384 / 8 * 8192]).unwrap();
    assert!(bomb.len() < 1 << 20, "{}", bomb.len());
    let mut file = plain_house();
    let accessor = file.accessor("SCALAR", 5121, &bomb, bomb.len());
    let view = file.json["accessors"][accessor]["bufferView"].clone();
    file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    file.push("textures", json!({"source": 0}));
    file.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let picture = file.picture();
    assert!(picture.covered > 0.2);
    assert!(picture.notes[0].contains("16384 × 8192 pixels, too many for the bytes"), "{:?}", picture.notes);
}

#[test]
fn what_is_not_drawn_is_said_in_one_line() {
    let mut file = plain_house();
    let primitive = file.json["meshes"][0]["primitives"][0].clone();
    let mut points = primitive.clone();
    points["mode"] = json!(0);
    file.json["meshes"][0]["primitives"] = json!([primitive, points]);
    file.json["meshes"][0]["primitives"][0]["targets"] = json!([{}]);
    file.json["extensionsUsed"] = json!(["KHR_materials_clearcoat", "KHR_mesh_quantization"]);
    let expected = "not drawn: morph targets, points, KHR_materials_clearcoat";
    assert_eq!(file.picture().notes, [expected]);

    let mut file = plain_house();
    let transmission = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
    let transform = json!({"KHR_texture_transform": {"scale": [2, 2]}});
    file.push("materials", json!({
        "extensions": transmission, "emissiveFactor": [1, 0, 0], "normalTexture": {"index": 0, "extensions": transform},
    }));
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    file.json["skins"] = json!([{"joints": [0]}]);
    file.json["nodes"][0]["skin"] = json!(0);
    file.json["extensionsUsed"] = json!(["KHR_materials_transmission", "KHR_texture_transform"]);
    let picture = file.picture();
    let core = "not drawn: skins (meshes rest), emission, normal maps";
    assert_eq!(picture.notes, [format!("{core}, KHR_materials_transmission, KHR_texture_transform")]);
    assert!(picture.covered > 0.2);
}

#[test]
fn compressed_meshes_are_left_out_and_named() {
    let mut file = plain_house();
    let positions = file.push("accessors", json!({"componentType": 5126, "type": "VEC3", "count": 9}));
    let draco = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    let mesh = json!({"primitives": [{"attributes": {"POSITION": positions}, "extensions": draco}]});
    let mesh = file.push("meshes", mesh);
    file.push("nodes", json!({"mesh": mesh}));
    for list in ["extensionsUsed", "extensionsRequired"] {
        file.json[list] = json!(["KHR_draco_mesh_compression"]);
    }
    let picture = file.picture();
    assert_eq!(picture.notes, ["not drawn: KHR_draco_mesh_compression"]);
    assert!(picture.covered > 0.2, "the other mesh is drawn");
}

#[test]
fn the_default_scene_else_the_roots_are_shown() {
    let mut file = plain_house();
    file.push("nodes", json!({"children": [0]}));
    assert!(file.picture().covered > 0.2, "no scene: roots");
    file.json["scenes"] = json!([{"nodes": []}, {"nodes": [1]}]);
    assert_eq!(file.picture().covered, 0.0, "the first scene is empty");
    file.json["scene"] = json!(1);
    assert!(file.picture().covered > 0.2, "the second is not");
}

#[test]
fn cycles_end_deep_trees_do_not_overflow_and_strangers_are_skipped() {
    let mut file = plain_house();
    file.json["nodes"] = json!([{"mesh": 0, "children": [1, 7]}, {"children": [0, 1]}]);
    file.json["scenes"] = json!([{"nodes": [0, 9]}]);
    assert!(file.picture().covered > 0.2);

    let count = 50_000;
    let node = |i: usize| match i {
        0 => json!({"mesh": 0}),
        _ => json!({"children": [i - 1]}),
    };
    file.json["nodes"] = (0..count).map(node).collect();
    file.json["scenes"] = json!([{"nodes": [count - 1]}]);
    assert!(file.picture().covered > 0.2);
}

#[test]
fn nothing_at_all_is_an_empty_picture() {
    let file = File::new();
    let picture = file.picture();
    assert_eq!(picture.covered, 0.0);
    assert_eq!(picture.pixels.dimensions(), SIZE);
    let look = look(&mut file.asset(), SIZE, Renderer::Cpu).unwrap();
    assert!(!look.visible() && look.clips.is_empty());
}

#[test]
fn clips_are_found_by_name_and_times_clamped_aloud() {
    let mut file = plain_house();
    file.animate("slide", 0, "translation", &[0.0, 0.0, 0.0, 5.0, 0.0, 0.0]);
    file.animate("rise", 0, "translation", &[0.0, 0.0, 0.0, 0.0, 9.0, 0.0]);
    let draw = |clip: Option<&str>, time| {
        let options = Options { clip: clip.map(str::to_owned), time, ..options() };
        thumbnail(&mut file.asset(), &options)
    };
    let first = draw(None, Time::Fraction(0.5)).unwrap();
    assert!(draw(Some("slide"), Time::Seconds(0.5)).unwrap().pixels == first.pixels);
    assert!(draw(Some("rise"), Time::Seconds(0.5)).unwrap().pixels != first.pixels);
    let late = draw(None, Time::Seconds(9.0)).unwrap();
    assert!(late.pixels == draw(None, Time::Fraction(1.0)).unwrap().pixels);
    assert_eq!(late.notes, ["9 s is after the clip's end (it lasts 1 s): drew its end"]);
    let error = draw(Some("fall"), Time::Seconds(0.0)).unwrap_err().to_string();
    assert_eq!(error, "there is no clip named `fall`: the file has `slide`, `rise`");
}

/// Panics when anything is drawn near the border at some time of the clip.
fn stays_in_view(file: &File) {
    let mut asset = file.asset();
    let mut session = Session::new(&mut asset, Renderer::Cpu).unwrap();
    for step in 0..=100 {
        let time = Time::Fraction(f64::from(step) / 100.0);
        let style = Style { background: Background::Transparent, ..style((128, 80)) };
        let picture = session.picture(&mut asset, Some(0), time, &style).unwrap();
        assert!(picture.covered > 0.0);
        for (x, y, pixel) in picture.pixels.enumerate_pixels() {
            let border = x < 3 || y < 2 || x > 124 || y > 77;
            assert!(!(border && pixel[3] > 0), "step {step}: {x} {y}");
        }
    }
}

#[test]
fn the_whole_motion_stays_in_view() {
    let mut file = plain_house();
    let slide = [0.0, 0.0, 0.0, 50.0, 30.0, -20.0, -10.0, 3.0, 9.0];
    file.animate("slide", 0, "translation", &slide);
    stays_in_view(&file);
}

#[test]
fn turns_in_step_with_the_framing_stay_in_view() {
    let mut file = plain_house();
    file.json["nodes"][0]["scale"] = json!([0.2, 3, 1]);
    let quarter = std::f32::consts::FRAC_1_SQRT_2;
    let turn = [[0.0, 1.0], [quarter, quarter], [1.0, 0.0], [quarter, -quarter]];
    let key = |i: usize| [0.0, 0.0, turn[i % 4][0], turn[i % 4][1]];
    let keys: Vec<f32> = (0..=256).flat_map(key).collect();
    file.animate("64 turns", 0, "rotation", &keys);
    stays_in_view(&file);
}

#[test]
fn a_look_tells_what_moves() {
    let mut file = plain_house();
    file.push("nodes", json!({"name": "shows nothing"}));
    let moving = [0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    file.animate("moves", 0, "translation", &moving);
    file.animate("moves nothing", 1, "translation", &moving);
    file.animate("rests", 0, "translation", &[1.0; 9]);
    let look = look(&mut file.asset(), SIZE, Renderer::Cpu).unwrap();
    assert!(look.visible());
    let moves: Vec<_> = look.clips.iter().map(|clip| clip.moves).collect();
    assert_eq!(moves, [Some(true), Some(false), None]);
}

#[test]
fn a_look_sees_what_is_long_and_thin_but_not_what_is_clear() {
    let mut file = plain_house();
    let far = |i: i32| json!({"mesh": 0, "translation": [i * 2000, i * 1500, 0]});
    file.json["nodes"] = (0..3).map(far).collect();
    assert!(file.picture().covered < LEAST_VISIBLE);
    let seen = |file: &File| look(&mut file.asset(), SIZE, Renderer::Cpu).unwrap().visible();
    assert!(seen(&file));

    let pbr = json!({"baseColorFactor": [1, 1, 1, 0]});
    file.push("materials", json!({"alphaMode": "BLEND", "pbrMetallicRoughness": pbr}));
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    assert!(!seen(&file));
}

#[test]
fn sizes_out_of_range_are_errors() {
    let file = plain_house();
    for size in [(0, 9), (9, 0), (MOST_PIXELS + 1, 9), (9, u32::MAX)] {
        let result = thumbnail(&mut file.asset(), &Options { style: style(size), ..options() });
        assert!(matches!(result, Err(Error::Size(..))), "{size:?}");
    }
    for size in [(1, 1), (MOST_PIXELS, 1), (1, MOST_PIXELS)] {
        let picture = thumbnail(&mut file.asset(), &Options { style: style(size), ..options() }).unwrap();
        assert_eq!(picture.pixels.dimensions(), size);
    }
}

#[test]
fn damaged_files_do_not_panic() {
    let mut file = plain_house();
    file.animate("turns", 0, "rotation", &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]);
    file.json["buffers"][0]["byteLength"] = json!(file.bin.len());
    let sound = glb(&file.json, &file.bin);
    // Where the JSON's numbers and the binary chunk are: the rest would mostly
    // be no JSON any more, and that is another module's concern.
    let json_end = sound.len() - file.bin.len() - 8;
    let damageable: Vec<usize> =
        (20..sound.len()).filter(|at| *at >= json_end + 8 || sound[*at].is_ascii_digit()).collect();
    let mut seed = 1_u64;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % below
    };
    let (mut opened, mut seen) = (0, 0);
    for _ in 0..1500 {
        let mut damaged = sound.clone();
        for _ in 0..3 {
            let at = damageable[random(damageable.len())];
            damaged[at] = match at < json_end {
                true => b'0' + random(10) as u8,
                false => random(256) as u8,
            };
        }
        let Ok(mut asset) = open(damaged) else {
            continue;
        };
        opened += 1;
        let look = look(&mut asset, (16, 16), Renderer::Cpu);
        seen += usize::from(look.is_ok_and(|look| look.visible()));
    }
    assert!(opened > 500 && seen > 100, "{opened} {seen}");
}
