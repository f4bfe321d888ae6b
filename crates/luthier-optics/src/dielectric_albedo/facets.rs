//! Quadrature over the facets of a micro-surface, around the direction of incidence.
//!
//! Facets of one angle theta_d against the light reflect and refract equally strongly. On such a ring, whose azimuth psi starts in the
//! plane of incidence, cos_theta_h = cos(theta_d - theta_i) - 2 sin theta_d sin theta_i h with h = sin^2(psi/2), and the cosines of the
//! reflected and of the refracted direction are linear in cos_theta_h. So are their horizons, at which pieces end.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

use super::JointMasking;
use crate::microfacet::{lambda, scaled_distribution};
use crate::quadrature::GradedRules;
use crate::stack::Distribution;

/// Slope, over alpha, beyond which Gaussian slopes are left out: exp(-36) is below rounding.
const BECKMANN_REACH: f64 = 6.0;

/// Pieces shorter than this are left out.
const NOTHING: f64 = 1e-15;

/// Least scale that rules are graded to.
const SCALE_MIN: f64 = 1e-12;

/// Least cosine at which a refracted ray turns, and least width of the range of angles in which it does, in the choice of rules.
const COS_TURN_MIN: f64 = 1e-9;

/// Replaces a divisor of 0, so that a quotient is huge and not NaN.
const TINY: f64 = 1e-300;

/// Graded rules over the angle against the light and over the azimuth.
pub(super) struct Rules {
    rings: GradedRules,
    azimuths: GradedRules,
    /// Over cosines of incidence.
    pub(super) averages: GradedRules,
}

impl Rules {
    /// `[first, per_fold]` nodes of [`GradedRules::new`], each for half a piece.
    pub(super) fn new(rings: [f64; 2], azimuths: [f64; 2], averages: [f64; 2]) -> Self {
        // Squared nodes: pieces start like square roots where a circle of facets begins to be cut.
        let [rings, averages] = [rings, averages]
            .map(|[first, per_fold]| GradedRules::new(first, per_fold).map(|x, weight| (x * x, 2.0 * x * weight), &[]));
        Self { rings, azimuths: GradedRules::new(azimuths[0], azimuths[1]), averages }
    }

    /// The rules in use.
    pub(super) fn usual() -> &'static Self {
        static RULES: OnceLock<Rules> = OnceLock::new();
        RULES.get_or_init(|| Self::new([8.0, 6.0], [6.0, 4.0], [6.0, 4.0]))
    }
}

/// A place near which an integrand changes on a scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Feature {
    pub(super) at: f64,
    pub(super) width: f64,
}

/// The angle of incidence near which the reflectance between transparent media changes fastest: grazing, or the critical angle, below which
/// Brewster's lies.
pub(super) fn fresnel_feature(eta_ti: f64) -> Feature {
    let width = libm::sqrt(((eta_ti - 1.0) * (eta_ti + 1.0)).abs());
    if eta_ti >= 1.0 {
        Feature { at: FRAC_PI_2, width: width.min(1.0 / eta_ti) }
    } else {
        let critical = libm::asin(eta_ti);
        Feature { at: critical, width: (eta_ti * width).min(critical - libm::atan(eta_ti)) }
    }
}

/// Visits nodes and weights of a rule between ends, in pieces between features, graded to both ends of each.
pub(super) fn visit_nodes(
    rules: &GradedRules,
    [from, to]: [f64; 2],
    features: [Feature; 4],
    mut visit: impl FnMut(f64, f64),
) {
    let [a, b, c, d] = features.map(|feature| feature.at.clamp(from, to.max(from)));
    let mut ends = [from, a, b, c, d, to];
    ends.sort_by(f64::total_cmp);
    for pair in ends.windows(2) {
        let half = 0.5 * (pair[1] - pair[0]);
        if half < NOTHING {
            continue;
        }
        for (end, step) in [(pair[0], half), (pair[1], -half)] {
            let scale = features.iter().map(|f| (f.at - end).abs() + f.width).fold(f64::INFINITY, f64::min);
            for &(x, weight) in rules.for_reach_squared(half / scale.max(SCALE_MIN)) {
                visit(end + step * x, weight * half);
            }
        }
    }
}

/// A micro-surface lit from one direction.
pub(super) struct Facets<'a> {
    rules: &'a Rules,
    distribution: Distribution,
    masking: JointMasking,
    alpha: f64,
    cos_i: f64,
    sin_i: f64,
    theta_i: f64,
    lambda_i: f64,
    /// Cosine to the horizon on whose scale masking changes.
    horizon: f64,
    /// Least cosine of facets.
    cos_theta_h_min: f64,
}

