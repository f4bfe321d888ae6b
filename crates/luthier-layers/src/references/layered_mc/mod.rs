//! Position-free Monte Carlo of a whole stack at one wavelength: the reference for rough stacks.
//!
//! Guo, Hasan and Zhao 2018, "Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs", with the interfaces
//! of Heitz et al. 2016: every interface is a Smith micro-surface on which light walks, reflecting and refracting,
//! until it leaves on one side. Slabs absorb and do not scatter. Paths have no greatest length: faint and long ones
//! survive by chance, with the weight that makes up for it.
//!
//! Everything is geometrical optics of unpolarised light: each event sees the mean of both polarisations, films
//! excepted, which are coherent inside. Interfaces do not know each other's heights. Lateral extent is out of scope.

mod chance;
mod colored;
mod connect;
mod facets;
#[cfg(test)]
mod fixtures;
mod interface;
mod joint;
mod one_facet;
mod optics;
mod path;
mod random;
#[cfg(test)]
mod rare_paths;
mod rough;
mod walk;

use glam::DVec3;

pub use colored::ColorPaths;
pub use joint::{JointPath, JointPaths};
pub use optics::Side;

pub(crate) use connect::both_above;
pub(crate) use interface::Interface;
pub(crate) use random::Stream;
pub(crate) use rough::Sided;

use crate::model::{Claims, Estimate, Estimator, Input, Inputs, Kind, Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow};
use connect::Scratch;
use path::Interfaces;

/// Treatment of light at a rough interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum InterfaceMode {
    /// A walk between facets until the light leaves: no energy is lost.
    #[default]
    SmithWalk,
    /// One facet, with `G2 = 1 / (1 + Lambda_i + Lambda_o)` for reflection and refraction. Blocked light is lost. Most
    /// fast models assume this.
    OneFacet,
}

/// Position-free Monte Carlo of a stack. The same fields give the same numbers.
///
/// ```
/// use luthier_layers::glam::DVec3;
/// use luthier_layers::luthier_optics::stack::Surface;
/// use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
/// use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
///
/// // A smooth glass without a bottom mirrors 4% along the normal.
/// let glass = Monochrome::bare(&[(Surface::smooth(), MonochromeBelow::dielectric(1.5, 0.0))]);
/// let albedo = LayeredMc::new(InterfaceMode::SmithWalk).albedo(&glass, DVec3::Z, 10_000);
/// assert!(albedo.agrees_with(0.04, 4.0) && albedo.std_err < 0.003);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LayeredMc {
    /// Treatment of light at rough interfaces.
    pub mode: InterfaceMode,
    /// Samples per value.
    pub samples: u64,
    /// Family of random numbers.
    pub seed: u64,
}

impl LayeredMc {
    /// The mode with the registered number of samples.
    pub const fn new(mode: InterfaceMode) -> Self {
        Self { mode, samples: 4096, seed: 0 }
    }

