//! From energies and spreads to a BRDF.

use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::adding::add;
use super::diffuse_base::DiffuseBase;
use super::energy::{Energy, ExactEnergy, FacetCache};
use super::spread::Spread;
use crate::facets::{Facets, Masking};
use crate::monochrome::Monochrome;

/// The direction whose statistics all lobes are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Follow {
    /// The eye's, as in the papers (whose paths start there): once per pixel, and lobes carry their energy exactly. Not reciprocal.
    Eye,
    /// Either direction against the half vector: once per light, and reciprocal.
    HalfVector,
}

/// `f cos_theta_i`: every lobe of the stack as a GGX surface of its spread with height-correlated Smith masking (Yamaguchi et al.
/// 2019, eq. 3), plus the diffuse base.
///
/// Light that leaves a lobe's surface downward, or is blocked on it, is lost, although FGD-infinity counts it: directional albedos
/// fall short of the energies by what single scattering loses.
pub fn evaluate<S: Spread>(
    stack: &Monochrome,
    energy: &impl Energy,
    base: Option<&DiffuseBase>,
    follow: Follow,
    wi: DVec3,
    wo: DVec3,
) -> f64 {
    if wi.z <= 0.0 || wo.z <= 0.0 {
        return 0.0;
    }
    let cos_theta = match follow {
        Follow::Eye => wo.z,
        // For unit directions wo.wh is half the length of their sum.
        Follow::HalfVector => (0.5 * (wi + wo).length()).min(1.0),
    };
    let mut sum = 0.0;
    for lobe in add::<S>(stack, energy, cos_theta).lobes {
        if lobe.energy > 0.0 {
            let facets = Facets::new(&lobe.spread.surface()).lobe(Masking::Smith, wi, wo);
            sum += lobe.energy * facets.map_or(0.0, |l| l.value);
        }
    }
    if let Some(base) = base {
        let [light, eye] = [wi, wo].map(|w| add::<S>(stack, energy, w.z));
        sum += base.brdf((wi, &light), (wo, &eye)) * wi.z;
    }
    sum
}

/// A stack with the energies that do not depend on directions computed.
#[derive(Debug, Clone)]
pub struct Prepared {
    stack: Monochrome,
    energy: ExactEnergy,
    base: Option<DiffuseBase>,
}

impl Prepared {
    /// Computes them: tens of milliseconds for a rough interface.
    pub fn new(stack: &Monochrome) -> Self {
        Self::with_facets(stack, &mut FacetCache::default())
    }

    fn with_facets(stack: &Monochrome, facets: &mut FacetCache) -> Self {
        let energy = ExactEnergy::with_facets(stack, facets);
        let base = DiffuseBase::new(stack, &energy);
        Self { stack: stack.clone(), energy, base }
    }

    /// The energies.
    pub fn energy(&self) -> &ExactEnergy {
        &self.energy
    }

    /// `f cos_theta_i`; see [`evaluate`].
    pub fn eval<S: Spread>(&self, follow: Follow, wi: DVec3, wo: DVec3) -> f64 {
        evaluate::<S>(&self.stack, &self.energy, self.base.as_ref(), follow, wi, wo)
    }
}

/// Stacks that a model keeps prepared, at most.
const KEPT: usize = 1024;

/// Prepared stacks of a model, so that it can be evaluated direction by direction. Values do not depend on what is kept.
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
