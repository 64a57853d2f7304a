use super::*;
use crate::math::Quat;
use crate::orient::Frame;
use crate::path::Kind as PathKind;
use crate::read::{Rotations, keyframes};
use proptest::prelude::*;

fn read(text: impl AsRef<[u8]>) -> Result<Input, Error> {
    input("a.dat", text.as_ref(), None)
}

fn path(text: impl AsRef<[u8]>) -> PathFile {
    match read(text).unwrap() {
        Input::Path(path) => path,
        other => panic!("{other:?}"),
    }
}

fn rotations(text: impl AsRef<[u8]>) -> RotationsFile {
    match read(text).unwrap() {
        Input::Rotations(rotations) => rotations,
        other => panic!("{other:?}"),
    }
}

fn refusal(text: impl AsRef<[u8]>) -> String {
    read(text).unwrap_err().to_string()
}

/// Each text is refused at `LINE:COLUMN: ` with that problem, and the whole message holds
/// the last part.
fn refuses(cases: &[(&str, &str, &str)]) {
    for (text, start, part) in cases {
        let found = refusal(text);
        assert!(found.starts_with(&format!("a.dat:{start}")), "{text:?}\n{found}");
        assert!(found.contains(part), "{text:?}\n{found}");
    }
}

#[test]
fn the_header_tells_the_kind() {
    assert!(matches!(read("# 1 2\n0 1 0 0 0\n1 1 0 0 0\n").unwrap(), Input::Keyframes(_)));
    let first = "# notes\n# polyline\n# 4 3.0\n0 0 0\n1 1 1\n";
    assert_eq!(path(first).kind, PathKind::Polyline);
    assert!(matches!(read("# 1 2\n# polyline\n0 1 0 0 0\n1 1 0 0 0\n").unwrap(), Input::Keyframes(_)));
    for (name, kind) in [
        ("catmull-rom", PathKind::CatmullRom),
        ("catmull-rom-centripetal", PathKind::CatmullRomCentripetal),
        ("catmull-rom-chordal", PathKind::CatmullRomChordal),
    ] {
        let path = path(format!("# {name} 20\n0 0 0\n1 1 1\n"));
        assert_eq!((path.kind, path.kind.name(), path.duration), (kind, name, Some(20.0)));
    }
}

#[test]
fn reads_points() {
    let text = b"\xef\xbb\xbf# made by hand\r\n\r\n# bezier duration=20 frame=flu\r\n0 .5 1E1\r\n# inner\r\n1\t1 1\r\n\r\n+2 2 2 \r\n3 3 -1.0D+00";
    let path = path(text);
    assert_eq!((path.kind, path.duration, path.frame), (PathKind::Bezier, Some(20.0), Some(Frame::Flu)));
    assert_eq!(path.points, [[0.0, 0.5, 10.0], [1.0; 3], [2.0; 3], [3.0, 3.0, -1.0]]);
    assert_eq!((path.times, path.start), (None, 0.0));
    assert_eq!(path.orientations, [None, None]);
    let lines: Vec<usize> = (0..4).map(|i| path.lines.of(i)).collect();
    assert_eq!(lines, [4, 6, 8, 9]);
    assert_eq!((path.bytes, path.hash), (text.len() as u64, blake3::hash(text).to_hex().to_string()));
    assert!(path.warnings.is_empty());
}

