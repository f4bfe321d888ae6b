//! Light in a layer of fibres that stand along the normal: the volume of Zeltner, Burley and Chiang 2022.

use std::f64::consts::PI;

use luthier_optics::quadrature::{GradedRules, gauss_legendre};

use super::matrix::Matrix;

/// Fourier modes over the azimuth.
const MODES: usize = 24;
/// Midpoints over half the azimuth, for the kernels' modes.
const AZIMUTHS: usize = 64;
/// Halvings of the layer, down to a slab that scatters once.
const HALVINGS: u32 = 24;

/// The reflection of a layer of unit thickness and density at given cosines, with all orders of scattering and no
/// absorption. The layer consists of mirrors with the SGGX distribution of a fibre (Heitz, Dupuy, Crassin and
/// Dachsbacher 2015).
///
/// Computed by adding and doubling (van de Hulst 1980) for each mode of the azimuth. Radiance is cubic between
/// ordinates.
#[derive(Debug, Clone)]
pub(super) struct FibreLayer {
    /// Cosines of the ordinates, ascending.
    pub(super) cosines: Vec<f64>,
    /// Share of the interval of cosines and mean cosine of each ordinate.
    weights: Vec<[f64; 2]>,
    /// Reflection of each mode, row by row, times the weights.
    modes: Vec<Matrix>,
}

/// One row of reflection: the BRDF times the cosine over directions of the light, for one direction of the viewer.
pub(super) struct Row<'a> {
    layer: &'a FibreLayer,
    row: usize,
}

/// Rules for the kernels of layers.
pub(super) fn kernel_rules() -> GradedRules {
    GradedRules::new(2.0, 4.0)
}

impl FibreLayer {
    /// The layer of fibres of cross section `sigma`, in 0..=1. `cosines` ascend, are above 0, and end with 1.
    pub(super) fn new(rules: &GradedRules, sigma: f64, cosines: Vec<f64>) -> Self {
        let n = cosines.len();
        let weights = weights(&cosines);
        let kernels = Kernels::new(rules, sigma, &cosines);
        let modes = kernels.same.iter().zip(&kernels.opposite).map(|(same, opposite)| {
            // A slab so thin that light is scattered once.
            let step = libm::ldexp(1.0, -(HALVINGS as i32));
            let mut reflect = Matrix::zeros(n);
            let mut transmit = Matrix::zeros(n);
            for i in 0..n {
                let depth = step / cosines[i];
                for j in 0..n {
                    reflect[(i, j)] = depth * opposite[(i, j)];
                    transmit[(i, j)] = depth * same[(i, j)];
                }
                transmit[(i, i)] += 1.0 - depth * projected_area(sigma, cosines[i]);
            }
            for _ in 0..HALVINGS {
                // Light between both halves, for light from above.
                let between = reflect.times(&reflect).identity_less_inverse_times(&transmit);
                let more = transmit.times(&reflect.times(&between));
                reflect.add(&more);
                transmit = transmit.times(&between);
            }
            reflect
        });
        Self { weights, modes: modes.collect(), cosines }
    }

    /// The reflection for the viewer at an ordinate.
    pub(super) fn row(&self, row: usize) -> Row<'_> {
        Row { layer: self, row }
    }
}

impl Row<'_> {
    /// The directional albedo.
    pub(super) fn albedo_dir(&self) -> f64 {
        (0..self.layer.cosines.len()).map(|j| self.layer.modes[0][(self.row, j)]).sum()
    }

    /// For each ordinate of the light: its mean cosine, its share of 0..1, and the BRDF times the cosine at an azimuth
    /// against the viewer.
    pub(super) fn at_azimuth(&self, phi: f64) -> impl Iterator<Item = [f64; 3]> + '_ {
        // The azimuth of travelling light and the azimuth of its source differ by pi, which flips odd modes.
        let factors: [f64; MODES] = std::array::from_fn(|m| {
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            sign * if m == 0 { 0.5 } else { 1.0 } * libm::cos(m as f64 * phi) / PI
        });
        self.layer.weights.iter().enumerate().map(move |(j, &[weight, cos])| {
            let sum: f64 = factors.iter().zip(&self.layer.modes).map(|(f, mode)| f * mode[(self.row, j)]).sum();
            [cos, weight, (sum / weight).max(0.0)]
        })
    }
}

/// Area of the fibres seen along a direction, over their area seen from the side: the extinction of a layer of density
/// 1.
fn projected_area(sigma: f64, cos: f64) -> f64 {
    libm::sqrt((1.0 - cos) * (1.0 + cos) + sigma * sigma * cos * cos)
}

