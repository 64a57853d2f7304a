//! The .bin files beside a .gltf: their names carry their content's hash, so that a
//! .gltf never meets the data of another.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

/// `clip.0123456789abcdef.bin` for `clip.gltf`.
pub(super) fn bin_file_name(gltf: &Path, hash: &str) -> String {
    format!("{}.{hash}.bin", stem(gltf))
}

fn stem(gltf: &Path) -> String {
    gltf.file_stem().unwrap_or(OsStr::new("clip")).to_string_lossy().into_owned()
}

/// Removes the .bin files that earlier outputs of this name left, but for those in
/// `kept`. That one cannot be removed is no reason to fail.
pub(super) fn remove_old_bins(gltf: &Path, kept: &[String]) {
    let stem = stem(gltf);
    let folder = gltf.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let rest = name.strip_prefix(&*stem).and_then(|rest| rest.strip_prefix('.'));
        let hash = rest.and_then(|rest| rest.strip_suffix(".bin"));
        let ours = hash.is_some_and(|hash| hash.len() == 16 && hash.bytes().all(|b| b.is_ascii_hexdigit()));
        if ours && !kept.contains(&name) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// A file name as a relative URI (RFC 3986): all but unreserved characters escaped.
pub(super) fn percent_encoded(name: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-._~".contains(&b);
    let escaped = |b: u8| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") };
    name.bytes().map(escaped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_escaped_and_names_made_of_content() {
        assert_eq!(percent_encoded("clip 1%ä.bin"), "clip%201%25%C3%A4.bin");
        assert_eq!(bin_file_name(Path::new("a/b.c.gltf"), "00"), "b.c.00.bin");
    }

    #[test]
    fn only_unused_bins_of_the_same_name_go() {
        let folder = tempfile::tempdir().unwrap();
        let gltf = folder.path().join("a b.gltf");
        let hashed = |digit: &str| bin_file_name(&gltf, &digit.repeat(16));
        let others = ["a b.bin".to_owned(), "a b.0.bin".to_owned(), format!("c.{}.bin", "0".repeat(16))];
        for name in others.iter().chain(&[hashed("1"), hashed("2"), hashed("3")]) {
            fs::write(folder.path().join(name), b"x").unwrap();
        }
        remove_old_bins(&gltf, &[hashed("2"), hashed("3")]);
        let left = |name: &String| folder.path().join(name).exists();
        assert!(others.iter().all(left) && left(&hashed("2")) && left(&hashed("3")));
        assert!(!left(&hashed("1")));
        assert_eq!(percent_encoded(&hashed("1")), format!("a%20b.{}.bin", "1".repeat(16)));
    }
}
