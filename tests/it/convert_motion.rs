//! `dat2glb convert`: what moves in the file, read by another crate and played as glTF
//! defines it, is the curve through the keys.

use crate::support::loaded::{Channel, Clip, Loaded, angle, load};
use crate::support::tool::run;
use crate::support::{good, keyframes, read_clip};
use dat2glb::clip::{self, Body};
use dat2glb::curve::{Ends, Motion, Scheme};
use dat2glb::math::Quat;
use gltf::animation::Interpolation;
use std::path::Path;

/// How exactly samples and keys must be met, degrees.
const EXACT: f64 = 3e-5;

fn convert(name: &str, options: &[&str], folder: &Path) -> Loaded {
    let output = folder.join(format!("{name}.glb"));
    let input = keyframes(name);
    let mut arguments = vec!["convert", input.to_str().unwrap(), "-o", output.to_str().unwrap(), "--quiet"];
    arguments.extend(options);
    run(arguments).exits(0);
    load(&output)
}

/// The channels of each clip, with the motions they must follow.
fn channels<'a>(
    loaded: &'a Loaded,
    clip: &'a clip::Clip,
    schemes: &'a [Scheme],
    ends: Ends,
) -> impl Iterator<Item = (&'a Clip, &'a Channel, Motion<'a>)> {
    assert_eq!(loaded.clips.len(), schemes.len());
    let channels = loaded.clips.iter().zip(schemes);
    let channels = channels.flat_map(|(found, &scheme)| {
        assert_eq!(found.channels.len(), clip.tracks.len());
        found.channels.iter().zip(&clip.tracks).map(move |(channel, keys)| (found, scheme, channel, keys))
    });
    channels.map(move |(found, scheme, channel, keys)| {
        (found, channel, Motion::new(&clip.times, keys, scheme, ends))
    })
}

/// The ends that a fixture can have.
fn ends_of(clip: &clip::Clip) -> impl Iterator<Item = Ends> {
    Ends::ALL.into_iter().filter(|ends| ends.accept(clip).is_ok())
}

#[test]
fn every_fixture_scheme_and_end_plays_its_curve() {
    let folder = tempfile::tempdir().unwrap();
    let (mut files, mut closed) = (0, 0);
    for name in good() {
        let clip = read_clip(&keyframes(&name));
        for ends in ends_of(&clip) {
            let loaded = convert(&name, &["--scheme", "all", "--ends", ends.name()], folder.path());
            for (found, channel, motion) in channels(&loaded, &clip, Scheme::ALL, ends) {
                let what = format!("{} {} {}", found.name, ends.name(), channel.node);
                check_times(channel, &clip.times, &what);
                check_rotations(channel, &what);
                check_samples(channel, &motion, &what);
                check_keys(channel, &motion, &clip.times, &what);
            }
            files += 1;
            closed += usize::from(ends == Ends::Closed);
        }
    }
    assert!(files >= 4 * good().len() && closed >= 1, "{files} files, {closed} closed");
}

/// From exactly 0 to the last key, strictly increasing, every key time among them, no
/// gap longer than a frame.
fn check_times(channel: &Channel, keys: &[f64], what: &str) {
    let times = &channel.times;
    assert_eq!(times[0].to_bits(), 0f32.to_bits(), "{what}");
    assert_eq!(times[times.len() - 1], keys[keys.len() - 1] as f32, "{what}");
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{what}");
    for &key in keys {
        assert!(times.contains(&(key as f32)), "{what}: no sample at the key at {key} s");
    }
    let widest = times.windows(2).map(|pair| f64::from(pair[1]) - f64::from(pair[0])).fold(0.0, f64::max);
    assert!(widest < 1.0 / 60.0 + 1.1e-3, "{what}: {widest} s without a sample");
    assert_eq!(channel.min, 0.0, "{what}");
    assert_eq!(channel.max.as_f64().unwrap() as f32, times[times.len() - 1], "{what}");
    assert_eq!(channel.interpolation, Interpolation::Linear, "{what}");
}

/// Unit quaternions that never change to the other sign of the same rotation.
fn check_rotations(channel: &Channel, what: &str) {
    let dot =
        |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).map(|(&a, b)| f64::from(a) * f64::from(b)).sum::<f64>();
    assert_eq!(channel.rotations.len(), channel.times.len(), "{what}");
    for (i, &q) in channel.rotations.iter().enumerate() {
        let norm = dot(q, q).sqrt();
        assert!((norm - 1.0).abs() < 2e-7, "{what}: length {norm} at {} s", channel.times[i]);
    }
    for (i, pair) in channel.rotations.windows(2).enumerate() {
        // The ramp of a half turn has no nearer sign.
        assert!(dot(pair[0], pair[1]) > -1e-6, "{what}: sign changes at {} s", channel.times[i + 1]);
    }
}

