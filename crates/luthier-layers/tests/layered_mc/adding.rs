//! Rough stacks against adding of matrices over directions (van de Hulst 1980, "Multiple Light Scattering", ch. 4-5).
//!
//! Each interface is one matrix per Fourier mode of the azimuth; no random numbers are involved.
//!
//! With `A` the base and `B` the underside of the coat, both followed by a slab, light from `wo` that reaches the base comes
//! back with `t (1 - A B)^-1 A u`: the geometric series of all bounces. Interfaces are written out here from Walter et al.
//! 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 16, 20, 21 and 33, with the masking of the one-facet
//! mode. Nothing but Gauss points comes from the crates under test.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_layers::references::layered_mc::InterfaceMode;
use luthier_optics::quadrature::gauss_legendre;

use crate::scenes::{at, conductor, dielectric, ggx, lambert, mc};

/// GGX's D, eq. 33.
fn density(alpha: f64, m: DVec3) -> f64 {
    let cos_sq = m.z * m.z;
    let tan_sq = (1.0 - cos_sq) / cos_sq;
    let sum = alpha * alpha + tan_sq;
    alpha * alpha / (PI * cos_sq * cos_sq * sum * sum)
}

/// `1 / (1 + Lambda_a + Lambda_b)`.
fn masking(alpha: f64, cos_a: f64, cos_b: f64) -> f64 {
    let root = |cos: f64| (1.0 + alpha * alpha * (1.0 - cos * cos) / (cos * cos)).sqrt();
    2.0 / (root(cos_a) + root(cos_b))
}

/// Fresnel's reflectance of a dielectric of relative index `eta`, eq. 22.
fn dielectric_reflectance(cos: f64, eta: f64) -> f64 {
    let g_sq = eta * eta - 1.0 + cos * cos;
    if g_sq <= 0.0 {
        return 1.0;
    }
    let g = g_sq.sqrt();
    let (outer, inner) = ((g - cos) / (g + cos), (cos * (g + cos) - 1.0) / (cos * (g - cos) + 1.0));
    0.5 * outer * outer * (1.0 + inner * inner)
}

/// Reflectance of a conductor of relative index `n + ik`, in real numbers (Born and Wolf, ch. 14.2).
fn conductor_reflectance(cos: f64, n: f64, k: f64) -> f64 {
    let (cos_sq, sin_sq) = (cos * cos, 1.0 - cos * cos);
    let shifted = n * n - k * k - sin_sq;
    let both = (shifted * shifted + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (both + shifted)).sqrt();
    let s = (both + cos_sq - 2.0 * a * cos) / (both + cos_sq + 2.0 * a * cos);
    let (sum, product) = (cos_sq * both + sin_sq * sin_sq, 2.0 * a * cos * sin_sq);
    0.5 * s * (1.0 + (sum - product) / (sum + product))
}

/// Eq. 20, times the cosine of `b`.
fn reflected(alpha: f64, reflectance: impl Fn(f64) -> f64, a: DVec3, b: DVec3) -> f64 {
    let m = (a + b).normalize();
    reflectance(a.dot(m).min(1.0)) * density(alpha, m) * masking(alpha, a.z, b.z) / (4.0 * a.z)
}

/// Eq. 21, times the cosine of `b`: from the medium of index `index_a` to that of `index_b`. The frame of `b` is upside down.
fn transmitted(alpha: f64, [index_a, index_b]: [f64; 2], a: DVec3, b: DVec3) -> f64 {
    let o = DVec3::new(b.x, b.y, -b.z);
    let sum = -(index_a * a + index_b * o);
    let m = sum.normalize() * sum.z.signum();
    let (cos_a, cos_o) = (a.dot(m), o.dot(m));
    if cos_a <= 0.0 || cos_o >= 0.0 {
        return 0.0;
    }
    let through = 1.0 - dielectric_reflectance(cos_a.min(1.0), index_b / index_a);
    let length = index_a * cos_a + index_b * cos_o;
    let jacobian = cos_a * -cos_o * index_b * index_b / (length * length);
    through * jacobian * density(alpha, m) * masking(alpha, a.z, b.z) / a.z
}

