//! Twin of `eval.wgsl`: the facets of the first interface, and the light from below it that terms have in rows.

use glam::DVec3;
use luthier_optics::Rgb;

use crate::layers::{Below, Layers};
use crate::models::microfacet::{Components, Microfacet};
use crate::models::path::Tilts;
use crate::models::shade::{Given, Shade, ShaderTerms, Under};

#[derive(Debug)]
struct Twin {
    facets: Microfacet,
    layers: Layers,
}

/// The twin for a surface.
pub(super) fn twin(given: &Given<'_>) -> Box<dyn Shade> {
    Box::new(Twin { facets: Microfacet::new(Components::PLAIN), layers: Layers::rgb(given.stack) })
}

impl Shade for Twin {
    fn eval(&self, terms: &dyn ShaderTerms, under: &Under, _: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        let Some(layer) = self.layers.layers.first() else { return [0.0; 3] };
        let first = self.facets.eval_with(std::slice::from_ref(layer), terms, wi, wo);
        let below = match layer.below {
            Below::Dielectric { .. } | Below::Conductor if wi.z > 0.0 => terms.below(wo),
            _ => None,
        };
        let Some(mut below) = below else { return first };
        if under.slope_variance > 0.0 {
            below = below.widened(wo, under.slope_variance);
        }
        if let Some(albedo) = under.base_color {
            below = below.over_base(albedo);
        }
        if let Below::Dielectric { ior, .. } = layer.below
            && under.flake_normal != DVec3::Z
        {
            below = below.tilted(under.flake_normal, ior / self.layers.exterior);
        }
        let below = below.eval(wi);
        [0, 1, 2].map(|c: usize| first[c] + below[c])
    }
}
