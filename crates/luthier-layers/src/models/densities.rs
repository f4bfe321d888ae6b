//! Sampling densities by name, by which a Monte Carlo renderer divides `f cos_theta_i`.
//!
//! The value is the density in solid angle of `wi`, for the direction `wo` of the eye. Its integral over `wi` (the albedo of the listing) is the
//! share of draws above the horizon: 1 for the local method. For the global method it is the number of layers, because each proposes a direction.

use glam::DVec3;
use luthier_optics::microfacet::{Anisotropic, to_layer};
use luthier_optics::sampling::{CosineHemisphere, Mixture, Sampler as DirectionSampler, VisibleNormals};
use luthier_optics::stack::Surface;

use crate::formulas::facets::ALPHA_MIN;
use crate::model::{Claims, Input, Inputs, Kind, Model, ModelInfo, WEIGHTS_MOST};
use crate::models::weidlich_wilkie::sampling::Sampler;
use crate::monochrome::Monochrome;

/// A sampling method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Density {
    /// Cosine over pi.
    Cosine,
    /// Reflection at a facet of the first interface that the eye sees.
    VisibleNormals,
    /// Half of either, the densities added (balance heuristic).
    Mixture,
    /// The local method of Weidlich and Wilkie: one direction for all layers.
    LocalLayers,
    /// The global method of Weidlich and Wilkie: one proposal for each layer, and the sum of their densities.
    GlobalLayers,
}

impl Density {
    /// All methods, in the order of listings.
    pub const ALL: [Self; 5] =
        [Self::Cosine, Self::VisibleNormals, Self::Mixture, Self::LocalLayers, Self::GlobalLayers];
}

impl Model for Density {
    fn info(&self) -> ModelInfo {
        let (name, source) = match self {
            Self::Cosine => ("density-cosine", "Malley's method: a disc lifted to the hemisphere"),
            Self::VisibleNormals => {
                ("density-visible-normals", "GGX: Dupuy and Benyoub 2023; Beckmann: Heitz and d'Eon 2014")
            }
            Self::Mixture => ("density-mixture", "half cosine, half visible normals; Veach and Guibas 1995"),
            Self::LocalLayers => ("density-layers-local", "Weidlich and Wilkie 2009, section 3.2.4, eq. 3.6"),
            Self::GlobalLayers => (
                "density-layers-global",
                "Weidlich and Wilkie 2009, section 3.2.2: the sum over layers, each of which integrates to 1",
            ),
        };
        let (domain, leaves_out) = match self {
            Self::Cosine => ("any stack", "what the surface looks like"),
            Self::VisibleNormals | Self::Mixture => {
                ("the first interface, anisotropic or not; alpha from 1e-4", "all layers below")
            }
            Self::LocalLayers | Self::GlobalLayers => ("any stack; alpha from 1e-4", "blur by refraction"),
        };
        let claims = Claims::NONE;
        let inputs: &[Input] = if *self == Self::LocalLayers { &[Input::Weights] } else { &[] };
        ModelInfo { name, kind: Kind::Density, claims, source, domain, leaves_out, inputs }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let Some(layer) = stack.layers.first() else { return 0.0 };
        if wi.z <= 0.0 || wo.z <= 0.0 || (wi + wo).length() == 0.0 {
            return 0.0;
        }
        match self {
            Self::Cosine => CosineHemisphere.pdf_solid_angle(wo, wi),
            Self::VisibleNormals => turned(&layer.surface, wi, wo, |normals| normals),
            Self::Mixture => turned(&layer.surface, wi, wo, |normals| {
                Mixture::default().with(1.0, CosineHemisphere).with(1.0, normals)
            }),
            Self::LocalLayers => Sampler::new(stack, wo).pdf_solid_angle(wi),
            Self::GlobalLayers => Sampler::new(stack, wo).sum_of_densities(wi),
        }
    }

    fn with_inputs(&self, inputs: &Inputs) -> Option<Box<dyn Model>> {
        let weights = inputs.weights.filter(|_| *self == Self::LocalLayers)?;
        Some(Box::new(WeightedLayers { weights }))
    }
}

/// The local method with weights that one chooses.
#[derive(Debug, Clone, Copy, PartialEq)]
struct WeightedLayers {
    weights: [f64; WEIGHTS_MOST],
}

