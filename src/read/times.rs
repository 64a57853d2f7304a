//! Times of keys: seconds since the first, strictly increasing.

use super::refusal::Problem;

/// The next key's time since the first, which is at `start`; `before` is the time since
/// the first of the key before it, which stands in the line `line`.
pub(super) fn next(
    start: f64,
    before: Option<f64>,
    time: f64,
    line: impl FnOnce() -> usize,
) -> Result<f64, Problem> {
    let t = time - start;
    let problem = match before {
        None => return Ok(t),
        Some(_) if !t.is_finite() => "expected times less than 1.8e308 s apart, found".to_owned(),
        Some(before) if t > before => return Ok(t),
        Some(before) => {
            let (earlier, line) = (start + before, line());
            if time > earlier {
                format!("expected a time that float64 can tell from {earlier} in line {line}, found")
            } else {
                format!("expected a time later than {earlier} in line {line}, found")
            }
        }
    };
    Err(Problem::new(format!("{problem} {time}")).hint("times must increase from row to row"))
}
