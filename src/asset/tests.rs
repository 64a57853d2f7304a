//! Small files made by hand, and what reading makes of them.

use std::io::Cursor;

use serde_json::{Value, json};

use super::*;

/// A `.glb` of this JSON and binary chunk, padded as it should be.
pub(crate) fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut data = bin.to_vec();
    data.resize(data.len().next_multiple_of(4), 0);
    let total = 12 + 8 + text.len() + if bin.is_empty() { 0 } else { 8 + data.len() };
    let mut file = b"glTF".to_vec();
    file.extend(2u32.to_le_bytes());
    file.extend(u32::try_from(total).unwrap().to_le_bytes());
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        file.extend(u32::try_from(data.len()).unwrap().to_le_bytes());
        file.extend(kind);
        file.extend(data);
    };
    chunk(b"JSON", &text);
    if !bin.is_empty() {
        chunk(b"BIN\0", &data);
    }
    file
}

pub(crate) fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

pub(crate) fn open(file: Vec<u8>) -> Result<Asset, Error> {
    Asset::open(Box::new(Cursor::new(file)), Box::new(NoFiles))
}

/// One accessor over the whole binary chunk.
fn one(accessor: Value, view: Value, bin: &[u8]) -> Asset {
    let mut view = view;
    view["buffer"] = json!(0);
    view["byteLength"] = view.get("byteLength").cloned().unwrap_or(json!(bin.len()));
    let mut accessor = accessor;
    accessor["bufferView"] = json!(0);
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": bin.len()}],
        "bufferViews": [view],
        "accessors": [accessor],
    });
    open(glb(&json, bin)).unwrap()
}

#[test]
fn floats_of_every_component_type() {
    for (kind, bin, expected) in [
        (5120, &[128u8, 127, 0, 255][..], [-1.0, 1.0, 0.0, -1.0 / 127.0]),
        (5121, &[0, 255, 51, 1], [0.0, 1.0, 0.2, 1.0 / 255.0]),
        (5122, &[0, 128, 255, 127, 0, 0, 1, 0], [-1.0, 1.0, 0.0, 1.0 / 32767.0]),
        (5123, &[0, 0, 255, 255, 51, 51, 1, 0], [0.0, 1.0, 0.2, 1.0 / 65535.0]),
    ] {
        let accessor = json!({"componentType": kind, "type": "VEC4", "count": 1, "normalized": true});
        let got = one(accessor, json!({}), bin).floats(0, 0..1).unwrap();
        for (x, y) in got.iter().zip(expected) {
            assert!((x - y).abs() < 1e-7, "{kind}: {got:?}");
        }
    }
    let accessor = json!({"componentType": 5121, "type": "SCALAR", "count": 2});
    assert_eq!(one(accessor, json!({}), &[3, 200]).floats(0, 0..2).unwrap(), [3.0, 200.0]);
}

#[test]
fn strides_offsets_and_ranges() {
    let bin = bytes(&[9.0, 1.0, 2.0, 9.0, 3.0, 4.0, 9.0, 5.0, 6.0]);
    let accessor = json!({"componentType": 5126, "type": "VEC2", "count": 3, "byteOffset": 4});
    let mut asset = one(accessor, json!({"byteStride": 12}), &bin);
    assert_eq!(asset.floats(0, 1..3).unwrap(), [3.0, 4.0, 5.0, 6.0]);
    assert!(asset.floats(0, 3..3).unwrap().is_empty());
    assert!(asset.floats(0, 2..4).is_err());
    assert!(asset.floats(1, 0..1).is_err());
}

#[test]
fn columns_of_small_matrices_are_padded() {
    let bin = [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9];
    let accessor = json!({"componentType": 5121, "type": "MAT3", "count": 1});
    let got = one(accessor, json!({}), &bin).floats(0, 0..1).unwrap();
    assert_eq!(got, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
}

#[test]
fn longer_than_a_block() {
    let numbers: Vec<f32> = (0..600_000).map(|i| i as f32).collect();
    let accessor = json!({"componentType": 5126, "type": "SCALAR", "count": 600_000});
    let got = one(accessor, json!({}), &bytes(&numbers)).floats(0, 5..600_000).unwrap();
    assert_eq!(got, numbers[5..]);
}

#[test]
fn sparse_elements_replace_others() {
    let mut bin = vec![1, 3, 0, 0];
    bin.extend(bytes(&[7.0, 8.0]));
    let sparse = json!({
        "count": 2,
        "indices": {"bufferView": 0, "componentType": 5121},
        "values": {"bufferView": 0, "byteOffset": 4},
    });
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 12}],
        "bufferViews": [{"buffer": 0, "byteLength": 12}],
        "accessors": [{"componentType": 5126, "type": "SCALAR", "count": 4, "sparse": sparse}],
    });
    let mut asset = open(glb(&json, &bin)).unwrap();
    assert_eq!(asset.floats(0, 0..4).unwrap(), [0.0, 7.0, 0.0, 8.0]);
    assert_eq!(asset.floats(0, 2..4).unwrap(), [0.0, 8.0]);
}

