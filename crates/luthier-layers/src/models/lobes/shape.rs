//! Shapes of lobes: a density of slopes, and the wide remainder.

use std::f64::consts::PI;

use super::ViewAxis;
use super::tally::{COSINES, Tally};
use crate::least_squares::solve;

/// Points of a bin of cosines.
const STEPS: usize = 8;

/// An elliptic density of slopes, Student's in two dimensions. It integrates to 1 over all slopes.
///
/// `p(s) = (1 + t q)^-(1 + 1/t) / (pi w_0 w_1)`, `q = (u_0 / w_0)^2 + (u_1 / w_1)^2`; u is the slope from the middle along the axes of the ellipse.
/// A tail t of 0 gives a Gaussian (Beckmann's distribution), a tail of 1 the distribution of Trowbridge and Reitz (GGX). Tails below [`TAIL_MIN`]
/// count as it: at q = 7, where a Gaussian is a thousandth of its peak, the density is then 2.4 % too large.
///
/// ```
/// use luthier_layers::models::lobes::Shape;
///
/// let ggx = Shape { middle: [0.1, 0.0], width: [0.3, 0.2], turn: [1.0, 0.0], tail: 1.0 };
/// assert!((ggx.density([0.1, 0.0]) * std::f64::consts::PI * 0.3 * 0.2 - 1.0).abs() < 1e-12);
/// // One width from the middle, (1 + 1)^-2 of the peak is left.
/// assert!((ggx.density([0.4, 0.0]) / ggx.density([0.1, 0.0]) - 0.25).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// The middle: in the plane of the eye and across it, or in tangents.
    pub middle: [f64; 2],
    /// Widths along the axes.
    pub width: [f64; 2],
    /// Cosine and sine of the angle of the first axis.
    pub turn: [f64; 2],
    /// The tail t, in 0..=1.
    pub tail: f64,
}

/// The least tail: formulas divide by it.
pub const TAIL_MIN: f64 = 1.0 / 1024.0;

impl Shape {
    /// Density of a slope.
    pub fn density(&self, slope: [f64; 2]) -> f64 {
        let [x, y] = self.scaled(slope);
        let (q, tail) = (x * x + y * y, self.tail.max(TAIL_MIN));
        libm::exp(-(1.0 + 1.0 / tail) * libm::log1p(tail * q)) / (PI * self.width[0] * self.width[1])
    }

    /// A slope from the middle, in the axes of the ellipse and over its widths.
    pub(super) fn scaled(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([x, y], [cos, sin]) = ([x - self.middle[0], y - self.middle[1]], self.turn);
        [(cos * x + sin * y) / self.width[0], (cos * y - sin * x) / self.width[1]]
    }

    /// The inverse of [`Self::scaled`].
    pub(super) fn unscaled(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([x, y], [cos, sin]) = ([self.width[0] * x, self.width[1] * y], self.turn);
        [self.middle[0] + (cos * x - sin * y), self.middle[1] + (sin * x + cos * y)]
    }

