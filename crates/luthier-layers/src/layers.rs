//! Stack in channels that share their directions: as shaders have it, and at one wavelength.

use luthier_optics::stack::{Base, Stack, Surface};

use crate::formulas::refraction::REFRACTION_WAVELENGTH_NM;
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

/// Smallest slope parameter of models that have a shader; smoother surfaces are raised to it. Its lobe is 0.06 degrees wide, narrower than one pixel
/// or one light source resolves. Smaller parameters would not be safe in f32.
pub const ALPHA_MIN: f64 = 1e-3;

/// A stack in `C` channels that share their directions: one wavelength, or three colours.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers<const C: usize = 3> {
    /// Real index of the exterior.
    pub exterior: f64,
    /// Interfaces from the top down.
    pub layers: Vec<Layer<C>>,
}

/// One interface and what lies below it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer<const C: usize = 3> {
    /// The micro-surface.
    pub surface: Surface,
    /// Real index above.
    pub above: f64,
    /// Material below the interface.
    pub below: Below<C>,
}

/// Material below an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Below<const C: usize = 3> {
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

impl From<&MonochromeLayer> for Layer<1> {
    fn from(layer: &MonochromeLayer) -> Self {
        let below = match layer.below {
            MonochromeBelow::Dielectric { ior, optical_depth, .. } => {
                Below::Dielectric { ior, optical_depth: [optical_depth] }
            }
            MonochromeBelow::Conductor { .. } => Below::Conductor,
            MonochromeBelow::Diffuse { albedo, sigma } => Below::Diffuse { albedo: [albedo], sigma },
        };
        Self { surface: layer.surface, above: layer.above, below }
    }
}

impl From<&Monochrome> for Layers<1> {
    fn from(stack: &Monochrome) -> Self {
        Self { exterior: stack.exterior, layers: stack.layers.iter().map(Layer::from).collect() }
    }
}

impl Layers {
    /// The stack as shaders have it. The index at 589.3 nm bends the directions of all three channels, and slope parameters are at least
    /// [`ALPHA_MIN`].
    pub fn rgb(stack: &Stack) -> Self {
        let mut layers = Self::of(stack);
        for surface in layers.layers.iter_mut().map(|layer| &mut layer.surface) {
            for alpha in [&mut surface.alpha_x, &mut surface.alpha_y] {
                *alpha = alpha.clamp(ALPHA_MIN, 1.0);
            }
        }
        layers
    }

    /// The stack as shaders of isotropic models have it: [`Self::rgb`] with the geometric mean of both slope parameters for each.
    pub fn isotropic_rgb(stack: &Stack) -> Self {
        Self::of(stack).isotropic()
    }

    fn of(stack: &Stack) -> Self {
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
            layers.push(Layer { surface: layer.surface, above, below });
            if let Below::Dielectric { ior, .. } = below {
                above = ior;
            }
        }
        Self { exterior, layers }
    }
}

impl<const C: usize> Layer<C> {
    /// Index below over index above; 1 where nothing is transmitted.
    pub fn eta(&self) -> f64 {
        match self.below {
            Below::Dielectric { ior, .. } => ior / self.above,
            Below::Conductor | Below::Diffuse { .. } => 1.0,
        }
    }
}

impl<const C: usize> Layers<C> {
    /// The stack with isotropic surfaces: the geometric mean of both slope parameters for each, and at least [`ALPHA_MIN`].
    #[must_use]
    pub fn isotropic(mut self) -> Self {
        for surface in self.layers.iter_mut().map(|layer| &mut layer.surface) {
            *surface = Surface::isotropic(surface.distribution, surface.alpha_isotropic().clamp(ALPHA_MIN, 1.0));
        }
        self
    }

    /// Number and place of the diffuse base, if there is one.
    pub(crate) fn base(&self) -> Option<(usize, [f64; C], f64)> {
        self.layers.iter().enumerate().find_map(|(i, layer)| match layer.below {
            Below::Diffuse { albedo, sigma } => Some((i, albedo, sigma)),
            Below::Dielectric { .. } | Below::Conductor => None,
        })
    }
}
