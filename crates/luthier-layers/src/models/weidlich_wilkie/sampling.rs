//! Sampling of a layered surface, by the two methods of Weidlich and Wilkie 2009, sec. 3.2.
//!
//! - *Global* (3.2.2): every layer proposes a direction. A path follows one of them, with a probability in proportion to the light that it carries
//!   ([`Sampler::propose`], [`Sampler::follow`]).
//! - *Local* (3.2.4, eq. 3.6): one direction for the whole surface ([`Sampler::sample`]), with the mixture density
//!   `p = sum w_k p_k`, `sum w_k = 1`.
//!
//! Every draw leaves the surface: each `p_k` integrates to 1, and so does `p`. Layer k lies in a medium of index `n_k`, and the exterior has index 1.
//! The product `n sin_theta` is the same in all media. So upward light leaves if its `n_k sin_theta` is below the least index m on its way. In the
//! medium of the layer these directions are a cone about the normal, `cos_theta > c_k = sqrt(1 - m^2 / n_k^2)`. Solid angles grow on the way out:
//! `d omega' = d omega cos_theta / (n_k^2 cos_theta')`, with primes for the medium of the layer.
//!
//! - *A diffuse base* is drawn by the cosine inside the cone. In directions outside the stack this is `p_k = cos_theta / (pi m^2)` up to
//!   `sin_theta = m`. For m = 1 it is the cosine over the hemisphere.
//! - *An interface* mirrors `wo'` at a visible facet. The density `q = G1 D / (4 cos_theta_o')` integrates to 1 over the sphere, and
//!   reaches from `z = cos_theta' = 1` down to `-cos_theta_o'`. The part outside the cone is folded into it at its edge:
//!   `z -> c_k + s (c_k - z)`. The azimuth is kept, and s = min(1, (1 - c_k) / (c_k + cos_theta_o')) makes it fit. Solid angle is
//!   `dz d phi`, so the density inside the cone is `q(z) + q(c_k - (z - c_k) / s) / s`. In directions outside the stack, `p_k` is this times
//!   `d omega' / d omega`.
//!
//! The fold adds density to directions that leave, and removes none. So it never makes an estimate noisier than losing the draw would.

use std::f64::consts::PI;

use glam::DVec3;

use crate::formulas::facets::Facets;
use crate::formulas::plane_stack::seen_from_above;
use crate::formulas::refraction::refract;
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

/// A proposed direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proposal {
    /// Layer that proposed the direction.
    pub layer: usize,
    /// The direction.
    pub wi: DVec3,
    /// Its density, for this layer alone.
    pub pdf_solid_angle: f64,
}

/// The layers of a stack as `wo` sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampler {
    layers: Vec<Sampled>,
}

#[derive(Debug, Clone, PartialEq)]
struct Sampled {
    /// `None` for a diffuse base.
    facets: Option<Facets>,
    /// `wo` in the medium above the layer.
    wo: DVec3,
    /// Indices, below over above, of the interfaces above the layer.
    etas: Vec<f64>,
    /// Cosine, there, of the edge of the cone of directions that leave.
    edge: f64,
    /// Share of the samples.
    weight: f64,
}

impl Sampler {
    /// The sampler for a direction above the horizon. For other directions it has no layers, and so no samples.
    ///
    /// The weights of the mixture are the light that smooth layers would send to `wo` in the model of the course: the power that the interfaces above
    /// transmit, both ways, times the reflectance. The weight of an interface is also multiplied by `n_k^2`, because that model spreads a lobe over
    /// so much more solid angle on its way out and does not dim it.
    pub fn new(stack: &Monochrome, wo: DVec3) -> Self {
        let mut layers: Vec<Sampled> = Vec::with_capacity(stack.layers.len());
        let (mut wo_local, mut etas) = (wo, Vec::new());
        let (mut index, mut least) = (1.0, 1.0_f64);
        if wo.z <= 0.0 {
            return Self { layers };
        }
        for (k, layer) in stack.layers.iter().enumerate() {
            let Some((powers, _)) = seen_from_above(stack, k, wo.z) else { break };
            let facets = match layer.below {
                MonochromeBelow::Diffuse { .. } => None,
                MonochromeBelow::Dielectric { .. } | MonochromeBelow::Conductor { .. } => {
                    Some(Facets::new(&layer.surface))
                }
            };
            let spread = if facets.is_some() { index * index } else { 1.0 };
            let weight = powers.transmittance * powers.transmittance * reflectance(layer, wo_local.z) * spread;
            let edge = libm::sqrt((index - least) * (index + least)) / index;
            layers.push(Sampled { facets, wo: wo_local, etas: etas.clone(), edge, weight });
            let MonochromeBelow::Dielectric { .. } = layer.below else { break };
            let Some(below) = refract(wo_local, layer.eta()) else { break };
            etas.push(layer.eta());
            wo_local = below;
            index *= layer.eta();
            least = least.min(index);
        }
        let sum: f64 = layers.iter().map(|l| l.weight).sum();
        let count = layers.len() as f64;
        for layer in &mut layers {
            layer.weight = if sum > 0.0 { layer.weight / sum } else { 1.0 / count };
        }
        Self { layers }
    }

    /// [`Self::new`] with weights that one chooses (eq. 3.6: "constant values w"), over their sum. Layers beyond them are not drawn; without a weight
    /// above 0 all are drawn alike.
    #[must_use]
    pub fn weighted(mut self, weights: &[f64]) -> Self {
        let count = self.layers.len() as f64;
        let sum: f64 = weights.iter().take(self.layers.len()).sum();
        for (k, layer) in self.layers.iter_mut().enumerate() {
            let weight = weights.get(k).copied().unwrap_or(0.0);
            layer.weight = if sum > 0.0 { weight / sum } else { 1.0 / count };
        }
        self
    }

