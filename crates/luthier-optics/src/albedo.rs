//! Directional albedo of a rough interface with all bounces between its facets: FGD-infinity.
//!
//! The geometry of the micro-surface is separated from its optics. [`FacetStatistics`] holds, for one direction and one
//! alpha, how the light meets facets when they all reflect: the first bounce as weights over the cosine (quadrature),
//! the later ones as walks. Any reflectance function of the cosine then gives its albedo in a few thousand
//! multiplications, so the same statistics serve every wavelength and every material.

use std::f64::consts::PI;

use glam::DVec3;

use crate::interpolation::cubic_stencil;
use crate::microfacet::lambda;
use crate::microsurface::{TransparentFacets, Walk, crossed_and_returned, walk_after_first_facet};
use crate::quadrature::gauss_legendre;
use crate::stack::Distribution;

/// Nodes of the cosine axis on which cubics spread first-bounce weights.
const FIRST_NODES: usize = 129;

/// Nodes of the finer cosine axis. Walks look reflectances up on it; for curves with a kink, straight lines spread first-bounce weights
/// on it.
const WALK_NODES: usize = 1025;

/// Tolerance of cubics against a curve. They miss a kink by a hundred times as much.
const CUBIC_TOLERANCE: f64 = 1e-3;

/// Least cosine at which cubics are compared with curves. Nearer to grazing incidence they miss the curves of films, at no great cost.
const CUBIC_COS_THETA: f64 = 1.0 / 32.0;

/// Points of a curve per interval of nodes, for the means that replace its values if cubics fail.
const MEAN_POINTS: u32 = 8;

/// Least cosine of a direction, the limit at grazing incidence: flatter directions are evaluated at it.
pub const COS_THETA_MIN: f64 = 1e-5;

/// Least slope parameter of a micro-surface; a surface below it is a mirror.
pub const ALPHA_MIN: f64 = 1e-5;

/// Reflectances as functions of the cosine, one per wavelength, tabulated for lookups by the million.
#[derive(Debug, Clone, PartialEq)]
pub struct ReflectanceCurves {
    count: usize,
    /// All curves at the first node, then all at the second.
    values: Vec<f64>,
    /// Means of all curves around the nodes, in the same order, if one of them has a kink (the critical angle). A density that
    /// is smooth across an interval, spread by straight lines, integrates exactly against these.
    means: Option<Vec<f64>>,
}

impl ReflectanceCurves {
    /// Tabulates `count` curves: `f(k, cos_theta)` is the k-th.
    pub fn new(count: usize, f: impl Fn(usize, f64) -> f64) -> Self {
        let last = (WALK_NODES - 1) as f64;
        let nodes = (0..WALK_NODES).flat_map(|i| (0..count).map(move |k| (k, i as f64 / last)));
        let values = nodes.clone().map(|(k, cos)| f(k, cos)).collect();
        let mut curves = Self { count, values, means: None };
        if !curves.cubics_follow() {
            curves.means = Some(nodes.map(|(k, cos)| tent_mean(|c| f(k, c), cos, 1.0 / last)).collect());
        }
        curves
    }

    /// Whether cubics between the coarser nodes pass all finer nodes closely enough.
    fn cubics_follow(&self) -> bool {
        (0..WALK_NODES).all(|i| {
            let cos_theta = i as f64 / (WALK_NODES - 1) as f64;
            if cos_theta < CUBIC_COS_THETA {
                return true;
            }
            let (base, weights) = cubic_stencil(cos_theta * (FIRST_NODES - 1) as f64, FIRST_NODES);
            let fine = &self.values[i * self.count..(i + 1) * self.count];
            fine.iter().enumerate().all(|(k, value)| {
                let at = weights.iter().enumerate().map(|(j, w)| w * self.at_first_node(base + j)[k]).sum::<f64>();
                (at - value).abs() <= CUBIC_TOLERANCE
            })
        })
    }

    /// Number of curves.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The k-th curve, linear between nodes: within 1e-5 for dielectrics up to n = 2.5.
    pub fn at(&self, k: usize, cos_theta: f64) -> f64 {
        let (low, high, t) = self.around(cos_theta);
        low[k] + (high[k] - low[k]) * t
    }

    /// All curves at the nodes on both sides of a cosine, and how far it is between them.
    fn around(&self, cos_theta: f64) -> (&[f64], &[f64], f64) {
        let p = cos_theta * (WALK_NODES - 1) as f64;
        let i = (p as usize).min(WALK_NODES - 2);
        let (low, high) = self.values[i * self.count..(i + 2) * self.count].split_at(self.count);
        (low, high, p - i as f64)
    }

