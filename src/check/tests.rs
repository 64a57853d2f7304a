//! A good file without findings, and for every code that file broken so that
//! exactly that code is found, where it was broken.

use std::io::Cursor;

use serde_json::{Value, json};

use super::*;
use crate::asset::NoFiles;
use crate::asset::tests::{bytes, glb};

/// Where the parts of the good file's data begin.
const TIMES: usize = 0;
const ROTATIONS: usize = 12;
const POSITIONS: usize = 60;
const INDICES: usize = 132;

/// A turning and moving triangle.
fn good() -> (Value, Vec<u8>) {
    let (s, c) = (5f32.to_radians().sin(), 5f32.to_radians().cos());
    let mut bin = bytes(&[0.0, 0.5, 1.0]);
    bin.extend(bytes(&[0.0, 0.0, 0.0, 1.0, s, 0.0, 0.0, c, 0.0, s, 0.0, c]));
    bin.extend(bytes(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    bin.extend(bytes(&[0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 2.0, 4.0, 6.0]));
    bin.extend([0, 0, 1, 0, 2, 0]);
    let view = |start: usize, length: usize| json!({"buffer": 0, "byteOffset": start, "byteLength": length});
    let float = |view: usize, kind: &str| json!({"bufferView": view, "componentType": 5126, "type": kind, "count": 3});
    let json = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "root", "children": [1]}, {"name": "triangle", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 2}, "indices": 4}]}],
        "animations": [{
            "name": "clip",
            "samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 3}],
            "channels": [
                {"sampler": 0, "target": {"node": 1, "path": "rotation"}},
                {"sampler": 1, "target": {"node": 1, "path": "translation"}},
            ],
        }],
        "buffers": [{"byteLength": bin.len()}],
        "bufferViews": [view(TIMES, 12), view(ROTATIONS, 48), view(POSITIONS, 36), view(96, 36), view(INDICES, 6)],
        "accessors": [
            with(float(0, "SCALAR"), json!({"min": [0], "max": [1]})),
            float(1, "VEC4"),
            with(float(2, "VEC3"), json!({"min": [0, 0, 0], "max": [1, 1, 0]})),
            float(3, "VEC3"),
            {"bufferView": 4, "componentType": 5123, "type": "SCALAR", "count": 3},
        ],
    });
    (json, bin)
}

/// `value` with the members of `more`.
fn with(mut value: Value, more: Value) -> Value {
    let (Some(object), Value::Object(more)) = (value.as_object_mut(), more) else {
        panic!("not objects");
    };
    object.extend(more);
    value
}

fn checked(file: Vec<u8>) -> Report {
    super::file(Box::new(Cursor::new(file)), Box::new(NoFiles)).unwrap()
}

/// Codes and places, as they are printed.
fn found(report: &Report) -> Vec<(&'static str, String)> {
    let findings = report.findings().iter();
    findings.map(|f| (f.code.as_str(), f.place.to_string())).collect()
}

/// Breaks the good file and expects just these findings.
#[track_caller]
fn expect(expected: &[(&str, &str)], edit: impl Fn(&mut Value, &mut Vec<u8>)) {
    let (mut json, mut bin) = good();
    edit(&mut json, &mut bin);
    let report = checked(glb(&json, &bin));
    let found = found(&report);
    let found: Vec<_> = found.iter().map(|(code, place)| (*code, place.as_str())).collect();
    assert_eq!(found, expected, "\n{}", report.text("FILE"));
}

/// Breaks the bytes of the good file and expects just these findings.
#[track_caller]
fn expect_bytes(expected: &[(&str, String)], edit: impl Fn(&mut Vec<u8>)) {
    let (json, bin) = good();
    let mut file = glb(&json, &bin);
    edit(&mut file);
    let report = checked(file);
    assert_eq!(found(&report), expected, "\n{}", report.text("FILE"));
}

fn put(bin: &mut [u8], at: usize, numbers: &[f32]) {
    let new = bytes(numbers);
    bin[at..at + new.len()].copy_from_slice(&new);
}

fn u32_at(file: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(file[at..at + 4].try_into().unwrap())
}

fn set_u32(file: &mut [u8], at: usize, change: impl Fn(u32) -> u32) {
    let new = change(u32_at(file, at));
    file[at..at + 4].copy_from_slice(&new.to_le_bytes());
}

