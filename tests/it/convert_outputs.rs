//! `dat2glb convert`: where outputs go, and that they appear whole or not at all.

use crate::support::keyframes;
use crate::support::loaded::{decoded, load};
use crate::support::tool::{names, run_in};
use std::fs;
use std::path::Path;

/// A folder with these fixtures as NAME.dat.
fn folder_with(fixtures: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in fixtures {
        fs::copy(keyframes(name), folder.path().join(format!("{name}.dat"))).unwrap();
    }
    folder
}

fn uri(gltf: &Path) -> String {
    let json: serde_json::Value = serde_json::from_slice(&fs::read(gltf).unwrap()).unwrap();
    json["buffers"][0]["uri"].as_str().unwrap().to_owned()
}

#[test]
fn gltf_has_its_bin_beside_it_with_the_hash_in_its_name() {
    let folder = folder_with(&["two-keys", "single-even"]);
    let path = folder.path();
    let (name, gltf) = ("a b%ü#1", path.join("a b%ü#1.gltf"));
    run_in(path, ["two-keys.dat", "a b%ü#1.gltf"]).exits(0);
    let first = decoded(&uri(&gltf));
    let hash = first.strip_prefix(&format!("{name}.")).and_then(|rest| rest.strip_suffix(".bin")).unwrap();
    let content = blake3::hash(&fs::read(path.join(&first)).unwrap()).to_hex();
    assert!(hash.len() == 16 && content.starts_with(hash), "{first} {content}");
    assert!(uri(&gltf).bytes().all(|b| b.is_ascii_alphanumeric() || b"-._~%".contains(&b)), "{}", uri(&gltf));
    run_in(path, ["check", "--strict", "--against", "two-keys.dat", "a b%ü#1.gltf"]).exits(0);

    // The same content as the .glb.
    run_in(path, ["two-keys.dat", "two.glb"]).exits(0);
    let (text, binary) = (load(&gltf), load(&path.join("two.glb")));
    assert!(text.buffers == binary.buffers);
    assert_eq!(text.clips[0].extras, binary.clips[0].extras);

    // The next conversion takes its old .bin away, and no other file.
    let others = [format!("{name}.notours.bin"), format!("{name}2.0123456789abcdef.bin")];
    others.iter().for_each(|other| fs::write(path.join(other), "").unwrap());
    run_in(path, ["single-even.dat", "a b%ü#1.gltf"]).exits(0);
    let second = decoded(&uri(&gltf));
    assert_ne!(first, second);
    assert!(!path.join(&first).exists() && path.join(&second).exists());
    assert!(others.iter().all(|other| path.join(other).exists()));
    assert_eq!(load(&gltf).clips[0].name, "single-even");
}

#[test]
fn an_output_that_is_the_input_is_refused() {
    let folder = folder_with(&["two-keys"]);
    let path = folder.path();
    let text = fs::read(path.join("two-keys.dat")).unwrap();
    fs::rename(path.join("two-keys.dat"), path.join("in.glb")).unwrap();
    let check = |arguments: &[&str]| {
        run_in(path, arguments).exits(2).says(&["expected an output that is no input", "in.glb"]);
        assert!(fs::read(path.join("in.glb")).unwrap() == text, "{arguments:?}");
    };
    check(&["in.glb", "in.glb"]);
    check(&["in.glb"]);
    check(&["in.glb", "./in.glb"]);
    fs::hard_link(path.join("in.glb"), path.join("same.glb")).unwrap();
    check(&["in.glb", "same.glb"]);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("in.glb", path.join("link.glb")).unwrap();
        check(&["in.glb", "link.glb"]);
        check(&["link.glb", "in.glb"]);
    }
}

#[cfg(feature = "render")]
#[test]
fn a_thumbnail_must_not_replace_its_glb() {
    let folder = folder_with(&["two-keys"]);
    let both = ["convert", "two-keys.dat", "-o", "x.glb", "--thumbnail", "x.glb"];
    run_in(folder.path(), both).exits(2).says(&["x.glb", "thumbnail"]);
    assert_eq!(names(folder.path()), ["two-keys.dat"]);
}

#[test]
fn a_folder_as_output_takes_the_input_s_name() {
    let folder = folder_with(&["two-keys"]);
    fs::create_dir(folder.path().join("there")).unwrap();
    run_in(folder.path(), ["convert", "two-keys.dat", "-o", "there"]).exits(0);
    run_in(folder.path(), ["convert", "two-keys.dat", "-o", "new/"]).exits(0);
    assert_eq!(names(&folder.path().join("there")), ["two-keys.glb"]);
    assert_eq!(names(&folder.path().join("new")), ["two-keys.glb"]);
}

#[test]
fn existing_outputs_are_replaced_and_nothing_else_is_left() {
    let folder = folder_with(&["two-keys"]);
    fs::write(folder.path().join("out.glb"), "old").unwrap();
    run_in(folder.path(), ["two-keys.dat", "out.glb"]).exits(0);
    assert_eq!(names(folder.path()), ["out.glb", "two-keys.dat"]);
    assert_eq!(load(&folder.path().join("out.glb")).clips[0].name, "two-keys");
}

