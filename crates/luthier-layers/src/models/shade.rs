//! Twins of kernels: a model as its shader evaluates it, in three channels with optical terms from elsewhere.

use std::fmt::Debug;

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use crate::models::lobes::Below;
use crate::models::parts::Parts;
use crate::models::path::{Tilts, Walked};
use crate::models::statistics::diffuse_base::Veil;
use crate::models::statistics::energy::Energy;
use crate::terms::Terms;

/// All that the shaders of any model are given: what [`Terms`] are; for `belcour` and `yamaguchi` energies, and what layers do to the light
/// of a diffuse base; for `lobes` the light from below the first interface.
pub trait ShaderTerms: Terms + Energy<3> {
    /// Effect of the layers above a diffuse base on its light; anything where there is no such base.
    fn veil(&self) -> Veil<3>;

    /// Light from below the first interface as seen from `wo`; `None` below the horizon, and where the terms have none.
    fn below(&self, wo: DVec3) -> Option<Below>;
}

/// Normals below the first interface of a surface, each unit, and the variance of its own: those of `LuthierPlace`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Under {
    /// Normal of the flakes, which all that lies below is turned by; for `elek`, `weidlich-wilkie` and `lobes`.
    pub flake_normal: DVec3,
    /// Normal of the lower boundary of the film; for `granier-heidrich`.
    pub inner_normal: DVec3,
    /// Variance of the slopes of normals in a pixel, which widens what comes from below; for `lobes`. Others have it in their slope parameters.
    pub slope_variance: f64,
    /// Albedo of the diffuse base, where it is not that of the stack; for `lobes`. Others have it in their layers.
    pub base_color: Option<Rgb>,
}

impl Under {
    /// Normals of the surface itself.
    pub const NONE: Self =
        Self { flake_normal: DVec3::Z, inner_normal: DVec3::Z, slope_variance: 0.0, base_color: None };
}

/// A surface whose shader a twin computes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Given<'a> {
    pub(crate) stack: &'a Stack,
    /// Wavelengths of the three channels.
    pub(crate) wavelengths_nm: [f64; 3],
    /// Colour of what the material buffer holds in place of terms.
    pub(crate) color: Color,
    /// Parts that the material chooses.
    pub(crate) parts: Parts,
}

/// The f64 twin of a model's kernel, for one surface.
pub(crate) trait Shade: Debug + Send + Sync {
    /// `f cos_theta_i`, RGB, for light from `wi` seen from `wo`. Zero when either is at or below the horizon.
    fn eval(&self, terms: &dyn ShaderTerms, under: &Under, tilts: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb;

    /// The way of the light down to a diffuse base and back, for a model that tells it apart: a fluorescent base changes channels there.
    fn walked(&self, _terms: &dyn ShaderTerms, _tilts: Tilts<'_>, _wi: DVec3, _wo: DVec3) -> Option<Walked<3>> {
        None
    }
}