/// Each sample is the curve's value at the float32 time that is written.
fn check_samples(channel: &Channel, motion: &Motion, what: &str) {
    for (&t, &q) in channel.times.iter().zip(&channel.rotations) {
        let error = angle(q.map(f64::from), Quat::to_xyzw(motion.at(f64::from(t))));
        assert!(error < EXACT, "{what}: {error} degrees off the curve at {t} s");
    }
}

/// Playback passes through each key as the file gives it, but for what rounding the
/// key's time to float32 is worth; held ends never reach the last.
fn check_keys(channel: &Channel, motion: &Motion, keys: &[f64], what: &str) {
    for &t in keys {
        let rounding = (f64::from(t as f32) - t).abs() * channel.speed(t);
        let error = angle(channel.play(t), Quat::to_xyzw(motion.at(t)));
        assert!(error < EXACT + rounding, "{what}: {error} degrees off the key at {t} s");
    }
}

/// `Motion` is held against other programs' numbers elsewhere; that keys are met must
/// not hang on it.
#[test]
fn every_key_of_the_file_is_passed_through() {
    let folder = tempfile::tempdir().unwrap();
    for name in good() {
        let clip = read_clip(&keyframes(&name));
        for ends in ends_of(&clip) {
            let loaded = convert(&name, &["--scheme", "all", "--ends", ends.name()], folder.path());
            // One clip a scheme; those that smooth do not meet their keys.
            let clips = loaded.clips.iter().zip(Scheme::ALL).filter(|(_, scheme)| scheme.passes_keys());
            let channels = clips.flat_map(|(found, scheme)| {
                found.channels.iter().zip(&clip.tracks).map(move |(c, k)| (scheme, c, k))
            });
            for (scheme, found, keys) in channels {
                let held = ends == Ends::Hold && scheme.has_ends() && keys.len() > 2;
                let last = keys.len() - 1;
                for (i, (&t, &key)) in clip.times.iter().zip(keys).enumerate() {
                    let key = if held && i == last { keys[last - 1] } else { key };
                    let rounding = (f64::from(t as f32) - t).abs() * found.speed(t);
                    let error = angle(found.play(t), key.to_xyzw());
                    assert!(error < EXACT + rounding, "{name} {} key {i}: {error} degrees", ends.name());
                }
            }
        }
    }
}

#[test]
fn clips_are_named_and_ordered_as_asked() {
    let folder = tempfile::tempdir().unwrap();
    let named = |options: &[&str]| -> Vec<String> {
        let loaded = convert("single-even", options, folder.path());
        loaded.clips.into_iter().map(|clip| clip.name).collect()
    };
    assert_eq!(named(&[]), ["single-even"]);
    assert_eq!(named(&["--scheme", "squad"]), ["single-even"]);
    assert_eq!(named(&["--scheme", "squad,bessel"]), ["single-even-squad", "single-even-bessel"]);
    let all: Vec<String> =
        Scheme::ALL.iter().map(|scheme| format!("single-even-{}", scheme.name())).collect();
    assert_eq!(named(&["--scheme", "all"]), all);
}

#[test]
fn channels_of_a_clip_share_their_times() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["sixteen", "chain-uneven"] {
        let loaded = convert(name, &["--scheme", "bessel,slerp", "--ends", "hold"], folder.path());
        for clip in &loaded.clips {
            let first = clip.channels[0].input;
            assert!(clip.channels.iter().all(|channel| channel.input == first), "{name} {}", clip.name);
        }
    }
}

#[test]
fn boxes_hang_from_each_other() {
    let folder = tempfile::tempdir().unwrap();
    for name in good() {
        let clip = read_clip(&keyframes(&name));
        let loaded = convert(&name, &[], folder.path());
        let scene = loaded.document.default_scene().unwrap();
        let roots: Vec<_> = scene.nodes().collect();
        assert_eq!(roots.len(), 1, "{name}");
        assert_eq!(roots[0].name(), Some("root"), "{name}");
        let mut node = roots[0].clone();
        let mut meshes = Vec::new();
        for index in 1..=clip.tracks.len() {
            assert_eq!(node.children().len(), 1, "{name}");
            node = node.children().next().unwrap();
            let (expected, offset) = match clip.body {
                Body::Chain { length } if index > 1 => (format!("box{index}"), -length as f32),
                Body::Chain { .. } => (format!("box{index}"), 0.0),
                Body::Free => ("body".to_owned(), 0.0),
            };
            assert_eq!(node.name(), Some(expected.as_str()), "{name}");
            assert_eq!(node.transform().decomposed().0, [0.0, offset, 0.0], "{name} {expected}");
            assert_eq!(loaded.clips[0].channels[index - 1].node, expected, "{name}");
            meshes.push(node.mesh().unwrap().index());
        }
        assert_eq!(node.children().len(), 0, "{name}");
        assert!(meshes.iter().all(|&mesh| mesh == 0), "{name}: {meshes:?}");
        assert_eq!(loaded.document.meshes().len(), 1, "{name}");
    }
}

