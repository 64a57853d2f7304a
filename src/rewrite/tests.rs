//! Whole files: what changes, what stays, and how the result plays.

use super::*;
use crate::asset::play::{Player, Property};
use crate::asset::{NoFiles, Resolve, Source};
use std::io::{self, Cursor};

const KEYS: usize = 65;

/// A buffer's bytes, part by part, each at a multiple of four.
#[derive(Default)]
struct Bin {
    bytes: Vec<u8>,
    parts: Vec<(usize, usize)>,
}

impl Bin {
    fn add(&mut self, part: &[u8]) {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.parts.push((self.bytes.len(), part.len()));
        self.bytes.extend(part);
    }

    fn floats(&mut self, numbers: impl IntoIterator<Item = f64>) {
        let bytes: Vec<u8> = numbers.into_iter().flat_map(|x| (x as f32).to_le_bytes()).collect();
        self.add(&bytes);
    }

    fn views(&self) -> String {
        let view = |(i, (start, length)): (usize, &(usize, usize))| {
            // Spelt in several ways.
            let extra = if i % 2 == 0 { " , \"extras\" : { \"n\" : 1.50e0 }" } else { "" };
            format!("{{ \"byteLength\" : {length}, \"buffer\":0,\"byteOffset\":{start}{extra} }}")
        };
        self.parts.iter().enumerate().map(view).collect::<Vec<_>>().join(",\n  ")
    }
}

/// The number of key i, and its time.
fn time(i: usize) -> f64 {
    i as f64 / 32.0
}

fn all<const N: usize>(value: impl Fn(f64) -> [f64; N]) -> Vec<f64> {
    (0..KEYS).flat_map(|i| value(time(i))).collect()
}

fn turn(t: f64) -> [f64; 4] {
    let half = 0.9 * (1.3 * t).sin();
    [0.6 * half.sin(), 0.0, 0.8 * half.sin(), half.cos()]
}

