//! The two kinds of URI that a glTF file may hold: `data:` and relative paths.

/// A URI, taken apart.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Uri {
    /// The bytes of a `data:` URI.
    Data(Vec<u8>),
    /// A relative path, percent-decoded.
    Path(String),
}

/// Takes a URI apart; the error is a sentence about it.
pub(super) fn parse(uri: &str) -> Result<Uri, String> {
    if let Some(("data", rest)) = uri.split_once(':') {
        return data(rest).map(Uri::Data);
    }
    if let Some(scheme) = scheme(uri) {
        return Err(format!(
            "begins with `{scheme}:`; only data: URIs and files beside or below the file are opened"
        ));
    }
    let path = String::from_utf8(percent_decoded(uri)?)
        .map_err(|_| "is not UTF-8 once its %-escapes are decoded".to_owned())?;
    let wrong = |what: &str| {
        Err(format!("`{}` {what}; only files beside or below the file are opened", path.escape_debug()))
    };
    // Backslashes part folders on some systems, and mean the same everywhere here.
    let drive = path.split(['/', '\\']).next().is_some_and(|first| first.ends_with(':'));
    match path.as_str() {
        "" => Err("is empty; it must be a path relative to the file's own folder".into()),
        path if path.contains('\0') => wrong("holds a zero byte"),
        path if path.starts_with(['/', '\\']) || drive => wrong("is an absolute path"),
        path if path.split(['/', '\\']).any(|part| part == "..") => {
            wrong("leads out of the file's folder by `..`")
        }
        _ => Ok(Uri::Path(path)),
    }
}

/// The scheme of a URI that has one: letters before the first colon.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
    (scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(plain)).then_some(scheme)
}

/// What follows `data:`: a media type, perhaps `;base64`, a comma, the data.
fn data(rest: &str) -> Result<Vec<u8>, String> {
    let (media, text) = rest.split_once(',').ok_or("is a data: URI without a comma before its data")?;
    let bytes = percent_decoded(text)?;
    if media.ends_with(";base64") { base64(&bytes) } else { Ok(bytes) }
}

fn percent_decoded(text: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digits = tail.get(..2).map(|two| (digit(two[0]), digit(two[1])));
        let Some((Some(high), Some(low))) = digits else {
            return Err("holds a % that two hexadecimal digits do not follow".into());
        };
        bytes.push(high << 4 | low);
        rest = &tail[2..];
    }
    Ok(bytes)
}

fn digit(byte: u8) -> Option<u8> {
    let value = char::from(byte).to_digit(16)?;
    u8::try_from(value).ok()
}

/// Base64 in the usual or the URL's alphabet, padded or not (RFC 4648).
fn base64(text: &[u8]) -> Result<Vec<u8>, String> {
    let end = text.iter().rposition(|&c| c != b'=').map_or(0, |at| at + 1);
    if text.len() - end > 2 {
        return Err("holds base64 with more than two `=` at its end".into());
    }
    let mut bytes = Vec::with_capacity(end / 4 * 3 + 2);
    for group in text[..end].chunks(4) {
        let mut bits = 0;
        for &c in group {
            bits = bits << 6 | sextet(c).ok_or_else(|| wrong_character(c))?;
        }
        match group.len() {
            4 => bytes.extend(&bits.to_be_bytes()[1..]),
            3 => bytes.extend(&(bits << 6).to_be_bytes()[1..3]),
            2 => bytes.extend(&(bits << 12).to_be_bytes()[1..2]),
            _ => return Err("holds base64 that is cut off within a byte".into()),
        }
    }
    Ok(bytes)
}

fn sextet(c: u8) -> Option<u32> {
    let value = match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    };
    Some(u32::from(value))
}

fn wrong_character(c: u8) -> String {
    format!("holds `{}`, which is not base64", c.escape_ascii())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_every_length() {
        for (text, bytes) in [
            ("", &b""[..]),
            ("Zg==", b"f"),
            ("Zg", b"f"),
            ("Zm8=", b"fo"),
            ("Zm9v", b"foo"),
            ("Zm9vYg==", b"foob"),
            ("+/8=", b"\xFB\xFF"),
            ("-_8", b"\xFB\xFF"),
        ] {
            assert_eq!(base64(text.as_bytes()).as_deref(), Ok(bytes), "{text}");
        }
        for text in ["A", "A===", "Zm9v!", "Zm9=v"] {
            assert!(base64(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn uris_are_told_apart() {
        let path = |text: &str| Ok(Uri::Path(text.into()));
        assert_eq!(parse("a%20b.bin"), path("a b.bin"));
        assert_eq!(parse("1:2.bin"), path("1:2.bin"));
        let foo = Ok(Uri::Data(b"foo".to_vec()));
        assert_eq!(parse("data:application/octet-stream;base64,Zm9v"), foo);
        assert_eq!(parse("data:;base64,Zm9%76"), foo);
        assert_eq!(parse("data:text/plain,f%6fo"), foo);
        for text in ["", "/etc/x", "%2Fetc/x", "http://a/b", "file:b", "C:/b", "C%3A/b", "a%2", "a%zz", "%ff"]
        {
            assert!(parse(text).is_err(), "{text}");
        }
        for text in ["..", "../b", "a/../../b", "%2e%2E%2fb", "..\\b", "a%5C..%5cb", "data:x", "a%00b"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