fn direction(cos: f64, phi: f64) -> DVec3 {
    let sin = (1.0 - cos * cos).sqrt();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

#[derive(Clone, Copy)]
enum Base {
    Conductor { alpha: f64, n: f64, k: f64 },
    Lambert { albedo: f64 },
}

/// A coat in air over a base.
#[derive(Clone, Copy)]
struct Coated {
    alpha: f64,
    ior: f64,
    optical_depth: f64,
    base: Base,
}

impl Coated {
    fn kernel_of_base(self, a: DVec3, b: DVec3) -> f64 {
        match self.base {
            Base::Conductor { alpha, n, k } => {
                reflected(alpha, |cos| conductor_reflectance(cos, n / self.ior, k / self.ior), a, b)
            }
            Base::Lambert { albedo } => albedo * b.z / PI,
        }
    }

    fn kernel_from_outside(self, a: DVec3, b: DVec3) -> f64 {
        reflected(self.alpha, |cos| dielectric_reflectance(cos, self.ior), a, b)
    }

    fn kernel_from_inside(self, a: DVec3, b: DVec3) -> f64 {
        reflected(self.alpha, |cos| dielectric_reflectance(cos, 1.0 / self.ior), a, b)
    }

    fn stack(self) -> Monochrome {
        let (surface, below): (_, MonochromeBelow) = match self.base {
            Base::Conductor { alpha, n, k } => (ggx(alpha), conductor(n, k)),
            Base::Lambert { albedo } => (ggx(0.0), lambert(albedo)),
        };
        Monochrome::bare(&[(ggx(self.alpha), dielectric(self.ior, self.optical_depth)), (surface, below)])
    }
}

type Matrix = Vec<Vec<f64>>;

/// `a x = b` for several columns, by elimination with partial pivots; `b` becomes `x`.
fn solve(mut a: Matrix, b: &mut Matrix) {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).expect("k < n");
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (row_a, row_b) = (a[k].clone(), b[k].clone());
        for i in k + 1..n {
            let factor = a[i][k] / row_a[k];
            a[i][k..].iter_mut().zip(&row_a[k..]).for_each(|(x, y)| *x -= factor * y);
            b[i].iter_mut().zip(&row_b).for_each(|(x, y)| *x -= factor * y);
        }
    }
    for k in (0..n).rev() {
        for column in 0..b[k].len() {
            let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j][column]).sum();
            b[k][column] = (b[k][column] - known) / a[k][k];
        }
    }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let row = |row: &Vec<f64>| {
        let mut sum = vec![0.0; b[0].len()];
        for (factor, line) in row.iter().zip(b) {
            sum.iter_mut().zip(line).for_each(|(s, x)| *s += factor * x);
        }
        sum
    };
    a.iter().map(row).collect()
}

/// The angles of all directions, in degrees: 0 to 75.
const ANGLES_DEG: [f64; 3] = [0.0, 45.0, 75.0];

/// Pairs of (wi, wo) at those angles.
fn pairs() -> [(DVec3, DVec3); 4] {
    [
        (at(45.0, 0.0), at(45.0, 180.0)),
        (at(0.0, 0.0), at(45.0, 90.0)),
        (at(75.0, 0.0), at(75.0, 170.0)),
        (at(45.0, 0.0), at(75.0, 40.0)),
    ]
}

/// Gauss points on each piece between breaks in 0..1.
fn pieces(points: usize, mut breaks: Vec<f64>) -> Vec<(f64, f64)> {
    breaks.extend([0.0, 1.0]);
    breaks.retain(|x| (0.0..=1.0).contains(x));
    breaks.sort_by(f64::total_cmp);
    let rule = gauss_legendre(points);
    let piece = |ends: &[f64]| {
        let (low, width) = (ends[0], ends[1] - ends[0]);
        rule.iter().map(move |(x, w)| (low + width * x, width * w)).collect::<Vec<_>>()
    };
    breaks.windows(2).flat_map(piece).collect()
}

