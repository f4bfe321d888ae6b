//! The layered model of Weidlich and Wilkie, corrected to conserve energy.
//!
//! Two corrections to [`crate::models::weidlich_wilkie`]:
//!
//! - radiance that leaves a medium of index n is divided by n^2;
//! - bounces between a layer and all the interfaces above it are summed, which replaces the term `t`.
//!
//! Layer k, seen from the exterior through the interfaces above it, contributes
//!
//! ```text
//! f_k(wi', wo') T(wi) T(wo) (n_0 / n_k)^2 / (1 - R_k S_k)
//! ```
//!
//! T is the power that the smooth interfaces above transmit, with all bounces between them, R_k their reflectance from below, and S_k the reflectance
//! of layer k. For an interface, R_k and S_k are taken at the angle of its half vector. For a diffuse base, R_k is the mean over diffuse light and S_k
//! the albedo. This is exact for smooth layers over a mirror or Lambert's surface (adding of powers, layer by layer), and reciprocal for any stack.

use glam::DVec3;
use luthier_model::Masking;

use crate::formulas::facets::Facets;
use crate::formulas::oren_nayar;
use crate::formulas::plane_stack::{diffuse_return, seen_from_above, seen_from_below};
use crate::formulas::refraction::refract;
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow};

/// The energy-corrected variant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WeidlichWilkieCorrected;

impl Model for WeidlichWilkieCorrected {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "weidlich-wilkie-corrected",
            kind: Kind::Layered,
            claims: Claims::BOTH,
            source: "Weidlich and Wilkie 2009, eq. 3.1-3.2, with 1/n^2 and the geometric series of inner bounces",
            domain: "any stack; exact for smooth interfaces over a mirror or Lambert's surface; alpha from 1e-4; returns \
                     up to 1.0023 of the light where a rough coat reflects more than the smooth one that transmits",
            leaves_out: "blur by refraction and by inner bounces; interfaces transmit and return as if smooth",
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let (mut wi_local, mut wo_local) = (wi, wo);
        let (mut index, mut total) = (stack.exterior, 0.0);
        for (k, layer) in stack.layers.iter().enumerate() {
            let (Some((powers_i, _)), Some((powers_o, _))) =
                (seen_from_above(stack, k, wi.z), seen_from_above(stack, k, wo.z))
            else {
                break;
            };
            let compression = stack.exterior / index;
            let crossed = powers_i.transmittance * powers_o.transmittance * (compression * compression);
            if let MonochromeBelow::Diffuse { albedo, sigma } = layer.below {
                let echo = albedo * diffuse_return(stack, k);
                let value = oren_nayar::brdf_scalar(albedo, sigma, wi_local, wo_local);
                return total + wi.z * crossed * value * series(echo);
            }
            let Some(lobe) = Facets::new(&layer.surface).lobe(Masking::VCavity, wi_local, wo_local) else { break };
            let reflected = layer.reflectance(lobe.cos_theta_d);
            let echo = reflected * seen_from_below(stack, k, lobe.cos_theta_d).below;
            total += crossed * (wi.z / wi_local.z) * reflected * lobe.value * series(echo);

            let MonochromeBelow::Dielectric { ior, .. } = layer.below else { break };
            let (Some(wi_below), Some(wo_below)) = (refract(wi_local, layer.eta()), refract(wo_local, layer.eta()))
            else {
                break;
            };
            (wi_local, wo_local) = (wi_below, wo_below);
            index = ior;
        }
        total
    }
}

/// `1 + echo + echo^2 + ...`; 0 for an echo of 1. Light that never leaves has not entered either.
fn series(echo: f64) -> f64 {
    if echo < 1.0 { 1.0 / (1.0 - echo) } else { 0.0 }
}