/// Where the header of the BIN chunk is.
fn bin_at(file: &[u8]) -> usize {
    20 + u32_at(file, 12) as usize
}

#[test]
fn a_good_file_has_no_findings() {
    expect(&[], |_, _| {});
}

#[test]
fn lengths_of_a_glb() {
    expect_bytes(&[("GLB_TRUNCATED", "byte 8".into())], |file| set_u32(file, 8, |n| n + 4));
    let (json, bin) = good();
    let length = glb(&json, &bin).len();
    let end = format!("byte {length}");
    expect_bytes(&[("GLB_TRAILING_DATA", end.clone())], |file| file.extend([0; 9]));
    expect_bytes(&[("GLB_TRAILING_DATA", end)], |file| {
        file.extend([0; 4]);
        set_u32(file, 8, |n| n + 4);
    });
}

#[test]
fn chunks_of_a_glb() {
    let (json, bin) = good();
    let file = glb(&json, &bin);
    let (at, end) = (bin_at(&file), file.len());
    let bin_header = format!("byte {at}");
    expect_bytes(&[("GLB_CHUNK_TRUNCATED", bin_header.clone())], |file| set_u32(file, at, |n| n + 4));
    expect_bytes(&[("GLB_CHUNK_ALIGNMENT", bin_header)], |file| {
        file.truncate(end - 1);
        set_u32(file, at, |n| n - 1);
        set_u32(file, 8, |n| n - 1);
    });
    let more = |kind: &'static [u8; 4]| {
        move |file: &mut Vec<u8>| {
            file.extend(4u32.to_le_bytes());
            file.extend(kind);
            file.extend([0; 4]);
            set_u32(file, 8, |n| n + 12);
        }
    };
    expect_bytes(&[("GLB_CHUNK_ORDER", format!("byte {end}"))], more(b"BIN\0"));
    expect_bytes(&[("GLB_UNKNOWN_CHUNK", format!("byte {end}"))], more(b"ABCD"));
    expect_bytes(&[("GLB_BIN_UNUSED", format!("byte {}", at + 8))], |file| {
        file.extend([0; 4]);
        set_u32(file, at, |n| n + 4);
        set_u32(file, 8, |n| n + 4);
    });
}

#[test]
fn what_stands_around_the_json() {
    let (json, bin) = good();
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let padded = format!("byte {}", 20 + text.len());
    let longer = |file: &mut Vec<u8>, at: usize, insert: &[u8]| {
        file.splice(at..at, insert.iter().copied());
        set_u32(file, 12, |n| n + 4);
        set_u32(file, 8, |n| n + 4);
    };
    let end = bin_at(&glb(&json, &bin));
    expect_bytes(&[("JSON_PADDING", padded)], |file| longer(file, end, &[0; 4]));
    expect_bytes(&[("JSON_BYTE_ORDER_MARK", "byte 20".into())], |file| {
        longer(file, 20, b"\xEF\xBB\xBF ");
    });
}

#[test]
fn the_json_as_a_whole() {
    expect(&[("SCHEMA", "the JSON's root")], |json, _| json["nodes"] = json!(3));
    expect(&[("JSON_PARTLY_UNREAD", "the JSON's root")], |json, _| {
        json["extras"] = (0..200).fold(json!(0), |inner, _| json!([inner]));
    });
    expect(&[("VERSION", "/asset/version")], |json, _| json["asset"]["version"] = json!("1.0"));
    expect(&[("VERSION", "/asset/minVersion")], |json, _| json["asset"]["minVersion"] = json!("2.1"));
    expect(&[("EXTENSION_REQUIRED", "/extensionsRequired/0")], |json, _| {
        json["extensionsRequired"] = json!(["KHR_new"]);
        json["extensionsUsed"] = json!(["KHR_new"]);
    });
    expect(
        &[("EXTENSION_UNDECLARED", "/extensionsRequired/0"), ("EXTENSION_REQUIRED", "/extensionsRequired/0")],
        |json, _| json["extensionsRequired"] = json!(["KHR_new"]),
    );
}

