//! sRGB to linear light and back, exactly the same on every machine.
//!
//! Both ways are tables made when the crate is compiled, from nothing but the
//! four operations: the curve's power 2.4 is x²·(x²)^⅕, its root by Newton's
//! method. A level is chosen by the linear value half way to the next one.

/// Linear light of each 8-bit sRGB level.
pub(crate) const LINEAR: [f32; 256] = linear_levels();
/// The least linear light that is shown as each level.
const THRESHOLD: [f32; 256] = thresholds();
/// Evenly spaced starting points for the search in [`THRESHOLD`].
const STEPS: usize = 4096;
const START: [u8; STEPS] = starts();

/// The 8-bit sRGB level nearest to linear light, in sRGB's own steps.
pub(crate) fn encode(linear: f32) -> u8 {
    // `clamp` would keep a NaN, which the cast turns into black.
    let linear = linear.clamp(0.0, 1.0);
    let mut level = START[(linear * (STEPS - 1) as f32) as usize];
    while level < 255 && linear >= THRESHOLD[level as usize + 1] {
        level += 1;
    }
    level
}

/// Linear light of an sRGB value from 0 to 1.
const fn decode(srgb: f64) -> f64 {
    if srgb <= 0.04045 {
        return srgb / 12.92;
    }
    let x = (srgb + 0.055) / 1.055;
    x * x * fifth_root(x * x)
}

const fn fifth_root(x: f64) -> f64 {
    let mut root = 1.0;
    let mut i = 0;
    while i < 64 {
        let fourth = root * root * root * root;
        root = (4.0 * root + x / fourth) / 5.0;
        i += 1;
    }
    root
}

const fn linear_levels() -> [f32; 256] {
    let mut table = [0.0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = decode(i as f64 / 255.0) as f32;
        i += 1;
    }
    table
}

const fn thresholds() -> [f32; 256] {
    let mut table = [0.0; 256];
    let mut i = 1;
    while i < 256 {
        table[i] = decode((i as f64 - 0.5) / 255.0) as f32;
        i += 1;
    }
    table
}

const fn starts() -> [u8; STEPS] {
    let mut table = [0; STEPS];
    let mut level = 0;
    let mut i = 0;
    while i < STEPS {
        let linear = i as f32 / STEPS as f32;
        while level < 255 && linear >= THRESHOLD[level + 1] {
            level += 1;
        }
        table[i] = level as u8;
        i += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_srgbs() {
        for i in 0..=255_u8 {
            let srgb = f64::from(i) / 255.0;
            let expected = if srgb <= 0.04045 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) };
            assert!((f64::from(LINEAR[i as usize]) - expected).abs() < 1e-7);
        }
    }

    #[test]
    fn levels_survive_the_way_there_and_back() {
        for i in 0..=255_u8 {
            assert_eq!(encode(LINEAR[i as usize]), i);
        }
    }

    #[test]
    fn every_light_gets_the_nearest_level() {
        for i in 0..=100_000 {
            let linear = f64::from(i) / 1e5;
            let srgb =
                if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
            let level = f64::from(encode(linear as f32));
            assert!((level - srgb * 255.0).abs() < 0.5 + 1e-3, "{linear}");
        }
        assert_eq!((encode(-1.0), encode(2.0), encode(f32::NAN)), (0, 255, 0));
    }
}
