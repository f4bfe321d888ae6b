//! Elek's real-time form of the layered model of Weidlich and Wilkie, for any number of layers.
//!
//! O. Elek, "Layered Materials in Real-Time Rendering", CESCG 2010, eq. 2-4 and Algorithm 1:
//!
//! ```text
//! f(i) = f_i(L, V) + T_12 f(i+1)(L', V') a t
//! T_12 = T_21 = 1 - F(V.H)      a = exp(-sigma d (1/NL' + 1/NV'))      t = (1 - G) + T_21 G
//! ```
//!
//! f_i is the Torrance-Sparrow BRDF `F D G / (4 NL NV)`, with D normalised (the paper's prefactors disagree with each other; see CONVENTIONS.md)
//! and G of V-cavities. L' and V' are refracted at the surface normal. As in the paper, a layer is never smoother than the one above it, which
//! stands for the blur of refraction.
//!
//! Simplifications of the model, all the paper's: no inter-reflection between layers, no 1/n^2 compression of radiance, `t` returns blocked light
//! heuristically, absorption and `f_i` combine in three colour channels. Roughness is isotropic: anisotropic surfaces have the geometric mean of
//! their slope parameters.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_model::{LowerCosine, LowerFacets, Masking, PathParts, ShadingModel};
use luthier_optics::masking::{kelemen, v_cavity};

use crate::formulas::facets::Lobe;
use crate::formulas::refraction::refract;
use crate::frame::half_vector;
use crate::layers::{ALPHA_MIN, Layer, Layers};
use crate::model::{Claims, Input, Kind, Model, ModelInfo};
use crate::models::parts::Parts;
use crate::models::path::{PathModel, Tilts, eval, power_lobe, walk};
use crate::models::room::{Kernels, Room};
use crate::monochrome::Monochrome;
use crate::terms::Terms;

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels { eval: include_str!("eval.wgsl"), ..Kernels::NONE },
    twin: |given| eval::twin(Elek::of(given.parts), Layers::isotropic_rgb(given.stack)),
    models: || vec![Box::new(Elek::default())],
    composed: |parts| Some(Box::new(Elek::of(parts))),
};

/// The real-time model. Layers are isotropic ([`Layers::isotropic`]). As a [`Model`], at one wavelength, the index of that wavelength bends
/// directions. In colour, one index bends the directions of all channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Elek {
    /// The parts that a material chooses.
    pub parts: PathParts,
}

impl Elek {
    /// The model with the parts that a material chooses.
    fn of(parts: Parts) -> Self {
        Self { parts: parts.path }
    }

    /// `f cos_theta_i` of the layers for light from `wi` seen from `wo`, per channel. It is zero if either direction is at or below the horizon, and
    /// finite for all unit directions. With T_12 and T_21 at the half vector every factor of eq. 2 is symmetric, so the model is reciprocal; with
    /// [`LowerCosine::Inside`] it is not.
    pub fn eval_with<const C: usize>(
        &self,
        layers: &[Layer<C>],
        terms: &dyn Terms<C>,
        wi: DVec3,
        wo: DVec3,
    ) -> [f64; C] {
        self.eval_below(layers, terms, wi, wo, DVec3::Z)
    }

    /// [`Self::eval_with`] with another normal below the first interface (unit, in the surface's frame), as flakes in the coat have (Elek 2010,
    /// section 4.1). Refracted directions and path lengths in the first slab are measured against it, as in the paper's code. If a refracted direction
    /// is at or below its horizon, the layers below are dark.
    pub fn eval_below<const C: usize>(
        &self,
        layers: &[Layer<C>],
        terms: &dyn Terms<C>,
        wi: DVec3,
        wo: DVec3,
        normal_below: DVec3,
    ) -> [f64; C] {
        walk(self, layers, terms, wi, wo, Tilts { below: normal_below, own: &[] }, false).value()
    }