    /// All curves at a node of the coarser first-bounce axis.
    fn at_first_node(&self, i: usize) -> &[f64] {
        let start = i * (WALK_NODES - 1) / (FIRST_NODES - 1) * self.count;
        &self.values[start..start + self.count]
    }
}

/// Accuracy of [`FacetStatistics`]: Gauss-Legendre points per direction of each smooth piece of an integral.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Effort {
    /// Points for the first bounce.
    pub first: usize,
    /// Points for the first facets of walks, if later bounces carry a quarter of the light. The number grows as the root of their share.
    pub later: usize,
}

impl Effort {
    /// Points for later bounces that carry `remaining` of the light. Their square, the number of walks, is in proportion to the light.
    fn points_for(self, remaining: f64) -> usize {
        let points = self.later as f64 * libm::sqrt(4.0 * remaining.max(0.0));
        (libm::ceil(points) as usize).max(self.later.min(6))
    }
}

/// Encounters of the light from one direction with the facets of a perfectly reflecting micro-surface.
///
/// ```
/// use luthier_optics::{albedo::{Effort, FacetStatistics, ReflectanceCurves}, stack::Distribution};
///
/// let statistics = FacetStatistics::new(Distribution::Ggx, 0.5, 0.7, Effort { first: 24, later: 12 }, 0);
/// // White facets return all light; grey ones lose some at every bounce.
/// let albedos = statistics.albedo(&ReflectanceCurves::new(2, |k, _| [1.0, 0.5][k]));
/// assert!((albedos[0] - 1.0).abs() < 1e-4);
/// assert!(albedos[1] < 0.5);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FacetStatistics {
    /// Weight of the first bounce per cosine node; the sum is the single-scattering albedo for F = 1.
    first: Vec<f64>,
    /// Weight of the first bounce over the finer nodes, by straight lines.
    first_fine: Vec<f32>,
    /// Share of the light that has not left after the first bounce.
    remaining: f64,
    /// Facets of all walks, one after the other: cosine, and light that leaves there. The light is negative at the last facet of a walk.
    facets: Vec<(f32, f32)>,
    /// Light of all walks.
    later: f64,
}

impl FacetStatistics {
    /// The statistics for light at `cos_theta_i` (clamped to [`COS_THETA_MIN`]) on a surface of slope `alpha`.
    ///
    /// The first bounce is exact to the quadrature (within 2e-5 at 24 points down to cosines of 0.05, 5e-5 to 0.0087); later bounces share the rest of the light, so
    /// that a perfect reflector has albedo 1 within rounding. Reflectances with a kink (total reflection) converge more slowly:
    /// within 2e-3 at 64 points, against 2e-2 at 24.
    pub fn new(distribution: Distribution, alpha: f64, cos_theta_i: f64, effort: Effort, seed: u32) -> Self {
        let cos_theta_i = cos_theta_i.clamp(COS_THETA_MIN, 1.0);
        let mut first = vec![0.0; FIRST_NODES];
        let mut first_fine = vec![0f32; WALK_NODES];
        if alpha < ALPHA_MIN {
            spread(&mut first, cos_theta_i, 1.0);
            spread_fine(&mut first_fine, cos_theta_i, 1.0);
            return Self { first, first_fine, remaining: 0.0, facets: Vec::new(), later: 0.0 };
        }
        let distribution = distribution.walked();
        let surface = Microsurface::new(distribution, alpha, cos_theta_i);
        surface.first_facets(effort.first, Horizon::Above, |facet| {
            let leaving = facet.weight * surface.leaving(&facet);
            spread(&mut first, facet.cos_theta_d, leaving);
            spread_fine(&mut first_fine, facet.cos_theta_d, leaving);
        });
        let remaining = 1.0 - first.iter().sum::<f64>();

        let mut facets = Vec::new();
        let mut later = 0.0;
        let mut walk = Walk { seed, index: 0 };
        for horizon in [Horizon::Above, Horizon::Below] {
            surface.first_facets(effort.points_for(remaining), horizon, |facet| {
                let onward = facet.weight * (1.0 - surface.leaving(&facet));
                walk.index += 1;
                if onward < NEGLIGIBLE * remaining {
                    return;
                }
                later += onward;
                facets.push((facet.cos_theta_d as f32, 0.0));
                walk_after_first_facet(distribution, alpha, surface.lambda_i, facet.reflected, walk, |next| {
                    facets.push((next.cos_theta_d as f32, (onward * next.leaving) as f32));
                });
                if let Some(last) = facets.last_mut() {
                    last.1 = -last.1;
                }
            });
        }
        Self { first, first_fine, remaining, facets, later }
    }

