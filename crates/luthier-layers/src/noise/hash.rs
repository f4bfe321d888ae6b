//! Random numbers as a function of a place, in 32-bit arithmetic that shaders repeat bit by bit.

/// A well-mixed word for a lattice cell. Coordinates count modulo 2^32.
pub(crate) fn cell(seed: u32, x: i64, y: i64) -> u32 {
    mix(mix(mix(seed).wrapping_add(x as u32)).wrapping_add(y as u32))
}

/// The number `index` of a cell: a multiple of 2^-24 in 0..1, which f32 holds exactly.
pub(crate) fn unit(cell: u32, index: u32) -> f64 {
    let word = mix(cell.wrapping_add(index.wrapping_mul(0x9e37_79b9)));
    f64::from(word >> 8) / f64::from(1u32 << 24)
}

/// PCG's output function after one step (Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020, section 2).
fn mix(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// The lattice coordinate below `x`; saturates far out, and is 0 for NaN.
pub(crate) fn floor(x: f64) -> i64 {
    x.floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_uniform_and_neighbours_unrelated() {
        let n = 200;
        let all: Vec<f64> = (0..n).flat_map(|x| (0..n).map(move |y| unit(cell(3, x - 100, y), 0))).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let covariance = all.windows(2).map(|w| (w[0] - 0.5) * (w[1] - 0.5)).sum::<f64>() / all.len() as f64;
        // Standard errors over 40 000 numbers: 1/sqrt(12 n) and 1/(12 sqrt n).
        assert!((mean - 0.5).abs() < 4.0 * 0.00145, "{mean}");
        assert!(covariance.abs() < 4.0 * 0.00042, "{covariance}");
        assert!(all.iter().all(|u| (0.0..1.0).contains(u)));
    }
}
