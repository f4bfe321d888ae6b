//! Twin of the kernels of statistics: three channels that share directions and spreads.

use std::fmt::Debug;
use std::marker::PhantomData;

use glam::DVec3;
use luthier_optics::Rgb;

use super::diffuse_base::DiffuseBase;
use super::evaluate::{Follow, evaluate};
use super::spread::Spread;
use crate::layers::{Below, Layers};
use crate::models::path::Tilts;
use crate::models::shade::{Given, Shade, ShaderTerms, Under};

#[derive(Debug)]
struct Twin<S> {
    layers: Layers,
    spread: PhantomData<fn() -> S>,
}

/// The twin for a surface, with spreads of type `S`.
pub(in crate::models) fn twin<S: Spread + Debug + 'static>(given: &Given<'_>) -> Box<dyn Shade> {
    Box::new(Twin::<S> { layers: Layers::rgb(given.stack), spread: PhantomData })
}

impl<S: Spread + Debug> Shade for Twin<S> {
    fn eval(&self, terms: &dyn ShaderTerms, _: &Under, _: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        // A veil may take long to compute.
        let has_base = self.layers.layers.last().is_some_and(|last| matches!(last.below, Below::Diffuse { .. }));
        let base = if has_base { DiffuseBase::veiled(&self.layers, terms.veil()) } else { None };
        evaluate::<S, 3>(&self.layers, terms, base.as_ref(), Follow::Eye, wi, wo)
    }
}