#[test]
fn indices_of_every_type() {
    for (kind, bin) in [(5121, &[1u8, 2][..]), (5123, &[1, 0, 2, 0]), (5125, &[1, 0, 0, 0, 2, 0, 0, 0])] {
        let accessor = json!({"componentType": kind, "type": "SCALAR", "count": 2});
        assert_eq!(one(accessor, json!({}), bin).indices(0).unwrap(), [1, 2]);
    }
    let accessor = json!({"componentType": 5126, "type": "SCALAR", "count": 1});
    assert!(one(accessor, json!({}), &[0; 4]).indices(0).is_err());
}

#[test]
fn claims_that_the_file_does_not_back_are_refused() {
    let huge = 1u64 << 62;
    let scalar = |count: u64| json!({"componentType": 5126, "type": "SCALAR", "count": count});
    assert!(one(scalar(huge), json!({}), &[0; 4]).shape(0).is_err());
    assert!(one(scalar(u64::MAX), json!({}), &[0; 4]).shape(0).is_err());
    assert!(one(scalar(2), json!({}), &[0; 4]).shape(0).is_err());
    assert!(one(scalar(1), json!({"byteLength": 1u64 << 31}), &[0; 4]).view(0).is_err());
    assert!(one(scalar(1), json!({"byteOffset": u64::MAX}), &[0; 4]).view(0).is_err());
    // A stride below the element's size would multiply the data.
    let accessor = json!({"componentType": 5126, "type": "MAT4", "count": 9});
    assert!(one(accessor, json!({"byteStride": 4}), &[0; 96]).shape(0).is_err());
    // Nothing backs an accessor of zeros.
    let json = json!({"asset": {"version": "2.0"}, "accessors": [scalar(1 << 31)]});
    assert!(open(glb(&json, &[])).unwrap().shape(0).is_err());
}

#[test]
fn views_and_images() {
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 4}, {"byteLength": 3, "uri": "data:;base64,Zm9v"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 1, "byteLength": 2}, {"buffer": 1, "byteLength": 3}],
        "images": [{"bufferView": 1}, {"uri": "data:image/png,x"}, {"uri": "gone.png"}, {}],
    });
    let mut asset = open(glb(&json, &[1, 2, 3, 4])).unwrap();
    assert_eq!(asset.view(0).unwrap(), [2, 3]);
    assert_eq!(asset.image(0).unwrap(), b"foo");
    assert_eq!(asset.image(1).unwrap(), b"x");
    let refused = asset.image(2).unwrap_err().to_string();
    assert!(refused.contains("/images/2/uri") && refused.contains("gone.png"), "{refused}");
    assert!(asset.image(3).is_err() && asset.image(4).is_err());
}

#[test]
fn other_files_are_opened_through_the_caller() {
    struct One;
    impl Resolve for One {
        fn open(&self, uri: &str) -> io::Result<Box<dyn Source>> {
            assert_eq!(uri, "the data.bin");
            Ok(Box::new(Cursor::new(vec![5, 6, 7])))
        }
    }
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 3, "uri": "the%20data.bin"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 1, "byteLength": 2}],
    });
    let text = format!("\u{feff} {json}\n").into_bytes();
    let mut asset = Asset::open(Box::new(Cursor::new(text)), Box::new(One)).unwrap();
    assert_eq!(asset.view(0).unwrap(), [6, 7]);
}

#[test]
fn what_is_no_gltf_is_refused() {
    for file in [
        &b""[..],
        b"  ",
        b"PK\x03\x04",
        b"glTF",
        b"glTF\x01\0\0\0\x0c\0\0\0",
        b"{",
        b"{}",
        b"glTF\x02\0\0\0\x0c\0\0\0",
    ] {
        assert!(open(file.to_vec()).is_err(), "{}", file.escape_ascii());
    }
}

#[test]
fn a_channel_may_lack_its_node() {
    let json = json!({
        "asset": {"version": "2.0"},
        "scenes": [{}],
        "animations": [{"channels": [{"sampler": 0, "target": {"path": "pointer"}}], "samplers": []}],
    });
    let asset = open(glb(&json, &[])).unwrap();
    let node = asset.root().animations[0].channels[0].target.node;
    assert_eq!(node.value(), u32::MAX as usize);
}

/// An asset of one node with one channel.
pub(crate) fn animated(path: &str, interpolation: &str, times: &[f32], values: &[f32]) -> Asset {
    let (kind, width) = match path {
        "rotation" => ("VEC4", 4),
        "weights" => ("SCALAR", 1),
        _ => ("VEC3", 3),
    };
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 4 * (times.len() + values.len())}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 4 * times.len()},
            {"buffer": 0, "byteOffset": 4 * times.len(), "byteLength": 4 * values.len()},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": times.len()},
            {"bufferView": 1, "componentType": 5126, "type": kind, "count": values.len() / width},
        ],
        "nodes": [{}],
        "animations": [{
            "name": "clip",
            "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
            "samplers": [{"input": 0, "output": 1, "interpolation": interpolation}],
        }],
    });
    let bin = [bytes(times), bytes(values)].concat();
    open(glb(&json, &bin)).unwrap()
}