    /// The shape in the plane of an eye after slopes are multiplied by the root of a symmetric matrix in tangents: along x, along y, and between them. `turn` is
    /// cosine and sine of the azimuth of the eye.
    pub(super) fn stretched(&self, [xx, yy, xy]: [f64; 3], [cos, sin]: [f64; 2]) -> Self {
        let (cos_sq, sin_sq, both) = (cos * cos, sin * sin, cos * sin);
        let along = cos_sq * xx + sin_sq * yy + 2.0 * both * xy;
        let across = sin_sq * xx + cos_sq * yy - 2.0 * both * xy;
        let between = (cos_sq - sin_sq) * xy + both * (yy - xx);
        // Cayley and Hamilton: the root of a 2 x 2 matrix M is (M + d) / sqrt(tr M + 2 d), d being the root of its determinant.
        let root_det = (along * across - between * between).max(0.0).sqrt();
        let scale = (along + across + 2.0 * root_det).sqrt();
        let [a, c, b] = [(along + root_det) / scale, (across + root_det) / scale, between / scale];
        let [first, second] = self.width.map(|width| width * width);
        let squares = [a * a * first + b * b * second, b * b * first + c * c * second, b * (a * first + c * second)];
        let (mean, half) = (0.5 * (squares[0] + squares[1]), 0.5 * (squares[0] - squares[1]));
        let radius = libm::hypot(half, squares[2]);
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(squares[2], half));
        let greater = mean + radius;
        // The product of the widths does not cancel, as the lesser one may.
        let area = self.width[0] * self.width[1] * root_det;
        let width = [greater.sqrt(), area / greater.sqrt()];
        let [x, y] = self.middle;
        Self { middle: [a * x + b * y, b * x + c * y], width, turn: [cos, sin], ..*self }
    }

    /// Reciprocal widths as a symmetric matrix: both entries of its diagonal, and the one off it.
    pub(super) fn sharpness(&self) -> [f64; 3] {
        let ([cos, sin], [first, second]) = (self.turn, self.width.map(|width| 1.0 / width));
        let (cos_sq, sin_sq) = (cos * cos, sin * sin);
        // Adding 0 turns a negative zero into 0.
        let shear = cos * sin * (first - second) + 0.0;
        [cos_sq * first + sin_sq * second, sin_sq * first + cos_sq * second, shear]
    }

    /// Share of the shape beyond a squared distance q from its middle, in widths: `(1 + t q)^-(1/t)`.
    pub(super) fn beyond(&self, q: f64) -> f64 {
        let tail = self.tail.max(TAIL_MIN);
        libm::exp(-libm::log1p(tail * q) / tail)
    }

    /// A slope for two numbers that are uniform in 0..1: the inverse of the share of slopes beyond one.
    pub fn sample(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let tail = self.tail.max(TAIL_MIN);
        let q = libm::expm1(-tail * libm::log(1.0 - u)) / tail;
        let (sin, cos) = libm::sincos(2.0 * PI * v);
        let radius = q.sqrt();
        self.unscaled([radius * cos, radius * sin])
    }
}

/// The shape of the wide remainder over the cosine mu of the light: `S(mu) = 1 - a (1 - c)^5 - b (1 - c)^2`, not below 0. c is mu, or the cosine
/// inside ([`ViewAxis::inside`]) if there is a critical angle.
///
/// The fifth power is Schlick's, for light that crosses an interface; the square is for whatever else darkens grazing light.
///
/// ```
/// use luthier_layers::models::lobes::{Critical, ViewAxis, Wide};
///
/// let wide = Wide::new([0.7, 0.2], ViewAxis::new(2, Critical::default()));
/// assert!((wide.value(0.5) - (1.0 - 0.7 / 32.0 - 0.2 / 4.0)).abs() < 1e-12);
/// // 2 int mu S = 1 - a / 21 - b / 6.
/// assert!((wide.integral() - (1.0 - 0.7 / 21.0 - 0.2 / 6.0)).abs() < 1e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Wide {
    falloff: [f64; 2],
    axis: ViewAxis,
    integral: f64,
}

impl Wide {
    /// The coefficients a and b.
    pub fn falloff(&self) -> [f64; 2] {
        self.falloff
    }

    /// S at a cosine of the light.
    pub fn value(&self, cos_theta: f64) -> f64 {
        let rest = 1.0 - self.axis.inside(cos_theta);
        let square = rest * rest;
        (1.0 - self.falloff[0] * (square * square * rest) - self.falloff[1] * square).max(0.0)
    }

    /// Slopes of S by a and by b, wherever S is above 0.
    pub(super) fn slopes(&self, cos_theta: f64) -> [f64; 2] {
        let rest = 1.0 - self.axis.inside(cos_theta);
        let square = rest * rest;
        [-square * square * rest, -square]
    }

    /// The shape of two coefficients over the cosine of an axis.
    pub fn new(falloff: [f64; 2], axis: ViewAxis) -> Self {
        let mut wide = Self { falloff, axis, integral: 1.0 };
        wide.integral = wide.mean(|wide, cos_theta| wide.value(cos_theta));
        wide
    }

    /// The shape of other coefficients over the same axis. They have to leave S above 0 everywhere: its integral is then linear in them, which saves
    /// the quadrature.
    #[must_use]
    pub fn of_base(self, falloff: [f64; 2]) -> Self {
        let [fifth, square] = self.moments();
        Self { falloff, integral: 1.0 - falloff[0] * fifth - falloff[1] * square, ..self }
    }

