//! Twin of the kernels of a path, and of the interface that a model adds in its own `eval.wgsl`.

use std::fmt::Debug;

use glam::DVec3;
use luthier_optics::Rgb;

use super::{PathModel, Tilts, Walked, walk};
use crate::layers::Layers;
use crate::models::shade::{Shade, ShaderTerms, Under};

#[derive(Debug)]
struct Twin<M> {
    model: M,
    layers: Layers,
}

/// The twin of a model for the layers of a surface.
pub(in crate::models) fn twin(model: impl PathModel + Debug + Send + Sync + 'static, layers: Layers) -> Box<dyn Shade> {
    Box::new(Twin { model, layers })
}

impl<M: PathModel + Debug + Send + Sync> Shade for Twin<M> {
    fn eval(&self, terms: &dyn ShaderTerms, _: &Under, tilts: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        walk(&self.model, &self.layers.layers, terms, wi, wo, tilts, false).value()
    }

    fn walked(&self, terms: &dyn ShaderTerms, tilts: Tilts<'_>, wi: DVec3, wo: DVec3) -> Option<Walked<3>> {
        Some(walk(&self.model, &self.layers.layers, terms, wi, wo, tilts, true))
    }
}