#[test]
fn a_missing_folder_is_the_environment_s_fault() {
    let folder = folder_with(&["two-keys"]);
    run_in(folder.path(), ["two-keys.dat", "no/where.glb"])
        .exits(4)
        .says(&["no/where.glb", "cannot be written"]);
    assert_eq!(names(folder.path()), ["two-keys.dat"]);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use crate::support::tool::{Ran, finish, program_path};
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    use std::process::Command;

    /// Runs a shell script that finds the program as $0.
    fn shell(folder: &Path, script: &str) -> Ran {
        let mut command = Command::new("sh");
        finish(command.current_dir(folder).args(["-c", script]).arg(program_path()), b"")
    }

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn symbolic_links_are_followed_and_stay() {
        let folder = folder_with(&["two-keys"]);
        let path = folder.path();
        fs::create_dir(path.join("real")).unwrap();
        for (link, target) in [("out.glb", "real/out.glb"), ("twice.glb", "out.glb")] {
            symlink(target, path.join(link)).unwrap();
        }
        // A link to what is not there yet makes it; one to a link goes all the way.
        for link in ["out.glb", "twice.glb"] {
            let _ = fs::remove_file(path.join("real/out.glb"));
            run_in(path, ["two-keys.dat", link]).exits(0);
            assert!(fs::symlink_metadata(path.join(link)).unwrap().is_symlink(), "{link}");
            assert!(fs::symlink_metadata(path.join("real/out.glb")).unwrap().is_file(), "{link}");
        }
        symlink("loop.glb", path.join("loop.glb")).unwrap();
        run_in(path, ["two-keys.dat", "loop.glb"]).exits(4).says(&["loop.glb"]);
    }

    #[test]
    fn modes_come_from_the_old_file_or_the_mask() {
        let folder = folder_with(&["two-keys"]);
        let path = folder.path();
        shell(path, "umask 027; \"$0\" two-keys.dat new.glb").exits(0);
        assert_eq!(mode(&path.join("new.glb")), 0o640);
        fs::set_permissions(path.join("new.glb"), fs::Permissions::from_mode(0o604)).unwrap();
        shell(path, "umask 077; \"$0\" two-keys.dat new.glb").exits(0);
        assert_eq!(mode(&path.join("new.glb")), 0o604);
        shell(path, "umask 027; \"$0\" two-keys.dat new.gltf").exits(0);
        let bin = names(path).into_iter().find(|name| name.ends_with(".bin")).unwrap();
        assert_eq!((mode(&path.join("new.gltf")), mode(&path.join(bin))), (0o640, 0o640));
    }

    /// A limit on the size of files stands in for a disk that is full.
    #[test]
    fn a_full_disk_leaves_what_was_there() {
        let folder = folder_with(&["sixteen"]);
        let path = folder.path();
        fs::write(path.join("old.glb"), "old").unwrap();
        for output in ["old.glb", "new.glb", "new.gltf"] {
            let script = format!("trap '' XFSZ; ulimit -f 16; \"$0\" sixteen.dat {output}");
            shell(path, &script).exits(4).says(&[output, "cannot be written"]);
            assert_eq!(names(path), ["old.glb", "sixteen.dat"], "{output}");
        }
        assert_eq!(fs::read(path.join("old.glb")).unwrap(), b"old");
    }

    #[test]
    fn devices_and_pipes_are_written_straight() {
        let folder = folder_with(&["two-keys"]);
        let path = folder.path();
        run_in(path, ["two-keys.dat", "out.glb"]).exits(0);
        let whole = fs::read(path.join("out.glb")).unwrap();
        run_in(path, ["convert", "two-keys.dat", "-o", "/dev/null"]).exits(0);
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
        let ran = run_in(path, ["convert", "two-keys.dat", "-o", "/dev/stdout"]).exits(0);
        assert!(ran.stdout == whole);
        let ran =
            shell(path, "mkfifo pipe; cat pipe & \"$0\" convert two-keys.dat -q -o pipe && wait").exits(0);
        assert!(ran.stdout == whole);
        assert!(fs::metadata(path.join("pipe")).unwrap().file_type().is_fifo());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn places_nobody_may_write_to() {
        let folder = folder_with(&["two-keys"]);
        for output in ["/proc/out.glb", "/dev/full"] {
            let ran = run_in(folder.path(), ["convert", "two-keys.dat", "-o", output]).exits(4);
            ran.says(&[output, "cannot be written"]);
        }
    }

    /// A reader that has seen enough, as `head` has, is no failure.
    #[test]
    fn a_closed_pipe_is_no_failure() {
        let folder = folder_with(&["sixteen"]);
        let script = "{ \"$0\" sixteen.dat - -q; echo $? >code; } | head -c 8 >seen";
        shell(folder.path(), script).exits(0);
        assert_eq!(fs::read_to_string(folder.path().join("code")).unwrap(), "0\n");
        assert!(fs::read(folder.path().join("seen")).unwrap().starts_with(b"glTF"));
    }
}