#[test]
fn times_and_orientations_belong_to_keys() {
    let timed = path("# polyline\n2.5 0 0 0\n3 1 1 1 0 0 0 2\n4 1 1 1\n");
    assert_eq!((timed.times.as_deref(), timed.start), (Some([0.0, 0.5, 1.5].as_slice()), 2.5));
    let turned = Quat::from_wxyz([0.0, 0.0, 0.0, 1.0]);
    assert_eq!(timed.orientations, [None, Some(turned), None]);
    assert_eq!(timed.largest_norm_error, 1.0);
    assert!(timed.warnings[0].message.contains("line 3 (length 2.0"), "{:?}", timed.warnings);

    let curve = path("# bezier\n1 0 0 0\n0 0 1\n0 0 2\n2 0 0 3 1 0 0 0\n0 0 4\n0 0 5\n4 0 0 6\n");
    assert_eq!(curve.times.as_deref(), Some([0.0, 1.0, 3.0].as_slice()));
    assert_eq!(curve.keys().collect::<Vec<_>>(), [0, 3, 6]);
    assert_eq!(curve.orientations, [None, Some(Quat::IDENTITY), None]);
    assert_eq!(curve.points[3], [0.0, 0.0, 3.0]);

    let one = path("# bezier degree=2\n1 0 0 0\n0 0 1\n3 0 0 2\n");
    assert_eq!((one.kind, one.times.as_deref()), (PathKind::BezierDegree(2), Some([0.0, 2.0].as_slice())));
    assert_eq!(one.keys().collect::<Vec<_>>(), [0, 2]);
}

#[test]
fn orders_of_parts() {
    let q = |text: &str, order| match input("a", text.as_bytes(), order).unwrap() {
        Input::Path(path) => path.orientations[0].unwrap(),
        Input::Rotations(RotationsFile { rotations: Rotations::QuatBezier(q), .. }) => q[0],
        other => panic!("{other:?}"),
    };
    let row = "0 1 0 0\n";
    let bezier = |header: &str| format!("# quat-bezier {header}\n{}", row.repeat(4));
    assert_eq!(q(&bezier(""), None).to_wxyz(), [0.0, 1.0, 0.0, 0.0]);
    assert_eq!(q(&bezier("xyzw"), None).to_xyzw(), [0.0, 1.0, 0.0, 0.0]);
    assert_eq!(q(&bezier("xyzw"), Some(Order::Wxyz)).to_wxyz(), [0.0, 1.0, 0.0, 0.0]);
    let polyline = "# polyline xyzw\n1 2 3 0 0 1 0\n1 2 4\n";
    assert_eq!(q(polyline, None).to_xyzw(), [0.0, 0.0, 1.0, 0.0]);
}

#[test]
fn reads_rotations() {
    let keys = rotations("# euler 4 frame=gltf\n0 10 350\n0 -10 -20.5\n");
    assert_eq!(keys.rotations, Rotations::Euler(vec![[0.0, 10.0, 350.0], [0.0, -10.0, -20.5]]));
    assert_eq!((keys.duration, keys.frame), (Some(4.0), Some(Frame::Gltf)));
    assert_eq!((keys.rotations.len(), keys.rotations.usual_frame()), (2, Frame::Frd));
    let timed = rotations("# euler\n1 0 0 0\n1.5 0 0 90\n");
    assert_eq!((timed.times.as_deref(), timed.start), (Some([0.0, 0.5].as_slice()), 1.0));
    let control = rotations("# euler-bezier\n1 0 0 0\n0 0 30\n0 0 60\n4 0 0 90\n");
    assert_eq!(control.times.as_deref(), Some([0.0, 3.0].as_slice()));
    assert_eq!((control.rotations.name(), control.rotations.len()), ("euler-bezier", 4));
    let control = rotations("# quat-bezier\n1 2 0 0 0\n-1 0 0 0\n0 1 0 0\n4 0 0 -1 0\n");
    let Rotations::QuatBezier(q) = &control.rotations else { panic!() };
    assert_eq!(q.iter().map(|q| q.w).collect::<Vec<_>>(), [1.0, -1.0, 0.0, 0.0]);
    assert_eq!(control.times.as_deref(), Some([0.0, 3.0].as_slice()));
    assert!(control.warnings[0].message.starts_with("1 quaternion is not of unit length"));
    assert_eq!(control.rotations.usual_frame(), Frame::Gltf);
}

