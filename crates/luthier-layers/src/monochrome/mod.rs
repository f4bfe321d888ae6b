//! Layered surface at one wavelength, the input of every model.

mod lossless;

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::fresnel::{FilmLayer, Polarised, coated};
use luthier_optics::interface::Interface;
use luthier_optics::schlick::{F82, index_below_film};
use luthier_optics::stack::{Base, Layer, Stack, Surface};
use num_complex::Complex64;
use std::f64::consts::PI;

use crate::terms::Terms;

/// A stack at one wavelength, for one colour channel.
///
/// Indices are spectral; absorption and diffuse albedo are given per colour channel, so a channel goes with the wavelength. Colour is
/// the sum over wavelengths of the channel's weight times the model at (wavelength, channel).
#[derive(Debug, Clone, PartialEq)]
pub struct Monochrome {
    /// Real index of the exterior.
    pub exterior: f64,
    /// Interfaces from the top down; at least one.
    pub layers: Vec<MonochromeLayer>,
}

/// One interface and what lies below it, at one wavelength.
#[derive(Debug, Clone, PartialEq)]
pub struct MonochromeLayer {
    /// The micro-surface.
    pub surface: Surface,
    /// Real index above.
    pub above: f64,
    /// Coherent films from the top down.
    pub films: Vec<FilmLayer>,
    /// Material below the interface.
    pub below: MonochromeBelow,
    /// Reflectance at normal incidence and edge tint, if Schlick's formula takes the place of Fresnel's. The index below is not lower than the index above then, and bends
    /// directions only: films interfere by the index of the F0 ([`MonochromeLayer::index_below`]).
    pub f0: Option<F82>,
}

/// Material below an interface, at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MonochromeBelow {
    /// A transparent medium: real index, and optical depth of the slab along the normal. Last in the stack: half-infinite.
    Dielectric {
        /// Index.
        ior: f64,
        /// Complex index, for the reflectance of the interface.
        complex_ior: Complex64,
        /// Optical depth along the normal.
        optical_depth: f64,
    },
    /// An opaque conductor.
    Conductor {
        /// Complex index.
        ior: Complex64,
    },
    /// A diffuse base without an interface of its own.
    Diffuse {
        /// Albedo.
        albedo: f64,
        /// Oren-Nayar slope deviation, radians.
        sigma: f64,
    },
}

impl MonochromeBelow {
    /// A transparent medium of a real index.
    pub const fn dielectric(ior: f64, optical_depth: f64) -> Self {
        Self::Dielectric { ior, complex_ior: Complex64::new(ior, 0.0), optical_depth }
    }

    /// Optical depth along the normal; 0 if the material is opaque.
    pub(crate) fn optical_depth(self) -> f64 {
        if let Self::Dielectric { optical_depth, .. } = self { optical_depth } else { 0.0 }
    }
}

impl Monochrome {
    /// Interfaces without films under vacuum, from the top down: the micro-surface of each, and the material below it.
    pub fn bare(interfaces: &[(Surface, MonochromeBelow)]) -> Self {
        let layers = interfaces.iter().map(|&(surface, below)| MonochromeLayer {
            surface,
            above: 1.0,
            films: Vec::new(),
            below,
            f0: None,
        });
        Self::joined(1.0, layers.collect())
    }

    /// Layers under a medium of index `exterior`, from the top down. Sets the index above each layer to that of the medium there.
    pub fn joined(exterior: f64, mut layers: Vec<MonochromeLayer>) -> Self {
        let mut above = exterior;
        for layer in &mut layers {
            layer.above = above;
            if let MonochromeBelow::Dielectric { ior, .. } = layer.below {
                above = ior;
            }
        }
        Self { exterior, layers }
    }

    /// The stack at a wavelength, for channel 0, 1 or 2.
    pub fn new(stack: &Stack, wavelength_nm: f64, channel: usize) -> Self {
        let exterior = stack.exterior.at(wavelength_nm).re;
        let layers = stack.layers.iter().map(|layer| MonochromeLayer::new(layer, exterior, wavelength_nm, channel));
        Self::joined(exterior, layers.collect())
    }
}

impl Terms<1> for Monochrome {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> [f64; 1] {
        [self.layers.get(layer).map_or(0.0, |layer| layer.reflectance(cos_theta_d))]
    }
}

impl MonochromeLayer {
    fn new(layer: &Layer, above: f64, wavelength_nm: f64, channel: usize) -> Self {
        let below = match &layer.base {
            Base::Dielectric { ior, slab } => {
                let complex_ior = ior.at(wavelength_nm);
                let optical_depth = slab.optical_depth()[channel];
                MonochromeBelow::Dielectric { ior: complex_ior.re, complex_ior, optical_depth }
            }
            Base::Conductor { ior } => MonochromeBelow::Conductor { ior: ior.at(wavelength_nm) },
            Base::Diffuse(d) => MonochromeBelow::Diffuse { albedo: d.albedo[channel], sigma: d.sigma },
        };
        let films = layer.films.iter().map(|film| film.at(wavelength_nm)).collect();
        let f0 = match &layer.base {
            Base::Dielectric { ior, .. } | Base::Conductor { ior } => ior.f82(channel),
            Base::Diffuse(_) => None,
        };
        Self { surface: layer.surface, above, films, below, f0 }
    }

