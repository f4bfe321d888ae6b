//! Elek's real-time form of the layered model of Weidlich and Wilkie, for any number of layers.
//!
//! O. Elek, "Layered Materials in Real-Time Rendering", CESCG 2010, eq. 2-4 and Algorithm 1:
//!
//! ```text
//! f(i) = f_i(L, V) + T_12 f(i+1)(L', V') a t
//! T_12 = T_21 = 1 - F(V.H)      a = exp(-sigma d (1/NL' + 1/NV'))      t = (1 - G) + T_21 G
//! ```
//!
//! with f_i the Torrance-Sparrow BRDF `F D G / (4 NL NV)`, D normalised (the paper's prefactors disagree with each
//! other; see CONVENTIONS.md), G of V-cavities, and L', V' refracted at the surface normal. As in the paper, a
//! layer is never smoother than the one above it, which stands for the blur of refraction.
//!
//! Simplifications of the model, all the paper's: no inter-reflection between layers, no 1/n^2 compression of
//! radiance, `t` gives back blocked light heuristically, absorption and `f_i` combine in three colour channels.
//! Roughness is isotropic: anisotropic surfaces enter with the geometric mean of their slope parameters.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_model::InternalReflection;
use luthier_optics::Rgb;
use luthier_optics::masking::v_cavity;
use luthier_optics::stack::{Base, Diffuse, Distribution, Stack};

use crate::formulas::oren_nayar;
use crate::formulas::refraction::{REFRACTION_WAVELENGTH_NM, refract};
use crate::frame;
use crate::frame::{off, onto};
use crate::layers::ALPHA_MIN;
use crate::terms::Terms;

/// One layer as the model sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Slope distribution.
    pub distribution: Distribution,
    /// Isotropic slope parameter, at least [`ALPHA_MIN`].
    pub alpha: f64,
    /// Material below the interface.
    pub below: Below,
    /// Light from below that the interface lets out.
    pub internal_reflection: InternalReflection,
}

/// Material that follows below an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Below {
    /// A transparent medium: real index below over index above, and the optical depth of the slab.
    Dielectric {
        /// Index below over index above.
        eta: f64,
        /// Optical depth along the normal.
        optical_depth: Rgb,
    },
    /// A conductor: nothing lies below.
    Conductor,
    /// The layer is a diffuse base, without an interface of its own.
    Diffuse(Diffuse),
}

/// The layers of a stack as the model sees them.
pub fn layers(stack: &Stack) -> Vec<Layer> {
    let mut above = stack.exterior.at(REFRACTION_WAVELENGTH_NM).re;
    let mut out = Vec::with_capacity(stack.layers.len());
    for layer in &stack.layers {
        let below = match &layer.base {
            Base::Dielectric { ior, slab } => {
                let index = ior.at(REFRACTION_WAVELENGTH_NM).re;
                let eta = index / above;
                above = index;
                Below::Dielectric { eta, optical_depth: slab.optical_depth() }
            }
            Base::Conductor { .. } => Below::Conductor,
            Base::Diffuse(diffuse) => Below::Diffuse(*diffuse),
        };
        out.push(Layer {
            distribution: layer.surface.distribution,
            alpha: layer.surface.alpha_isotropic().clamp(ALPHA_MIN, 1.0),
            below,
            internal_reflection: InternalReflection::Facets,
        });
    }
    out
}

/// `f cos_theta_i` of the layers for light from `wi` seen from `wo`, per channel. Zero when either is at or below the
/// horizon. Finite for all unit directions. Reciprocal: every factor of eq. 2 is symmetric in the two directions with T_12 and T_21
/// at the half vector.
pub fn eval(layers: &[Layer], terms: &impl Terms, wi: DVec3, wo: DVec3) -> Rgb {
    eval_below(layers, terms, wi, wo, DVec3::Z)
}

/// [`eval`] with another normal below the first interface (unit, in the surface's frame): what flakes in the coat look like
/// (Elek 2010, section 4.1). The refracted directions are measured against it, the path lengths of the first slab included, as
/// in the paper's code; layers below see nothing when it hides either of them.
pub fn eval_below(layers: &[Layer], terms: &impl Terms, wi: DVec3, wo: DVec3, normal_below: DVec3) -> Rgb {
    eval_tilted(layers, terms, wi, wo, Tilts { below: normal_below, own: &[] })
}

/// [`eval`] with other normals of interfaces.
pub(crate) fn eval_tilted(layers: &[Layer], terms: &impl Terms, wi: DVec3, wo: DVec3, tilts: Tilts<'_>) -> Rgb {
    let Walked { mut interfaces, base } = walk(layers, terms, wi, wo, tilts);
    if let Some(AtBase { diffuse, wi_local, wo_local, passed, .. }) = base {
        add(&mut interfaces, passed, oren_nayar::brdf(&diffuse, wi_local, wo_local));
    }
    interfaces
}

/// Normals of interfaces that are not those of the surface, all unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tilts<'a> {
    /// Normal below the first interface, in its frame: all that lies there is turned.
    pub(crate) below: DVec3,
    /// Normals of interfaces alone, from the top down, in the frame of the surface; those that are missing are +z.
    pub(crate) own: &'a [DVec3],
}

