//! The exact terms of the real-time models in colour: what tables stand in for.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::microfacet;
use luthier_optics::stack::{Distribution, Stack};

use crate::elek::Terms;

/// Exact Fresnel and distribution terms, evaluated at every call.
#[derive(Debug, Clone)]
pub struct Exact {
    interfaces: Vec<Option<Sampled>>,
}

impl Exact {
    /// The terms of a stack, in the given colour mode.
    pub fn new(stack: &Stack, color: Color) -> Self {
        let interfaces = (0..stack.layers.len())
            .map(|i| Interface::of(stack, i).map(|interface| interface.sampled(&color)))
            .collect();
        Self { interfaces }
    }
}

impl Terms for Exact {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        self.interfaces.get(layer).and_then(Option::as_ref).map_or([0.0; 3], |i| i.rgb(cos_theta_d))
    }

    fn distribution(
        &self,
        _: usize,
        distribution: Distribution,
        alpha: f64,
        cos_theta_h: f64,
        sin_theta_h_sq: f64,
    ) -> f64 {
        microfacet::scaled_distribution(distribution, alpha, cos_theta_h, sin_theta_h_sq)
    }
}
