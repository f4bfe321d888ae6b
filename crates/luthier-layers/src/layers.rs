//! Stack description of the statistical models, in any number of channels.

use luthier_optics::stack::{Base, Stack, Surface};

use crate::formulas::refraction::REFRACTION_WAVELENGTH_NM;
use crate::monochrome::{Monochrome, MonochromeBelow};

/// Smallest slope parameter of models that have a shader. Smoother surfaces are evaluated with this one: a lobe 0.06 degrees wide, well
/// below what one pixel or one light source resolves, and still safe in f32.
pub const ALPHA_MIN: f64 = 1e-3;

/// A stack in `C` channels that share their directions: one wavelength, or three colours.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers<const C: usize> {
    /// Real index of the exterior.
    pub exterior: f64,
    /// Interfaces from the top down.
    pub layers: Vec<Layer<C>>,
}

/// One interface and what lies below it.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer<const C: usize> {
    /// The micro-surface.
    pub surface: Surface,
    /// Real index above.
    pub above: f64,
    /// Material below the interface.
    pub below: Below<C>,
}

/// Material below an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Below<const C: usize> {
    /// A transparent medium: real index, and optical depth of the slab along the normal.
    Dielectric {
        /// Index.
        ior: f64,
        /// Optical depth along the normal.
        optical_depth: [f64; C],
    },
    /// A conductor: nothing lies below.
    Conductor,
    /// A diffuse base without an interface of its own.
    Diffuse {
        /// Albedo.
        albedo: [f64; C],
        /// Oren-Nayar slope deviation, radians.
        sigma: f64,
    },
}

impl From<&Monochrome> for Layers<1> {
    fn from(stack: &Monochrome) -> Self {
        let layer = |layer: &crate::monochrome::MonochromeLayer| Layer {
            surface: layer.surface,
            above: layer.above,
            below: match layer.below {
                MonochromeBelow::Dielectric { ior, optical_depth, .. } => {
                    Below::Dielectric { ior, optical_depth: [optical_depth] }
                }
                MonochromeBelow::Conductor { .. } => Below::Conductor,
                MonochromeBelow::Diffuse { albedo, sigma } => Below::Diffuse { albedo: [albedo], sigma },
            },
        };
        Self { exterior: stack.exterior, layers: stack.layers.iter().map(layer).collect() }
    }
}

impl Layers<3> {
    /// The stack as shaders have it: one index bends the directions of all three channels, that of 589.3 nm, and slope
    /// parameters are at least [`ALPHA_MIN`].
    pub fn rgb(stack: &Stack) -> Self {
        let exterior = stack.exterior.at(REFRACTION_WAVELENGTH_NM).re;
        let mut above = exterior;
        let mut layers = Vec::with_capacity(stack.layers.len());
        for layer in &stack.layers {
            let below = match &layer.base {
                Base::Dielectric { ior, slab } => {
                    let ior = ior.at(REFRACTION_WAVELENGTH_NM).re;
                    Below::Dielectric { ior, optical_depth: slab.optical_depth() }
                }
                Base::Conductor { .. } => Below::Conductor,
                Base::Diffuse(diffuse) => Below::Diffuse { albedo: diffuse.albedo, sigma: diffuse.sigma },
            };
            let [alpha_x, alpha_y] = [layer.surface.alpha_x, layer.surface.alpha_y].map(|a| a.clamp(ALPHA_MIN, 1.0));
            layers.push(Layer { surface: Surface { alpha_x, alpha_y, ..layer.surface }, above, below });
            if let Below::Dielectric { ior, .. } = below {
                above = ior;
            }
        }
        Self { exterior, layers }
    }
}

impl<const C: usize> Layers<C> {
    /// Number and place of the diffuse base, if there is one.
    pub(super) fn base(&self) -> Option<(usize, [f64; C], f64)> {
        self.layers.iter().enumerate().find_map(|(i, layer)| match layer.below {
            Below::Diffuse { albedo, sigma } => Some((i, albedo, sigma)),
            Below::Dielectric { .. } | Below::Conductor => None,
        })
    }
}