/// Points in each piece of the cosine, and in azimuth over half a turn.
#[derive(Clone, Copy)]
struct Resolution {
    cosines: usize,
    azimuths: usize,
}

impl Resolution {
    fn doubled(self) -> Self {
        Self { cosines: 2 * self.cosines, azimuths: 2 * self.azimuths }
    }

    fn phi(self, j: usize) -> f64 {
        PI * (j as f64 + 0.5) / self.azimuths as f64
    }

    /// Fourier modes of the azimuth `[mode][from][to]`: integrals of `kernel cos(mode phi)` over the circle.
    fn modes(self, from: &[f64], to: &[f64], kernel: impl Fn(DVec3, DVec3) -> f64) -> Vec<Matrix> {
        let n = self.azimuths;
        let weight = |mode: usize, j: usize| (mode as f64 * self.phi(j)).cos() * 2.0 * PI / n as f64;
        let weights: Matrix = (0..n / 2).map(|mode| (0..n).map(|j| weight(mode, j)).collect()).collect();
        let mut modes = vec![vec![vec![0.0; to.len()]; from.len()]; n / 2];
        for (i, &cos_a) in from.iter().enumerate() {
            let a = direction(cos_a, 0.0);
            for (k, &cos_b) in to.iter().enumerate() {
                let values: Vec<f64> = (0..n).map(|j| kernel(a, direction(cos_b, self.phi(j)))).collect();
                for (mode, weights) in modes.iter_mut().zip(&weights) {
                    mode[i][k] = values.iter().zip(weights).map(|(v, c)| v * c).sum();
                }
            }
        }
        modes
    }

    /// Integral of a kernel over all directions that light from a cosine may leave to; it may jump at `jump`.
    fn share(self, cos_a: f64, jump: f64, kernel: impl Fn(DVec3, DVec3) -> f64) -> f64 {
        let a = direction(cos_a, 0.0);
        let ring = |cos_b: f64| (0..self.azimuths).map(|j| kernel(a, direction(cos_b, self.phi(j)))).sum::<f64>();
        let sum: f64 = pieces(2 * self.cosines, vec![jump]).into_iter().map(|(cos, w)| w * ring(cos)).sum();
        sum * 2.0 * PI / self.azimuths as f64
    }

    /// Directional albedos at all angles, and values `f cos_theta_i` of all pairs.
    fn of(self, coated: Coated) -> (Vec<f64>, Vec<f64>) {
        let n = coated.ior;
        let outside = ANGLES_DEG.map(|theta| at(theta, 0.0).z);
        let place = |w: DVec3| outside.iter().position(|cos| (cos - w.z).abs() < 1e-12).expect("one of the angles");
        // GGX has facets up to the vertical, and none beyond: transmission jumps where the facet is vertical. Under the critical
        // angle total reflection sets in.
        let breaks = outside.iter().map(|cos| cos / n).chain([(1.0 - 1.0 / (n * n)).sqrt()]).collect();
        let rule = pieces(self.cosines, breaks);
        let inside: Vec<f64> = rule.iter().map(|(cos, _)| *cos).collect();
        // A weight and the slab after each event.
        let passed: Vec<f64> = rule.iter().map(|(cos, w)| w * (-coated.optical_depth / cos).exp()).collect();
        let then = |mut matrix: Matrix| {
            matrix.iter_mut().for_each(|row| row.iter_mut().zip(&passed).for_each(|(x, p)| *x *= p));
            matrix
        };
        let down = |a, b| transmitted(coated.alpha, [1.0, n], a, b);
        let up = |a, b| transmitted(coated.alpha, [n, 1.0], a, b);
        let enter = self.modes(&outside, &inside, down);
        let leave = self.modes(&inside, &outside, up);
        let base = self.modes(&inside, &inside, |a, b| coated.kernel_of_base(a, b));
        let under = self.modes(&inside, &inside, |a, b| coated.kernel_from_inside(a, b));

        let mut albedos = outside.map(|cos| self.share(cos, 0.0, |a, b| coated.kernel_from_outside(a, b)));
        let mut values = pairs().map(|(wi, wo)| coated.kernel_from_outside(wo, wi));
        for (mode, (((enter, mut leave), base), under)) in enter.into_iter().zip(leave).zip(base).zip(under).enumerate()
        {
            let (enter, a, b) = (then(enter), then(base), then(under));
            if mode == 0 {
                // One more column: all directions outside.
                leave.iter_mut().zip(&inside).for_each(|(row, cos)| row.push(self.share(*cos, n * cos, up)));
            }
            let mut series = product(&a, &b);
            for (i, row) in series.iter_mut().enumerate() {
                row.iter_mut().enumerate().for_each(|(j, x)| *x = f64::from(i == j) - *x);
            }
            let mut out = product(&a, &leave);
            solve(series, &mut out);
            let seen = product(&enter, &out);
            if mode == 0 {
                albedos.iter_mut().zip(&seen).for_each(|(albedo, row)| *albedo += row[outside.len()]);
            }
            for (value, (wi, wo)) in values.iter_mut().zip(pairs()) {
                let phi = wi.y.atan2(wi.x) - wo.y.atan2(wo.x);
                let factor = if mode == 0 { 1.0 } else { 2.0 * (mode as f64 * phi).cos() } / (2.0 * PI);
                *value += factor * seen[place(wo)][place(wi)];
            }
        }
        (albedos.to_vec(), values.to_vec())
    }
}