impl Model for WeightedLayers {
    fn info(&self) -> ModelInfo {
        Density::LocalLayers.info()
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 || (wi + wo).length() == 0.0 {
            return 0.0;
        }
        Sampler::new(stack, wo).weighted(&self.weights).pdf_solid_angle(wi)
    }
}

/// The density of a method built on the visible normals of a surface, evaluated in the frame of its tangent.
fn turned<S: DirectionSampler>(surface: &Surface, wi: DVec3, wo: DVec3, method: impl Fn(VisibleNormals) -> S) -> f64 {
    let [alpha_x, alpha_y] = [surface.alpha_x, surface.alpha_y].map(|alpha| alpha.clamp(ALPHA_MIN, 1.0));
    let [wi, wo] = [wi, wo].map(|w| to_layer(surface.rotation, w));
    // Slope parameters in that range are always accepted.
    Anisotropic::new(surface.distribution, alpha_x, alpha_y)
        .map_or(0.0, |ndf| method(VisibleNormals { ndf }).pdf_solid_angle(wo, wi))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::directional_albedo::directional_albedo;
    use crate::formulas::facets::Facets;
    use crate::monochrome::MonochromeBelow;
    use luthier_optics::stack::Distribution;

    fn varnished() -> Monochrome {
        let surface = Surface { distribution: Distribution::Ggx, alpha_x: 0.4, alpha_y: 0.1, rotation: 0.6 };
        let base = MonochromeBelow::Diffuse { albedo: 0.7, sigma: 0.0 };
        Monochrome::bare(&[MonochromeBelow::dielectric(1.5, 0.2), base].map(|below| (surface, below)))
    }

    /// One minus what is lost: nothing of the cosine's draws; of reflections at GGX facets, seen from the normal, those steeper than 45
    /// degrees, which leaves 1/sqrt((1 + alpha_x^2)(1 + alpha_y^2)); nothing of the methods for layers, whose global one has two.
    #[test]
    fn densities_integrate_to_what_is_not_lost() {
        let stack = varnished();
        let share = |density| directional_albedo(&density, &stack, DVec3::Z).value;
        let [cosine, normals, mixture, local, global] = Density::ALL.map(share);
        assert!((cosine - 1.0).abs() < 1e-6, "{cosine}");
        assert!((normals - 1.0 / libm::sqrt(1.16 * 1.01)).abs() < 1e-4, "{normals}");
        assert!((mixture - 0.5 * (cosine + normals)).abs() < 2e-4, "{mixture}");
        assert!((local - 1.0).abs() < 2e-3, "{local}");
        assert!((global - 2.0).abs() < 4e-3, "{global}");
    }

    /// By hand: all weight on the Lambertian base, whose density is the cosine over pi; and half on each layer.
    #[test]
    fn weights_of_layers_can_be_chosen() {
        let stack = varnished();
        let (wi, wo) = (DVec3::new(0.2, 0.5, 0.8).normalize(), DVec3::new(-0.3, 0.1, 0.7).normalize());
        let weighted = |first: f64, second: f64| {
            let mut weights = [0.0; WEIGHTS_MOST];
            (weights[0], weights[1]) = (first, second);
            let model = Density::LocalLayers.with_inputs(&Inputs { weights: Some(weights), ..Inputs::default() });
            model.unwrap().eval(&stack, wi, wo)
        };
        let base = wi.z / std::f64::consts::PI;
        assert!((weighted(0.0, 3.0) / base - 1.0).abs() < 1e-12, "{} {base}", weighted(0.0, 3.0));
        let sum = Density::GlobalLayers.eval(&stack, wi, wo);
        assert!((weighted(2.0, 2.0) / (0.5 * sum) - 1.0).abs() < 1e-12);
        assert!((weighted(1.0, 0.0) + base - sum).abs() < 1e-12);
    }

    /// Oracle: the facets of this crate, which are another road to the same.
    #[test]
    fn visible_normals_are_turned_with_the_surface() {
        let stack = varnished();
        let (wi, wo) = (DVec3::new(0.2, 0.5, 0.8).normalize(), DVec3::new(-0.3, 0.1, 0.7).normalize());
        let expected = Facets::new(&stack.layers[0].surface).pdf_solid_angle(wi, wo);
        assert!((Density::VisibleNormals.eval(&stack, wi, wo) / expected - 1.0).abs() < 1e-12);
        assert_eq!(Density::VisibleNormals.eval(&stack, -wi, wo), 0.0);
    }
}
