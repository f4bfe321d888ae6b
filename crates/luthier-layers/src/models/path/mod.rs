//! The walk of Weidlich and Wilkie's model and of Elek's form of it: down through the layers along refracted directions, and back.

pub(in crate::models) mod eval;

use std::array::from_fn;
use std::f64::consts::PI;

use glam::DVec3;
use luthier_model::{DiffusePart, InternalReflection, LowerCosine, LowerFacets, PathParts};

use crate::formulas::facets::Lobe;
use crate::formulas::{normals, oren_nayar};
use crate::frame::{self, off, onto};
use crate::layers::{Below, Layer};
use crate::models::phong::lobe;
use crate::terms::Terms;

/// Kernels of the walk.
pub const EVAL: &str = include_str!("eval.wgsl");

/// Kernels of interfaces as lobes, from which directions are drawn.
pub const PARTS: &str = include_str!("parts.wgsl");

/// Steps in which walking models differ. Each model multiplies its factors in an order of its own.
pub(crate) trait PathModel {
    /// The parts that a material chooses.
    fn parts(&self) -> PathParts;

    /// Two factors whose product is the cosine of the light outside: on light that falls in, and on light that an interface or the base returns.
    fn cosines(&self, cos_theta_i: f64) -> [f64; 2];

    /// The lobe of the last layer for `wi` and `wo`. Layers above may bound its slope parameter.
    fn facets<const C: usize>(&self, layers: &[Layer<C>], terms: &dyn Terms<C>, wi: DVec3, wo: DVec3) -> Option<Lobe>;

    /// Both directions in the medium below, pointing up; `None` if either is totally reflected or refracted upward.
    fn refracted(&self, eta: f64, wi: DVec3, wo: DVec3) -> Option<[DVec3; 2]>;

    /// Light that an interface returns when `passed` arrives. `cosines` is the ratio of the light's cosine outside to that in the medium above.
    fn sent(&self, passed: f64, cosines: f64, reflectance: f64, lobe: f64) -> f64;

    /// Share of light that crosses an interface and its slab, and back.
    fn kept(&self, entered: f64, left: f64, absorbed: f64) -> f64;
}

/// BRDF of a lower interface that reflects all light, as a lobe of a power; `None` for facets. `alpha` is the isotropic slope parameter.
pub(crate) fn power_lobe(facets: LowerFacets, alpha: f64, wi: DVec3, wo: DVec3) -> Option<f64> {
    let of_blinn = normals::exponent(alpha);
    match facets {
        LowerFacets::TorranceSparrow => None,
        LowerFacets::BlinnPhong => {
            let (wh, _) = frame::half_vector(wi, wo)?;
            Some((of_blinn + 2.0) / (8.0 * PI) * lobe(wh, DVec3::Z, of_blinn))
        }
        LowerFacets::Phong => {
            let exponent = 0.25 * of_blinn;
            Some((exponent + 2.0) / (2.0 * PI) * lobe(DVec3::new(-wi.x, -wi.y, wi.z), wo, exponent))
        }
    }
}

/// Normals of interfaces that are not those of the surface, all unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tilts<'a> {
    /// Normal of everything below the first interface, in the frame of that interface.
    pub(crate) below: DVec3,
    /// Normals of single interfaces, from the top down, in the frame of the surface. Missing ones are +z.
    pub(crate) own: &'a [DVec3],
}

impl Tilts<'_> {
    /// Nothing is tilted.
    pub(crate) const NONE: Self = Self { below: DVec3::Z, own: &[] };
}

/// Light of a walk down through the layers and back.
pub(crate) struct Walked<const C: usize> {
    /// f cos_theta_i of the interfaces.
    pub(crate) interfaces: [f64; C],
    /// Light of the diffuse base; `None` if there is none, or if the walk ends above it.
    pub(crate) base: Option<AtBase<C>>,
}

/// Light of a diffuse base below interfaces.
pub(crate) struct AtBase<const C: usize> {
    /// f cos_theta_i of the base.
    value: [f64; C],
    /// Share of light that reaches the base: T_12 of each interface, times the transmittance of slabs along `wi`.
    pub(crate) down: [f64; C],
    /// Share of the base's light that leaves: t of each interface, times the transmittance of slabs along `wo`.
    pub(crate) up: [f64; C],
}

impl<const C: usize> Walked<C> {
    /// f cos_theta_i of interfaces and base.
    pub(crate) fn value(&self) -> [f64; C] {
        match &self.base {
            Some(base) => from_fn(|c| self.interfaces[c] + base.value[c]),
            None => self.interfaces,
        }
    }
}