#[test]
fn indices_that_refer_to_nothing() {
    let out = |place: &'static str| [("INDEX_OUT_OF_RANGE", place)];
    expect(&out("/nodes/1/children/0"), |json, _| json["nodes"][1]["children"] = json!([7]));
    expect(&out("/scene"), |json, _| json["scene"] = json!(1));
    expect(&out("/animations/0/channels/0/target/node"), |json, _| {
        json["animations"][0]["channels"][0]["target"]["node"] = json!(2);
    });
    expect(
        &[out("/animations/0/channels/0/sampler")[0], ("UNUSED_OBJECT", "/animations/0/samplers/0")],
        |json, _| {
            json["animations"][0]["channels"][0]["sampler"] = json!(2);
        },
    );
    expect(&[out("/animations/0/samplers/0/output")[0], ("UNUSED_OBJECT", "/accessors/1")], |json, _| {
        json["animations"][0]["samplers"][0]["output"] = json!(5);
    });
    expect(&[out("/accessors/1/bufferView")[0], ("UNUSED_OBJECT", "/bufferViews/1")], |json, _| {
        json["accessors"][1]["bufferView"] = json!(9);
    });
    // Here gltf-json itself would panic.
    let position = "/meshes/0/primitives/0/attributes/POSITION";
    expect(&[out(position)[0], ("UNUSED_OBJECT", "/accessors/2")], |json, _| {
        json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99);
    });
    // And here it would take the low 32 bits.
    expect(&out(position), |json, _| {
        json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!((1u64 << 32) + 2);
    });
    expect(&out("/nodes/0/children/0"), |json, _| json["nodes"][0]["children"] = json!([(1u64 << 32) + 1]));
}

#[test]
fn values_that_gltf_does_not_know() {
    expect(&[("INVALID_VALUE", "/animations/0/samplers/0/interpolation")], |json, _| {
        json["animations"][0]["samplers"][0]["interpolation"] = json!("BEZIER");
    });
    expect(&[("INVALID_VALUE", "/animations/0/channels/0/target/path")], |json, _| {
        json["animations"][0]["channels"][0]["target"]["path"] = json!("colour");
    });
    expect(&[("INVALID_VALUE", "/meshes/0/primitives/0/mode")], |json, _| {
        json["meshes"][0]["primitives"][0]["mode"] = json!(7);
    });
    expect(&[("INVALID_VALUE", "/nodes/1/camera")], |json, _| json["nodes"][1]["camera"] = Value::Null);
    expect(&[("VERSION", "/asset/version")], |json, _| json["asset"]["version"] = json!("2"));
    expect(&[("MISSING_VALUE", "/cameras/0")], |json, _| {
        json["cameras"] = json!([{"type": "perspective"}]);
        json["nodes"][0]["camera"] = json!(0);
    });
}

#[test]
fn buffers_and_views() {
    expect(&[("GLB_BIN_UNUSED", "byte 1528"), ("BUFFER_UNREADABLE", "/buffers/0/uri")], |json, _| {
        json["buffers"][0]["uri"] = json!("gone.bin");
        // Keeps the place of the BIN chunk the same whatever else changes.
        let length = json.to_string().len();
        json["extras"] = json!("x".repeat(1520 - 20 - length - r#","extras":"""#.len()));
    });
    expect(&[("BUFFER_TOO_SHORT", "/buffers/0/byteLength")], |json, _| {
        json["buffers"][0]["byteLength"] = json!(9999);
    });
    expect(&[("VIEW_BOUNDS", "/bufferViews/4")], |json, _| {
        json["bufferViews"][4]["byteLength"] = json!(7);
    });
    expect(
        &[("VIEW_BOUNDS", "/bufferViews/4"), ("ACCESSOR_ALIGNMENT", "/accessors/4/byteOffset")],
        |json, _| {
            json["bufferViews"][4]["byteOffset"] = json!(u64::MAX);
        },
    );
    expect(
        &[("VIEW_STRIDE", "/bufferViews/2/byteStride"), ("VIEW_STRIDE", "/bufferViews/2/byteStride")],
        |json, _| {
            json["bufferViews"][2]["byteStride"] = json!(2);
        },
    );
}

#[test]
fn morph_targets_and_cameras() {
    let target = |accessor: u64| {
        move |json: &mut Value, _: &mut Vec<u8>| {
            let mut fewer = json["accessors"][2].clone();
            fewer["count"] = json!(2);
            fewer["max"] = json!([1, 0, 0]);
            json["accessors"].as_array_mut().unwrap().push(fewer);
            json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 5}, {"POSITION": accessor}]);
        }
    };
    let count = ("ATTRIBUTE_COUNT", "/meshes/0/primitives/0/targets/0");
    expect(&[count], target(2));
    let place = "/meshes/0/primitives/0/targets/1/POSITION";
    expect(&[("INDEX_OUT_OF_RANGE", place), count], target((1 << 32) + 2));
    expect(&[("INVALID_VALUE", "/cameras/0/perspective")], |json, _| {
        json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 2, "zfar": 1}}]);
        json["nodes"][0]["camera"] = json!(0);
    });
}

