//! Random numbers as a function of a place.

/// A well-mixed word for a lattice cell: the finaliser of SplitMix64 (Steele, Lea and Flood 2014) over the coordinates.
pub(crate) fn cell(seed: u32, x: i64, y: i64) -> u64 {
    let start = mix(u64::from(seed) ^ 0x9e37_79b9_7f4a_7c15);
    mix(mix(start ^ x.cast_unsigned()).wrapping_add(y.cast_unsigned()))
}

/// The number `index` of a cell, in 0..1.
pub(crate) fn unit(cell: u64, index: u64) -> f64 {
    let word = mix(cell.wrapping_add((index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    (word >> 11) as f64 / (1u64 << 53) as f64
}

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The lattice coordinate below `x`; saturates far out, 0 for what is not a number.
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