#[test]
fn angles_that_jump() {
    let message = |text: &str| rotations(text).warnings.into_iter().find(|w| w.code == "ANGLE_JUMP");
    assert_eq!(message("# euler\n0 0 -90\n0 0 90\n"), None);
    let one = message("# euler\n# notes\n0 0 170\n0 0 -170\n").unwrap().message;
    assert!(
        one.starts_with("an angle jumps by more than 180° from row to row (yaw in line 4: from 170 to -170)"),
        "{one}"
    );
    let two = message("# euler-bezier\n0 0 0\n270 0 0\n0 0 0\n0 0 0\n").unwrap().message;
    assert!(two.starts_with("2 angles jump") && two.contains("(the first: roll in line 3:"), "{two}");
    assert!(message("# euler\n0 0 1e300\n0 0 -1e300\n").unwrap().message.contains("1e300"));
}

#[test]
fn headers_that_nearly_are() {
    refuses(&[
        (
            "# besier\n0 0 0\n",
            "2:1: expected a header before the first row, found '0'; line 1 is a comment, because 'besier' \
             is no kind of file (did you mean 'bezier'?)\n  0 0 0\n  ^\n",
            "begin a file of points with its kind, such as '# bezier'",
        ),
        ("# bezier 20s\n0 0 0\n", "2:1: ", "line 1 is a comment, because '20s' is neither"),
        ("0 0 0\n", "1:1: expected a header", "'# bezier'"),
        ("0 1 0 0 0\n", "1:1: expected a header", "'# 4 3.0'"),
        ("# Polyline\n", "1:11: expected a header, found the end of the file; line 1", "'polyline'"),
        (
            "# bezier duraton=2\n",
            "1:10: expected a word that 'bezier' knows (duration=, degree=, frame=), found 'duraton=2'\n  \
             # bezier duraton=2\n           ^",
            "did you mean 'duration='?",
        ),
        ("# bezier -2\n", "1:10: expected a positive duration", ""),
        ("\u{feff}# one\n\n  # polyline frame=x\n", "3:20: expected the frame", ""),
    ]);
}

#[test]
fn what_keyframes_refuse_is_refused() {
    refuses(&[
        ("", "1:1: expected a header, found an empty file", "# 4 3.0"),
        ("# polyline\n0 0 0\n1 x 0\n", "3:3: expected a number, found 'x'\n  1 x 0\n    ^", ""),
        ("# polyline\n0 0 0\n1 0,5 0\n", "3:3: ", "decimal comma: write 0.5"),
        ("# polyline\n0 0 0\n1 0 nan\n", "3:5: expected a finite number, found 'nan'", ""),
        ("# polyline\n0 0 0\n1 -inf 0\n", "3:3: expected a finite number", ""),
        ("# polyline\n0 0 0\n1 1e999 0\n", "3:3: expected a number of at most 1.8e308", ""),
        ("# polyline\n0 0 0\n1 0 0 # end\n", "3:7: ", "a comment stands on a line of its own"),
        ("# polyline\n0 0 0\n1 0 0 x\n", "3:7: expected a number, found 'x'", ""),
        ("# polyline\n1e31 0 0\n1 0 0\n", "2:1: expected a number between -1e30 and 1e30, found 1e31", ""),
        (
            "# polyline\n0 0 0 0\n0 1 1 1\n",
            "3:1: expected a time later than 0 in line 2, found '0'",
            "times must",
        ),
        (
            "# bezier\n5 0 0 0\n1 1 1\n2 2 2\n# c\n4 3 3 3\n",
            "6:1: expected a time later than 5 in line 2",
            "",
        ),
        (
            "# polyline\n-1e308 0 0 0\n1e308 1 1 1\n",
            "3:1: expected a time less than 1.8e308 s after the first",
            "",
        ),
        ("# polyline\n0 0 0 0 0 0 0\n1 1 1\n", "2:7: expected a rotation, found a quaternion of zeros", ""),
        ("# quat-bezier\n1 0 0 0\n0 0 0 0\n", "3:1: expected a rotation, found a quaternion of zeros", ""),
    ]);
    let bytes = |text: &[u8]| refusal(text);
    assert!(bytes(b"# polyline\n0 0 0\n# \xe9\n1 1 1\n").starts_with("a.dat:3:3: expected UTF-8 text"));
    assert!(bytes(b"# polyline\n0 0 \xe9\n").starts_with("a.dat:2:5: expected UTF-8 text"));
    assert!(bytes(b"\xff\xfe#\0").starts_with("a.dat:1:1: expected UTF-8 text, found UTF-16"));
}