    /// Number of layers to sample.
    pub fn count(&self) -> usize {
        self.layers.len()
    }

    /// The local method: a direction of the mixture and its density [`Self::pdf_solid_angle`], from three numbers in 0..1.
    pub fn sample(&self, u: [f64; 3]) -> Option<(DVec3, f64)> {
        let mut rest = u[0];
        let mut chosen = self.layers.len().checked_sub(1)?;
        for (k, layer) in self.layers.iter().enumerate() {
            if rest < layer.weight {
                chosen = k;
                break;
            }
            rest -= layer.weight;
        }
        let wi = self.layers[chosen].sample([u[1], u[2]])?;
        Some((wi, self.pdf_solid_angle(wi)))
    }

    /// Density of the local method.
    pub fn pdf_solid_angle(&self, wi: DVec3) -> f64 {
        self.layers.iter().map(|layer| layer.weight * layer.pdf_solid_angle(wi)).sum()
    }

    /// The proposal of one layer, from two numbers in 0..1. The global method takes the proposals of all layers.
    pub fn propose(&self, layer: usize, u: [f64; 2]) -> Option<Proposal> {
        let sampled = self.layers.get(layer)?;
        let wi = sampled.sample(u)?;
        Some(Proposal { layer, wi, pdf_solid_angle: sampled.pdf_solid_angle(wi) })
    }

    /// Density of the proposals of one layer; 0 for a missing layer.
    pub fn pdf_of_layer(&self, layer: usize, wi: DVec3) -> f64 {
        self.layers.get(layer).map_or(0.0, |l| l.pdf_solid_angle(wi))
    }

    /// Sum of the densities of all layers, the divisor of the balance heuristic (Veach 1995).
    pub fn sum_of_densities(&self, wi: DVec3) -> f64 {
        self.layers.iter().map(|layer| layer.pdf_solid_angle(wi)).sum()
    }

    /// The choice of the global method: one of the proposals, and its probability, in proportion to `carried`. That is the light of a proposal: the
    /// model's `f cos_theta_i` over [`Self::sum_of_densities`]. `None` if no proposal carries light.
    pub fn follow(proposals: &[Proposal], carried: impl Fn(&Proposal) -> f64, u: f64) -> Option<(Proposal, f64)> {
        let shares: Vec<f64> = proposals.iter().map(|p| carried(p).max(0.0)).collect();
        let sum: f64 = shares.iter().sum();
        let mut rest = u * sum;
        let mut last = None;
        for (proposal, share) in proposals.iter().zip(shares).filter(|(_, share)| *share > 0.0) {
            last = Some((*proposal, share / sum));
            if rest < share {
                break;
            }
            rest -= share;
        }
        last
    }
}

impl Sampled {
    fn sample(&self, u: [f64; 2]) -> Option<DVec3> {
        let mut w = match &self.facets {
            Some(facets) => {
                let m = facets.sample(self.wo, u);
                self.folded(2.0 * self.wo.dot(m) * m - self.wo)
            }
            None => {
                let sin_sq = u[0] * (1.0 - self.edge * self.edge);
                let (radius, phi) = (libm::sqrt(sin_sq), 2.0 * PI * u[1]);
                DVec3::new(radius * libm::cos(phi), radius * libm::sin(phi), libm::sqrt(1.0 - sin_sq))
            }
        };
        for eta in self.etas.iter().rev() {
            w = refract(w, 1.0 / eta)?;
        }
        (w.z > 0.0).then(|| w.normalize())
    }

    fn pdf_solid_angle(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let (mut w, mut jacobian) = (wi, 1.0);
        for &eta in &self.etas {
            let Some(below) = refract(w, eta) else { return 0.0 };
            jacobian *= w.z / (eta * eta * below.z);
            w = below;
        }
        jacobian
            * match &self.facets {
                Some(facets) => self.pdf_of_facets(facets, w),
                None => w.z / (PI * (1.0 - self.edge * self.edge)),
            }
    }

    /// Cosines outside the cone that reflections reach, and the factor that fits them into it.
    fn fold(&self) -> (f64, f64) {
        let reach = self.edge + self.wo.z;
        (reach, ((1.0 - self.edge) / reach).min(1.0))
    }

    /// A direction outside the stack. One that would not leave is folded into the cone first.
    fn folded(&self, w: DVec3) -> DVec3 {
        if w.z > self.edge {
            return w;
        }
        with_cosine(w, self.edge + self.fold().1 * (self.edge - w.z))
    }

    fn pdf_of_facets(&self, facets: &Facets, w: DVec3) -> f64 {
        let (reach, scale) = self.fold();
        let beyond = (w.z - self.edge).max(0.0) / scale;
        let unfolded = facets.pdf_of_mirrored(w, self.wo);
        if beyond >= reach {
            return unfolded;
        }
        unfolded + facets.pdf_of_mirrored(with_cosine(w, self.edge - beyond), self.wo) / scale
    }
}

/// The direction of the same azimuth and another cosine.
fn with_cosine(w: DVec3, cos_theta: f64) -> DVec3 {
    let cos_theta = cos_theta.min(1.0);
    let across = libm::hypot(w.x, w.y);
    let scale = libm::sqrt((1.0 - cos_theta) * (1.0 + cos_theta)) / across.max(f64::MIN_POSITIVE);
    DVec3::new(w.x * scale, w.y * scale, cos_theta)
}

fn reflectance(layer: &MonochromeLayer, cos_theta: f64) -> f64 {
    match layer.below {
        MonochromeBelow::Diffuse { albedo, .. } => albedo,
        MonochromeBelow::Dielectric { .. } | MonochromeBelow::Conductor { .. } => layer.reflectance(cos_theta.min(1.0)),
    }
}