    /// The integrals of `(1 - c)^5 mu / pi` and `(1 - c)^2 mu / pi` over the hemisphere.
    pub fn moments(&self) -> [f64; 2] {
        // Over the cosine itself: 2 int (1 - mu)^k mu = 2 / ((k + 1) (k + 2)).
        if self.axis.critical().cot_sq == 0.0 {
            return [1.0 / 21.0, 1.0 / 6.0];
        }
        [0, 1].map(|power: usize| self.mean(|wide, cos_theta| -wide.slopes(cos_theta)[power]))
    }

    /// The mean of a function over the squared cosine, by the midpoint rule.
    fn mean(&self, of: impl Fn(&Self, f64) -> f64) -> f64 {
        const POINTS: u32 = 256;
        let sum: f64 = (0..POINTS).map(|i| of(self, ((f64::from(i) + 0.5) / f64::from(POINTS)).sqrt())).sum();
        sum / f64::from(POINTS)
    }

    /// Coefficients of the shape nearest to the light of a Lambertian base, by least squares over the cosine of that light; `None` without such light.
    /// Its shape does not depend on the view, so all views are added up.
    pub(super) fn falloff_of(axis: ViewAxis, views: &[Tally]) -> Option<[f64; 2]> {
        Self::nearest(axis, views, |[one, fifth, square]| vec![one, fifth, square])
            .map(|found| [found[1] / found[0], found[2] / found[0]])
    }

    /// [`Self::falloff_of`] with a given b.
    pub(super) fn fall_of(axis: ViewAxis, views: &[Tally], square: f64) -> Option<[f64; 2]> {
        Self::nearest(axis, views, |[one, fifth, second]| vec![one + square * second, fifth])
            .map(|found| [found[1] / found[0], square])
    }

    /// Factors on terms, made of a constant and both powers of [`Self::value`], whose sum is nearest to the light of all views.
    fn nearest(axis: ViewAxis, views: &[Tally], terms_of: impl Fn([f64; 3]) -> Vec<f64>) -> Option<Vec<f64>> {
        let mut light = [0.0; COSINES];
        for by_cosine in views.iter().filter_map(|view| view.by_cosine.as_ref()) {
            light.iter_mut().zip(by_cosine).for_each(|(sum, energy)| *sum += energy);
        }
        let total: f64 = light.iter().sum();
        let shape = Self { falloff: [0.0; 2], axis, integral: 1.0 };
        let count = terms_of([0.0; 3]).len();
        let (mut matrix, mut right) = (vec![vec![0.0; count]; count], vec![0.0; count]);
        for (bin, light) in light.iter().enumerate() {
            let of_cosine = over_bin(bin, |_| 1.0);
            let [fifth, square] = [0, 1].map(|power: usize| over_bin(bin, |mu| shape.slopes(mu)[power]));
            let terms = terms_of([of_cosine, fifth, square]);
            for (i, own) in terms.iter().enumerate() {
                right[i] += own * light / total / of_cosine;
                terms.iter().zip(&mut matrix[i]).for_each(|(other, sum)| *sum += own * other / of_cosine);
            }
        }
        let found = solve(matrix, right);
        (total > 0.0 && found[0] > 0.0).then_some(found)
    }

    /// The integral of `S(mu) mu / pi` over the hemisphere; within 1e-4.
    pub fn integral(&self) -> f64 {
        self.integral
    }
}

