//! Twins of kernels: models as shaders evaluate them, in three channels, with optical terms from outside.

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

/// Values that shaders get from tables or compute: [`Terms`] for all models, energies and veils for `belcour` and `yamaguchi`, and light from below
/// the first interface for `lobes`.
pub trait ShaderTerms: Terms + Energy<3> {
    /// Effect of the layers above a diffuse base on its light. Without such a base the value is not used.
    fn veil(&self) -> Veil<3>;

    /// Light from below the first interface as seen from `wo`; `None` below the horizon, or if the terms have no lobes.
    fn below(&self, wo: DVec3) -> Option<Below>;

    /// Terms of the stack without its first layer, for a twin of a coat with a weight ([`Twin::covering`](crate::twins::real_time::Twin::covering)).
    fn bare(&self) -> Option<&dyn ShaderTerms> {
        None
    }
}

/// Values at a place that act below the first interface, as in `LuthierPlace`. Normals are unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Under {
    /// Normal of a flake, which turns everything below it; for `elek`, `weidlich-wilkie` and `lobes`.
    pub flake_normal: DVec3,
    /// Normal of the lower boundary of the film; for `granier-heidrich`.
    pub inner_normal: DVec3,
    /// Variance of the slopes of normals in a pixel, which widens light from below; for `lobes`. Other models have it in their slope parameters.
    pub slope_variance: f64,
    /// Albedo of the diffuse base, if it differs from that of the stack; for `lobes`. Other models have it in their layers.
    pub base_color: Option<Rgb>,
}

impl Under {
    /// No effect: level normals, no variance, the base of the stack.
    pub const NONE: Self =
        Self { flake_normal: DVec3::Z, inner_normal: DVec3::Z, slope_variance: 0.0, base_color: None };
}

/// A surface for a twin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Given<'a> {
    pub(crate) stack: &'a Stack,
    /// Wavelengths of the three channels.
    pub(crate) wavelengths_nm: [f64; 3],
    /// Colour of values that shaders read from the material buffer, and not from terms.
    pub(crate) color: Color,
    /// Parts that the material chooses.
    pub(crate) parts: Parts,
}

/// The f64 twin of a model's kernel, for one surface.
pub(crate) trait Shade: Debug + Send + Sync {
    /// `f cos_theta_i`, RGB, for light from `wi` seen from `wo`. Zero when either is at or below the horizon.
    fn eval(&self, terms: &dyn ShaderTerms, under: &Under, tilts: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb;

    /// The path of the light with its diffuse base apart, because a fluorescent base changes channels; `None` for models that leave fluorescence out.
    fn walked(&self, _terms: &dyn ShaderTerms, _tilts: Tilts<'_>, _wi: DVec3, _wo: DVec3) -> Option<Walked<3>> {
        None
    }
}
