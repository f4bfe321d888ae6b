//! Twin of `eval.wgsl`: the facets of the first interface, and the light from below it that terms have in rows.

use glam::{DVec2, DVec3};
use luthier_optics::Rgb;

use super::below::UP_MIN;
use crate::frame;
use crate::layers::{Below, Layer, Layers};
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
    fn eval(&self, terms: &dyn ShaderTerms, under: &Under, tilts: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        let Some(layer) = self.layers.layers.first() else { return [0.0; 3] };
        let (normal, own) = frame::on_first(DVec3::Z, tilts.own, self.layers.layers.len());
        let [wi, wo] = [wi, wo].map(|w| frame::local(normal, w));
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; 3];
        }
        let first = self.facets.eval_with(std::slice::from_ref(layer), terms, wi, wo);
        let below = match layer.below {
            Below::Dielectric { .. } | Below::Conductor => terms.below(wo),
            Below::Diffuse { .. } => None,
        };
        let Some(mut below) = below else { return first };
        if under.slope_variance > 0.0 {
            below = below.widened(wo, under.slope_variance);
        }
        if let Some(albedo) = under.base_color {
            below = below.over_base(albedo);
        }
        if let Below::Dielectric { ior, .. } = layer.below {
            let index = ior / self.layers.exterior;
            let [lowest, base] = self.lower_normals(&own);
            if let Some(normal) = both(under.flake_normal, lowest) {
                below = below.tilted(normal, index);
            }
            if base != DVec3::Z {
                below = below.leaning(base, index, under.base_color);
            }
        }
        let below = below.eval(wi);
        [0, 1, 2].map(|c: usize| first[c] + below[c])
    }
}

impl Twin {
    /// The normals of the lowest interface and of a diffuse base below it, of those of all layers.
    fn lower_normals(&self, own: &[DVec3]) -> [DVec3; 2] {
        let layers = &self.layers.layers;
        let is_base = |layer: &Layer<3>| matches!(layer.below, Below::Diffuse { .. });
        let lowest = layers.iter().rposition(|layer| !is_base(layer));
        let base = layers.len().checked_sub(1).filter(|last| is_base(&layers[*last]));
        [lowest, base].map(|number| number.and_then(|number| own.get(number).copied()).unwrap_or(DVec3::Z))
    }
}

/// The normal whose slope is the sum of those of two; `None` if both are level.
fn both(a: DVec3, b: DVec3) -> Option<DVec3> {
    let normals = [a, b].into_iter().filter(|normal| *normal != DVec3::Z);
    let slopes = normals.map(|normal| DVec2::new(normal.x, normal.y) / normal.z.max(UP_MIN));
    let slope = slopes.reduce(|a, b| a + b)?;
    Some(slope.extend(1.0).normalize())
}