/// Largest change by the last doubling of all points.
const QUADRATURE: f64 = 1e-4;

/// Standard errors of the estimates, at most.
const SIGMA: f64 = 1e-3;

fn compare(coated: Coated) {
    let coarse = Resolution { cosines: 9, azimuths: 24 };
    let [first, second, third] =
        [coarse, coarse.doubled(), coarse.doubled().doubled()].map(|resolution| resolution.of(coated));
    let change = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let stack = coated.stack();
    for (what, [first, second, third]) in
        [("albedo", [first.0, second.0, third.0]), ("value", [first.1, second.1, third.1])]
    {
        let (before, after) = (change(&first, &second), change(&second, &third));
        assert!(after < QUADRATURE && after < 0.5 * before, "{what} changes by {before}, then {after}");
        for (k, expected) in third.into_iter().enumerate() {
            let found = match what {
                "albedo" => mc(InterfaceMode::OneFacet, 0).albedo(&stack, at(ANGLES_DEG[k], 0.0), 250_000),
                _ => mc(InterfaceMode::OneFacet, 60_000).estimate(&stack, pairs()[k].0, pairs()[k].1),
            };
            assert!(found.std_err <= SIGMA, "{what} {k}: {found:?}");
            assert!((found.mean - expected).abs() <= 4.0 * found.std_err + after, "{what} {k}: {found:?} {expected}");
        }
    }
}

#[test]
fn rough_coat_over_rough_conductor_agrees_with_adding() {
    let base = Base::Conductor { alpha: 0.5, n: 0.2, k: 3.5 };
    compare(Coated { alpha: 0.4, ior: 1.5, optical_depth: 0.1, base });
}

#[test]
fn rougher_coat_than_its_conductor_agrees_with_adding() {
    let base = Base::Conductor { alpha: 0.3, n: 3.2, k: 3.3 };
    compare(Coated { alpha: 0.6, ior: 1.5, optical_depth: 0.0, base });
}

#[test]
fn dense_rough_coat_over_the_roughest_conductor_agrees_with_adding() {
    let base = Base::Conductor { alpha: 0.7, n: 1.0, k: 6.7 };
    compare(Coated { alpha: 0.7, ior: 2.0, optical_depth: 0.3, base });
}

#[test]
fn rough_coat_over_lambert_agrees_with_adding() {
    compare(Coated { alpha: 0.4, ior: 1.5, optical_depth: 0.2, base: Base::Lambert { albedo: 0.8 } });
}