/// The integral of a function of the cosine mu over a bin of cosines, with weight 2 mu.
fn over_bin(bin: usize, of: impl Fn(f64) -> f64) -> f64 {
    let points = (0..STEPS).map(|i| (bin as f64 + (i as f64 + 0.5) / STEPS as f64) / COSINES as f64);
    points.map(|mu| 2.0 * mu * of(mu)).sum::<f64>() / (STEPS * COSINES) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::lobes::Critical;
    use luthier_optics::microfacet;
    use luthier_optics::stack::Distribution;

    /// Oracle: the distributions of facets, whose densities of slopes are `D cos^4`.
    #[test]
    fn the_ends_of_the_tail_are_the_two_distributions() {
        for (tail, distribution) in [(0.0, Distribution::Beckmann), (1.0, Distribution::Ggx)] {
            for alpha in [0.05, 0.4] {
                let shape = Shape { middle: [0.0; 2], width: [alpha; 2], turn: [1.0, 0.0], tail };
                for slope in [0.0, 0.02, 0.3, 1.5] {
                    let cos_sq: f64 = 1.0 / (1.0 + slope * slope);
                    let d = microfacet::distribution(distribution, alpha, cos_sq.sqrt(), 1.0 - cos_sq);
                    let expected = d * cos_sq * cos_sq;
                    let found = shape.density([0.6 * slope, 0.8 * slope]);
                    assert!(
                        (found / expected - 1.0).abs() <= if tail == 0.0 { 0.05 } else { 1e-9 } || expected < 1e-3,
                        "{tail} {slope}: {found} {expected}"
                    );
                }
            }
        }
    }

    /// Oracle: the density of slopes that are multiplied by the root of the matrix is the density of what they were, over the determinant.
    #[test]
    fn stretched_shapes_are_those_of_stretched_slopes() {
        let plain = Shape { middle: [0.3, 0.0], width: [0.2, 0.4], turn: [1.0, 0.0], tail: 0.7 };
        // Twice and half as wide along axes at .6 from the tangent; the eye is at an azimuth of 1.1.
        let ([c, s], [cos, sin]) = ([0.6_f64, 1.1].map(libm::cos), [0.6_f64, 1.1].map(libm::sin));
        let [[c, cos], [s, sin]] = [[c, s], [cos, sin]];
        let matrix = |first: f64, second: f64| {
            [c * c * first + s * s * second, s * s * first + c * c * second, c * s * (first - second)]
        };
        let (squares, root) = (matrix(4.0, 0.25), matrix(2.0, 0.5));
        let stretched = plain.stretched(squares, [cos, sin]);
        for slope in [[0.0, 0.0], [0.4, 0.1], [0.2, -0.5]] {
            // To tangents, multiplied, and back to the plane of the eye.
            let [x, y] = [cos * slope[0] - sin * slope[1], sin * slope[0] + cos * slope[1]];
            let [x, y] = [root[0] * x + root[2] * y, root[2] * x + root[1] * y];
            let there = [cos * x + sin * y, cos * y - sin * x];
            let (found, expected) = (stretched.density(there), plain.density(slope));
            assert!((found / expected - 1.0).abs() < 1e-9, "{slope:?}: {found} {expected}");
        }
        let same = plain.stretched([1.0, 1.0, 0.0], [cos, sin]);
        assert!((same.density([0.1, 0.2]) / plain.density([0.1, 0.2]) - 1.0).abs() < 1e-12);
    }

    /// Samples fall into each ring as often as the density says; the ring's share is counted by the midpoint rule.
    #[test]
    fn samples_follow_the_density() {
        for tail in [0.0, 0.3, 1.0] {
            let shape = Shape { middle: [0.2, 0.0], width: [0.5, 0.1], turn: [1.0, 0.0], tail };
            let side = 400;
            let (mut sampled, mut expected) = ([0.0; 4], [0.0; 4]);
            let ring = |[x, y]: [f64; 2]| ((((x - 0.2) / 0.5).abs() + (y / 0.1).abs()) * 2.0) as usize;
            for i in 0..side * side {
                let u = [f64::from(i % side) + 0.5, f64::from(i / side) + 0.5].map(|u| u / f64::from(side));
                if let Some(count) = sampled.get_mut(ring(shape.sample(u))) {
                    *count += 1.0 / f64::from(side * side);
                }
                // Sides that no edge of a ring divides evenly.
                let at = [0.2 + 2.03 * (2.0 * u[0] - 1.0), 0.41 * (2.0 * u[1] - 1.0)];
                if let Some(share) = expected.get_mut(ring(at)) {
                    *share += shape.density(at) * 4.06 * 0.82 / f64::from(side * side);
                }
            }
            for (a, b) in sampled.iter().zip(expected) {
                assert!((a - b).abs() < 2e-3, "{tail}: {sampled:?} {expected:?}");
            }
        }
    }

    /// Oracle: by hand, `2 int mu S = 1 - a / 21 - b / 6`.
    #[test]
    fn the_wide_shape_integrates() {
        let wide = Wide::new([0.7, 0.2], ViewAxis::new(2, Critical::default()));
        assert!((wide.integral() - (1.0 - 0.7 / 21.0 - 0.2 / 6.0)).abs() < 1e-4, "{}", wide.integral());
        assert_eq!(Wide::new([0.0, 2.0], ViewAxis::new(2, Critical::default())).value(0.1), 0.0);
    }
}