#[test]
fn rows_are_alike() {
    refuses(&[
        (
            "# polyline\n0 0 0\n0.5 1 1 1\n",
            "3:9: expected 3 numbers (x y z, as in line 2) or 7 with an orientation, found 4\n  0.5 1 1 1\n",
            "4 more numbers at the end of a row are the point's orientation, w x y z",
        ),
        ("# polyline\n0 0 0 0\n1 1 1\n", "3:6: expected 4 numbers (t x y z, as in line 2) or 8", "found 3"),
        ("# polyline\n0 0 0\n1 1 1 1 0 0 \n", "3:7: expected 3 numbers", "found 6"),
        ("# polyline\n0 0 0\n1 1 1 1 0 0 0 0\n", "3:15: expected 3 numbers", "found 8"),
        (
            "# polyline\n0 0\n1 1 1\n",
            "2:4: expected 3 numbers (x y z) or 4 (t x y z), found 2",
            "orientation",
        ),
        ("# polyline\n0 0 0 1 2\n1 1 1\n", "2:9: expected 3 numbers (x y z) or 4 (t x y z), found 5", ""),
        ("# euler\n0 0 0 1 2\n1 1 1\n", "2:9: expected 3 numbers (roll pitch yaw) or 4 (t roll", ""),
        ("# euler\n0 0 0\n1 1 1 1\n", "3:7: expected 3 numbers (roll pitch yaw, as in line 2), found 4", ""),
        ("# quat-bezier\n0 0\n1 0 0 0\n", "2:4: expected 4 numbers (w x y z) or 5 (t w x y z), found 2", ""),
        ("# quat-bezier xyzw\n0 0\n1 0 0 0\n", "2:4: expected 4 numbers (x y z w) or 5 (t x y z w)", ""),
    ]);
}

#[test]
fn only_ends_of_segments_carry_times_and_orientations() {
    refuses(&[
        (
            "# bezier\n0 0 0 0\n1 1 1 1\n2 2 2 2\n3 3 3 3\n",
            "3:1: expected 3 numbers (x y z: an inner control point has no time), found 4\n  1 1 1 1\n  ^",
            "with times, rows 1, 4, 7, …, where segments begin and end, are 't x y z', all others 'x y z'",
        ),
        (
            "# bezier\n0 0 0 0\n1 1 1\n2 2 2\n3 3 3\n",
            "5:6: expected 4 numbers (t x y z: a segment begins or ends here) or 8 with an orientation, found 3",
            "with times",
        ),
        (
            "# bezier\n0 0 0\n1 1 1 1 0 0 0\n",
            "3:7: expected 3 numbers (x y z: an inner control point has no orientation), found 7",
            "",
        ),
        (
            "# bezier\n0 0 0\n1 1 1\n2 2 2\n1 3 3 3\n",
            "5:7: expected 3 numbers (x y z, as in line 2) or 7",
            "",
        ),
        (
            "# bezier degree=2\n0 0 0 0\n1 1 1 1\n2 2 2 2\n",
            "3:1: expected 3",
            "the first row and the last are",
        ),
        (
            "# bezier degree=2\n0 0 0 0\n1 1 1\n2 2 2\n",
            "4:6: expected 4 numbers (t x y z: the curve ends here)",
            "",
        ),
        (
            "# euler-bezier\n0 0 0 0\n1 0 0 0\n",
            "3:1: expected 3 numbers (roll pitch yaw: an inner control rotation",
            "",
        ),
        (
            "# quat-bezier\n0 1 0 0 0\n1 1 0 0 0\n",
            "3:1: expected 4 numbers (w x y z: an inner",
            "has no time",
        ),
    ]);
}