/// The value of the only channel at some times.
fn played(asset: &mut Asset, times: &[f64]) -> Vec<Vec<f64>> {
    let clip = asset.clips().remove(0);
    let mut player = play::Player::new();
    let channel = &clip.channels[0];
    times.iter().map(|&t| player.value(asset, channel, t).unwrap()).collect()
}

#[test]
fn linear_blends_and_clamps() {
    let mut asset = animated("translation", "LINEAR", &[1.0, 3.0], &[0.0, 0.0, 0.0, 2.0, 4.0, 8.0]);
    let got = played(&mut asset, &[0.0, 1.5, 3.0, 9.0]);
    assert_eq!(got[0], [0.0, 0.0, 0.0]);
    assert_eq!(got[1], [0.5, 1.0, 2.0]);
    assert_eq!(got[2], [2.0, 4.0, 8.0]);
    assert_eq!(got[3], got[2]);
    assert_eq!(asset.clips()[0].duration, 3.0);
}

#[test]
fn step_holds() {
    let mut asset = animated("scale", "STEP", &[0.0, 1.0], &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    let got = played(&mut asset, &[0.999, 1.0]);
    assert_eq!(got, [[1.0; 3], [2.0; 3]]);
}

#[test]
fn rotations_take_the_shorter_way() {
    let (s, c) = (30f32.to_radians().sin(), 30f32.to_radians().cos());
    for sign in [1.0, -1.0] {
        let values = [0.0, 0.0, 0.0, 1.0, sign * s, 0.0, 0.0, sign * c];
        let mut asset = animated("rotation", "LINEAR", &[0.0, 1.0], &values);
        let got = played(&mut asset, &[0.25]).remove(0);
        let quarter = 7.5f64.to_radians();
        assert!((got[0] - quarter.sin()).abs() < 1e-7, "{got:?}");
        assert!((got[3] - quarter.cos()).abs() < 1e-7, "{got:?}");
    }
}

#[test]
fn slerp_is_accurate_near_and_far() {
    for half in [1e-12f64, 1e-9, 1e-4, 0.7, 1.57] {
        let b = [half.sin(), 0.0, 0.0, half.cos()];
        let q = play::slerp([0.0, 0.0, 0.0, 1.0], b, 0.3);
        assert!((q[0] - (0.3 * half).sin()).abs() < 1e-15, "{half}: {q:?}");
    }
}

#[test]
fn cubic_splines_follow_their_tangents() {
    // x(t) = t³ on 0..2 has tangents 3t²; the cubic reproduces it.
    let values = [[0.0; 3], [0.0; 3], [0.0; 3], [12.0; 3], [8.0; 3], [12.0; 3]].concat();
    let mut asset = animated("translation", "CUBICSPLINE", &[0.0, 2.0], &values);
    for t in [0.5, 1.0, 1.75] {
        let got = played(&mut asset, &[t]).remove(0)[0];
        assert!((got - t.powi(3)).abs() < 1e-12, "{got}");
    }
    let values = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4], [1.0, 0.0, 0.0, 0.0], [0.0; 4]];
    let mut asset = animated("rotation", "CUBICSPLINE", &[0.0, 1.0], &values.concat());
    let got = played(&mut asset, &[0.5]).remove(0);
    assert!((got[0] - 0.5f64.sqrt()).abs() < 1e-12, "{got:?}");
}

#[test]
fn weights_are_as_wide_as_the_mesh_has_targets() {
    let mut asset = animated("weights", "LINEAR", &[0.0, 1.0], &[0.0, 1.0, 1.0, 0.0]);
    assert_eq!(played(&mut asset, &[0.25]), [[0.25, 0.75]]);
}

#[test]
fn keys_come_in_blocks_without_gaps() {
    let times: Vec<f32> = (0..70_000).map(|i| i as f32).collect();
    let values: Vec<f32> = (0..210_000).map(|i| i as f32).collect();
    let mut asset = animated("translation", "LINEAR", &times, &values);
    let clip = asset.clips().remove(0);
    let mut keys = play::Keys::new(&clip.channels[0]);
    let (mut seen, mut blocks) = (0, 0);
    while let Some(block) = keys.next(&mut asset).unwrap() {
        assert_eq!(block.first, seen);
        assert_eq!(block.times, &times[seen..seen + block.times.len()]);
        assert_eq!(block.values, &values[3 * seen..3 * (seen + block.times.len())]);
        seen += block.times.len();
        blocks += 1;
    }
    assert_eq!(seen, times.len());
    assert!(blocks > 1);
}

#[test]
fn channels_that_cannot_be_played_are_left_out() {
    assert!(animated("rotation", "LINEAR", &[0.0, 1.0], &[0.0; 4]).clips()[0].channels.is_empty());
    assert!(animated("rotation", "BEZIER", &[0.0], &[0.0; 4]).clips()[0].channels.is_empty());
    assert!(animated("rotation", "LINEAR", &[0.0], &[0.0; 4]).clips()[0].channels.len() == 1);
}
