//! Random numbers as a function of a seed, a path and a count.

use glam::DVec2;
use luthier_optics::sampling::split_mix::{GOLDEN, mix};

/// The random numbers of one path. The k-th is a hash of (seed, path, k), whatever other paths do. An even stream takes its first numbers from a
/// sequence instead.
#[derive(Debug, Clone)]
pub(crate) struct Stream {
    counter: u64,
    /// Number of the path in the sequence.
    place: u64,
    /// Index of the next of [`STEPS`]; beyond the last one numbers are hashes.
    dimension: usize,
    seed: u64,
}

/// Fractions of the square roots of primes, times 2^64 (Richtmyer 1951). Multiples of one fill the unit interval evenly, and multiples of all
/// together fill the unit cube.
const STEPS: [u64; 16] = [
    0x6a09_e667_f3bc_c908,
    0xbb67_ae85_84ca_a73b,
    0x3c6e_f372_fe94_f82b,
    0xa54f_f53a_5f1d_36f1,
    0x510e_527f_ade6_82d1,
    0x9b05_688c_2b3e_6c1f,
    0x1f83_d9ab_fb41_bd6b,
    0x5be0_cd19_137e_2179,
    0xcbbb_9d5d_c105_9ed8,
    0x629a_292a_367c_d507,
    0x9159_015a_3070_dd17,
    0x152f_ecd8_f70e_5939,
    0x6733_2667_ffc0_0b31,
    0x8eb4_4a87_6858_1511,
    0xdb0c_2e0d_64f9_8fa7,
    0x47b5_481d_befa_4fa4,
];

impl Stream {
    /// The stream of a path.
    pub(crate) fn new(seed: u64, path: u64) -> Self {
        let counter = mix(mix(seed.wrapping_add(GOLDEN)).wrapping_add(path.wrapping_mul(GOLDEN)));
        Self { counter, place: 0, dimension: STEPS.len(), seed: 0 }
    }

    /// The stream of a path whose first numbers come from a sequence, shifted by the seed: means over many paths have less noise.
    pub(crate) fn even(seed: u64, path: u64) -> Self {
        Self { place: path + 1, dimension: 0, seed: mix(seed.wrapping_add(GOLDEN)), ..Self::new(seed, path) }
    }

    /// A seed from a seed and a number.
    pub(crate) fn hash(seed: u64, number: u64) -> u64 {
        mix(mix(seed.wrapping_add(GOLDEN)) ^ number.wrapping_mul(GOLDEN))
    }

    #[inline]
    fn next(&mut self) -> u64 {
        if let Some(step) = STEPS.get(self.dimension) {
            self.dimension += 1;
            let shift = mix(self.seed.wrapping_add((self.dimension as u64).wrapping_mul(GOLDEN)));
            return self.place.wrapping_mul(*step).wrapping_add(shift);
        }
        self.counter = self.counter.wrapping_add(GOLDEN);
        mix(self.counter)
    }

    /// Uniform in 0..1, 1 excluded, in steps of 2^-53.
    #[inline]
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A uniform direction in the plane, and a number uniform in 0..1 that is independent of it.
    ///
    /// A point of the unit disc by rejection: its squared radius is uniform, and doubling its angle needs no root
    /// (Marsaglia 1972 for the disc).
    #[inline]
    pub(crate) fn direction_and_uniform(&mut self) -> (DVec2, f64) {
        if self.dimension < STEPS.len() {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * self.uniform());
            return (DVec2::new(cos, sin), self.uniform());
        }
        loop {
            // Two numbers of 32 bits at the middles of their steps, from -1 to 1.
            let bits = self.next();
            let [x, y] = [bits >> 32, bits & 0xffff_ffff].map(|half| half as f64 + 0.5);
            let p = DVec2::new(x, y) * (1.0 / (1u64 << 31) as f64) - 1.0;
            let r_sq = p.length_squared();
            if r_sq < 1.0 {
                return (DVec2::new(p.x * p.x - p.y * p.y, 2.0 * p.x * p.y) / r_sq, r_sq);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_neighbouring_paths_are_uniform_and_uncorrelated() {
        let n = 100_000u64;
        let first: Vec<f64> = (0..n).map(|i| Stream::new(7, i).uniform()).collect();
        let mean = first.iter().sum::<f64>() / n as f64;
        let product = first.windows(2).map(|w| (w[0] - 0.5) * (w[1] - 0.5)).sum::<f64>() / n as f64;
        // Standard errors: sqrt(1/12 / n) and 1/12 / sqrt(n).
        assert!((mean - 0.5).abs() < 4.0 * 9.2e-4, "{mean}");
        assert!(product.abs() < 4.0 * 2.7e-4, "{product}");
    }

    /// Oracle: the integral of a product of six numbers, (1/2)^6. Independent numbers miss it by 2.7e-4 on average.
    #[test]
    fn even_numbers_fill_the_cube() {
        let n = 16_000u64;
        for seed in 0..4 {
            let product = |i| {
                let mut stream = Stream::even(seed, i);
                (0..6).map(|_| stream.uniform()).product::<f64>()
            };
            let mean = (0..n).map(product).sum::<f64>() / n as f64;
            assert!((mean - 1.0 / 64.0).abs() < 1.3e-4, "{seed}: {mean}");
        }
        // Behind the sequence they are independent.
        let mut stream = Stream::even(1, 2);
        (0..STEPS.len()).for_each(|_| assert!(stream.uniform() < 1.0));
        assert_eq!(stream.uniform(), Stream::new(1, 2).uniform());
    }

    #[test]
    fn directions_are_isotropic_and_independent_of_the_number() {
        let mut stream = Stream::new(1, 2);
        let n = 100_000;
        let (mut moments, mut mean) = ([0.0; 4], 0.0);
        for _ in 0..n {
            let (d, u) = stream.direction_and_uniform();
            assert!((d.length() - 1.0).abs() < 1e-12 && u < 1.0);
            mean += u / f64::from(n);
            for (m, v) in moments.iter_mut().zip([d.x, d.y, d.x * d.y, (d.x * d.x - 0.5) * (u - 0.5)]) {
                *m += v / f64::from(n);
            }
        }
        assert!((mean - 0.5).abs() < 4e-3);
        assert!(moments.iter().all(|m| m.abs() < 4.0 * 0.71 / 316.0), "{moments:?}");
    }
}
