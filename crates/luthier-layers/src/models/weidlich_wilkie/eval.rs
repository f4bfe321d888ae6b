//! Twin of the path's kernels. The model has no others.

use glam::DVec3;
use luthier_optics::Rgb;

use super::WeidlichWilkie;
use crate::layers::Layers;
use crate::models::path::{Tilts, Walked, walk};
use crate::models::shade::{Given, Shade, ShaderTerms, Under};

#[derive(Debug)]
struct Twin {
    model: WeidlichWilkie,
    layers: Layers,
}

/// The twin for a surface.
pub(super) fn twin(given: &Given<'_>) -> Box<dyn Shade> {
    let model = WeidlichWilkie { internal_reflection: given.parts.internal_reflection, ..WeidlichWilkie::default() };
    Box::new(Twin { model, layers: Layers::rgb(given.stack) })
}

impl Shade for Twin {
    fn eval(&self, terms: &dyn ShaderTerms, _: &Under, tilts: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        walk(&self.model, &self.layers.layers, terms, wi, wo, tilts).value()
    }

    fn walked(&self, terms: &dyn ShaderTerms, tilts: Tilts<'_>, wi: DVec3, wo: DVec3) -> Option<Walked<3>> {
        Some(walk(&self.model, &self.layers.layers, terms, wi, wo, tilts))
    }
}