    /// [`Self::eval_below`] of a stack, with factors on the reflectance of the first interface and of all others.
    pub(crate) fn eval_tinted(
        self,
        stack: &Monochrome,
        tint: [f64; 2],
        wi: DVec3,
        wo: DVec3,
        normal_below: DVec3,
    ) -> f64 {
        let layers = Layers::from(stack).isotropic().layers;
        let [value] = self.eval_below(&layers, &Tinted { stack, tint }, wi, wo, normal_below);
        value
    }
}

impl PathModel for Elek {
    fn parts(&self) -> PathParts {
        self.parts
    }

    fn cosines(&self, cos_theta_i: f64) -> [f64; 2] {
        [cos_theta_i, 1.0]
    }

    /// A layer has the greatest slope parameter of itself and those above: it is never smoother than one above it.
    fn facets<const C: usize>(&self, layers: &[Layer<C>], terms: &dyn Terms<C>, wi: DVec3, wo: DVec3) -> Option<Lobe> {
        let (wh, cos_theta_d) = half_vector(wi, wo)?;
        let (last, above) = layers.split_last()?;
        let alpha = layers.iter().map(|layer| layer.surface.alpha_x).fold(ALPHA_MIN, f64::max);
        let own = if above.is_empty() { LowerFacets::TorranceSparrow } else { self.parts.lower_facets };
        if let Some(value) = power_lobe(own, alpha, wi, wo) {
            return Some(Lobe { cos_theta_d, masking: 1.0, value });
        }
        let sin_theta_h_sq = wh.x * wh.x + wh.y * wh.y;
        let scaled = terms.distribution(above.len(), last.surface.distribution, alpha, wh.z, sin_theta_h_sq);
        let masking = match self.parts.cavity_masking() {
            Masking::Kelemen => kelemen(wi.z, wo.z, cos_theta_d),
            _ => v_cavity(wi.z, wo.z, wh.z, cos_theta_d),
        };
        let value = scaled / (PI * alpha * alpha) * masking / (4.0 * wi.z * wo.z);
        Some(Lobe { cos_theta_d, masking, value })
    }

    fn refracted(&self, eta: f64, wi: DVec3, wo: DVec3) -> Option<[DVec3; 2]> {
        Some([refract(wi, eta)?, refract(wo, eta)?])
    }

    fn sent(&self, passed: f64, _cosines: f64, reflectance: f64, lobe: f64) -> f64 {
        passed * (reflectance * lobe)
    }

    fn kept(&self, entered: f64, left: f64, absorbed: f64) -> f64 {
        entered * absorbed * left
    }
}

impl Model for Elek {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: ShadingModel::Elek.name(),
            kind: Kind::Layered,
            claims: match self.parts.lower_cosine {
                LowerCosine::Outside => Claims::RECIPROCAL,
                LowerCosine::Inside => Claims::NONE,
            },
            source: "Elek 2010, eq. 2-4 and Algorithm 1",
            domain: "any number of isotropic interfaces above a conductor or a diffuse base; alpha from 1e-3",
            leaves_out: "bounces between layers, 1/n^2, blur by refraction (stood for by the roughness clamp)",
            inputs: &[Input::Environment],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let [value] = self.eval_with(&Layers::from(stack).isotropic().layers, stack, wi, wo);
        value
    }
}

/// Light of an environment that a smooth first interface would mirror (Algorithm 1, lines 28 and 29): its reflectance at the angle of `wo`, times
/// the radiance from the mirror direction. Callers blur `environment` to the roughness of the interface.
pub fn environment(stack: &Monochrome, wo: DVec3, environment: impl FnOnce(DVec3) -> f64) -> f64 {
    match stack.layers.first() {
        Some(layer) if wo.z > 0.0 => {
            let reflectance = layer.reflectance(wo.z.min(1.0));
            if reflectance == 0.0 { 0.0 } else { reflectance * environment(DVec3::new(-wo.x, -wo.y, wo.z)) }
        }
        _ => 0.0,
    }
}

