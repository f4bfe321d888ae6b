//! Phong's model: one lobe over one diffuse term, the baseline for layered models.

mod eval;

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;
use luthier_model::ShadingModel;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use crate::formulas::normals::exponent;
use crate::formulas::plane_stack::seen_from_above;
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::models::room::{Kernels, Room};
use crate::monochrome::{Monochrome, MonochromeBelow, in_colors};

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels { eval: include_str!("eval.wgsl"), parts: include_str!("parts.wgsl"), ..Kernels::NONE },
    twin: eval::twin,
    models: || vec![Box::new(Phong)],
    composed: |_| None,
};

/// B. T. Phong, "Illumination for computer generated pictures", 1975: the single-layer shader of Elek's Table 1.
///
/// ```text
/// f cos_theta_i = k_d cos_theta_i / pi + k_s (e + 1) / (2 pi) max(0, r.wo)^e
/// ```
///
/// r is the mirror direction of `wi`. As in 1975, the lobe has no cosine and no Fresnel term. The only change is its scale: a whole lobe carries
/// k_s. The coefficients come from the stack at normal incidence: k_s is the reflectance of its interfaces, and k_d the albedo of the diffuse base
/// times the rest. The exponent e is that of the most reflecting layer: a quarter of Blinn's exponent `2/alpha^2 - 2`, because the lobe is about
/// the mirror direction, not the half vector.
///
/// Without the cosine the model is not reciprocal: an eye sees less than one of a white sky, but the albedo for grazing light exceeds one (3.7 for
/// alpha = 0.1 at 89 degrees).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Phong;

/// Coefficients of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// Diffuse, k_d.
    pub diffuse: f64,
    /// Specular, k_s.
    pub specular: f64,
    /// Exponent about the mirror direction.
    pub exponent: f64,
}

impl Coefficients {
    /// The coefficients of a stack.
    pub fn of(stack: &Monochrome) -> Self {
        let (mut diffuse, mut specular, mut most, mut alpha) = (0.0, 0.0, -1.0, 1.0);
        for (k, layer) in stack.layers.iter().enumerate() {
            let Some((powers, _)) = seen_from_above(stack, k, 1.0) else { break };
            if let MonochromeBelow::Diffuse { albedo, .. } = layer.below {
                diffuse = albedo * (1.0 - specular);
                break;
            }
            let reflected = layer.reflectance(1.0);
            let echo = (1.0 - powers.below * reflected).max(f64::MIN_POSITIVE);
            let share = powers.transmittance * powers.transmittance * reflected / echo;
            specular += share;
            if share > most {
                (most, alpha) = (share, layer.surface.alpha_isotropic());
            }
        }
        Self { diffuse, specular, exponent: 0.25 * exponent(alpha) }
    }

    /// The diffuse and the specular coefficient in colour.
    pub fn in_color(stack: &Stack, color: &Color) -> [Rgb; 2] {
        in_colors(stack, color, |one| {
            let Self { diffuse, specular, .. } = Self::of(one);
            [diffuse, specular]
        })
    }

    /// `f cos_theta_i`; zero unless both directions are above the horizon.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        self.with_lobe(wi, self.lobe(wi, wo))
    }

    /// `max(0, r.wo)^e`.
    fn lobe(&self, wi: DVec3, wo: DVec3) -> f64 {
        lobe(DVec3::new(-wi.x, -wi.y, wi.z), wo, self.exponent)
    }

    /// The value from the lobe, which channels share.
    fn with_lobe(&self, wi: DVec3, lobe: f64) -> f64 {
        let Self { diffuse, specular, exponent } = *self;
        FRAC_1_PI * diffuse * wi.z + specular * (exponent + 1.0) / (2.0 * PI) * lobe
    }
}

/// `max(0, a.b)^e` of unit directions. `1 - a.b` is computed as half the squared distance, which keeps its digits in narrow lobes.
pub(crate) fn lobe(a: DVec3, b: DVec3, e: f64) -> f64 {
    let away = 0.5 * (a - b).length_squared();
    if away < 1.0 { libm::exp(e * libm::log1p(-away)) } else { 0.0 }
}

impl Model for Phong {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: ShadingModel::Phong.name(),
            kind: Kind::Surface,
            claims: Claims::NONE,
            source: "Phong 1975; the single-layer shader of Elek 2010, Table 1",
            domain: "a visual stand-in for any stack",
            leaves_out: "Fresnel, absorption at an angle, reciprocity: everything but one lobe and one diffuse term",
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 { 0.0 } else { Coefficients::of(stack).eval(wi, wo) }
    }
}
