//! Model by statistics: one stack in, one value out, with the energies that it has computed before.

use std::marker::PhantomData;

use glam::DVec3;

use super::evaluate::{Follow, Memory};
use super::spread::Spread;
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::monochrome::Monochrome;

/// A model whose lobes have spreads of type `S`, with FGD-infinity computed exactly. To read it from a table, see
/// [`evaluate`](super::evaluate::evaluate).
#[derive(Debug)]
pub struct Statistical<S> {
    follow: Follow,
    info: ModelInfo,
    memory: Memory,
    spread: PhantomData<fn() -> S>,
}

impl<S> Statistical<S> {
    /// The model of a paper, following one of the directions: its name, source, domain, and what it leaves out.
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