/// Terms of a stack at one wavelength, with factors on the reflectance of the first interface and of all others.
struct Tinted<'a> {
    stack: &'a Monochrome,
    tint: [f64; 2],
}

impl Terms<1> for Tinted<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> [f64; 1] {
        self.stack.fresnel(layer, cos_theta_d).map(|reflectance| self.tint[layer.min(1)] * reflectance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twins::terms;
    use luthier_optics::color::Color;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{self, Base, Distribution, Slab, Stack, Surface};

    fn lacquer() -> Stack {
        let coat = Base::Dielectric {
            ior: Ior::constant(1.5, 0.0).unwrap(),
            slab: Slab { thickness_um: 10.0, absorption_per_um: [0.01, 0.02, 0.03] },
        };
        let metal = Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() };
        let layer = |alpha, base| stack::Layer {
            films: Vec::new(),
            surface: Surface::isotropic(Distribution::Beckmann, alpha),
            base,
        };
        Stack { exterior: Ior::vacuum(), layers: vec![layer(0.05, coat), layer(0.3, metal)] }
    }

    /// One channel is that of three: channels share directions, and nothing else. Values are compared with other programs elsewhere.
    #[test]
    fn one_wavelength_at_a_time_is_the_colour_form() {
        let stack = lacquer();
        let (wi, wo) = (DVec3::new(0.3, 0.1, 0.7).normalize(), DVec3::new(-0.2, 0.2, 0.9).normalize());
        let exact = terms::Exact::new(&stack, Color::ThreeWavelengths([645.0, 525.0, 445.0]));
        let rgb = Elek::default().eval_with(&Layers::isotropic_rgb(&stack).layers, &exact, wi, wo);
        for (channel, wavelength) in [645.0, 525.0, 445.0].into_iter().enumerate() {
            let found = Elek::default().eval(&Monochrome::new(&stack, wavelength, channel), wi, wo);
            assert!((found - rgb[channel]).abs() < 1e-15 + 1e-13 * found, "{found} {}", rgb[channel]);
        }
    }

    /// By hand: swapped directions swap the cosine by which the lower layer counts, and its ratio to that outside.
    #[test]
    fn the_inner_cosine_is_not_reciprocal() {
        let stack = Monochrome::new(&lacquer(), 550.0, 0);
        let mut bare = stack.clone();
        bare.layers.truncate(1);
        let at = |theta: f64| DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
        let (wi, wo) = (at(1.1), at(-0.4));
        let ratio = |w: DVec3| (1.0 - (1.0 - w.z * w.z) / 2.25).sqrt() / w.z;
        let model = Elek { parts: PathParts { lower_cosine: LowerCosine::Inside, ..PathParts::PLAIN } };
        let below = |wi: DVec3, wo| (model.eval(&stack, wi, wo) - model.eval(&bare, wi, wo)) / wi.z;
        let apart = below(wi, wo) / below(wo, wi) * ratio(wo) / ratio(wi);
        assert!((apart - 1.0).abs() < 1e-9 && ratio(wi) > 1.5 * ratio(wo), "{apart}");
        assert_eq!((model.info().claims, Elek::default().info().claims), (Claims::NONE, Claims::RECIPROCAL));
    }

    #[test]
    fn the_environment_is_mirrored_by_fresnel() {
        let stack = Monochrome::new(&lacquer(), 550.0, 0);
        let wo = DVec3::new(0.5f64.sqrt(), 0.0, 0.5f64.sqrt());
        let found = environment(&stack, wo, |w| if w.x < 0.0 { 2.0 } else { 0.0 });
        // Fresnel at 45 degrees, n = 1.5: physics of the interface to ten digits.
        assert!((found - 2.0 * 0.0502399110).abs() < 1e-9, "{found}");
    }
}
