//! Perlin's gradient noise, summed over octaves: one for tables, and one that shaders repeat.

use std::f64::consts::SQRT_2;

use glam::DVec2;
use noise::NoiseFn;

use super::hash;

/// Octaves of Perlin's noise, with their tables made: each doubles the frequency of the one before it and halves the amplitude.
#[derive(Debug, Clone)]
pub struct Octaves(Vec<noise::Perlin>);

impl Octaves {
    /// The octaves of a seed. Each further octave has the next number as seed.
    pub fn new(seed: u32, count: u32) -> Self {
        Self((0..count).map(|octave| noise::Perlin::new(seed.wrapping_add(octave))).collect())
    }

    /// The sum of the octaves at a place of the plane, in lattice cells of the first octave, which has amplitude 1.
    pub fn in_plane(&self, place: DVec2) -> f64 {
        self.sum(place.to_array())
    }

    /// The sum of the octaves in four dimensions, in which a plane that repeats is a torus.
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

/// Perlin's noise (Perlin 2002, in the plane), summed over octaves. Its gradients are numbers of the lattice's cells, which shaders
/// repeat bit by bit: `luthier_perlin`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perlin {
    /// Seed of the first octave; each has the next number.
    pub seed: u32,
    /// Lattice cells per unit of length in the first octave; each octave doubles it and halves the amplitude.
    pub frequency: f64,
    /// Number of octaves.
    pub octaves: u32,
}

impl Perlin {
    /// The noise at a place: mean 0, within -1..=1, zero at the lattice points of the first octave, and everywhere without octaves.
    pub fn at(&self, uv: DVec2) -> f64 {
        let (mut place, mut amplitude) = (uv * self.frequency, 1.0);
        let (mut sum, mut total) = (0.0, 0.0);
        for octave in 0..self.octaves {
            sum += amplitude * gradients(self.seed.wrapping_add(octave), place);
            total += amplitude;
            place *= 2.0;
            amplitude *= 0.5;
        }
        if total > 0.0 { sum / total } else { 0.0 }
    }
}

/// One octave: the four gradients around a place, blended by quintic curves.
fn gradients(seed: u32, p: DVec2) -> f64 {
    let (x, y) = (hash::floor(p.x), hash::floor(p.y));
    let t = p - DVec2::new(x as f64, y as f64);
    let [s, r] = [t.x, t.y].map(|t| t * t * t * (t * (6.0 * t - 15.0) + 10.0));
    let [near, beside, far, across] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j): (i64, i64)| {
        let word = hash::cell(seed, x.saturating_add(i), y.saturating_add(j));
        rise(word, t - DVec2::new(i as f64, j as f64))
    });
    let [near, far] = [near + (beside - near) * s, far + (across - far) * s];
    near + (far - near) * r
}

/// Rise from a lattice point to a place: its gradient is one of eight, 45 degrees apart and of length sqrt(2).
fn rise(word: u32, offset: DVec2) -> f64 {
    let turn = (hash::unit(word, 0) * 8.0) as u32;
    let [along, across] = [2, 4].map(|bit| if turn & bit == 0 { -1.0 } else { 1.0 });
    match turn & 1 {
        0 => along * offset.x + across * offset.y,
        _ => SQRT_2 * (across * if turn & 2 == 0 { offset.x } else { offset.y }),
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
                // Steeper than 1.875 * 2 + sqrt(2) = 5.2 per unit along each axis it never gets.
                assert!((noise.at(p + DVec2::new(1e-6, 1e-6)) - value).abs() < 1.04e-5);
            }
        }
        assert!(most <= 1.0 && most > 0.5, "{most}");
        assert!((sum / 90_000.0).abs() < 0.05, "{sum}");
    }
    /// Slopes are those of the gradients: at lattice points they are one of the eight, all as likely, and continuous across edges of cells.
    #[test]
    fn slopes_at_lattice_points_are_the_gradients() {
        let noise = Perlin { seed: 5, frequency: 1.0, octaves: 1 };
        let step = 1e-6;
        let mut counts = [0u32; 8];
        for i in 0..4000 {
            let p = DVec2::new(f64::from(i % 50 - 25), f64::from(i / 50 - 25));
            let rise = |d: DVec2| (noise.at(p + step * d) - noise.at(p - step * d)) / (2.0 * step);
            let slope = DVec2::new(rise(DVec2::X), rise(DVec2::Y));
            let ahead = DVec2::new(noise.at(p + step * DVec2::X), noise.at(p + step * DVec2::Y)) / step;
            assert!((slope - ahead).length() < 1e-5 && (slope.length() - SQRT_2).abs() < 1e-5, "{p}: {slope} {ahead}");
            let eighth = slope.to_angle() / std::f64::consts::FRAC_PI_4;
            assert!((eighth - eighth.round()).abs() < 1e-5, "{p}: {slope}");
            counts[(eighth.round() as i32).rem_euclid(8) as usize] += 1;
        }
        // 500 of each, within four standard errors of 21.
        assert!(counts.iter().all(|count| (415..585).contains(count)), "{counts:?}");
    }

    /// Far from the origin and at seeds that wrap, too.
    #[test]
    fn octaves_are_the_sum_of_single_ones() {
        let at = |seed, frequency, octaves, uv| Perlin { seed, frequency, octaves }.at(uv);
        for i in 0..200 {
            let uv = DVec2::new(hash::unit(i, 0), hash::unit(i, 1)) * 1e4 - 5e3;
            let single = [0, 1, 2].map(|n| at(u32::MAX.wrapping_add(n), 3.0 * libm::exp2(f64::from(n)), 1, uv));
            let sum = (single[0] + 0.5 * single[1] + 0.25 * single[2]) / 1.75;
            assert_eq!(at(u32::MAX, 3.0, 3, uv), sum, "{uv}");
        }
        assert_eq!(at(1, 3.0, 0, DVec2::new(0.3, 0.7)), 0.0);
    }
}
