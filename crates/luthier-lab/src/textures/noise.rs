//! Noise and lines that repeat over the unit square, from whole numbers and `libm` alone.

/// Gradient noise over a lattice that repeats, summed over octaves: mean 0, mostly within -1..=1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noise {
    pub(super) seed: u32,
    /// Lattice cells of the first octave along u and along v; further octaves double them and halve the amplitude.
    pub(super) cells: [u32; 2],
    pub(super) octaves: u32,
}

impl Noise {
    pub(super) fn at(&self, [u, v]: [f64; 2]) -> f64 {
        let (mut sum, mut amplitude) = (0.0, 1.0);
        for octave in 0..self.octaves {
            let cells = self.cells.map(|cells| cells << octave);
            sum += amplitude * gradients(self.seed.wrapping_add(octave), cells, [u, v]);
            amplitude *= 0.5;
        }
        // One octave stays within sqrt(1/2).
        sum * std::f64::consts::SQRT_2 / (2.0 - 2.0 * amplitude)
    }
}

/// One octave: the gradients of four lattice points, blended by quintic curves (Perlin 2002).
fn gradients(seed: u32, cells: [u32; 2], place: [f64; 2]) -> f64 {
    let axes = [0, 1].map(|i: usize| {
        let x = place[i] * f64::from(cells[i]);
        let low = x.floor();
        ([low as i64, low as i64 + 1].map(|c| c.rem_euclid(i64::from(cells[i])) as u32), x - low)
    });
    let [(columns, s), (rows, t)] = axes;
    let corner = |i: usize, j: usize| {
        let angle = std::f64::consts::TAU * unit(seed, [columns[i], rows[j]]);
        let (sin, cos) = libm::sincos(angle);
        cos * (s - i as f64) + sin * (t - j as f64)
    };
    let [a, b] = [s, t].map(|x| x * x * x * (x * (6.0 * x - 15.0) + 10.0));
    mix(mix(corner(0, 0), corner(1, 0), a), mix(corner(0, 1), corner(1, 1), a), b)
}

/// A random number in 0..1 of two whole numbers.
pub(super) fn unit(seed: u32, [x, y]: [u32; 2]) -> f64 {
    let word = hashed(hashed(hashed(seed).wrapping_add(x)).wrapping_add(y));
    f64::from(word >> 8) / f64::from(1u32 << 24)
}

/// PCG's output function after one step (Jarzynski and Olano 2020).
fn hashed(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

pub(super) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// 0 below `from`, 1 above `to`, smooth between.
pub(super) fn step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A straight line on the unit square, which goes on at the other side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    middle: [f64; 2],
    along: [f64; 2],
    half_length: f64,
    pub(super) depth: f64,
}

impl Line {
    /// The n-th random line of a seed, with a length between two numbers.
    pub(super) fn random(seed: u32, n: u32, lengths: [f64; 2]) -> Self {
        let number = |index| unit(seed, [n, index]);
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * number(2));
        // Few lines are long, and few are deep.
        let [long, deep] = [3, 4].map(|index| number(index) * number(index));
        Self {
            middle: [number(0), number(1)],
            along: [cos, sin],
            half_length: 0.5 * mix(lengths[0], lengths[1], long),
            depth: mix(0.25, 1.0, deep),
        }
    }

    /// Distance of a place from the line.
    pub(super) fn distance(&self, place: [f64; 2]) -> f64 {
        // To the nearest copy of the middle: lines are shorter than half the square.
        let away = [0, 1].map(|i: usize| {
            let x = place[i] - self.middle[i];
            x - (x + 0.5).floor()
        });
        let at = (away[0] * self.along[0] + away[1] * self.along[1]).clamp(-self.half_length, self.half_length);
        let [x, y] = [0, 1].map(|i: usize| away[i] - at * self.along[i]);
        libm::sqrt(x * x + y * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_repeats() {
        let noise = Noise { seed: 7, cells: [3, 5], octaves: 3 };
        let line = Line::random(3, 2, [0.1, 0.4]);
        for place in [[0.0, 0.3], [0.25, 0.0], [0.9, 0.7]] {
            for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-2.0, 3.0)] {
                let moved = [place[0] + x, place[1] + y];
                assert!((noise.at(place) - noise.at(moved)).abs() < 1e-12);
                assert!((line.distance(place) - line.distance(moved)).abs() < 1e-12);
            }
        }
    }

    /// Gradient noise is 0 at lattice points, and neither it nor its octaves leave -1..=1.
    #[test]
    fn noise_is_around_nothing() {
        let noise = Noise { seed: 1, cells: [4, 4], octaves: 1 };
        assert_eq!(noise.at([0.25, 0.75]), 0.0);
        let all = Noise { octaves: 4, ..noise };
        let values = (0..4096).map(|i| all.at([f64::from(i % 64) / 64.0, f64::from(i / 64) / 64.0]));
        let (low, high) = values.fold((0.0, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
        assert!((-1.0..-0.3).contains(&low) && (0.3..=1.0).contains(&high), "{low} {high}");
    }
}