/// Facets at one angle against the light.
struct Ring {
    cos_d: f64,
    /// 1 - cos(theta_d - theta_i): 1 less the largest cosine against the normal.
    versine: f64,
    /// 2 sin theta_d sin theta_i.
    span: f64,
}

impl Ring {
    /// h of the facet at a cosine against the normal. At normal incidence, where the span is 0, all of them are infinite.
    fn h(&self, cos_theta_h: f64) -> f64 {
        (1.0 - self.versine - cos_theta_h) / self.span.max(TINY)
    }
}

/// Cosine of the refracted direction, 0 under total reflection.
fn refracted(eta_ti: f64, cos_d: f64) -> f64 {
    libm::sqrt((1.0 - (1.0 - cos_d * cos_d) / (eta_ti * eta_ti)).max(0.0))
}

impl<'a> Facets<'a> {
    pub(super) fn new(
        rules: &'a Rules,
        distribution: Distribution,
        masking: JointMasking,
        alpha: f64,
        cos_i: f64,
    ) -> Self {
        let sin_i = libm::sqrt((1.0 - cos_i) * (1.0 + cos_i));
        let distribution = distribution.walked();
        let lambda_i = lambda(distribution, alpha, cos_i);
        let cos_theta_h_min = match distribution {
            Distribution::Beckmann => 1.0 / libm::sqrt(1.0 + BECKMANN_REACH * BECKMANN_REACH * alpha * alpha),
            _ => 0.0,
        };
        let theta_i = libm::atan2(sin_i, cos_i);
        let horizon = alpha / (1.0 + 2.0 * lambda_i);
        Self { rules, distribution, masking, alpha, cos_i, sin_i, theta_i, lambda_i, horizon, cos_theta_h_min }
    }

    /// The light that facets of reflectance `f(cos_theta_d)` send above the horizon; `fresnel` is the angle at which f changes fastest.
    pub(super) fn reflected(&self, fresnel: Feature, f: impl Fn(f64) -> f64) -> f64 {
        let Self { theta_i, cos_i, .. } = *self;
        let last = 0.5 * (FRAC_PI_2 + theta_i);
        let features = [
            Feature { at: theta_i, width: self.alpha },
            Feature { at: last, width: 0.5 * self.horizon },
            Feature { at: 0.5 * (FRAC_PI_2 - theta_i), width: 0.5 * self.horizon },
            fresnel,
        ];
        self.over_rings(last, features, |ring| {
            let reflectance = f(ring.cos_d);
            if reflectance == 0.0 {
                return 0.0;
            }
            // cos_theta_o = 2 cos_theta_d cos_theta_h - cos_theta_i.
            reflectance * self.around(ring, [-cos_i, 2.0 * ring.cos_d])
        })
    }

    /// The light that facets of reflectance `f(cos_theta_d)` between transparent media transmit, away from the surface.
    pub(super) fn transmitted(&self, eta_ti: f64, f: impl Fn(f64) -> f64) -> f64 {
        let Self { theta_i, cos_i, sin_i, .. } = *self;
        let flat = FRAC_PI_2 - theta_i;
        let denser = eta_ti >= 1.0;
        let fresnel = fresnel_feature(eta_ti);
        let last = fresnel.at;
        // Where the refracted ray of the first facet of a ring turns back above the horizon: theta_t - theta_d = pi/2 - theta_i.
        let turn = if denser { last } else { libm::atan2(cos_i, 1.0 / eta_ti - sin_i).min(last) };
        let away = cos_i / eta_ti + self.horizon;
        let cos_turn = libm::cos(turn);
        let turn_width =
            self.horizon * eta_ti * refracted(eta_ti, cos_turn) / cos_turn.max(COS_TURN_MIN) + COS_TURN_MIN;
        let features = [
            Feature { at: theta_i, width: self.alpha },
            Feature { at: flat, width: away },
            fresnel,
            Feature { at: turn, width: turn_width },
        ];
        self.over_rings(last, features, |ring| {
            let transmittance = 1.0 - f(ring.cos_d);
            if transmittance <= 0.0 {
                return 0.0;
            }
            transmittance * self.around(ring, [cos_i / eta_ti, refracted(eta_ti, ring.cos_d) - ring.cos_d / eta_ti])
        })
    }

    fn over_rings(&self, last: f64, features: [Feature; 4], f: impl Fn(&Ring) -> f64) -> f64 {
        let Self { theta_i, cos_i, sin_i, alpha, .. } = *self;
        let (mut from, mut to) = (0.0f64, last);
        if self.cos_theta_h_min > 0.0 {
            let reach = libm::atan(BECKMANN_REACH * alpha);
            (from, to) = (from.max(theta_i - reach), to.min(theta_i + reach));
        }
        let mut sum = 0.0;
        visit_nodes(&self.rules.rings, [from, to], features, |theta_d, weight| {
            let (sin_d, cos_d) = (libm::sin(theta_d), libm::cos(theta_d));
            let sin_half = libm::sin(0.5 * (theta_d - theta_i));
            let ring = Ring { cos_d, versine: 2.0 * sin_half * sin_half, span: 2.0 * sin_d * sin_i };
            sum += weight * sin_d * cos_d * f(&ring);
        });
        sum * 2.0 / (cos_i * PI * alpha * alpha)
    }

