//! Evaluation of a BRDF from energies and spreads.

use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use luthier_model::Masking;

use super::adding::add;
use super::diffuse_base::{DiffuseBase, Veil};
use super::energy::{Energy, ExactEnergy, FacetCache};
use super::spread::Spread;
use crate::formulas::facets::Facets;
use crate::frame::cos_theta_d;
use crate::layers::Layers;
use crate::monochrome::Monochrome;

/// The direction whose statistics all lobes have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Follow {
    /// The eye's direction, as in the papers, whose paths start there. It takes one evaluation per pixel, and lobes carry their energy exactly. Not
    /// reciprocal.
    Eye,
    /// The angle of both directions against the half vector. It takes one evaluation per light. Reciprocal.
    HalfVector,
}

/// `f cos_theta_i` of all lobes and the diffuse base. A lobe is a GGX surface of its spread, with height-correlated Smith masking (Yamaguchi et al.
/// 2019, eq. 3).
///
/// FGD-infinity counts light that leaves such a surface downward or is blocked on it, and the lobe loses it. So directional albedos fall short of
/// the energies by the losses of single scattering.
pub fn evaluate<S: Spread, const C: usize>(
    stack: &Layers<C>,
    energy: &dyn Energy<C>,
    base: Option<&DiffuseBase<C>>,
    follow: Follow,
    wi: DVec3,
    wo: DVec3,
) -> [f64; C] {
    let mut sum = [0.0; C];
    if wi.z <= 0.0 || wo.z <= 0.0 {
        return sum;
    }
    let cos_theta = match follow {
        Follow::Eye => wo.z,
        Follow::HalfVector => cos_theta_d(wi, wo),
    };
    for lobe in add::<S, C>(stack, energy, cos_theta).lobes {
        if lobe.energy.iter().any(|&energy| energy > 0.0) {
            let facets = Facets::new(&lobe.spread.surface()).lobe(Masking::Smith, wi, wo);
            let value = facets.map_or(0.0, |l| l.value);
            sum.iter_mut().zip(lobe.energy).for_each(|(sum, energy)| *sum += energy * value);
        }
    }
    if let Some(base) = base {
        let [light, eye] = [wi, wo].map(|w| add::<S, C>(stack, energy, w.z));
        let brdf = base.brdf((wi, &light), (wo, &eye));
        sum.iter_mut().zip(brdf).for_each(|(sum, f)| *sum += f * wi.z);
    }
    sum
}

/// A stack with its energies, which do not depend on directions.
#[derive(Debug, Clone)]
pub struct Prepared {
    stack: Monochrome,
    layers: Layers<1>,
    energy: ExactEnergy,
    base: Option<DiffuseBase<1>>,
}

impl Prepared {
    /// Computes the energies of a stack: tens of milliseconds for a rough interface.
    pub fn new(stack: &Monochrome) -> Self {
        Self::with_facets(stack, &mut FacetCache::default())
    }

    fn with_facets(stack: &Monochrome, facets: &mut FacetCache) -> Self {
        let energy = ExactEnergy::with_facets(stack, facets);
        let layers = Layers::from(stack);
        let base = DiffuseBase::new(&layers, &energy);
        Self { stack: stack.clone(), layers, energy, base }
    }

    /// The layers that the statistics follow.
    pub fn layers(&self) -> &Layers<1> {
        &self.layers
    }

    /// Effect of the layers on the light of a diffuse base; `None` without one.
    pub fn veil(&self) -> Option<Veil<1>> {
        self.base.as_ref().map(DiffuseBase::veil)
    }

    /// The energies.
    pub fn energy(&self) -> &ExactEnergy {
        &self.energy
    }

    /// `f cos_theta_i`; see [`evaluate`].
    pub fn eval<S: Spread>(&self, follow: Follow, wi: DVec3, wo: DVec3) -> f64 {
        let [value] = evaluate::<S, 1>(&self.layers, &self.energy, self.base.as_ref(), follow, wi, wo);
        value
    }
}

/// The most stacks that a model keeps prepared.
const KEPT: usize = 1024;

/// Prepared stacks of a model, for evaluation direction by direction. Values do not depend on which stacks are kept.
#[derive(Debug, Default)]
pub struct Memory {
    kept: Mutex<Kept>,
}

#[derive(Debug, Default)]
struct Kept {
    facets: FacetCache,
    stacks: Vec<Arc<Prepared>>,
}

impl Memory {
    /// The stack, prepared now or before.
    pub fn prepared(&self, stack: &Monochrome) -> Arc<Prepared> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = kept.stacks.iter().rev().find(|p| p.stack == *stack) {
            return Arc::clone(known);
        }
        if kept.stacks.len() == KEPT {
            *kept = Kept::default();
        }
        let prepared = Arc::new(Prepared::with_facets(stack, &mut kept.facets));
        kept.stacks.push(Arc::clone(&prepared));
        prepared
    }
}
