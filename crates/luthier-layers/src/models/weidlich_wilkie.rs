//! The layered model of Weidlich and Wilkie, as printed.
//!
//! A. Weidlich and A. Wilkie, "Exploring the potential of layered BRDF models", SIGGRAPH Asia 2009 course, eq. 3.1-3.3
//! (first in "Arbitrarily layered micro-facet surfaces", GRAPHITE 2007):
//!
//! ```text
//! f = f_1(wi, wo) + T_12 f_2(wi', wo') a t
//! a = exp(-sigma d (1/cos_theta_i' + 1/cos_theta_o'))      t = (1 - G) + T_21 G
//! ```
//!
//! f_2 is again a layered surface; T_12 = T_21 = 1 - F at the half vector (the course's shader takes both there, see
//! [`InternalReflection`]); G is of V-cavities. Of the distributions the course leaves free, each surface brings its own.
//!
//! The model errs in two ways, which the tests measure: radiance is not compressed by 1/n^2 on its way out, so that a smooth
//! coat over a white base returns about twice what it receives; and light that comes back from the underside of an
//! interface is lost or, by `t`, made up for where facets hide each other. [`crate::models::weidlich_wilkie_corrected`] mends
//! both.

use glam::DVec3;
use luthier_model::{InternalReflection, Masking, ShadingModel};

use crate::formulas::facets::Facets;
use crate::formulas::oren_nayar;
use crate::formulas::refraction::{refract, refract_at};
use crate::frame;
use crate::frame::{off, onto};
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::models::elek::Tilts;
use crate::monochrome::{Monochrome, MonochromeBelow, Optics};

/// Normal at which both directions are refracted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Refraction {
    /// The surface's, as in Elek's form of the model and in the sampling of this crate.
    #[default]
    Surface,
    /// The half vector: both rays pass the one facet that they have in common (the course's first simplification, read by the
    /// letter). The lower layer then sees the same half vector, whatever the index.
    Facet,
}

/// The recursive model, faithful to the course.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WeidlichWilkie {
    /// Normal at which directions are refracted.
    pub refraction: Refraction,
    /// Light that comes out.
    pub internal_reflection: InternalReflection,
}

impl WeidlichWilkie {
    /// The directions in the medium below, pointing up, or `None` when either is totally reflected or leaves upward.
    fn below(self, eta: f64, wi: DVec3, wo: DVec3) -> Option<(DVec3, DVec3)> {
        let pair = match self.refraction {
            Refraction::Surface => (refract(wi, eta)?, refract(wo, eta)?),
            Refraction::Facet => {
                let m = (wi + wo).try_normalize()?;
                (refract_at(m, wi, eta)?, refract_at(m, wo, eta)?)
            }
        };
        (pair.0.z > 0.0 && pair.1.z > 0.0).then_some(pair)
    }
}

impl Model for WeidlichWilkie {
    fn info(&self) -> ModelInfo {
        let at_directions = self.internal_reflection == InternalReflection::Directions;
        let (name, domain) = match (self.refraction, at_directions) {
            (Refraction::Surface, false) => {
                (ShadingModel::WeidlichWilkie.name(), "any stack; refraction at the surface normal; alpha from 1e-4")
            }
            (Refraction::Surface, true) => {
                ("weidlich-wilkie-directions", "any stack; transmission at the directions' own angles; alpha from 1e-4")
            }
            (Refraction::Facet, false) => {
                ("weidlich-wilkie-facet", "any stack; refraction at the half vector; alpha from 1e-4")
            }
            (Refraction::Facet, true) => {
                ("weidlich-wilkie-facet-directions", "any stack; refraction at the half vector, transmission not")
            }
        };
        ModelInfo {
            name,
            kind: Kind::Layered,
            claims: Claims::RECIPROCAL,
            source: "Weidlich and Wilkie 2009, eq. 3.1-3.3; Elek 2010, eq. 2-4",
            domain,
            leaves_out: "1/n^2 (up to n^2 times too bright), bounces between layers, blur by refraction",
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.eval_with(stack, stack, wi, wo)
    }
}

impl WeidlichWilkie {
    /// [`Model::eval`] with optical terms that may come from elsewhere.
    pub fn eval_with(self, stack: &Monochrome, optics: &impl Optics, wi: DVec3, wo: DVec3) -> f64 {
        self.eval_tilted(stack, optics, wi, wo, Tilts::NONE)
    }