/// One of everything, with a line an object: mesh data among that of animations, and what
/// no parser of glTF knows.
fn everything() -> (String, Vec<u8>) {
    let mut bin = Bin::default();
    bin.floats((0..KEYS).map(time)); // 0: shared times
    bin.floats(all(|t| [8.0 * t, -2.0 * t, 1.0])); // 1: a straight way
    bin.floats([-1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]); // 2: positions
    bin.add(&[0, 0, 1, 0, 2, 0]); // 3: indices
    let codes = all(turn).into_iter().flat_map(|x| ((x * 32767.0).round() as i16).to_le_bytes());
    bin.add(&codes.collect::<Vec<u8>>()); // 4: quantised rotations
    bin.floats((0..KEYS).map(|i| 0.25 + time(i))); // 5: times
    bin.floats(all(|t| [t * t / 4.0, 1.0 - t / 2.0])); // 6: weights
    bin.floats(all(|t| if t < 1.0 { [1.0; 3] } else { [2.0, 1.0, 1.0] })); // 7: steps
    bin.floats(all::<9>(|t| {
        let (sin, cos) = (4.0 * t).sin_cos();
        let tangent = [4.0 * cos, -4.0 * sin, 0.0];
        [tangent, [sin, cos, 0.0], tangent].concat().try_into().unwrap()
    })); // 8: a cubic spline
    bin.floats(all(turn)); // 9: rotations as floats
    bin.add(b"opaque bytes"); // 10
    bin.floats([0.5; 9]); // 11: morph targets
    let views = bin.views();
    let last = f64::from(time(KEYS - 1) as f32);
    let json = format!(
        r#"{{ "frobnicate" : [ 1.0e0, 0.50, {{ "accessor" : 3 }} ],
 "buffers":[ {{ "byteLength" : {length},"name":"b\u00e4r" }} ],
"bufferViews" : [
  {views}
 ],
 "accessors":[
  {{"bufferView":0,"componentType":5126,"count":{KEYS},"type":"SCALAR","min":[0.0e0],"max":[{last}], "extras":{{"keep":1.50}}}},
  {{"type":"VEC3","bufferView":1,"componentType":5126,"count":{KEYS},"zzz":[2.0]}},
  {{"bufferView":2,"componentType":5126,"count":3,"type":"VEC3","min":[-1.0,0e0,0],"max":[1,1.0,0]}},
  {{"bufferView":3,"componentType":5123,"count":3,"type":"SCALAR"}},
  {{"bufferView":4,"componentType":5122,"normalized":true,"count":{KEYS},"type":"VEC4"}},
  {{"bufferView":5,"componentType":5126,"count":{KEYS},"type":"SCALAR","min":[0.25],"max":[2.25]}},
  {{"bufferView":6,"componentType":5126,"count":{twice},"type":"SCALAR"}},
  {{"bufferView":7,"componentType":5126,"count":{KEYS},"type":"VEC3"}},
  {{"bufferView":8,"componentType":5126,"count":{thrice},"type":"VEC3"}},
  {{"bufferView":9,"componentType":5126,"count":{KEYS},"type":"VEC4"}},
  {{"bufferView":11,"componentType":5126,"count":3,"type":"VEC3","min":[0.50,0.5,0.5],"max":[0.5,0.5,0.5]}}
 ],
 "animations" : [ {{ "name":"all", "samplers":[
  {{"input":0,"output":1}},
  {{"output":4,"input":0,"extras":{{"why" : "x" }} }},
  {{"input":5,"output":6,"interpolation":"LINEAR"}},
  {{"input":5,"output":7,"interpolation":"STEP"}},
  {{"input":5,"output":8,"interpolation":"CUBICSPLINE"}},
  {{"input":0,"output":9}}
 ],
 "channels" : [ {{"sampler":0,"target":{{"node":0,"path":"translation"}}}},
  {{"sampler":1,"target":{{"node":0,"path":"rotation" , "extras":1E1}}}},
  {{"sampler":2,"target":{{"node":1,"path":"weights"}}}},
  {{"sampler":3,"target":{{"node":1,"path":"scale"}}}},
  {{"sampler":4,"target":{{"node":1,"path":"translation"}}}},
  {{"sampler":5,"target":{{"node":1,"path":"rotation"}}}} ], "extras":{{"0":[{{}},[ ]]}}}} ],
 "extensionsUsed":["X_unknown"], "extensions":{{"X_unknown":{{"view" : 10, "x":1.10}}}},
 "meshes":[{{"primitives":[{{"attributes":{{"POSITION":2}},"indices":3,"targets":[{{"POSITION":10}},{{"POSITION":10}}]}}],"weights":[0,0.0]}}],
 "nodes":[{{"name":"a","translation":[0.0,1.0e0,-0]}},{{"name":"b","mesh":0}}],
 "scenes":[{{"nodes":[0,1]}}],
 "scene":0, "asset" : {{ "version":"2.0" }}
}}"#,
        length = bin.bytes.len(),
        twice = 2 * KEYS,
        thrice = 3 * KEYS,
    );
    (json, bin.bytes)
}

fn word(n: usize) -> [u8; 4] {
    (n as u32).to_le_bytes()
}

fn glb(json: &str, bin: &[u8], more: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let total = 28 + json.len() + bin.len() + more.len();
    let head = [*b"glTF", word(2), word(total), word(json.len()), *b"JSON"].concat();
    let middle = [word(bin.len()), *b"BIN\0"].concat();
    [&head, &json, &middle, &bin, more].concat()
}

fn open(main: &[u8]) -> Asset {
    Asset::open(Box::new(Cursor::new(main.to_vec())), Box::new(NoFiles)).unwrap()
}

/// A reduced file, or what it was made from.
struct After {
    main: Vec<u8>,
    files: Vec<External>,
    facts: Facts,
}

fn reduced(main: &[u8], options: &Options) -> After {
    let Reduced { main: new, files, facts } = reduce(&mut open(main), options, |_| unreachable!()).unwrap();
    After { main: new.unwrap_or_else(|| main.to_vec()), files, facts }
}

fn loose() -> Options {
    Options { distance: Some(0.001), scale: Some(0.001), weight: Some(0.001), ..Options::new(0.05) }
}

