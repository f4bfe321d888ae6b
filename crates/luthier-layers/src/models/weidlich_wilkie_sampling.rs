//! Sampling of a layered surface, by the two methods of Weidlich and Wilkie 2009, sec. 3.2.
//!
//! - *Global* (3.2.2): every layer proposes one direction for a path to go on; one of them is followed, with a probability
//!   in proportion to what it carries.
//! - *Local* (3.2.4, eq. 3.6): one direction for the whole surface, with the mixture density `sum w_k p_k`.
//!
//! Layer k is sampled where it lies: `wo` is refracted down at the surface normal, reflected at a visible facet (cosine
//! density for a diffuse base), and refracted up. Solid angles grow on the way: `d omega' = d omega cos_theta / (n^2
//! cos_theta')` per interface. Light that cannot leave through an interface above, and reflections below the horizon, give no
//! direction; densities integrate to one less that share.

use std::f64::consts::PI;

use glam::DVec3;

use crate::facets::Facets;
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use crate::plane_stack::seen_from_above;
use crate::refraction::refract;

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
    /// Part of the samples.
    weight: f64,
}

impl Sampler {
    /// The sampler for a direction above the horizon; without layers, and so without samples, for others.
    ///
    /// The weights of the mixture are what smooth layers would send to `wo`: power passed by the interfaces above, both
    /// ways, times the reflectance.
    pub fn new(stack: &Monochrome, wo: DVec3) -> Self {
        let mut layers: Vec<Sampled> = Vec::with_capacity(stack.layers.len());
        let (mut wo_local, mut etas) = (wo, Vec::new());
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
            let weight = powers.transmittance * powers.transmittance * reflectance(layer, wo_local.z);
            layers.push(Sampled { facets, wo: wo_local, etas: etas.clone(), weight });
            let MonochromeBelow::Dielectric { .. } = layer.below else { break };
            let Some(below) = refract(wo_local, layer.eta()) else { break };
            etas.push(layer.eta());
            wo_local = below;
        }
        let sum: f64 = layers.iter().map(|l| l.weight).sum();
        let count = layers.len() as f64;
        for layer in &mut layers {
            layer.weight = if sum > 0.0 { layer.weight / sum } else { 1.0 / count };
        }
        Self { layers }
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

    /// The proposal of one layer, from two numbers in 0..1; the global method's list is that of all layers.
    pub fn propose(&self, layer: usize, u: [f64; 2]) -> Option<Proposal> {
        let sampled = self.layers.get(layer)?;
        let wi = sampled.sample(u)?;
        Some(Proposal { layer, wi, pdf_solid_angle: sampled.pdf_solid_angle(wi) })
    }

    /// Density of the proposals of one layer; 0 for a layer that there is not.
    pub fn pdf_of_layer(&self, layer: usize, wi: DVec3) -> f64 {
        self.layers.get(layer).map_or(0.0, |l| l.pdf_solid_angle(wi))
    }

    /// Sum of the densities of all layers: what weighs a proposal against those of other layers (balance heuristic, Veach 1995).
    pub fn sum_of_densities(&self, wi: DVec3) -> f64 {
        self.layers.iter().map(|layer| layer.pdf_solid_angle(wi)).sum()
    }

    /// The global method's choice: one of the proposals, in proportion to `carried` (what each brings: the model's
    /// `f cos_theta_i` over [`Self::sum_of_densities`]), with its probability. `None` when nothing is carried.
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
                2.0 * self.wo.dot(m) * m - self.wo
            }
            None => {
                let (radius, phi) = (libm::sqrt(u[0]), 2.0 * PI * u[1]);
                DVec3::new(radius * libm::cos(phi), radius * libm::sin(phi), libm::sqrt(1.0 - u[0]))
            }
        };
        for eta in self.etas.iter().rev() {
            if w.z <= 0.0 {
                return None;
            }
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
        jacobian * self.facets.map_or(w.z / PI, |facets| facets.pdf_solid_angle(w, self.wo))
    }
}

fn reflectance(layer: &MonochromeLayer, cos_theta: f64) -> f64 {
    match layer.below {
        MonochromeBelow::Diffuse { albedo, .. } => albedo,
        MonochromeBelow::Dielectric { .. } | MonochromeBelow::Conductor { .. } => layer.reflectance(cos_theta.min(1.0)),
    }
}