    /// `f cos_theta_i` for light from `wi` seen from `wo` (unit, away from the surface; zero unless both are above it).
    ///
    /// Without the part that meets smooth interfaces only: that is no function of the directions. Everything else
    /// counts, whatever smooth interfaces it crosses. [`Self::albedo`] and [`Self::paths`] have both.
    pub fn estimate(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> Estimate {
        if !both_above(wi, wo) {
            return Estimate::exact(0.0);
        }
        let interfaces = Interfaces::new(stack, self.mode);
        if !interfaces.scatter() {
            return Estimate::exact(0.0);
        }
        let mut scratch = Scratch::default();
        Estimate::of(self.samples, |i| {
            let mut stream = Stream::new(self.seed, i);
            connect::sample(&interfaces, &mut scratch, &mut stream, wi, wo)
        })
    }

    /// Share of the light from `wo` that leaves upward, in any direction: the directional albedo, mirrored light
    /// included. Zero unless `wo` is above the surface. Takes the number of paths in place of [`Self::samples`].
    pub fn albedo(&self, stack: &Monochrome, wo: DVec3, paths: u64) -> Estimate {
        self.albedo_above(stack, wo, DVec3::Z, paths)
    }

    /// [`Self::albedo`] of the light that leaves above the plane with the normal `up` alone.
    fn albedo_above(&self, stack: &Monochrome, wo: DVec3, up: DVec3, paths: u64) -> Estimate {
        if wo.z <= 0.0 {
            return Estimate::exact(0.0);
        }
        let interfaces = Interfaces::new(stack, self.mode);
        Estimate::of(paths, |i| {
            let mut stream = Stream::new(self.seed, i);
            let left = interfaces.trace::<false>(&mut stream, wo, |_| {}).filter(|(wi, _)| wi.dot(up) > 0.0);
            left.map_or(0.0, |(_, weight)| weight)
        })
    }

    /// Paths of light from `wo`, as many as [`Self::samples`]. A path that leaves the stack upward gives its direction and
    /// its weight, another one `None`. The density of directions, times weight, is `f cos_theta_i`.
    pub fn paths(&self, stack: &Monochrome, wo: DVec3) -> impl Iterator<Item = Option<(DVec3, f64)>> + use<> {
        let interfaces = Interfaces::new(stack, self.mode);
        let seed = self.seed;
        let count = if wo.z > 0.0 { self.samples } else { 0 };
        (0..count).map(move |i| interfaces.trace::<false>(&mut Stream::new(seed, i), wo, |_| {}))
    }
}

impl Model for LayeredMc {
    fn info(&self) -> ModelInfo {
        let (name, leaves_out) = match self.mode {
            InterfaceMode::SmithWalk => {
                ("layered-mc", "light that meets smooth interfaces only; polarisation between interfaces")
            }
            InterfaceMode::OneFacet => (
                "layered-mc-one-facet",
                "bounces between facets (what is blocked is lost); light that meets smooth interfaces only; \
                 polarisation between interfaces",
            ),
        };
        ModelInfo {
            name,
            kind: Kind::Reference,
            claims: Claims::BOTH,
            inputs: &[Input::Samples, Input::Seed],
            source: "Guo, Hasan and Zhao 2018 (position-free, bidirectional) over interfaces of Heitz et al. 2016",
            domain: "any stack; an estimate, with noise",
            leaves_out,
        }
    }

    /// The mean of [`LayeredMc::estimate`]. The seed is mixed with the arguments, so that errors are independent
    /// between wavelengths and average out in colour.
    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.eval_with_error(stack, wi, wo).mean
    }

    fn estimator(&self) -> Option<&dyn Estimator> {
        Some(self)
    }

    fn with_inputs(&self, inputs: &Inputs) -> Option<Box<dyn Model>> {
        let (samples, seed) = (inputs.samples.unwrap_or(self.samples), inputs.seed.unwrap_or(self.seed));
        Some(Box::new(Self { samples, seed, ..*self }))
    }
}

impl Estimator for LayeredMc {
    fn eval_with_error(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> Estimate {
        Self { seed: mixed_seed(self.seed, stack, wi, wo), ..*self }.estimate(stack, wi, wo)
    }

    fn albedo_with_error(&self, stack: &Monochrome, wo: DVec3, up: DVec3) -> Estimate {
        Self { seed: mixed_seed(self.seed, stack, wo, wo), ..*self }.albedo_above(stack, wo, up, self.samples)
    }
}

/// A seed that is a function of a stack's optics and of two directions.
pub(crate) fn mixed_seed(seed: u64, stack: &Monochrome, wi: DVec3, wo: DVec3) -> u64 {
    let mut hash = seed;
    let mut add = |value: f64| hash = Stream::hash(hash, value.to_bits());
    wi.to_array().into_iter().chain(wo.to_array()).for_each(&mut add);
    for layer in &stack.layers {
        match layer.below {
            MonochromeBelow::Dielectric { complex_ior, optical_depth, .. } => {
                [complex_ior.re, complex_ior.im, optical_depth].into_iter().for_each(&mut add);
            }
            MonochromeBelow::Conductor { ior } => [ior.re, ior.im].into_iter().for_each(&mut add),
            MonochromeBelow::Diffuse { albedo, sigma } => [albedo, sigma].into_iter().for_each(&mut add),
        }
        layer.films.iter().for_each(|film| add(film.waves));
        layer.f0.into_iter().for_each(|curve| add(curve.f0));
    }
    hash
}