/// The largest distances of both playbacks at many times that are no key's: the norm of
/// all numbers' differences, of rotations the angle of the better sign.
fn measured(before: &mut Asset, after: &mut Asset) -> [f64; 4] {
    let (old, new) = (before.clips(), after.clips());
    let mut worst = [0.0f64; 4];
    for (old, new) in old.iter().zip(&new) {
        assert_eq!((old.duration, old.channels.len()), (new.duration, new.channels.len()));
        let mut players = (Player::new(), Player::new());
        for i in 0..=3000 {
            let t = old.duration * f64::from(i) / 2990.0 - 0.001;
            for (a, b) in old.channels.iter().zip(&new.channels) {
                let a_value = players.0.value(before, a, t).unwrap();
                let b_value = players.1.value(after, b, t).unwrap();
                let off = a_value.iter().zip(&b_value).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                let (place, off) = match a.property {
                    Property::Rotation => {
                        let dot: f64 = a_value.iter().zip(&b_value).map(|(a, b)| a * b).sum();
                        let norm = |q: &[f64]| q.iter().map(|x| x * x).sum::<f64>().sqrt();
                        let cosine = (dot.abs() / norm(&a_value) / norm(&b_value)).min(1.0);
                        // Two acos lose what is below 1e-6°.
                        (0, 2.0 * cosine.acos().to_degrees())
                    }
                    Property::Translation => (1, off),
                    Property::Scale => (2, off),
                    Property::MorphTargetWeights => (3, off),
                };
                worst[place] = worst[place].max(off);
            }
        }
    }
    worst
}

/// Lines of a text that hold nothing which may change.
fn lines(json: &str) -> Vec<&str> {
    let may_change =
        |line: &&str| ["byteLength", "componentType", "\"input\""].iter().any(|w| line.contains(w));
    json.lines().filter(|line| !may_change(line)).map(|line| line.trim_end_matches([',', ' '])).collect()
}

#[test]
fn what_does_not_change_keeps_its_bytes() {
    let (json, bin) = everything();
    let chunk = [&word(8)[..], b"XTRA", b"12345678"].concat();
    let before = glb(&json, &bin, &chunk);
    for options in [Options::new(0.05), loose()] {
        let after = reduced(&before, &options);
        assert!(after.main.len() + 1500 < before.len(), "{} of {}", after.main.len(), before.len());
        assert_eq!(after.facts.bytes_after, after.main.len() as u64);
        assert!(after.main.ends_with(&chunk));
        let (mut old, mut new) = (open(&before), open(&after.main));
        let text = String::from_utf8(new.json().to_vec()).unwrap();
        assert_eq!(lines(&json), lines(&text));
        for kept in [
            "\"extras\":{\"keep\":1.50}",
            "\"zzz\":[2.0]",
            "\"min\":[0.0e0]",
            "\"min\":[-1.0,0e0,0],\"max\":[1,1.0,0]}",
            "\"extras\":{\"why\" : \"x\" } }",
            " , \"extras\" : { \"n\" : 1.50e0 }",
            "\"name\":\"b\\u00e4r\"",
        ] {
            assert!(text.contains(kept), "{kept} not in:\n{text}");
        }
        for view in [2, 3, 10, 11] {
            assert_eq!(old.view(view).unwrap(), new.view(view).unwrap(), "{view}");
        }
        let report = crate::check::asset(&mut new);
        assert_eq!(
            report.worst().filter(|w| *w > crate::check::Severity::Warning),
            None,
            "{}",
            report.text("")
        );
    }
}

#[test]
fn playback_keeps_each_tolerance() {
    let (json, bin) = everything();
    let before = glb(&json, &bin, &[]);
    let after = reduced(&before, &loose());
    let [clip] = &after.facts.clips[..] else { panic!("one clip") };
    assert!(clip.keys_after * 2 < clip.keys_before, "{clip:?}");
    let measured = measured(&mut open(&before), &mut open(&after.main));
    let bounds = [clip.deviation.degrees, clip.deviation.units, clip.deviation.scale, clip.deviation.weight];
    for ((measured, bound), asked) in measured.iter().zip(bounds).zip([0.05, 0.001, 0.001, 0.001]) {
        // What acos loses near 1.
        assert!(*measured <= bound + 2e-6 && bound <= asked, "{measured} {bound} {asked}");
    }
    assert!(measured[0] > 0.01 && measured[1] > 1e-4 && measured[3] > 1e-4, "nothing was used: {measured:?}");
    let found = strayed(&mut open(&before), &mut open(&after.main)).unwrap();
    assert!(found.degrees <= bounds[0] && found.degrees > 0.9 * measured[0] - 2e-6, "{found:?} {measured:?}");
}

