//! Twin of `eval.wgsl`: each channel bends directions by its own index.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::stack::{Base, Stack, Surface};

use super::GranierHeidrich;
use crate::formulas::refraction::REFRACTION_WAVELENGTH_NM;
use crate::layers::ALPHA_MIN;
use crate::models::path::Tilts;
use crate::models::shade::{Given, Shade, ShaderTerms, Under};
use crate::monochrome::{Monochrome, MonochromeBelow};

#[derive(Debug)]
struct Twin {
    model: GranierHeidrich,
    channels: [Monochrome; 3],
}

/// The twin for a surface, with the material's numbers of beams.
pub(super) fn twin(given: &Given<'_>) -> Box<dyn Shade> {
    Box::new(Twin { model: given.parts.beams, channels: channels(given.stack, given.wavelengths_nm) })
}

impl Shade for Twin {
    fn eval(&self, terms: &dyn ShaderTerms, under: &Under, _: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        self.model.leaning(under.inner_normal).eval_with(&self.channels, terms, wi, wo)
    }
}

/// Stacks of the channels with isotropic surfaces. The slope parameter is the mean of both axes, clamped afterwards.
fn channels(stack: &Stack, wavelengths_nm: [f64; 3]) -> [Monochrome; 3] {
    let mut channels = [0, 1, 2].map(|c| Monochrome::new(stack, wavelengths_nm[c], c));
    for one in &mut channels {
        for (layer, given) in one.layers.iter_mut().zip(&stack.layers) {
            let alpha = given.surface.alpha_isotropic().clamp(ALPHA_MIN, 1.0);
            layer.surface = Surface::isotropic(given.surface.distribution, alpha);
        }
    }
    // The record of a Schlick interface has one index for all channels.
    let has_f0 = channels[0].layers.first().is_some_and(|layer| layer.bare_f0().is_some());
    channels.map(|one| if has_f0 { bend_alike(one, stack) } else { one })
}

/// The stack with the real indices of the common wavelength, which bend directions. Reflectances come from the terms.
fn bend_alike(mut one: Monochrome, stack: &Stack) -> Monochrome {
    for (layer, given) in one.layers.iter_mut().zip(&stack.layers) {
        if let (MonochromeBelow::Dielectric { ior, .. }, Base::Dielectric { ior: given, .. }) =
            (&mut layer.below, &given.base)
        {
            *ior = given.at(REFRACTION_WAVELENGTH_NM).re;
        }
    }
    Monochrome::joined(stack.exterior.at(REFRACTION_WAVELENGTH_NM).re, one.layers)
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::{Ior, IorSample};
    use luthier_optics::stack::{Distribution, Layer, Slab};

    use super::*;

    #[test]
    fn one_index_bends_all_channels_of_an_interface_with_an_f0() {
        let samples = [(400.0, 1.55, 0.0), (700.0, 1.45, 0.0)];
        let samples = samples.map(|(wavelength_nm, n, k)| IorSample { wavelength_nm, n, k }).to_vec();
        let coat = Ior::sampled(samples).unwrap();
        let surface = Surface::isotropic(Distribution::Ggx, 0.1);
        let slab = Slab { thickness_um: 10.0, absorption_per_um: [0.0; 3] };
        let metal = Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() };
        let layer = |base| Layer { films: Vec::new(), surface, base };
        let layers = vec![layer(Base::Dielectric { ior: coat.clone(), slab }), layer(metal)];
        let stack = Stack { exterior: Ior::vacuum(), layers };
        let alike = bend_alike(Monochrome::new(&stack, 645.0, 0), &stack);
        assert!((alike.layers[0].eta() - coat.at(REFRACTION_WAVELENGTH_NM).re).abs() < 1e-15);
        assert_eq!(alike.layers[1].above, alike.layers[0].eta());
    }
}
