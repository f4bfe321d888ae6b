//! One rough interface, one bounce: the model of Torrance and Sparrow.

use glam::DVec3;

use crate::facets::{Facets, Masking};
use crate::model::{Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow};
use crate::oren_nayar;

/// `f = F D G / (4 cos_theta_i cos_theta_o)` of the first interface (Torrance and Sparrow 1967; Walter et al. 2007, eq. 20), D
/// normalised. What the interface lets through is lost; a diffuse first layer is Oren and Nayar's.
///
/// Reciprocal, and never above unit albedo with Smith's masking. V-cavities stay below one too but let `f cos_theta_i` grow
/// as 1/cos_theta_o towards grazing mirror directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Microfacet {
    /// Masking and shadowing.
    pub masking: Masking,
}

impl Model for Microfacet {
    fn info(&self) -> ModelInfo {
        let (name, source) = match self.masking {
            Masking::Smith => ("microfacet", "Walter et al. 2007, eq. 20; masking of Heitz 2014, eq. 99"),
            Masking::VCavity => ("microfacet-v-cavity", "Torrance and Sparrow 1967; Cook and Torrance 1982, eq. 9"),
        };
        ModelInfo {
            name,
            source,
            domain: "the first interface of any stack, anisotropic or not; alpha from 1e-4",
            leaves_out: "all layers below, and all bounces after the first",
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let Some(layer) = stack.layers.first() else { return 0.0 };
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        if let MonochromeBelow::Diffuse { albedo, sigma } = layer.below {
            return wi.z * oren_nayar::brdf_scalar(albedo, sigma, wi, wo);
        }
        let Some(lobe) = Facets::new(&layer.surface).lobe(self.masking, wi, wo) else { return 0.0 };
        layer.reflectance(lobe.cos_theta_d) * lobe.value
    }
}