/// Share of light that a slab of an optical depth lets through on a path of some thicknesses. Clear slabs, of which there are many, take no exponential.
fn through(optical_depth: f64, path: f64) -> f64 {
    if optical_depth == 0.0 { 1.0 } else { libm::exp(-optical_depth * path) }
}

/// Walks with light from `wi` through the layers to `wo`. The shares of light on the way down and up are found if they are asked for (`has_shares`);
/// otherwise they are 1.
pub(crate) fn walk<const C: usize>(
    model: &impl PathModel,
    layers: &[Layer<C>],
    terms: &dyn Terms<C>,
    wi: DVec3,
    wo: DVec3,
    tilts: Tilts<'_>,
    has_shares: bool,
) -> Walked<C> {
    let mut interfaces = [0.0; C];
    if wi.z <= 0.0 || wo.z <= 0.0 {
        return Walked { interfaces, base: None };
    }
    let parts = model.parts();
    let (mut wi_local, mut wo_local) = (wi, wo);
    let [falling, returning] = model.cosines(wi.z);
    let (mut passed, mut down, mut up) = ([falling; C], [1.0; C], [1.0; C]);
    for (i, layer) in layers.iter().enumerate() {
        let normal = tilts.own.get(i).copied().unwrap_or(DVec3::Z);
        let Some((wi_here, wo_here, facing)) = onto(normal, wi_local, wo_local) else { break };
        (wi_local, wo_local) = (wi_here, wo_here);
        (0..C).for_each(|c| (passed[c], down[c]) = (passed[c] * facing, down[c] * facing));
        if let Below::Diffuse { albedo, sigma } = layer.below {
            let brdf = oren_nayar::brdf(albedo, sigma, wi_local, wo_local);
            let value = from_fn(|c| passed[c] * returning * brdf[c]);
            return Walked { interfaces, base: Some(AtBase { value, down, up }) };
        }
        let Some(lobe) = model.facets(&layers[..=i], terms, wi_local, wo_local) else { break };
        let reflected = terms.fresnel(i, lobe.cos_theta_d);
        let brighter = match parts.lower_cosine {
            LowerCosine::Inside if i > 0 => wi_local.z / wi.z,
            _ => 1.0,
        };
        for c in 0..C {
            interfaces[c] += model.sent(passed[c], returning / wi_local.z, reflected[c], lobe.value * brighter);
        }

        let Below::Dielectric { optical_depth, .. } = layer.below else { break };
        let is_beside = parts.diffuse_part == DiffusePart::Beside
            && layers.get(i + 1).is_some_and(|next| matches!(next.below, Below::Diffuse { .. }));
        let (eta, optical_depth) = if is_beside { (1.0, [0.0; C]) } else { (layer.eta(), optical_depth) };
        let Some([mut wi_below, mut wo_below]) = model.refracted(eta, wi_local, wo_local) else { break };
        if i == 0 && tilts.below != DVec3::Z {
            (wi_below, wo_below) = (frame::local(tilts.below, wi_below), frame::local(tilts.below, wo_below));
            if wi_below.z <= 0.0 || wo_below.z <= 0.0 {
                break;
            }
        }
        let Some((wi_below, wo_below, facing)) = off(normal, wi_below, wo_below) else { break };
        let path = 1.0 / wi_below.z + 1.0 / wo_below.z;
        let transmitted = reflected.map(|reflected| 1.0 - reflected);
        let (entered, left) = match parts.internal_reflection {
            _ if is_beside => (transmitted, [1.0; C]),
            InternalReflection::Facets => {
                (transmitted, transmitted.map(|transmitted| (1.0 - lobe.masking) + transmitted * lobe.masking))
            }
            InternalReflection::None => (transmitted, [1.0; C]),
            InternalReflection::Directions => {
                [wi_local, wo_local].map(|w| terms.fresnel(i, w.z.min(1.0)).map(|f| 1.0 - f)).into()
            }
        };
        for c in 0..C {
            passed[c] *= model.kept(entered[c], left[c], through(optical_depth[c], path)) * facing;
            if has_shares {
                down[c] *= facing * entered[c] * through(optical_depth[c], 1.0 / wi_below.z);
                up[c] *= left[c] * through(optical_depth[c], 1.0 / wo_below.z);
            }
        }
        (wi_local, wo_local) = (wi_below, wo_below);
    }
    Walked { interfaces, base: None }
}