#[test]
fn views_hold_one_kind_of_data() {
    let unused = ("UNUSED_OBJECT", "/bufferViews/3");
    expect(&[("VIEW_USES", "/bufferViews/2"), unused], |json, _| {
        json["accessors"][3]["bufferView"] = json!(2);
    });
}

#[test]
fn accessors() {
    expect(&[("ACCESSOR_BOUNDS", "/accessors/2")], |json, _| {
        json["accessors"][2]["byteOffset"] = json!(4);
    });
    expect(&[("ACCESSOR_BOUNDS", "/accessors/4")], |json, _| {
        json["accessors"][4]["count"] = json!(u64::MAX);
    });
    expect(&[("ACCESSOR_ALIGNMENT", "/accessors/4/byteOffset")], |json, bin| {
        json["bufferViews"][4]["byteOffset"] = json!(INDICES + 1);
        json["buffers"][0]["byteLength"] = json!(INDICES + 7);
        bin.splice(INDICES..INDICES, [0]);
    });
    let sparse = |index: u16| {
        move |json: &mut Value, bin: &mut Vec<u8>| {
            bin.extend([0, 0]);
            let start = bin.len();
            bin.extend(index.to_le_bytes());
            bin.extend([0, 0]);
            bin.extend(bytes(&[0.0; 3]));
            json["buffers"][0]["byteLength"] = json!(bin.len());
            let views = json["bufferViews"].as_array_mut().unwrap();
            views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": 16}));
            json["accessors"][3]["sparse"] = json!({
                "count": 1,
                "indices": {"bufferView": 5, "componentType": 5123},
                "values": {"bufferView": 5, "byteOffset": 4},
            });
        }
    };
    expect(&[], sparse(2));
    expect(&[("SPARSE_INDICES", "/accessors/3/sparse/indices")], sparse(3));
}

#[test]
fn data_that_extensions_hold_is_not_missed() {
    let compressed = |extension: &'static str| {
        move |json: &mut Value, _: &mut Vec<u8>| {
            json["extensionsUsed"] = json!([extension]);
            json["buffers"].as_array_mut().unwrap().push(json!({"byteLength": 36}));
            json["bufferViews"][2] = json!({"buffer": 1, "byteLength": 36});
        }
    };
    expect(&[], compressed("EXT_meshopt_compression"));
    expect(&[], |json, _| {
        json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
        json["accessors"][2].as_object_mut().unwrap().remove("bufferView");
    });
}

#[test]
fn numbers_in_accessors() {
    expect(&[("NOT_FINITE", "/accessors/3")], |_, bin| put(bin, 96, &[f32::NAN]));
    expect(&[("NOT_FINITE", "/animations/0/samplers/0/output")], |_, bin| {
        put(bin, ROTATIONS + 16, &[f32::INFINITY]);
    });
    expect(&[("NOT_FINITE", "/animations/0/samplers/0/input")], |_, bin| put(bin, TIMES + 4, &[f32::NAN]));
    expect(
        &[
            ("MIN_MAX_MISSING", "/animations/0/samplers/0/input"),
            ("MIN_MAX_MISSING", "/animations/0/samplers/1/input"),
        ],
        |json, _| {
            json["accessors"][0].as_object_mut().unwrap().remove("max");
        },
    );
    expect(&[("MIN_MAX_MISSING", "/accessors/2")], |json, _| {
        json["accessors"][2].as_object_mut().unwrap().remove("min");
    });
    expect(&[("MIN_MAX_WRONG", "/accessors/0/max")], |json, _| {
        // The next float32 after 1.
        json["accessors"][0]["max"] = json!([1.000_000_119]);
    });
    expect(&[("MIN_MAX_WRONG", "/accessors/2/min")], |json, _| json["accessors"][2]["min"] = json!([0, 0]));
}