    /// Unpolarised reflectance of the interface for light from above; 0 for a diffuse base, which has none.
    pub fn reflectance(&self, cos_theta_i: f64) -> f64 {
        match self.bare_f0() {
            Some(curve) => curve.eval(cos_theta_i),
            None => self.polarised(cos_theta_i).map_or(0.0, |powers| powers.unpolarised()),
        }
    }

    /// Reflectance of either polarisation by the indices. `None` for a diffuse base, which has no interface, and for a bare interface with an F0: Schlick's
    /// formula knows no polarisation.
    pub fn polarised(&self, cos_theta_i: f64) -> Option<Polarised> {
        let below = self.index_below()?;
        if self.bare_f0().is_some() {
            return None;
        }
        Some(coated(Complex64::new(self.above, 0.0), &self.films, below, cos_theta_i))
    }

    /// F0 and edge tint, if the interface reflects by Schlick's formula: it has them, and no films.
    pub fn bare_f0(&self) -> Option<F82> {
        self.f0.filter(|_| self.films.is_empty())
    }

    /// The index by which the interface reflects: that of the medium below, or of its F0 under films. `None` for a diffuse base.
    pub fn index_below(&self) -> Option<Complex64> {
        let below = match self.below {
            MonochromeBelow::Dielectric { complex_ior, .. } => complex_ior,
            MonochromeBelow::Conductor { ior } => ior,
            MonochromeBelow::Diffuse { .. } => return None,
        };
        let under_films = self.f0.filter(|_| !self.films.is_empty());
        Some(under_films.map_or(below, |curve| Complex64::new(index_below_film(self.above, curve.f0), 0.0)))
    }

    /// `2 cos(2 Phi)` of the first film for the sum of the cosines in it (Granier and Heidrich 2003, eq. 3 and 19); 0 without a film.
    pub fn interference(&self, cosines: f64) -> f64 {
        self.films.first().map_or(0.0, |film| 2.0 * libm::cos(2.0 * PI * film.ior.re * film.waves * cosines))
    }

    /// Index below over index above; 1 where nothing is transmitted.
    pub fn eta(&self) -> f64 {
        match self.below {
            MonochromeBelow::Dielectric { ior, .. } => ior / self.above,
            MonochromeBelow::Conductor { .. } | MonochromeBelow::Diffuse { .. } => 1.0,
        }
    }
}

/// The value of a function of the monochrome stack in colour.
pub fn in_color(stack: &Stack, color: &Color, mut f: impl FnMut(&Monochrome) -> f64) -> Rgb {
    let [rgb] = in_colors(stack, color, |one| [f(one)]);
    rgb
}

/// The values of some functions of the monochrome stack in colour.
pub fn in_colors<const N: usize>(stack: &Stack, color: &Color, mut f: impl FnMut(&Monochrome) -> [f64; N]) -> [Rgb; N] {
    let mut colors = [[0.0; 3]; N];
    // Without a spectrum a stack has one value per channel: evaluating it once is enough, though weights are still summed node by node.
    let is_gray = (0..stack.layers.len()).filter_map(|l| Interface::of(stack, l)).all(|i| i.is_achromatic());
    let mut known = [None; 3];
    for node in color.nodes() {
        for channel in (0..3).filter(|&channel| node.weight[channel] != 0.0) {
            let kept = known[channel].filter(|_| is_gray);
            let values = kept.unwrap_or_else(|| f(&Monochrome::new(stack, node.wavelength_nm, channel)));
            known[channel] = Some(values);
            for (rgb, value) in colors.iter_mut().zip(values) {
                rgb[channel] += node.weight[channel] * value;
            }
        }
    }
    colors
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::{Ior, IorSample};
    use luthier_optics::stack::Slab;

    use super::*;

    /// Stacks with a spectrum and without are the weighted sum over the wavelengths of each channel.
    #[test]
    fn colours_are_sums_over_wavelengths() {
        let glass = |ior| {
            let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.1, 0.5, 0.9] };
            let layer = Layer { films: Vec::new(), surface: Surface::smooth(), base: Base::Dielectric { ior, slab } };
            Stack { exterior: Ior::vacuum(), layers: vec![layer] }
        };
        let value = |one: &Monochrome| {
            let MonochromeBelow::Dielectric { optical_depth, .. } = one.layers[0].below else { return 0.0 };
            one.layers[0].reflectance(0.7) * optical_depth
        };
        let sample = |wavelength_nm, n| IorSample { wavelength_nm, n, k: 0.0 };
        let spectral = Ior::sampled(vec![sample(400.0, 1.7), sample(700.0, 1.4)]).unwrap();
        for ior in [Ior::constant(1.5, 0.0).unwrap(), spectral] {
            let stack = glass(ior);
            let mut expected = [0.0; 3];
            for node in Color::Spectral.nodes() {
                for (channel, sum) in expected.iter_mut().enumerate() {
                    *sum += node.weight[channel] * value(&Monochrome::new(&stack, node.wavelength_nm, channel));
                }
            }
            assert_eq!(in_color(&stack, &Color::Spectral, value), expected);
        }
    }
}