#[test]
fn a_box_is_as_long_as_it_says_and_hangs_by_its_top() {
    let folder = tempfile::tempdir().unwrap();
    let loaded = convert("chain-uneven", &[], folder.path());
    let buffers = &loaded.buffers;
    let mesh = loaded.document.meshes().next().unwrap();
    let (mut low, mut high, mut colours) = ([f32::MAX; 3], [f32::MIN; 3], Vec::new());
    for primitive in mesh.primitives() {
        let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
        let normals: Vec<[f32; 3]> = reader.read_normals().unwrap().collect();
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        assert_eq!(normals.len(), positions.len());
        for p in positions {
            low = std::array::from_fn(|i| low[i].min(p[i]));
            high = std::array::from_fn(|i| high[i].max(p[i]));
        }
        colours.push(primitive.material().pbr_metallic_roughness().base_color_factor());
    }
    assert_eq!((low, high), ([-0.5, -2.5, -0.5], [0.5, 0.0, 0.5]));
    colours.sort_by(|a, b| a.partial_cmp(b).unwrap());
    colours.dedup();
    assert_eq!(colours.len(), 6);
}

#[test]
fn without_key_times_the_grid_is_even_but_for_the_last_time() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["chain-uneven", "late-start", "scipy"] {
        let duration = read_clip(&keyframes(name)).duration();
        for fps in [60.0, 24.0] {
            let fps_text = fps.to_string();
            let loaded = convert(name, &["--no-key-times", "--fps", &fps_text], folder.path());
            let grid = (0..).map(|frame| f64::from(frame) / fps).take_while(|t| duration - t >= 1e-3);
            let mut expected: Vec<f32> = grid.map(|t| t as f32).collect();
            expected.push(duration as f32);
            assert_eq!(loaded.clips[0].channels[0].times, expected, "{name} at {fps}");
            assert_eq!(loaded.clips[0].extras["keyTimes"], false);
        }
    }
}

#[test]
fn rates_may_be_fractions() {
    let folder = tempfile::tempdir().unwrap();
    let duration = read_clip(&keyframes("two-keys")).duration();
    for (fps, interval) in [("30000/1001", 1001.0 / 30000.0), ("23.976", 1.0 / 23.976), ("1/3", 3.0)] {
        let loaded = convert("two-keys", &["--fps", fps], folder.path());
        let grid = (0..).map(|frame| f64::from(frame) * interval).take_while(|t| duration - t >= 1e-3);
        let mut expected: Vec<f32> = grid.map(|t| t as f32).collect();
        expected.push(duration as f32);
        assert_eq!(loaded.clips[0].channels[0].times, expected, "{fps}");
    }
}

/// A grid sample next to a key is left out; keys next to each other never are.
#[test]
fn samples_next_to_keys_give_way() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("close.dat");
    let text = "# 1\n0 1 0 0 0\n0.1003 .8 .6 0 0\n0.1004 .8 .6 0 0\n0.2 1 0 0 0\n";
    std::fs::write(&input, text).unwrap();
    let ran = run([input.to_str().unwrap(), "--fps", "10"]).exits(0);
    assert!(ran.stderr.contains("[CLOSE_KEYS]") && ran.stderr.contains("line 4"), "{}", ran.stderr);
    let loaded = load(&input.with_extension("glb"));
    assert_eq!(loaded.clips[0].channels[0].times, [0.0, 0.1003, 0.1004, 0.2]);
}

/// Samples come in chunks of some thousands: neither signs nor times have a seam there.
#[test]
fn many_samples_join_without_a_seam() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["body-free", "half-turn"] {
        let clip = read_clip(&keyframes(name));
        let schemes = [Scheme::Slerp, Scheme::Bessel];
        let loaded = convert(name, &["--scheme", "slerp,bessel", "--fps", "2000"], folder.path());
        for (found, channel, motion) in channels(&loaded, &clip, &schemes, Ends::Natural) {
            let what = format!("{} {}", found.name, channel.node);
            assert!(channel.times.len() > 2 * 4096, "{what}: {}", channel.times.len());
            check_times(channel, &clip.times, &what);
            check_rotations(channel, &what);
            check_samples(channel, &motion, &what);
        }
    }
}

/// Half a day in, float32 times are 4 ms apart: rounding a time costs no accuracy.
#[test]
fn late_samples_are_as_exact_as_early_ones() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("late.dat");
    let text =
        "# 1\n0 1 0 0 0\n40000.3 .8 .6 0 0\n40001.21 .6 0 .8 0\n40002.1 .28 .96 0 0\n40002.901 1 0 0 0\n";
    std::fs::write(&input, text).unwrap();
    run([input.to_str().unwrap(), "--fps", "13/10"]).exits(0);
    let (clip, loaded) = (read_clip(&input), load(&input.with_extension("glb")));
    for (_, channel, motion) in channels(&loaded, &clip, &[Scheme::Bessel], Ends::Natural) {
        assert!(channel.times.len() > 50_000 && channel.speed(40_001.0) > 50.0);
        check_samples(channel, &motion, "late");
        check_keys(channel, &motion, &clip.times, "late");
    }
}