#[test]
fn vertices() {
    expect(&[("ATTRIBUTE_TYPE", "/meshes/0/primitives/0/attributes/TANGENT")], |json, _| {
        json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(2);
    });
    expect(&[("ATTRIBUTE_TYPE", "/meshes/0/primitives/0/indices")], |json, _| {
        json["accessors"][4]["normalized"] = json!(true);
    });
    expect(&[("ATTRIBUTE_COUNT", "/meshes/0/primitives/0/attributes/NORMAL")], |json, _| {
        let fewer = json!({"count": 2, "max": [1, 0, 0]});
        let fewer = with(json["accessors"][2].clone(), fewer);
        json["accessors"].as_array_mut().unwrap().push(fewer);
        let primitive = &mut json["meshes"][0]["primitives"][0];
        primitive["attributes"]["NORMAL"] = json!(4);
        // Its indices name the third vertex.
        primitive.as_object_mut().unwrap().remove("indices");
        json["accessors"].as_array_mut().unwrap().remove(4);
        json["bufferViews"].as_array_mut().unwrap().remove(4);
    });
    expect(&[("VERTEX_INDEX", "/meshes/0/primitives/0/indices")], |_, bin| bin[INDICES] = 3);
}

#[test]
fn the_forest_of_nodes() {
    expect(&[("NODE_CYCLE", "/nodes/2")], |json, _| {
        let nodes = json["nodes"].as_array_mut().unwrap();
        nodes.push(json!({"name": "a", "children": [3]}));
        nodes.push(json!({"name": "b", "children": [2]}));
    });
    expect(&[("NODE_TWO_PARENTS", "/nodes/2/children/0")], |json, _| {
        json["nodes"].as_array_mut().unwrap().push(json!({"name": "second", "children": [1]}));
        json["scenes"][0]["nodes"] = json!([0, 2]);
    });
    expect(&[("SCENE_NODE_NOT_ROOT", "/scenes/0/nodes/1")], |json, _| {
        json["scenes"][0]["nodes"] = json!([0, 1]);
    });
}

#[test]
fn a_deep_chain_of_nodes_needs_no_stack() {
    expect(&[("UNUSED_OBJECT", "/nodes/2")], |json, _| {
        let nodes = json["nodes"].as_array_mut().unwrap();
        for i in 2..200_000 {
            nodes.push(json!({"children": [i + 1]}));
        }
        nodes.push(json!({}));
    });
}

#[test]
fn transforms_of_nodes() {
    let unit = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    expect(&[("NODE_MATRIX_AND_TRS", "/nodes/0/matrix")], |json, _| {
        json["nodes"][0]["matrix"] = unit.clone();
        json["nodes"][0]["scale"] = json!([1, 1, 1]);
    });
    expect(&[("NODE_ROTATION", "/nodes/0/rotation")], |json, _| {
        json["nodes"][0]["rotation"] = json!([0, 0, 0, 1.001]);
    });
    expect(&[("NOT_FINITE", "/nodes/0/translation")], |json, _| {
        json["nodes"][0]["translation"] = json!([1e39, 0, 0]);
    });
    expect(
        &[
            ("ANIMATED_MATRIX", "/animations/0/channels/0/target"),
            ("ANIMATED_MATRIX", "/animations/0/channels/1/target"),
        ],
        |json, _| json["nodes"][1]["matrix"] = unit.clone(),
    );
}

#[test]
fn names_that_viewers_change() {
    expect(&[("DUPLICATE_NAME", "/nodes/1/name")], |json, _| json["nodes"][1]["name"] = json!("root"));
    expect(&[("DUPLICATE_NAME", "/animations/1/name")], |json, _| {
        let again = json["animations"][0].clone();
        json["animations"].as_array_mut().unwrap().push(again);
    });
    expect(&[("NAME_TOO_LONG", "/nodes/0/name")], |json, _| json["nodes"][0]["name"] = json!("x".repeat(64)));
}

#[test]
fn targets_of_channels() {
    expect(
        &[("ANIMATION_EMPTY", "/animations/1/channels"), ("ANIMATION_EMPTY", "/animations/1/samplers")],
        |json, _| {
            json["animations"]
                .as_array_mut()
                .unwrap()
                .push(json!({"name": "none", "channels": [], "samplers": []}));
        },
    );
    expect(&[("CHANNEL_WITHOUT_NODE", "/animations/0/channels/1/target")], |json, _| {
        json["animations"][0]["channels"][1]["target"] = json!({"path": "pointer"});
    });
    expect(&[("CHANNEL_TWICE", "/animations/0/channels/2/target")], |json, _| {
        let again = json["animations"][0]["channels"][0].clone();
        json["animations"][0]["channels"].as_array_mut().unwrap().push(again);
    });
    expect(
        &[
            ("WEIGHTS_WITHOUT_TARGETS", "/animations/0/channels/1/target"),
            ("OUTPUT_TYPE", "/animations/0/samplers/1/output"),
        ],
        |json, _| json["animations"][0]["channels"][1]["target"]["path"] = json!("weights"),
    );
}