#[test]
fn a_duration_and_times_exclude_each_other() {
    refuses(&[(
        "# a\n# bezier duration=20\n\n0 0 0 0\n",
        "2:10: expected no duration, because rows have times (t x y z, from line 4 on), found 20\n  # bezier duration=20\n           ^",
        "leave out the duration, or the times",
    )]);
    refuses(&[("# euler 3\n0 0 0 0\n", "1:9: expected no duration", "t roll pitch yaw")]);
}

#[test]
fn counts_of_rows() {
    let rows = |header: &str, n: usize| format!("# {header}\n{}", "1 2 3\n".repeat(n));
    let refused = |header: &str, n: usize| refusal(rows(header, n));
    assert_eq!(
        refused("bezier", 8),
        "a.dat:9:6: expected 3n + 1 control points for n cubic segments (4, 7, 10, …), found 8: 2 missing or 1 \
         over\n  1 2 3\n       ^\n  add 2 control points or leave out 1; or write degree=7 in the header for \
         one curve of all 8"
    );
    for (n, off, add) in [
        (0, "found 0: 4 missing", "add 4 control points"),
        (1, "found 1: 3 missing", "add 3 control points"),
        (2, "found 2: 2 missing", "degree=1"),
        (3, "found 3: 1 missing", "add 1 control point; or write degree=2"),
        (5, "found 5: 2 missing or 1 over", "degree=4"),
        (6, "found 6: 1 missing or 2 over", "add 1 control point or leave out 2; or write degree=5"),
    ] {
        let text = refused("bezier", n);
        assert!(text.contains(off) && text.contains(add), "{text}");
    }
    assert!(!refused("bezier", 1).contains("degree"));
    let control = refusal("# quat-bezier\n1 0 0 0\n1 0 0 0\n");
    assert!(control.contains("3n + 1 control rotations") && !control.contains("degree"), "{control}");
    assert_eq!(
        refused("bezier degree=5", 4),
        "a.dat:1:10: expected 6 control points for one curve of degree 5, found 4: 2 missing\n  \
         # bezier degree=5\n           ^\n  write degree=3 for these 4, or no degree for cubic segments, which \
         need 4, 7, 10, … control points"
    );
    assert!(refused("bezier degree=2", 4).contains("found 4: 1 too many"));
    assert!(refused("bezier degree=1", 0).contains("write no degree"));
    assert!(refused("polyline", 1).starts_with("a.dat:2:6: expected two points or more, found one"));
    assert!(refused("catmull-rom", 0).starts_with("a.dat:1:14: expected two points or more, found none"));
    assert!(refused("euler", 1).contains("a key is a row: 'roll pitch yaw' or 't roll pitch yaw'"));
    for (header, n) in [("bezier", 4), ("bezier", 7), ("bezier degree=1", 2), ("polyline", 2), ("euler", 2)] {
        assert!(read(rows(header, n)).is_ok(), "{header} {n}");
    }
}

#[test]
fn the_header_is_blamed_when_all_rows_agree() {
    refuses(&[
        (
            "# a\n# euler\n0 1 0 0 0\n1 1 0 0 0\n",
            "2:3: expected a header that fits the rows, found 'euler' where all 2 rows have 5 numbers",
            "keyframes, a time and 4 numbers for each box, begin with '# 1 3.0'",
        ),
        ("# polyline\n0 1\n1 1\n", "1:3: expected a header", "rows of 'polyline' are 'x y z' or 't x y z'"),
        ("# quat-bezier\n0 1 2\n1 1 2\n", "1:3: expected a header", "begin with '# bezier'"),
        ("# polyline\n0 1\n1 1 1\n", "2:4: expected 3 numbers", ""),
    ]);
}