impl Tilts<'_> {
    /// Nothing is tilted.
    pub(crate) const NONE: Self = Self { below: DVec3::Z, own: &[] };

    /// The own normal of an interface.
    pub(crate) fn of(&self, layer: usize) -> DVec3 {
        self.own.get(layer).copied().unwrap_or(DVec3::Z)
    }
}

/// A way down through the layers.
pub(crate) struct Walked {
    /// f cos_theta_i of the interfaces.
    pub(crate) interfaces: Rgb,
    /// Light at the diffuse base, where the layers end with one and light comes there and back.
    pub(crate) base: Option<AtBase>,
}

/// Light at a diffuse base below interfaces.
pub(crate) struct AtBase {
    diffuse: Diffuse,
    wi_local: DVec3,
    wo_local: DVec3,
    /// The cosine of the light outside times `down` times `up`.
    passed: Rgb,
    /// Share that comes down: T_12 of each interface, and what slabs leave on the way of `wi`.
    pub(crate) down: Rgb,
    /// Share of what the base sends up that comes out: t of each interface, and what slabs leave on the way of `wo`.
    pub(crate) up: Rgb,
}

/// The way down to the base and back: what interfaces send to `wo`, and what is left of the light at a diffuse base.
pub(crate) fn walk(layers: &[Layer], terms: &impl Terms, wi: DVec3, wo: DVec3, tilts: Tilts<'_>) -> Walked {
    if wi.z <= 0.0 || wo.z <= 0.0 {
        return Walked { interfaces: [0.0; 3], base: None };
    }
    let (mut wi_local, mut wo_local) = (wi, wo);
    let mut throughput = [wi.z; 3];
    let (mut down, mut up) = ([1.0; 3], [1.0; 3]);
    let mut total = [0.0; 3];
    let mut alpha_above = ALPHA_MIN;

    for (i, layer) in layers.iter().enumerate() {
        let normal = tilts.of(i);
        let Some((wi_here, wo_here, facing)) = onto(normal, wi_local, wo_local) else { break };
        (wi_local, wo_local) = (wi_here, wo_here);
        (0..3).for_each(|c| (throughput[c], down[c]) = (throughput[c] * facing, down[c] * facing));
        if let Below::Diffuse(diffuse) = layer.below {
            let base = AtBase { diffuse, wi_local, wo_local, passed: throughput, down, up };
            return Walked { interfaces: total, base: Some(base) };
        }
        let alpha = layer.alpha.max(alpha_above);
        alpha_above = alpha;

        let Some((wh, cos_theta_d)) = frame::half_vector(wi_local, wo_local) else { break };
        let sin_theta_h_sq = wh.x * wh.x + wh.y * wh.y;
        let f = terms.fresnel(i, cos_theta_d);
        let d = terms.distribution(i, layer.distribution, alpha, wh.z, sin_theta_h_sq) / (PI * alpha * alpha);
        let g = v_cavity(wi_local.z, wo_local.z, wh.z, cos_theta_d);
        let geometry = d * g / (4.0 * wi_local.z * wo_local.z);
        add(&mut total, throughput, f.map(|f| f * geometry));

        let Below::Dielectric { eta, optical_depth } = layer.below else { break };
        let (Some(mut wi_below), Some(mut wo_below)) = (refract(wi_local, eta), refract(wo_local, eta)) else { break };
        if i == 0 && tilts.below != DVec3::Z {
            (wi_below, wo_below) = (frame::local(tilts.below, wi_below), frame::local(tilts.below, wo_below));
            if wi_below.z <= 0.0 || wo_below.z <= 0.0 {
                break;
            }
        }
        let Some((wi_level, wo_level, facing)) = off(normal, wi_below, wo_below) else { break };
        (wi_below, wo_below) = (wi_level, wo_level);
        let path = 1.0 / wi_below.z + 1.0 / wo_below.z;
        let transmitted = f.map(|f| 1.0 - f);
        let (entered, left) = match layer.internal_reflection {
            InternalReflection::Facets => (transmitted, transmitted.map(|transmitted| (1.0 - g) + transmitted * g)),
            InternalReflection::None => (transmitted, [1.0; 3]),
            InternalReflection::Directions => {
                [wi_local, wo_local].map(|w| terms.fresnel(i, w.z.min(1.0)).map(|f| 1.0 - f)).into()
            }
        };
        for c in 0..3 {
            let absorbed = libm::exp(-optical_depth[c] * path);
            throughput[c] *= entered[c] * absorbed * left[c] * facing;
            down[c] *= facing * entered[c] * libm::exp(-optical_depth[c] / wi_below.z);
            up[c] *= left[c] * libm::exp(-optical_depth[c] / wo_below.z);
        }
        (wi_local, wo_local) = (wi_below, wo_below);
    }
    Walked { interfaces: total, base: None }
}

fn add(total: &mut Rgb, weight: Rgb, value: Rgb) {
    for c in 0..3 {
        total[c] += weight[c] * value[c];
    }
}
