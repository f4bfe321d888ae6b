//! Elek's model at one wavelength.

use glam::DVec3;
use luthier_model::{InternalReflection, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::stack::Diffuse;

use crate::layers::ALPHA_MIN;
use crate::model::{Claims, Input, Kind, Model, ModelInfo};
use crate::models::elek::{self, Below, Layer};
use crate::monochrome::{Monochrome, MonochromeBelow};
use crate::terms::Terms;

/// The real-time model of [`elek`] with exact terms at one wavelength: the index that bends the directions is the wavelength's
/// own, where the colour form has one scalar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Elek {
    /// Light from below that interfaces let out.
    pub internal_reflection: InternalReflection,
}

impl Model for Elek {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: ShadingModel::Elek.name(),
            kind: Kind::Layered,
            claims: Claims::RECIPROCAL,
            source: "Elek 2010, eq. 2-4 and Algorithm 1",
            domain: "any number of isotropic interfaces above a conductor or a diffuse base; alpha from 1e-3",
            leaves_out: "bounces between layers, 1/n^2, blur by refraction (stood for by the roughness clamp)",
            inputs: &[Input::Environment],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let one = |layer| Layer { internal_reflection: self.internal_reflection, ..layer };
        let layers: Vec<Layer> = layers(stack).into_iter().map(one).collect();
        let [value, ..] = elek::eval(&layers, &Exact { stack, tint: [1.0; 2] }, wi, wo);
        value
    }
}

/// The model with another normal below the first interface, see [`elek::eval_below`], and factors on the reflectance of the
/// first interface and of all others.
pub(crate) fn eval_below(stack: &Monochrome, tint: [f64; 2], wi: DVec3, wo: DVec3, normal_below: DVec3) -> f64 {
    let [value, ..] = elek::eval_below(&layers(stack), &Exact { stack, tint }, wi, wo, normal_below);
    value
}

/// Light of an environment that a smooth first interface would mirror (Algorithm 1, lines 28 and 29): its reflectance at the
/// angle of `wo`, times the radiance from the mirror direction. `environment` is to be blurred to the interface's
/// roughness, which this term cannot do by itself.
pub fn environment(stack: &Monochrome, wo: DVec3, environment: impl FnOnce(DVec3) -> f64) -> f64 {
    match stack.layers.first() {
        Some(layer) if wo.z > 0.0 => {
            let reflectance = layer.reflectance(wo.z.min(1.0));
            if reflectance == 0.0 { 0.0 } else { reflectance * environment(DVec3::new(-wo.x, -wo.y, wo.z)) }
        }
        _ => 0.0,
    }
}

/// The layers as [`elek::eval`] takes them, all channels alike.
pub(crate) fn layers(stack: &Monochrome) -> Vec<Layer> {
    stack
        .layers
        .iter()
        .map(|layer| Layer {
            distribution: layer.surface.distribution,
            alpha: layer.surface.alpha_isotropic().clamp(ALPHA_MIN, 1.0),
            below: match layer.below {
                MonochromeBelow::Dielectric { optical_depth, .. } => {
                    Below::Dielectric { eta: layer.eta(), optical_depth: [optical_depth; 3] }
                }
                MonochromeBelow::Conductor { .. } => Below::Conductor,
                MonochromeBelow::Diffuse { albedo, sigma } => Below::Diffuse(Diffuse { albedo: [albedo; 3], sigma }),
            },
            internal_reflection: InternalReflection::Facets,
        })
        .collect()
}

/// Exact terms of a stack at one wavelength.
struct Exact<'a> {
    stack: &'a Monochrome,
    tint: [f64; 2],
}

impl Terms for Exact<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        let tint = if layer == 0 { self.tint[0] } else { self.tint[1] };
        [self.stack.layers.get(layer).map_or(0.0, |l| tint * l.reflectance(cos_theta_d)); 3]
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

    /// Oracle: the colour form, which is tested against other programs.
    #[test]
    fn one_wavelength_at_a_time_is_the_colour_form() {
        let stack = lacquer();
        let (wi, wo) = (DVec3::new(0.3, 0.1, 0.7).normalize(), DVec3::new(-0.2, 0.2, 0.9).normalize());
        let exact = terms::Exact::new(&stack, Color::ThreeWavelengths([645.0, 525.0, 445.0]));
        let rgb = elek::eval(&elek::layers(&stack), &exact, wi, wo);
        for (channel, wavelength) in [645.0, 525.0, 445.0].into_iter().enumerate() {
            let found = Elek::default().eval(&Monochrome::new(&stack, wavelength, channel), wi, wo);
            assert!((found - rgb[channel]).abs() < 1e-15 + 1e-13 * found, "{found} {}", rgb[channel]);
        }
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