#[test]
fn types_and_counts_of_samplers() {
    expect(
        &[("INPUT_TYPE", "/animations/0/samplers/0/input"), ("INPUT_TYPE", "/animations/0/samplers/1/input")],
        |json, _| {
            json["accessors"][0]["normalized"] = json!(true);
        },
    );
    expect(&[("OUTPUT_TYPE", "/animations/0/samplers/0/output")], |json, _| {
        json["animations"][0]["samplers"][0]["output"] = json!(3);
        json["animations"][0]["samplers"][1]["output"] = json!(1);
        json["animations"][0]["channels"].as_array_mut().unwrap().remove(1);
        json["animations"][0]["samplers"].as_array_mut().unwrap().remove(1);
        json["nodes"][0]["extras"] = json!(0);
        json["accessors"][1] = json!({"componentType": 5126, "type": "VEC3", "count": 3});
        json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 1}]);
        json["bufferViews"][1]["byteLength"] = json!(1);
        json["images"] = json!([{"bufferView": 1}]);
        json["textures"] = json!([{"source": 0}]);
        json["materials"] = json!([{"normalTexture": {"index": 0}}]);
        json["meshes"][0]["primitives"][0]["material"] = json!(0);
    });
    expect(&[("OUTPUT_COUNT", "/animations/0/samplers/0/output")], |json, _| {
        json["accessors"][1]["count"] = json!(2);
    });
    expect(&[("OUTPUT_COUNT", "/animations/0/samplers/0/output")], |json, _| {
        json["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE");
    });
    expect(&[("CUBICSPLINE_ONE_KEY", "/animations/0/samplers/0/input")], |json, bin| {
        json["animations"][0]["samplers"].as_array_mut().unwrap().truncate(1);
        json["animations"][0]["channels"].as_array_mut().unwrap().truncate(1);
        json["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE");
        json["accessors"][0]["count"] = json!(1);
        json["accessors"][0]["max"] = json!([0]);
        json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 3}]);
        put(bin, ROTATIONS + 16, &[0.0, 0.0, 0.0, 1.0]);
    });
    expect(&[("SAMPLER_STRIDE", "/animations/0/samplers/0/output")], |json, _| {
        json["bufferViews"][1]["byteStride"] = json!(16);
    });
}

#[test]
fn a_sampler_must_suit_all_its_channels() {
    expect(
        &[("OUTPUT_TYPE", "/animations/0/samplers/0/output"), ("UNUSED_OBJECT", "/animations/0/samplers/1")],
        |json, _| json["animations"][0]["channels"][1]["sampler"] = json!(0),
    );
}

#[test]
fn times_of_keys() {
    let input = "/animations/0/samplers/0/input";
    let times = |expected: &[(&str, &str)], times: [f32; 3]| {
        expect(expected, |json, bin| {
            put(bin, TIMES, &times);
            let order = |f: fn(f32, f32) -> f32| times.into_iter().reduce(f).unwrap();
            json["accessors"][0]["min"] = json!([order(f32::min)]);
            json["accessors"][0]["max"] = json!([order(f32::max)]);
        });
    };
    times(&[("TIME_NEGATIVE", input)], [-0.5, 0.5, 1.0]);
    times(&[("TIME_NOT_INCREASING", input)], [0.0, 1.0, 1.0]);
    times(&[("TIME_NOT_INCREASING", input)], [0.0, 1.0, 0.5]);
    times(&[("KEYS_TOO_CLOSE", input)], [0.0, 0.0004, 1.0]);
    times(&[], [0.0, 0.0005, 1.0]);
    times(&[("NO_KEY_AT_ZERO", input)], [0.1, 0.5, 1.0]);
    times(&[("TIMES_BLURRED", input)], [0.0, 20_000.0, 20_001.0]);
    let late = [("NO_KEY_AT_ZERO", input), ("TIMES_BLURRED", input)];
    times(&late, [1000.0, 1000.001, 1000.002]);
    times(&late[..1], [1000.0, 1000.002, 1000.004]);
}