    /// Albedo of the first bounce alone, per curve.
    pub fn single_scattering(&self, f: &ReflectanceCurves) -> Vec<f64> {
        let mut sums = vec![0.0; f.count];
        match &f.means {
            None => {
                for (i, weight) in self.first.iter().enumerate() {
                    add_weighted(&mut sums, *weight, f.at_first_node(i));
                }
            }
            Some(means) => {
                for (weight, values) in self.first_fine.iter().zip(means.chunks_exact(f.count)) {
                    add_weighted(&mut sums, f64::from(*weight), values);
                }
            }
        }
        sums
    }

    /// Fraction of the light that has not left after the first bounce when facets reflect everything.
    pub fn remaining(&self) -> f64 {
        self.remaining
    }

    /// Share of the [remaining](Self::remaining) light, per curve, that facets of reflectance `f` send out in the end; the first reflection
    /// counts. It is a smooth function of direction and alpha, estimated with a little noise.
    pub fn later_share(&self, f: &ReflectanceCurves) -> Vec<f64> {
        let mut sums = vec![0.0; f.count];
        let mut throughput = vec![1.0; f.count];
        for &(cos_theta_d, leaving) in &self.facets {
            let (low, high, t) = f.around(f64::from(cos_theta_d));
            let light = f64::from(leaving.abs());
            for (((through, sum), low), high) in throughput.iter_mut().zip(&mut sums).zip(low).zip(high) {
                *through *= low + (high - low) * t;
                *sum += *through * light;
            }
            if leaving.is_sign_negative() {
                throughput.fill(1.0);
            }
        }
        let scale = if self.later > 0.0 { 1.0 / self.later } else { 0.0 };
        sums.iter().map(|sum| sum * scale).collect()
    }

    /// Albedo with all bounces, per curve: the light that never crosses the interface.
    pub fn albedo(&self, f: &ReflectanceCurves) -> Vec<f64> {
        let first = self.single_scattering(f);
        first.iter().zip(self.later_share(f)).map(|(first, later)| first + self.remaining * later).collect()
    }
}

/// Part of the light at `cos_theta_i` that crosses a rough interface between transparent media and returns upward: the mean of `walks`
/// low-discrepancy walks.
pub fn crossed_albedo(
    distribution: Distribution,
    alpha: f64,
    facets: TransparentFacets<impl Fn(f64) -> f64 + Copy>,
    cos_theta_i: f64,
    walks: u32,
    seed: u32,
) -> f64 {
    if alpha < ALPHA_MIN {
        return 0.0;
    }
    let cos_theta_i = cos_theta_i.clamp(COS_THETA_MIN, 1.0);
    let returned =
        (0..walks).map(|index| crossed_and_returned(distribution, alpha, facets, cos_theta_i, Walk { seed, index }));
    returned.sum::<f64>() / f64::from(walks)
}

