//! Perlin's gradient noise, summed over octaves.

use glam::DVec2;
use noise::NoiseFn;

/// Octaves of Perlin's noise, with their tables made: each doubles the frequency of the one before it and halves the amplitude.
#[derive(Debug, Clone)]
pub struct Octaves(Vec<noise::Perlin>);

impl Octaves {
    /// The octaves of a seed; each has a seed of its own, the next number.
    pub fn new(seed: u32, count: u32) -> Self {
        Self((0..count).map(|octave| noise::Perlin::new(seed.wrapping_add(octave))).collect())
    }

    /// Their sum at a place of the plane, in lattice cells of the first octave, which has amplitude 1.
    pub fn in_plane(&self, place: DVec2) -> f64 {
        self.sum(place.to_array())
    }

    /// Their sum in four dimensions, where a plane that repeats is a torus.
    pub fn in_four_dimensions(&self, place: [f64; 4]) -> f64 {
        self.sum(place)
    }

    fn sum<const N: usize>(&self, mut place: [f64; N]) -> f64
    where
        noise::Perlin: NoiseFn<f64, N>,
    {
        let (mut sum, mut amplitude) = (0.0, 1.0);
        for octave in &self.0 {
            sum += amplitude * octave.get(place);
            place = place.map(|x| 2.0 * x);
            amplitude *= 0.5;
        }
        sum
    }
}

/// Perlin's noise, summed over octaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perlin {
    /// Seed of the noise.
    pub seed: u32,
    /// Lattice cells per unit of length in the first octave; each octave doubles it and halves the amplitude.
    pub frequency: f64,
    /// Number of octaves.
    pub octaves: u32,
}

impl Perlin {
    /// The noise at a place: mean 0, within -1..=1, zero at the lattice points of a single octave.
    pub fn at(&self, uv: DVec2) -> f64 {
        // The sum of the amplitudes.
        let total = 2.0 * (1.0 - libm::exp2(-f64::from(self.octaves)));
        let sum = Octaves::new(self.seed, self.octaves).in_plane(uv * self.frequency);
        if total > 0.0 { sum / total } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_vanishes_on_the_lattice_and_stays_in_range_and_smooth() {
        let noise = Perlin { seed: 1, frequency: 1.0, octaves: 1 };
        let rough = Perlin { seed: 1, frequency: 3.0, octaves: 5 };
        let (mut sum, mut most) = (0.0, 0.0f64);
        for i in -150..150 {
            assert_eq!(noise.at(DVec2::new(f64::from(i), f64::from(-2 * i))), 0.0);
            for j in -150..150 {
                let p = DVec2::new(f64::from(i) * 0.0731, f64::from(j) * 0.0517);
                let value = noise.at(p);
                most = most.max(value.abs()).max(rough.at(p).abs());
                sum += value;
                // Steeper than 4 per unit along each axis it never gets.
                assert!((noise.at(p + DVec2::new(1e-6, 1e-6)) - value).abs() < 8e-6);
            }
        }
        assert!(most <= 1.0 && most > 0.5, "{most}");
        assert!((sum / 90_000.0).abs() < 0.05, "{sum}");
    }
}