#[test]
fn rotations_in_keys() {
    let output = "/animations/0/samplers/0/output";
    let turn = |degrees: f32| {
        let half = degrees.to_radians() / 2.0;
        [half.sin(), 0.0, 0.0, half.cos()]
    };
    let second = |expected: &[(&str, &str)], q: [f32; 4]| {
        expect(expected, |_, bin| put(bin, ROTATIONS + 16, &[q, q].concat()));
    };
    second(&[], turn(17.99));
    second(&[], turn(17.99).map(|x| x * 1.000_009));
    second(&[("ROTATION_NOT_UNIT", output)], turn(17.99).map(|x| x * 1.000_02));
    second(&[("ROTATION_NOT_UNIT", output)], [0.0; 4]);
    second(&[("ROTATION_SIGN_FLIP", output)], turn(5.0).map(|x| -x));
    second(&[("ROTATION_LARGE_STEP", output)], turn(18.1));
    second(&[("ROTATION_LARGE_STEP", output)], turn(180.0));
    // What is far for LINEAR is nothing for STEP.
    expect(&[], |json, bin| {
        json["animations"][0]["samplers"][0]["interpolation"] = json!("STEP");
        put(bin, ROTATIONS + 16, &turn(90.0).map(|x| -x));
    });
    // A ramp of a millisecond is meant as a jump.
    expect(&[("ROTATION_JUMP", output)], |_, bin| {
        put(bin, TIMES + 4, &[0.001]);
        put(bin, ROTATIONS + 16, &[turn(90.0), turn(90.0)].concat());
    });
}

#[test]
fn rotations_in_sixteen_bits_may_be_a_code_step_off() {
    let code = |q: [f64; 4]| q.map(|x| (x * 32767.0).round() as i16);
    let shorts = |w: i16| {
        move |json: &mut Value, bin: &mut Vec<u8>| {
            let mut q = code([0.1, 0.2, -0.3, 0.86f64.sqrt()]);
            q[3] += w;
            let packed: Vec<u8> = q.repeat(3).iter().flat_map(|x| x.to_le_bytes()).collect();
            bin[ROTATIONS..ROTATIONS + 24].copy_from_slice(&packed);
            json["accessors"][1]["componentType"] = json!(5122);
            json["accessors"][1]["normalized"] = json!(true);
        }
    };
    expect(&[], shorts(0));
    expect(&[("ROTATION_NOT_UNIT", "/animations/0/samplers/0/output")], shorts(4));
}

#[test]
fn what_is_not_used() {
    expect(&[("UNUSED_OBJECT", "/animations/0/samplers/1")], |json, _| {
        json["animations"][0]["channels"].as_array_mut().unwrap().pop();
    });
    expect(&[("UNUSED_OBJECT", "/nodes/2"), ("UNUSED_OBJECT", "/materials/0")], |json, _| {
        json["nodes"].as_array_mut().unwrap().push(json!({}));
        json["materials"] = json!([{}]);
    });
}

#[test]
fn lengths_of_channels_and_clips() {
    let shorter = |json: &mut Value| {
        let mut times = json["accessors"][0].clone();
        times["count"] = json!(2);
        times["max"] = json!([0.5]);
        let mut values = json["accessors"][3].clone();
        values["count"] = json!(2);
        let accessors = json["accessors"].as_array_mut().unwrap();
        accessors.extend([times, values]);
        json!({"input": 5, "output": 6})
    };
    expect(&[("CHANNEL_LENGTHS", "/animations/0"), ("UNUSED_OBJECT", "/accessors/3")], |json, _| {
        json["animations"][0]["samplers"][1] = shorter(json);
    });
    expect(&[("CLIP_LENGTHS", "/animations")], |json, _| {
        let sampler = shorter(json);
        let channel = json["animations"][0]["channels"][1].clone();
        let clip = json!({"name": "short", "samplers": [sampler], "channels": [with(channel, json!({"sampler": 0}))]});
        json["animations"].as_array_mut().unwrap().push(clip);
    });
}

