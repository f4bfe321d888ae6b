//! Models of statistics at one wavelength, which keep the energies of stacks.

use std::marker::PhantomData;

use glam::DVec3;

use super::evaluate::{Follow, Memory};
use super::spread::Spread;
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::monochrome::Monochrome;

/// A model whose lobes have spreads of type `S`. FGD-infinity is computed exactly; [`evaluate`](super::evaluate::evaluate) takes other sources, such
/// as a table.
#[derive(Debug)]
pub struct Statistical<S> {
    follow: Follow,
    info: ModelInfo,
    memory: Memory,
    spread: PhantomData<fn() -> S>,
}

impl<S> Statistical<S> {
    /// A published model with the statistics of one direction, and the texts of its listing: name, source, domain, omissions.
    pub(in crate::models) fn published(follow: Follow, [name, source, domain, leaves_out]: [&'static str; 4]) -> Self {
        let claims = match follow {
            Follow::Eye => Claims::ENERGY,
            Follow::HalfVector => Claims::RECIPROCAL,
        };
        let info = ModelInfo { name, kind: Kind::Layered, claims, source, domain, leaves_out, inputs: &[] };
        Self { follow, info, memory: Memory::default(), spread: PhantomData }
    }
}

impl<S: Spread> Model for Statistical<S> {
    fn info(&self) -> ModelInfo {
        self.info
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.memory.prepared(stack).eval::<S>(self.follow, wi, wo)
    }
}