    /// The integral of pi alpha^2 D G over half the azimuth of a ring, over facets whose light leaves at a cosine `z0 + z1 cos_theta_h > 0`.
    fn around(&self, ring: &Ring, [z0, z1]: [f64; 2]) -> f64 {
        let Self { alpha, horizon, .. } = *self;
        let Ring { versine, span, .. } = *ring;
        let mut range = [0.0, ring.h(self.cos_theta_h_min).min(1.0)];
        // The integrand changes fastest near two places beside the range: the peak of the distribution below it, and the horizon of the
        // light above it. Gaussian slopes end like exp(-1/cos^2), where the cosine of the facet is 0.
        let far = if self.cos_theta_h_min > 0.0 { ring.h(0.0) } else { f64::INFINITY };
        let mut near = [-(2.0 * versine + alpha * alpha) / (2.0 * span.max(TINY)), far];
        let (cut, scale) = (-z0 / z1, horizon / z1.abs());
        if z1 > 0.0 {
            range[1] = range[1].min(ring.h(cut));
            near[1] = near[1].min(ring.h(cut - scale));
        } else if z1 < 0.0 {
            range[0] = ring.h(cut).max(0.0);
            near[0] = near[0].max(ring.h(cut + scale));
        }
        let [from, to] = range;
        if to <= from {
            return 0.0;
        }
        let mut sum = 0.0;
        // The tangent t of half the azimuth up to 1, where h is 1/2; then 1/t.
        if from < 0.5 {
            let [ends, near] = [[from, to.min(0.5)], near].map(|pair| pair.map(|h| h / (1.0 - h)));
            sum += self.piece(ends, near, |t_sq| self.integrand(ring, [z0, z1], t_sq / (1.0 + t_sq)));
        }
        if to > 0.5 {
            // At an infinite h the cotangent has the limit i.
            let [ends, near] = [[to, from.max(0.5)], near]
                .map(|pair| pair.map(|h: f64| if h.is_infinite() { -1.0 } else { (1.0 - h) / h }));
            sum += self.piece(ends, near, |t_sq| self.integrand(ring, [z0, z1], 1.0 / (1.0 + t_sq)));
        }
        sum
    }

    /// pi alpha^2 D G of the facet at `h`.
    fn integrand(&self, ring: &Ring, [z0, z1]: [f64; 2], h: f64) -> f64 {
        let versine_h = ring.versine + ring.span * h;
        let cos_theta_h = 1.0 - versine_h;
        let sin_theta_h_sq = versine_h * (1.0 + cos_theta_h);
        let density = scaled_distribution(self.distribution, self.alpha, cos_theta_h, sin_theta_h_sq);
        density * self.masking(z0 + z1 * cos_theta_h)
    }

    /// The integral of `f(t^2)` over the azimuth whose half has tangent (or cotangent) t, between ends and near singular places given by
    /// their squares.
    fn piece(&self, ends: [f64; 2], near: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
        let [a, b] = ends.map(|sq| libm::sqrt(sq.max(0.0)));
        let length = b - a;
        // A negative square is a place beside the real line.
        let scales = [a, b].map(|end| {
            let near = near.map(|sq| if sq >= 0.0 { (end - libm::sqrt(sq)).abs() } else { libm::sqrt(end * end - sq) });
            near.into_iter().fold(f64::INFINITY, f64::min).max(SCALE_MIN)
        });
        // Graded to the end with a place near it, or to both.
        let parts = if scales[1] >= length {
            &[(a, length, scales[0])][..]
        } else if scales[0] >= length {
            &[(b, -length, scales[1])][..]
        } else {
            &[(a, 0.5 * length, scales[0]), (b, -0.5 * length, scales[1])][..]
        };
        let mut sum = 0.0;
        for &(end, step, scale) in parts {
            let reach = step.abs() / scale;
            for &(x, weight) in self.rules.azimuths.for_reach_squared(reach * reach) {
                let t = end + step * x;
                let t_sq = t * t;
                sum += weight * step.abs() * 2.0 / (1.0 + t_sq) * f(t_sq);
            }
        }
        sum
    }

    fn masking(&self, cos_o: f64) -> f64 {
        if cos_o <= 0.0 {
            return 0.0;
        }
        self.masking.of(self.lambda_i, || lambda(self.distribution, self.alpha, cos_o.min(1.0)))
    }
}