#[test]
fn a_million_bad_keys_are_one_finding() {
    let keys = 100_000;
    let times: Vec<f32> = (0..keys).map(|i| i as f32 / 64.0).collect();
    let rotations = [0.0, 0.0, 0.0, 2.0].repeat(keys);
    expect(&[("ROTATION_NOT_UNIT", "/animations/0/samplers/0/output")], |json, bin| {
        let start = bin.len().next_multiple_of(4);
        bin.resize(start, 0);
        bin.extend(bytes(&times));
        bin.extend(bytes(&rotations));
        json["buffers"][0]["byteLength"] = json!(bin.len());
        json["bufferViews"][0] = json!({"buffer": 0, "byteOffset": start, "byteLength": 4 * keys});
        json["bufferViews"][1] =
            json!({"buffer": 0, "byteOffset": start + 4 * keys, "byteLength": 16 * keys});
        json["accessors"][0]["count"] = json!(keys);
        json["accessors"][0]["max"] = json!([times[keys - 1]]);
        json["accessors"][1]["count"] = json!(keys);
        json["animations"][0]["channels"].as_array_mut().unwrap().pop();
        json["animations"][0]["samplers"].as_array_mut().unwrap().pop();
        json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 3}]);
    });
}

#[test]
fn reports_count_what_they_leave_out() {
    let mut report = Report::default();
    for i in 0..250 {
        report.add(Code::UnusedObject, format!("/nodes/{i}"), "nothing refers to it");
    }
    report.add(Code::NodeCycle, "/nodes/1", "goes round");
    assert_eq!(report.findings().len(), 101);
    assert_eq!((report.count(Severity::Info), report.count(Severity::Error)), (250, 1));
    assert_eq!(report.worst(), Some(Severity::Error));
    assert!(report.text("F").ends_with("F: info UNUSED_OBJECT: and 150 more of this kind\n"));
    let json = report.to_json();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["leftOut"]["UNUSED_OBJECT"], 150);
    let cycle =
        json!({"code": "NODE_CYCLE", "severity": "error", "pointer": "/nodes/1", "message": "goes round"});
    assert_eq!(json["findings"][100], cycle);
}

#[test]
fn every_code_has_a_file_that_is_broken_so() {
    let source: String = include_str!("tests.rs").split_whitespace().collect();
    // These come from comparing and from looking, which is done elsewhere.
    let elsewhere = [
        "MOTION_DIFFERS",
        "INPUT_CHANGED",
        "NOTHING_VISIBLE",
        "NOTHING_MOVES",
        "DIFFERENCE_LIMIT",
        "NOTHING_IN_COMMON",
        "ONLY_IN_ONE",
        "MATCHED_OTHERWISE",
        "LENGTH_DIFFERS",
        "NOT_COMPARED",
        "OUTDATED",
    ];
    for code in Code::ALL.iter().map(|code| code.as_str()) {
        let expected = source.contains(&format!("(\"{code}\","));
        assert!(expected || elsewhere.contains(&code), "{code}");
    }
}

/// Reading and checking whatever comes must end in a report or an error.
fn survives(file: Vec<u8>) {
    let _ = super::file(Box::new(Cursor::new(file.clone())), Box::new(NoFiles));
    if let Ok(mut asset) = crate::asset::tests::open(file) {
        for clip in asset.clips() {
            let mut player = crate::asset::play::Player::new();
            for channel in &clip.channels {
                for t in [-1.0, 0.3, 2.0] {
                    let _ = player.value(&mut asset, channel, t);
                }
            }
        }
    }
}

#[test]
fn a_file_cut_off_anywhere_is_survived() {
    let (json, bin) = good();
    let file = glb(&json, &bin);
    for length in 0..file.len() {
        survives(file[..length].to_vec());
        let mut claimed = file[..length].to_vec();
        if length >= 12 {
            // As a file that was always that short.
            claimed[8..12].copy_from_slice(&u32::try_from(length).unwrap().to_le_bytes());
            survives(claimed);
        }
    }
}

#[test]
fn flipped_bits_are_survived() {
    let (json, bin) = good();
    let file = glb(&json, &bin);
    for bit in 0..8 * file.len() {
        let mut flipped = file.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        survives(flipped);
    }
}

#[test]
fn changed_digits_are_survived() {
    let (json, bin) = good();
    let text = json.to_string();
    for (at, _) in text.match_indices(|c: char| c.is_ascii_digit()) {
        for new in ["9", "99", "4294967295", "4294967296", "18446744073709551615", "-1", "0.5", "null", "[]"]
        {
            let changed = format!("{}{new}{}", &text[..at], &text[at + 1..]);
            if let Ok(json) = serde_json::from_str(&changed) {
                survives(glb(&json, &bin));
            }
        }
    }
}