#[test]
fn keyframes_alone_refuse_other_kinds() {
    let error = keyframes("a.dat", b"# x\n# bezier 3\n".as_slice(), None).unwrap_err().to_string();
    assert_eq!(
        error,
        "a.dat:2:3: expected a header of keyframes, such as '# 4 3.0', found 'bezier'\n  # bezier 3\n    ^"
    );
}

#[test]
fn many_blocks_are_one_file() {
    let row = |i: usize| format!("{} {} 0.123456789\n", i, i % 7);
    let comments = format!("# {}\n", "nothing here ".repeat(20)).repeat(20_000);
    let text: String = [comments, "# polyline\n".into()].into_iter().chain((0..400_000).map(row)).collect();
    assert!(text.len() > 12 << 20);
    let path = path(&text);
    assert_eq!((path.points.len(), path.lines.of(399_999)), (400_000, 420_001));
    assert_eq!(path.points[399_999][0], 399_999.0);
    assert_eq!(path.hash, blake3::hash(text.as_bytes()).to_hex().to_string());
    let mut broken = text.into_bytes();
    let last = broken.len() - 3;
    broken[last] = b'x';
    assert!(refusal(broken).starts_with("a.dat:420001:10: "));
}

/// Every committed path reads, without a warning but where it is about one.
#[test]
fn fixtures() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/paths");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let file = std::fs::File::open(&path).unwrap();
        let warnings = match input(&path.display().to_string(), file, None).unwrap() {
            Input::Path(path) => path.warnings,
            Input::Rotations(rotations) => rotations.warnings,
            Input::Keyframes(_) => panic!("{path:?}"),
        };
        assert!(warnings.is_empty(), "{path:?}: {warnings:?}");
        count += 1;
    }
    assert!(count > 10);
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = read(&bytes).map_err(|error| error.to_string());
    }

    /// Files that are nearly right: a header, rows of numbers, and something odd among them.
    #[test]
    fn almost_valid_files_are_read_or_refused(
        header in "(\u{feff})?(# [a-z ]{0,9}\r?\n)?# ?(bezier|bezier|besier|catmull-rom(-chordal)?|polyline|euler|euler-bezier|quat-bezier|1)( (degree=[0-9]{1,2}|duration=[0-9.-]{1,4}|frame=frd|xyzw|3|[a-z=]{1,4})){0,2}",
        width in 2usize..9,
        rows in prop::collection::vec(prop::collection::vec("(-?[0-9]{1,2}(\\.[0-9]){0,1}|1e30|-1e-320|0)", 9), 0..9),
        odd in prop::option::of((0usize..9, "(x|nan|#|1e999|1,5|\u{2212}1|1 2|\r|\u{0}|)")),
        end in "(\r?\n)?",
    ) {
        let mut text = header;
        for (i, row) in rows.iter().enumerate() {
            text += "\n";
            text += &row[..width].join(" ");
            if let Some((_, odd)) = odd.as_ref().filter(|odd| odd.0 == i) {
                text += " ";
                text += odd;
            }
        }
        text += &end;
        match read(&text) {
            Ok(Input::Path(path)) => {
                prop_assert!(path.points.len() >= 2);
                prop_assert!(path.times.as_ref().is_none_or(|times| times.len() == path.keys().count()));
                prop_assert_eq!(path.orientations.len(), path.keys().count());
                prop_assert_eq!(path.keys().last(), Some(path.points.len() - 1));
            }
            Ok(Input::Rotations(rotations)) => prop_assert!(rotations.rotations.len() >= 2),
            Ok(Input::Keyframes(_)) => {}
            Err(Error::Refused(refusal)) => {
                let line = text.split('\n').nth(refusal.line - 1);
                prop_assert!(line.is_some(), "{} {:?}", refusal, text);
                prop_assert!(refusal.column <= line.unwrap().chars().count() + 1, "{} {:?}", refusal, text);
            }
            Err(error) => prop_assert!(false, "{}", error),
        }
    }
}