fn add_weighted(sums: &mut [f64], weight: f64, values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// Spreads a weight over four neighbouring nodes so that cubics integrate exactly.
fn spread(first: &mut [f64], cos_theta: f64, weight: f64) {
    let (base, weights) = cubic_stencil(cos_theta * (FIRST_NODES - 1) as f64, FIRST_NODES);
    for (k, l) in weights.into_iter().enumerate() {
        first[base + k] += weight * l;
    }
}

/// Spreads a weight over the two finer nodes around a cosine.
fn spread_fine(first: &mut [f32], cos_theta: f64, weight: f64) {
    let p = cos_theta.clamp(0.0, 1.0) * (WALK_NODES - 1) as f64;
    let base = (p as usize).min(WALK_NODES - 2);
    let t = p - base as f64;
    first[base] += (weight * (1.0 - t)) as f32;
    first[base + 1] += (weight * t) as f32;
}

/// Mean of a function of the cosine around a node. The weight is a tent over the intervals on both sides, cut off at 0 and 1.
fn tent_mean(f: impl Fn(f64) -> f64, cos_theta: f64, interval: f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for i in 0..2 * MEAN_POINTS {
        let t = (f64::from(i) + 0.5) / f64::from(MEAN_POINTS) - 1.0;
        let (at, weight) = (cos_theta + t * interval, 1.0 - t.abs());
        if (0.0..=1.0).contains(&at) {
            sum += weight * f(at);
            weights += weight;
        }
    }
    sum / weights
}

/// Walks that start with less than this share of the light of all later bounces are left out.
const NEGLIGIBLE: f64 = 1e-6;

/// A facet that incident light meets first.
struct FirstFacet {
    cos_theta_d: f64,
    /// Share of the incident light.
    weight: f64,
    /// Direction after the facet.
    reflected: DVec3,
}

/// First facets that reflect above the horizon, or below.
#[derive(Clone, Copy, PartialEq)]
enum Horizon {
    Above,
    Below,
}

/// A micro-surface lit from one direction.
struct Microsurface {
    distribution: Distribution,
    alpha: f64,
    cos_i: f64,
    sin_i: f64,
    lambda_i: f64,
}

impl Microsurface {
    fn new(distribution: Distribution, alpha: f64, cos_i: f64) -> Self {
        let sin_i = libm::sqrt((1.0 - cos_i * cos_i).max(0.0));
        Self { distribution, alpha, cos_i, sin_i, lambda_i: lambda(distribution, alpha, cos_i) }
    }

    /// Share of the light reflected by a first facet that leaves at once: `G2/G1` with height-correlated Smith masking,
    /// `G2 = 1 / (1 + Lambda_i + Lambda_o)` (Heitz 2014, eq. 99).
    fn leaving(&self, facet: &FirstFacet) -> f64 {
        let cos_o = facet.reflected.z;
        if cos_o <= 0.0 {
            return 0.0;
        }
        let g1_inverse = 1.0 + self.lambda_i;
        g1_inverse / (g1_inverse + lambda(self.distribution, self.alpha, cos_o.min(1.0)))
    }

    /// Quadrature over the visible normals. In slopes divided by alpha, polar around the normal: where the reflected ray
    /// crosses the horizon, and where a facet turns away, is known in closed form for each circle, so the integrand is
    /// smooth inside each piece.
    fn first_facets(&self, points: usize, horizon: Horizon, mut visit: impl FnMut(FirstFacet)) {
        let rule = gauss_legendre(points);
        let Self { distribution, alpha, cos_i, sin_i, lambda_i } = *self;
        // Slope radii where the horizon begins to cut the circle of reflecting facets, and where nothing is left of it; the
        // same for the circle of visible facets.
        let cut = cos_i / (alpha * (1.0 + sin_i));
        let end = (1.0 + sin_i) / (alpha * cos_i);
        let turn = cos_i / (alpha * sin_i);
        let radii = match horizon {
            Horizon::Above => [0.0, cut, end],
            Horizon::Below => [cut, turn, f64::INFINITY],
        };
        for piece in 0..2 {
            let [from, to] = [radii[piece], radii[piece + 1]].map(|r| radius_to_coordinate(distribution, r));
            if to - from < 1e-12 {
                continue;
            }
            for &(x, x_weight) in &rule {
                // Points gather at both ends, where limits of the azimuth start like square roots.
                let (fraction, stretch) = (x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x));
                let (r, density) = radius(distribution, from + (to - from) * fraction);
                let slope = alpha * r;
                let horizon_azimuth = azimuth(cos_i * (1.0 - slope * slope) / (2.0 * slope * sin_i));
                let (phi_from, phi_to) = match horizon {
                    Horizon::Above => (horizon_azimuth, PI),
                    Horizon::Below => (azimuth(cos_i / (slope * sin_i)), horizon_azimuth),
                };
                let span = phi_to - phi_from;
                if span <= 0.0 {
                    continue;
                }
                let normal_z = 1.0 / libm::sqrt(1.0 + slope * slope);
                for &(y, y_weight) in &rule {
                    // Squared away from the horizon, where masking changes fastest.
                    let (part, y_stretch) = match horizon {
                        Horizon::Above => (y * y, 2.0 * y),
                        Horizon::Below => (1.0 - (1.0 - y) * (1.0 - y), 2.0 * (1.0 - y)),
                    };
                    let phi = phi_from + span * part;
                    let (sin_phi, cos_phi) = libm::sincos(phi);
                    let projected = (cos_i - slope * cos_phi * sin_i).max(0.0);
                    let cos_theta_d = projected * normal_z;
                    let measure = density * (to - from) * stretch * x_weight * span * y_stretch * y_weight / PI;
                    let normal = DVec3::new(-slope * cos_phi, -slope * sin_phi, 1.0) * normal_z;
                    let reflected = 2.0 * cos_theta_d * normal - DVec3::new(sin_i, 0.0, cos_i);
                    let weight = measure * projected / (cos_i * (1.0 + lambda_i));
                    visit(FirstFacet { cos_theta_d, weight, reflected });
                }
            }
        }
    }
}