#[test]
fn without_a_tolerance_nothing_but_rounding_is_lost() {
    let (json, bin) = everything();
    let before = glb(&json, &bin, &[]);
    let after = reduced(&before, &Options::new(0.05));
    let (mut old, mut new) = (open(&before), open(&after.main));
    // Numbers up to 16, a step of float32 being 2⁻²⁰.
    assert!(measured(&mut old, &mut new)[1..].iter().all(|off| *off < 2e-6));
    let keys: Vec<usize> = new.clips()[0].channels.iter().map(|channel| channel.keys).collect();
    // A straight way has two; a step one for each value.
    assert_eq!((keys[0], keys[3]), (2, 2));
    // Nothing on t² is on a line, and nothing of a circle on a longer cubic.
    assert_eq!((keys[2], keys[4]), (KEYS, KEYS));
    assert!(keys[1] < KEYS / 2 && keys[5] < KEYS / 2, "{keys:?}");
}

#[test]
fn twice_is_once() {
    let (json, bin) = everything();
    let before = glb(&json, &bin, &[]);
    for options in [Options::new(0.05), loose(), Options { on_curve: true, ..loose() }] {
        let once = reduced(&before, &options).main;
        assert!(once.len() < before.len());
        assert!(reduced(&once, &options).main == once, "{options:?}");
    }
}

#[test]
fn whatever_something_else_may_use_stays() {
    let (json, bin) = everything();
    // The extension may mean the accessor of the straight way, and the shared times.
    let json = json.replace("\"view\" : 10", "\"view\" : 10, \"curve\" : 1, \"pointer\":\"/accessors/0\"");
    let before = glb(&json, &bin, &[]);
    let after = reduced(&before, &loose());
    assert!(after.main.len() < before.len());
    let (mut old, mut new) = (open(&before), open(&after.main));
    for accessor in [0, 1] {
        assert_eq!(old.floats(accessor, 0..KEYS).unwrap(), new.floats(accessor, 0..KEYS).unwrap());
    }
    assert!(measured(&mut old, &mut new)[1] <= 0.001);
}

#[test]
fn a_file_that_would_not_shrink_is_left_alone() {
    let (json, bin) = everything();
    let times = Options::new(0.05);
    let whole = glb(&json, &bin, &[]);
    let once = reduced(&whole, &times);
    let again = reduced(&once.main, &times);
    assert!(again.main == once.main);
    assert_eq!(again.facts.bytes_before, again.facts.bytes_after);
    assert!(again.facts.clips.iter().all(|clip| clip.keys_before == clip.keys_after));
    let none = glb(r#"{"asset":{"version":"2.0"}}"#, &[], &[]);
    assert!(reduced(&none, &times).main == none);
}

/// An animation of one channel, out of accessors given as JSON; views a part each.
fn single(path: &str, views: &str, input: &str, output: &str, bin: &[u8]) -> Vec<u8> {
    let length = bin.len();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{length}}}],"bufferViews":[{views}],
        "accessors":[{input},{output}],"nodes":[{{}}],"scenes":[{{"nodes":[0]}}],
        "animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"{path}"}}}}],
        "samplers":[{{"input":0,"output":1}}]}}]}}"#
    );
    glb(&json, bin, &[])
}

