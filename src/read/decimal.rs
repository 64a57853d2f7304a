//! Plain decimal numbers, such as `-0.123456789012`, eight digits at a time.
//!
//! Where the digits make a whole number up to 2⁵³, it and the power of ten below it are exact
//! in float64: one division, which IEEE 754 rounds correctly, gives the nearest float64.
//! Source: Clinger, PLDI 1990. What is longer or has an exponent is left to fast-float2, of
//! which this gives the same bits.

/// Numbers of so many digits fit into 64 bits.
const DIGITS: usize = 18;

/// The largest of the whole numbers that float64 holds without a gap.
const EXACT: u64 = 1 << 53;

const POWERS: [f64; DIGITS + 1] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18];

/// What so many digits more are worth.
const SHIFTS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// The number that begins at `from` and where it ends, if it is a plain one of few digits.
#[inline(always)]
pub(super) fn plain(line: &[u8], from: usize) -> Option<(f64, usize)> {
    let negative = *line.get(from)? == b'-';
    let start = from + usize::from(negative);
    let (mut whole, mut at, mut digits) = (0, start, 0);
    // Before the point there are few digits.
    while let Some(digit) = line.get(at).map(|byte| byte.wrapping_sub(b'0')).filter(|&digit| digit < 10) {
        whole = 10 * whole + u64::from(digit);
        at += 1;
        digits += 1;
        if digits > DIGITS {
            return None;
        }
    }
    let mut decimals = 0;
    if line.get(at) == Some(&b'.') {
        at += 1;
        loop {
            let (value, count) = eight(line, at);
            decimals += count;
            if digits + decimals > DIGITS {
                return None;
            }
            whole = whole * SHIFTS[count] + value;
            if count < 8 {
                at += count;
                break;
            }
            // Not by `count`: the next load need not wait for it.
            at += 8;
        }
    }
    let more = line.get(at).is_some_and(|byte| matches!(byte, b'e' | b'E'));
    if digits + decimals == 0 || whole > EXACT || more {
        return None;
    }
    // From a signed number: machines have an instruction for that.
    let value = whole as i64 as f64 / POWERS[decimals];
    Some((if negative { -value } else { value }, at))
}

/// The number that up to eight digits make, and how many they are.
///
/// Four bits of a digit are its value. Neighbours are joined to numbers of two digits, of
/// four and of eight by a product each.
#[inline(always)]
fn eight(line: &[u8], at: usize) -> (u64, usize) {
    const ZEROS: u64 = u64::from_le_bytes([b'0'; 8]);
    let word = word(line, at);
    let values = word ^ ZEROS;
    // A byte that is no digit has a high bit now, or gets one by adding 6.
    let strange = (values | values.wrapping_add(0x0606_0606_0606_0606)) & 0xf0f0_f0f0_f0f0_f0f0;
    let count = (strange.trailing_zeros() / 8) as usize;
    if count == 0 {
        return (0, 0);
    }
    // The first digit is the lowest byte; zeros come in before it.
    let values = values << (64 - 8 * count);
    let pairs = values.wrapping_mul(10).wrapping_add(values >> 8) & 0x00ff_00ff_00ff_00ff;
    let fours = pairs.wrapping_mul(100).wrapping_add(pairs >> 16) & 0x0000_ffff_0000_ffff;
    let value = fours.wrapping_mul(10_000).wrapping_add(fours >> 32) & 0xffff_ffff;
    (value, count)
}

/// Eight bytes, the first one lowest; zeros after the line's end.
#[inline(always)]
fn word(line: &[u8], at: usize) -> u64 {
    match line.get(at..at + 8) {
        Some(bytes) => u64::from_le_bytes(bytes.try_into().expect("eight bytes")),
        None => {
            let mut bytes = [0; 8];
            let rest = &line[at..];
            bytes[..rest.len()].copy_from_slice(rest);
            u64::from_le_bytes(bytes)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Either it is no plain number, or both agree to the last bit.
    fn agrees(text: &str) -> bool {
        let theirs = fast_float2::parse_partial::<f64, _>(text);
        match plain(text.as_bytes(), 0) {
            None => false,
            Some((value, end)) => {
                let (expected, length) = theirs.unwrap();
                assert_eq!((value.to_bits(), end), (expected.to_bits(), length), "{text}");
                true
            }
        }
    }

    proptest! {
        #[test]
        fn bits_are_those_of_the_nearest(text in "-?[0-9]{0,17}(\\.[0-9]{0,19})?( .*)?") {
            agrees(&text);
        }

        #[test]
        fn whatever_follows_is_left_alone(text in "-?[0-9]{1,3}\\.[0-9]{0,12}[ \t,x+\\-./:;]?.{0,9}") {
            agrees(&text);
        }

        #[test]
        fn usual_numbers_are_plain(value in -10.0..10.0f64) {
            let texts = [format!("{value:.12}"), format!("{value:.6} 1")];
            prop_assert!(texts.iter().all(|text| agrees(text)));
        }
    }

    #[test]
    fn what_is_no_plain_number() {
        for text in [
            "",
            "-",
            ".",
            "-.",
            "x",
            "+1",
            "1e5",
            "1.5e-3",
            "1E5",
            "0.123456789012345678",
            "9007199254740993",
            "12345678901234567890",
        ] {
            assert_eq!(plain(text.as_bytes(), 0), None, "{text}");
        }
        for text in [
            "0",
            "-0",
            "-0.0",
            "1.",
            ".5",
            "-.5",
            "00012.5",
            "999999999999999",
            "0.999999999999999",
            "9007199254740992",
            "0.9007199254740992",
        ] {
            assert!(agrees(text), "{text}");
        }
    }
}
