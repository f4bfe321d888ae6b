//! Perlin's gradient noise, summed over octaves.

use glam::DVec2;
use noise::NoiseFn;

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
        let (mut sum, mut total, mut amplitude) = (0.0, 0.0, 1.0);
        let mut p = uv * self.frequency;
        for octave in 0..self.octaves {
            sum += amplitude * noise::Perlin::new(self.seed.wrapping_add(octave)).get([p.x, p.y]);
            total += amplitude;
            amplitude *= 0.5;
            p *= 2.0;
        }
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