#[test]
fn interleaved_and_sparse_keys_are_read_and_packed() {
    let interleaved: Vec<f64> = (0..KEYS).flat_map(|i| [time(i), 2.0 * time(i), 5.0, 1.0]).collect();
    let mut bin = Bin::default();
    bin.floats(interleaved);
    let view = format!(r#"{{"buffer":0,"byteLength":{},"byteStride":16}}"#, 16 * KEYS);
    let common = format!(r#""componentType":5126,"count":{KEYS}"#);
    let input = format!(r#"{{"bufferView":0,"type":"SCALAR","min":[0],"max":[2],{common}}}"#);
    let output = format!(r#"{{"bufferView":0,"byteOffset":4,"type":"VEC3",{common}}}"#);
    let strided = single("translation", &view, &input, &output, &bin.bytes);

    let mut bin = Bin::default();
    bin.floats((0..KEYS).map(time));
    bin.add(&[40, 0]);
    bin.floats([0.0, 1.0, 0.0]);
    let views: Vec<String> = bin
        .parts
        .iter()
        .map(|(start, length)| format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length}}}"#))
        .collect();
    let sparse = r#"{"count":1,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}}"#;
    let output = format!(r#"{{"type":"VEC3","sparse":{sparse},{common}}}"#);
    let sparse = single("translation", &views.join(","), &input, &output, &bin.bytes);

    for (before, keys) in [(strided, 2), (sparse, 5)] {
        let after = reduced(&before, &Options::new(0.1)).main;
        assert!(after.len() < before.len());
        let (mut old, mut new) = (open(&before), open(&after));
        assert_eq!(new.clips()[0].channels[0].keys, keys);
        // Numbers up to 5.
        assert!(measured(&mut old, &mut new)[1] < 1e-6);
        let errors = crate::check::asset(&mut new).count(crate::check::Severity::Error);
        assert_eq!(errors, 0);
    }
}

#[test]
fn a_clip_of_rest_lasts_as_long() {
    let mut bin = Bin::default();
    bin.floats((0..KEYS).map(time));
    bin.floats(all(|_| [0.5; 4]));
    let views: Vec<String> = bin
        .parts
        .iter()
        .map(|(start, length)| format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length}}}"#))
        .collect();
    let common = format!(r#""componentType":5126,"count":{KEYS}"#);
    let input = format!(r#"{{"bufferView":0,"type":"SCALAR","min":[0],"max":[2],{common}}}"#);
    let output = format!(r#"{{"bufferView":1,"type":"VEC4",{common}}}"#);
    let before = single("rotation", &views.join(","), &input, &output, &bin.bytes);
    let after = reduced(&before, &Options::new(0.1)).main;
    let (mut old, mut new) = (open(&before), open(&after));
    assert_eq!(new.clips()[0].channels[0].keys, 2);
    assert!(measured(&mut old, &mut new)[0] == 0.0);
}

#[test]
fn buffers_in_uris_and_files_are_written_again() {
    struct One(Vec<u8>);
    impl Resolve for One {
        fn open(&self, uri: &str) -> io::Result<Box<dyn Source>> {
            assert!(uri == "a b.bin" || uri == "new.bin", "{uri}");
            Ok(Box::new(Cursor::new(self.0.clone())))
        }
    }
    let (json, bin) = everything();
    let named = json.replace("\"name\":\"b\\u00e4r\"", "\"uri\":\"a%20b.bin\"");
    let opened = |text: &str, bin: &[u8]| {
        Asset::open(Box::new(Cursor::new(text.as_bytes().to_vec())), Box::new(One(bin.to_vec()))).unwrap()
    };
    let mut asset = opened(&named, &bin);
    let after = reduce(&mut asset, &loose(), |_| "new.bin".to_owned()).unwrap();
    let [file] = &after.files[..] else { panic!("one file") };
    assert_eq!((file.hash.len(), file.buffer), (16, 0));
    assert_eq!(after.facts.bytes_before, (named.len() + bin.len()) as u64);
    let text = String::from_utf8(after.main.unwrap()).unwrap();
    assert!(text.contains("\"uri\":\"new.bin\""));
    let worst = measured(&mut asset, &mut opened(&text, &file.bytes));
    assert!(worst[0] <= 0.051 && worst[1] <= 0.001);

    let inline = file::data_uri("data:application/octet-stream,", &bin);
    let inline = json.replace("\"name\":\"b\\u00e4r\"", &format!("\"uri\":\"{inline}\""));
    let after = reduced(inline.as_bytes(), &loose());
    assert!(after.files.is_empty() && after.main.len() + 1500 < inline.len());
    let worst = measured(&mut open(inline.as_bytes()), &mut open(&after.main));
    assert!(worst[0] <= 0.051 && worst[1] <= 0.001);
}

#[test]
fn what_cannot_be_kept_is_refused() {
    let (json, bin) = everything();
    let before = glb(&json, &bin, &[]);
    let tight = reduce(&mut open(&before), &Options::new(1e-5), |_| String::new());
    assert!(matches!(tight, Err(Error::Tolerance { .. })));
    let meshopt = json.replace("\"X_unknown\":{", "\"EXT_meshopt_compression\":{\"buffer\":0,");
    let before = glb(&meshopt, &bin, &[]);
    let refused = reduce(&mut open(&before), &loose(), |_| String::new()).unwrap_err().to_string();
    assert!(refused.contains("/extensions/EXT_meshopt_compression: expected"), "{refused}");
    assert!(refused.contains("decompress"), "{refused}");
}