/// Ordinates and factors of the cubic through the four ordinates about a cosine. Below the first ordinate radiance is
/// constant.
///
/// A cubic, because straight lines would scatter light farther than thin fibres do where gaps are wide.
fn interpolation(cosines: &[f64], z: f64) -> [(usize, f64); 4] {
    let above = cosines.partition_point(|c| *c < z);
    if above == 0 {
        return [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
    }
    let first = above.saturating_sub(2).min(cosines.len() - 4);
    std::array::from_fn(|k| {
        let here = cosines[first + k];
        let others = (first..first + 4).filter(|j| *j != first + k);
        (first + k, others.map(|j| (z - cosines[j]) / (here - cosines[j])).product())
    })
}

/// Integral over 0..1 and centroid of each ordinate's basis function: the interpolation of 1 there and 0 elsewhere.
fn weights(cosines: &[f64]) -> Vec<[f64; 2]> {
    let mut moments = vec![[0.0; 2]; cosines.len()];
    moments[0] = [cosines[0], 0.5 * cosines[0] * cosines[0]];
    let rule = gauss_legendre(3);
    for pair in cosines.windows(2) {
        for (u, weight) in &rule {
            let z = pair[0] + u * (pair[1] - pair[0]);
            for (j, part) in interpolation(cosines, z) {
                let part = weight * (pair[1] - pair[0]) * part;
                moments[j] = [moments[j][0] + part, moments[j][1] + part * z];
            }
        }
    }
    moments.into_iter().map(|[weight, moment]| [weight, moment / weight]).collect()
}

/// Scattering into each ordinate from each other, by mode.
struct Kernels {
    /// Scattering of light that travels to the same side.
    same: Vec<Matrix>,
    /// Scattering of light that travels to the other side.
    opposite: Vec<Matrix>,
}

impl Kernels {
    fn new(rules: &GradedRules, sigma: f64, cosines: &[f64]) -> Self {
        let n = cosines.len();
        let mut same = vec![Matrix::zeros(n); MODES];
        let mut opposite = vec![Matrix::zeros(n); MODES];
        let azimuths: Vec<f64> = (0..AZIMUTHS).map(|k| PI * (k as f64 + 0.5) / AZIMUTHS as f64).collect();
        let cos_phis: Vec<f64> = azimuths.iter().map(|phi| libm::cos(*phi)).collect();
        let weights: Vec<[f64; MODES]> = azimuths
            .iter()
            .map(|phi| std::array::from_fn(|m| 2.0 * PI / AZIMUTHS as f64 * libm::cos(m as f64 * phi)))
            .collect();
        let pieces: Vec<[f64; 2]> = std::iter::once(&0.0).chain(cosines).zip(cosines).map(|(a, b)| [*a, *b]).collect();
        for i in 0..n {
            let z = cosines[i];
            let sin = libm::sqrt((1.0 - z) * (1.0 + z));
            // Mirrors are upright as closely as fibres are thin: light keeps its cosine, or reverses a small one. The
            // kernel changes on a scale beside a peak, which is at an ordinate or at 0.
            let kept = (&mut same, z, sigma * (sin + sigma), 1.0);
            let turned = (&mut opposite, 0.0, sigma + z, -1.0);
            for (matrices, peak, scale, sign) in [kept, turned] {
                let nodes = pieces.iter().flat_map(|&[a, b]| {
                    let [near, far] = if a >= peak { [a, b] } else { [b, a] };
                    let reach = (far - near) / (scale + (near - peak).abs());
                    let rule = rules.for_reach_squared(reach * reach);
                    rule.iter().map(move |&(u, weight)| (near + u * (far - near), weight * (b - a)))
                });
                for (z_from, weight) in nodes {
                    let sin_from = libm::sqrt(((1.0 - z_from) * (1.0 + z_from)).max(0.0));
                    let signed = sign * z_from;
                    let mut modes = [0.0; MODES];
                    for (cos_phi, weights) in cos_phis.iter().zip(&weights) {
                        let length_sq = 2.0 - 2.0 * (z * signed + sin * sin_from * cos_phi);
                        let cos_h_sq = ((z - signed) * (z - signed) / length_sq.max(f64::MIN_POSITIVE)).min(1.0);
                        let value = 0.25 * fibre_distribution(sigma, cos_h_sq) * weight;
                        modes.iter_mut().zip(weights).for_each(|(mode, w)| *mode += w * value);
                    }
                    for (j, part) in interpolation(cosines, z_from) {
                        matrices.iter_mut().zip(modes).for_each(|(matrix, mode)| matrix[(i, j)] += part * mode);
                    }
                }
            }
            // Nothing is absorbed, so scattering equals extinction. Quadrature misses this by less than half a percent,
            // and is scaled.
            let [kept, turned] = [&same, &opposite].map(|matrices| (0..n).map(|j| matrices[0][(i, j)]).sum::<f64>());
            let factor = projected_area(sigma, z) / (kept + turned);
            debug_assert!((factor - 1.0).abs() < 0.005, "{sigma} {z}: {factor}");
            for matrix in same.iter_mut().chain(&mut opposite) {
                (0..n).for_each(|j| matrix[(i, j)] *= factor);
            }
        }
        Self { same, opposite }
    }
}

/// The SGGX distribution of fibres along z (Heitz et al. 2015, eq. 10, with S = diag(1, 1, sigma^2)).
fn fibre_distribution(sigma: f64, cos_h_sq: f64) -> f64 {
    let sum = sigma * sigma * (1.0 - cos_h_sq) + cos_h_sq;
    sigma * sigma * sigma / (PI * sum * sum)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use luthier_optics::sampling::split_mix::SplitMix64;

    use super::super::sheen::ordinates;
    use super::*;

    fn layer(sigma: f64, cos: f64) -> (FibreLayer, usize) {
        let rules = kernel_rules();
        let all = ordinates(&[cos]);
        let row = all.iter().position(|c| *c == cos).unwrap();
        (FibreLayer::new(&rules, sigma, all), row)
    }

    /// Where a random walk leaves the layer, if above, and whether within so many bounces.
    fn walk(numbers: &mut SplitMix64, sigma: f64, cos: f64) -> Option<(DVec3, u32)> {
        let mut direction = DVec3::new(-libm::sqrt(1.0 - cos * cos), 0.0, -cos);
        let mut depth = 0.0;
        for bounce in 0.. {
            let area = projected_area(sigma, direction.z.abs().min(1.0));
            depth -= direction.z * -libm::log(1.0 - numbers.unit()) / area;
            if depth < 0.0 {
                return Some((direction, bounce));
            }
            if depth > 1.0 {
                return None;
            }
            // A visible normal: a cosine about the direction, in the space of a sphere (Heitz et al. 2015, section 4).
            let seen = DVec3::new(-direction.x, -direction.y, -direction.z * sigma).normalize();
            let (along, across) = seen.any_orthonormal_pair();
            let (radius_sq, phi) = (numbers.unit(), 2.0 * PI * numbers.unit());
            let radius = libm::sqrt(radius_sq);
            let n = seen * libm::sqrt(1.0 - radius_sq)
                + along * (radius * libm::cos(phi))
                + across * (radius * libm::sin(phi));
            let m = DVec3::new(n.x, n.y, n.z * sigma).normalize();
            direction = (direction - m * (2.0 * direction.dot(m))).normalize();
        }
        None
    }

    /// Albedo, the part of it that goes back to the viewer's side, and the mean cosine, against random walks.
    #[test]
    fn agrees_with_random_walks() {
        let walks = 200_000;
        for (sigma, cos) in [(1.0, 0.5), (0.25, 0.1), (0.25, 0.6), (0.0625, 0.06), (0.0166, 0.129), (0.002, 0.02)] {
            let mut numbers = SplitMix64::new(7);
            let [mut above, mut back, mut weight] = [0.0; 3];
            for _ in 0..walks {
                if let Some((direction, _)) = walk(&mut numbers, sigma, cos) {
                    above += 1.0 / f64::from(walks);
                    back += if direction.x > 0.0 { 1.0 } else { 0.0 } / f64::from(walks);
                    weight += direction.z / f64::from(walks);
                }
            }
            let (layer, row) = layer(sigma, cos);
            let row = layer.row(row);
            let [mut found_back, mut found_weight] = [0.0; 2];
            for k in 0..64 {
                let phi = PI * (f64::from(k) + 0.5) / 64.0;
                for [z, width, value] in row.at_azimuth(phi) {
                    let part = 2.0 * PI / 64.0 * width * value;
                    found_back += if k < 32 { part } else { 0.0 };
                    found_weight += part * z;
                }
            }
            let noise = 4.0 * libm::sqrt(above / f64::from(walks));
            assert!((row.albedo_dir() - above).abs() < noise + 2e-3, "{sigma} {cos}: {} {above}", row.albedo_dir());
            assert!((found_back - back).abs() < noise + 4e-3, "{sigma} {cos}: {found_back} {back}");
            assert!((found_weight - weight).abs() < noise + 2e-3, "{sigma} {cos}: {found_weight} {weight}");
        }
    }

    #[test]
    fn reflection_is_reciprocal() {
        for sigma in [1.0, 0.3] {
            let (layer, _) = layer(sigma, 0.5);
            // Ordinates are evenly spread there, so that means are the ordinates.
            for (i, j) in [(17, 21), (18, 33), (28, 33)] {
                for phi in [0.2, 1.5, 3.0] {
                    let f = |i: usize, j: usize| {
                        let [cos, _, value] = layer.row(i).at_azimuth(phi).nth(j).unwrap();
                        assert!((cos - layer.cosines[j]).abs() < 1e-3, "{cos} {}", layer.cosines[j]);
                        value / cos
                    };
                    let (a, b) = (f(i, j), f(j, i));
                    assert!((a / b - 1.0).abs() < 0.01, "{sigma} {i} {j} {phi}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn weights_integrate_cubics() {
        let cosines = ordinates(&[0.5]);
        let weights = weights(&cosines);
        assert!(weights.iter().all(|[weight, _]| *weight > 0.0), "{weights:?}");
        for degree in 0..4 {
            let power = |z: f64| libm::pow(z, f64::from(degree));
            let sum: f64 = cosines.iter().zip(&weights).map(|(z, [weight, _])| weight * power(*z)).sum();
            // Radiance is constant below the first ordinate.
            assert!((sum * f64::from(degree + 1) - 1.0).abs() < 1e-5, "{degree}: {sum}");
        }
        let mean: f64 = weights.iter().map(|[weight, cos]| weight * cos).sum();
        assert!((mean - 0.5).abs() < 1e-12, "{mean}");
    }
}
