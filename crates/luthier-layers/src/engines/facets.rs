//! Facets that formats share: GGX with two slope parameters, at an angle to the tangent.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::dielectric_albedo::JointMasking;

/// Smallest slope parameter: smaller ones are drawn as this one, which is all but a mirror.
pub const ALPHA_MIN: f64 = 1e-3;

/// Slopes of an interface.
///
/// ```
/// use luthier_layers::engines::facets::Facets;
/// use luthier_layers::glam::DVec3;
/// use luthier_layers::luthier_optics::dielectric_albedo::JointMasking;
///
/// // Along the normal D G / 4 is 1 / (4 pi alpha^2).
/// let lobe = Facets::isotropic(0.5).lobe(JointMasking::Correlated, DVec3::Z, DVec3::Z);
/// assert!((lobe - 0.318_309_886).abs() < 1e-8);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facets {
    /// Slope parameters along and across the direction.
    pub alpha: [f64; 2],
    /// Angle from the surface's tangent to the direction, counter-clockwise, radians.
    pub turn: f64,
}

impl Facets {
    /// Facets without a direction.
    pub fn isotropic(alpha: f64) -> Self {
        Self { alpha: [alpha; 2], turn: 0.0 }
    }

    /// Geometric mean of both slope parameters.
    pub fn mean(&self) -> f64 {
        (self.alpha[0] * self.alpha[1]).sqrt()
    }

    /// `D G / (4 cos_theta_i cos_theta_o)` of GGX, with Smith's masking, of unit directions above the surface.
    pub fn lobe(&self, masking: JointMasking, wi: DVec3, wo: DVec3) -> f64 {
        let (sin, cos) = libm::sincos(self.turn);
        let turned = |w: DVec3| DVec3::new(cos * w.x + sin * w.y, cos * w.y - sin * w.x, w.z);
        let (wi, wo) = (turned(wi), turned(wo));
        let [x, y] = self.alpha.map(|alpha| alpha.max(ALPHA_MIN));
        let half = (wi + wo).normalize();
        let below = (half.x / x) * (half.x / x) + (half.y / y) * (half.y / y) + half.z * half.z;
        let density = 1.0 / (PI * x * y * below * below);
        let root = |w: DVec3| DVec3::new(x * w.x, y * w.y, w.z).length();
        let visible = match masking {
            JointMasking::Correlated => 0.5 / (wi.z * root(wo) + wo.z * root(wi)),
            JointMasking::Separable => 1.0 / ((wi.z + root(wi)) * (wo.z + root(wo))),
            JointMasking::Incident => 0.5 / ((wi.z + root(wi)) * wo.z),
        };
        density * visible
    }
}

/// Cosine of the half vector of two unit directions against either.
pub fn cos_theta_d(wi: DVec3, wo: DVec3) -> f64 {
    (wi + wo).normalize().dot(wo).clamp(0.0, 1.0)
}

/// Schlick's `(1 - cos)^5`.
pub fn grazing(cos_theta: f64) -> f64 {
    let c = 1.0 - cos_theta;
    let square = c * c;
    square * square * c
}