    /// [`Self::eval_with`] with other normals of interfaces, see [`eval_below`](crate::models::elek::eval_below).
    pub(crate) fn eval_tilted(
        self,
        stack: &Monochrome,
        optics: &impl Optics,
        wi: DVec3,
        wo: DVec3,
        tilts: Tilts<'_>,
    ) -> f64 {
        let Walked { interfaces, base } = self.walk(stack, optics, wi, wo, tilts);
        match base {
            Some(AtBase { albedo, sigma, wi_local, wo_local, passed, .. }) => {
                interfaces + passed * wi.z * oren_nayar::brdf_scalar(albedo, sigma, wi_local, wo_local)
            }
            None => interfaces,
        }
    }

    /// The way down to the base and back: what interfaces send to `wo`, and what is left of the light at a diffuse base.
    pub(crate) fn walk(
        self,
        stack: &Monochrome,
        optics: &impl Optics,
        wi: DVec3,
        wo: DVec3,
        tilts: Tilts<'_>,
    ) -> Walked {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return Walked { interfaces: 0.0, base: None };
        }
        let (mut wi_local, mut wo_local) = (wi, wo);
        let (mut throughput, mut total) = (1.0, 0.0);
        let (mut down, mut up) = (1.0, 1.0);
        for (i, layer) in stack.layers.iter().enumerate() {
            let normal = tilts.of(i);
            let Some((wi_here, wo_here, facing)) = onto(normal, wi_local, wo_local) else { break };
            (wi_local, wo_local) = (wi_here, wo_here);
            throughput *= facing;
            down *= facing;
            // f_cos below carries the local cosine; the model wants that of the exterior.
            let cosines = wi.z / wi_local.z;
            if let MonochromeBelow::Diffuse { albedo, sigma } = layer.below {
                let base = AtBase { albedo, sigma, wi_local, wo_local, passed: throughput, down, up };
                return Walked { interfaces: total, base: Some(base) };
            }
            let facets = Facets::new(&layer.surface);
            let Some(lobe) = facets.lobe_of(optics, i, Masking::VCavity, wi_local, wo_local) else { break };
            let reflected = optics.reflectance(i, lobe.cos_theta_d);
            total += throughput * cosines * reflected * lobe.value;

            let MonochromeBelow::Dielectric { optical_depth, .. } = layer.below else { break };
            let Some((mut wi_below, mut wo_below)) = self.below(layer.eta(), wi_local, wo_local) else { break };
            if i == 0 && tilts.below != DVec3::Z {
                (wi_below, wo_below) = (frame::local(tilts.below, wi_below), frame::local(tilts.below, wo_below));
                if wi_below.z <= 0.0 || wo_below.z <= 0.0 {
                    break;
                }
            }
            let Some((wi_level, wo_level, facing)) = off(normal, wi_below, wo_below) else { break };
            (wi_below, wo_below) = (wi_level, wo_level);
            let transmitted = 1.0 - reflected;
            let (entered, left) = match self.internal_reflection {
                InternalReflection::Facets => (transmitted, (1.0 - lobe.masking) + transmitted * lobe.masking),
                InternalReflection::None => (transmitted, 1.0),
                InternalReflection::Directions => {
                    (1.0 - optics.reflectance(i, wi_local.z.min(1.0)), 1.0 - optics.reflectance(i, wo_local.z.min(1.0)))
                }
            };
            let absorbed = libm::exp(-optical_depth * (1.0 / wi_below.z + 1.0 / wo_below.z));
            throughput *= entered * left * absorbed * facing;
            down *= facing * entered * libm::exp(-optical_depth / wi_below.z);
            up *= left * libm::exp(-optical_depth / wo_below.z);
            (wi_local, wo_local) = (wi_below, wo_below);
        }
        Walked { interfaces: total, base: None }
    }
}

/// A way down through a stack.
pub(crate) struct Walked {
    /// f cos_theta_i of the interfaces.
    pub(crate) interfaces: f64,
    /// Light at the diffuse base, where the stack has one and light comes there and back.
    pub(crate) base: Option<AtBase>,
}

/// Light at a diffuse base below interfaces.
pub(crate) struct AtBase {
    albedo: f64,
    sigma: f64,
    wi_local: DVec3,
    wo_local: DVec3,
    /// Share of the light that comes down to the base and back out: `down` times `up`.
    passed: f64,
    /// Share that comes down: T_12 of each interface, and what slabs leave on the way of `wi`.
    pub(crate) down: f64,
    /// Share of what the base sends up that comes out: t of each interface, and what slabs leave on the way of `wo`.
    pub(crate) up: f64,
}