/// The azimuth of a cosine, which may lie outside -1..=1 where a horizon does not cut a circle.
fn azimuth(cos: f64) -> f64 {
    if cos >= 1.0 { 0.0 } else { libm::acos(cos.max(-1.0)) }
}

/// Radius at which Gaussian slopes end.
const BECKMANN_RADIUS: f64 = 6.0;

/// Integration coordinate of a slope radius (in units of alpha): the radius itself for Beckmann, its arc tangent for GGX.
fn radius_to_coordinate(distribution: Distribution, r: f64) -> f64 {
    match distribution {
        Distribution::Beckmann => r.min(BECKMANN_RADIUS),
        _ => libm::atan(r),
    }
}

/// Slope radius at a coordinate, and the density of slopes (summed over the azimuth) per unit of it.
fn radius(distribution: Distribution, coordinate: f64) -> (f64, f64) {
    match distribution {
        Distribution::Beckmann => (coordinate, 2.0 * coordinate * libm::exp(-coordinate * coordinate)),
        _ => (libm::tan(coordinate), libm::sin(2.0 * coordinate)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fresnel::interface;
    use crate::microfacet::distribution;
    use crate::microsurface::reflecting_walk;
    use num_complex::Complex64;

    const EFFORT: Effort = Effort { first: 64, later: 8 };
    const FIRST_ONLY: Effort = Effort { later: 0, ..EFFORT };
    const BOTH: [Distribution; 2] = [Distribution::Beckmann, Distribution::Ggx];

    fn white() -> ReflectanceCurves {
        ReflectanceCurves::new(1, |_, _| 1.0)
    }

    #[test]
    fn single_scattering_of_ggx_matches_closed_forms_and_quadrature() {
        // At the normal: quadrature to ten digits, and 1 - ln 2 exactly at alpha = 1. At mu = 0.5: six digits.
        let normal = [
            (0.1, 0.9883040565),
            (0.25, 0.9158124302),
            (0.5, 0.6878485151),
            (0.75, 0.4639165109),
            (1.0, 1.0 - std::f64::consts::LN_2),
        ];
        for (alpha, expected) in normal {
            let s = FacetStatistics::new(Distribution::Ggx, alpha, 1.0, FIRST_ONLY, 0);
            assert!((s.single_scattering(&white())[0] - expected).abs() < 1e-6, "{alpha}");
        }
        for (alpha, expected) in [(0.1, 0.969205), (0.25, 0.857263), (0.5, 0.69825), (0.75, 0.56462), (1.0, 0.45069)] {
            let s = FacetStatistics::new(Distribution::Ggx, alpha, 0.5, FIRST_ONLY, 0);
            let got = s.single_scattering(&white())[0];
            assert!((got - expected).abs() < 6e-6, "{alpha}: {got}");
        }
    }

    #[test]
    fn quadrature_has_converged() {
        for d in BOTH {
            for alpha in [0.01, 0.1, 0.5, 1.0] {
                for (mu, tolerance) in
                    [(1e-3, 1e-3), (0.0087, 5e-5), (0.05, 2e-5), (0.3, 2e-5), (0.9, 2e-5), (1.0, 2e-5)]
                {
                    let at = |first| {
                        FacetStatistics::new(d, alpha, mu, Effort { first, later: 0 }, 0).single_scattering(&white())[0]
                    };
                    let (coarse, fine) = (at(24), at(96));
                    assert!((coarse - fine).abs() < tolerance, "{d:?} {alpha} {mu}: {coarse} {fine}");
                }
            }
        }
    }

    #[test]
    fn a_perfect_reflector_loses_nothing() {
        for d in BOTH {
            for alpha in [0.0, 0.01, 0.1, 0.3, 0.6, 1.0] {
                for mu in [0.0, 0.01, 0.3, 0.7, 1.0] {
                    let s = FacetStatistics::new(d, alpha, mu, EFFORT, 0);
                    assert!((s.albedo(&white())[0] - 1.0).abs() < 1e-6, "{d:?} {alpha} {mu}");
                }
            }
        }
    }

    /// Share of the first facets, and the means over them of the cosine at the facet and of the reflected height.
    type Moments = [f64; 3];

    fn add(sums: &mut Moments, weight: f64, cos_theta_d: f64, height: f64) {
        sums.iter_mut().zip([1.0, cos_theta_d, height]).for_each(|(sum, x)| *sum += weight * x);
    }

    /// Oracle: visible normals on midpoints of the sphere, by whether they reflect above the horizon or below; both shares sum to 1,
    /// Smith's normalisation.
    #[test]
    fn first_facets_are_the_visible_normals_on_either_side_of_the_horizon() {
        // Circles of slopes that lie below the horizon as a whole begin inside a piece: the tails of GGX converge slowly.
        for (d, converged) in [(Distribution::Beckmann, 1e-6), (Distribution::Ggx, 5e-4)] {
            for (alpha, mu) in [(0.3, 0.2), (0.6, 0.1), (0.6, 0.7), (1.0, 0.5), (1.0, 1.0)] {
                let surface = Microsurface::new(d, alpha, mu);
                let found = [Horizon::Above, Horizon::Below].map(|horizon| {
                    let mut sums = [0.0; 3];
                    let visit = |f: FirstFacet| add(&mut sums, f.weight, f.cos_theta_d, f.reflected.z);
                    surface.first_facets(192, horizon, visit);
                    sums
                });
                let mut expected = [[0.0; 3]; 2];
                let (thetas, phis) = (1500, 720);
                for i in 0..thetas {
                    let (sin, cos) = libm::sincos(0.5 * PI * (f64::from(i) + 0.5) / f64::from(thetas));
                    for j in 0..phis {
                        let phi = PI * (f64::from(j) + 0.5) / f64::from(phis);
                        let cos_theta_d = (sin * libm::cos(phi) * surface.sin_i + cos * mu).max(0.0);
                        let area = sin * PI * PI / f64::from(thetas * phis);
                        let weight = distribution(d, alpha, cos, sin * sin) * cos_theta_d * area;
                        let height = 2.0 * cos_theta_d * cos - mu;
                        let side = &mut expected[usize::from(height < 0.0)];
                        add(side, weight / (mu * (1.0 + surface.lambda_i)), cos_theta_d, height);
                    }
                }
                let total = found[0][0] + found[1][0];
                assert!((total - 1.0).abs() < converged, "{d:?} {alpha} {mu}: {total}");
                for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                    // The midpoints miss parts of the cells that the horizon cuts.
                    assert!(
                        (found - expected).abs() < 2e-4 + converged,
                        "{d:?} {alpha} {mu}: {found} against {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn walks_agree_with_quadrature_about_the_first_bounce() {
        // Two formulations of the same number: what the walks leave over after the first facet, without rescaling.
        for d in BOTH {
            for (alpha, mu) in [(0.2, 0.3), (0.6, 0.8), (1.0, 0.5), (1.0, 1.0), (0.5, 0.05)] {
                let walks = 4096;
                let mut first = 0.0;
                for i in 0..walks {
                    let mut facet_number = 0;
                    reflecting_walk(d, alpha, mu, Walk { seed: 0, index: i }, |facet| {
                        first += if facet_number == 0 { facet.leaving / f64::from(walks) } else { 0.0 };
                        facet_number += 1;
                    });
                }
                let s = FacetStatistics::new(d, alpha, mu, FIRST_ONLY, 0);
                let expected = s.single_scattering(&white())[0];
                assert!((first - expected).abs() < 1e-3, "{d:?} {alpha} {mu}: {first} {expected}");
            }
        }
    }

    #[test]
    fn a_smooth_surface_has_the_albedo_of_a_mirror() {
        let fresnel = |mu| interface(Complex64::ONE, Complex64::new(1.5, 0.0), mu).unpolarised();
        let curve = ReflectanceCurves::new(1, |_, mu| fresnel(mu));
        for mu in [0.1, 0.5, 1.0] {
            let s = FacetStatistics::new(Distribution::Ggx, 0.0, mu, EFFORT, 0);
            assert!((s.albedo(&curve)[0] - fresnel(mu)).abs() < 1e-5);
            let facets = TransparentFacets { eta: 1.5, from_above: |cos| curve.at(0, cos) };
            assert_eq!(crossed_albedo(Distribution::Ggx, 0.0, facets, mu, 16, 0), 0.0);
        }
    }
}
