//! Twin of `eval.wgsl`.

use glam::DVec3;
use luthier_optics::Rgb;

use super::{Components, Microfacet};
use crate::layers::Layers;
use crate::models::parts::Parts;
use crate::models::path::Tilts;
use crate::models::shade::{Given, Shade, ShaderTerms, Under};

#[derive(Debug)]
struct Twin {
    model: Microfacet,
    layers: Layers,
}

/// The twin for a surface, with the masking that the material chooses.
pub(super) fn twin(given: &Given<'_>) -> Box<dyn Shade> {
    let Parts { masking, diffuse_term, .. } = given.parts;
    let components = Components { masking, diffuse_term, ..Components::PLAIN };
    Box::new(Twin { model: Microfacet::new(components), layers: Layers::rgb(given.stack) })
}

impl Shade for Twin {
    fn eval(&self, terms: &dyn ShaderTerms, _: &Under, _: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        self.model.eval_with(&self.layers.layers, terms, wi, wo)
    }
}
