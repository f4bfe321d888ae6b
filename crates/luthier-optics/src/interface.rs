//! One interface of a stack as a function of wavelength and angle.

use num_complex::Complex64;

use crate::Rgb;
use crate::color::{Color, WavelengthNode};
use crate::fresnel::{FilmLayer, coated};
use crate::ior::Ior;
use crate::schlick::Lazanyi;
use crate::stack::{Base, Film, Stack};

/// The optics of one interface: the medium above, films, the medium below. No micro-surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    /// Transparent medium above (its k is ignored: light that reaches the interface has been attenuated already).
    pub above: Ior,
    /// Films from the top down, at their nominal thickness.
    pub films: Vec<Film>,
    /// Medium below.
    pub below: Ior,
}

impl Interface {
    /// The interface at the top of a layer, or `None` for a diffuse base, which has none, and out of range.
    pub fn of(stack: &Stack, layer: usize) -> Option<Self> {
        let here = stack.layers.get(layer)?;
        let below = match &here.base {
            Base::Dielectric { ior, .. } | Base::Conductor { ior } => ior.clone(),
            Base::Diffuse(_) => return None,
        };
        let above = match layer.checked_sub(1).and_then(|l| stack.layers.get(l)).map(|l| &l.base) {
            None => stack.exterior.clone(),
            Some(Base::Dielectric { ior, .. }) => ior.clone(),
            Some(Base::Conductor { .. } | Base::Diffuse(_)) => return None,
        };
        Some(Self { above, films: here.films.clone(), below })
    }

    /// Index above, films and index below at one wavelength.
    pub fn at(&self, wavelength_nm: f64) -> Monochrome {
        Monochrome {
            above: Complex64::new(self.above.at(wavelength_nm).re, 0.0),
            films: self.films.iter().map(|film| film.at(wavelength_nm)).collect(),
            below: self.below.at(wavelength_nm),
        }
    }

    /// Whether some wavelength of a colour mode is totally reflected from an angle on that is not that of all, or where media absorb: the
    /// reflectance then has kinks over the cosine of incidence and over that of the refracted direction.
    pub fn has_kink(&self, color: &Color) -> bool {
        let sampled = self.sampled(color);
        let clear = || sampled.nodes.iter().map(|(_, at)| at).filter(|at| at.below.im <= NO_KINK);
        let etas = || clear().map(|at| at.below.re / at.above.re);
        let (least, most) = etas().fold((f64::INFINITY, 0.0), |(a, b), eta| (f64::min(a, eta), f64::max(b, eta)));
        least < 1.0 && (least < most || sampled.critical_cot_sq() == 0.0)
    }

    /// Whether the reflectance is the same at every wavelength.
    pub fn is_achromatic(&self) -> bool {
        self.films.is_empty() && self.above.is_constant() && self.below.is_constant()
    }

    /// The interface at every node of a colour mode; a single node when it is achromatic.
    pub fn sampled(&self, color: &Color) -> Sampled {
        self.at_nodes(&color.nodes())
    }

    /// The interface at given wavelength nodes; a single node when it is achromatic.
    pub fn at_nodes(&self, nodes: &[WavelengthNode]) -> Sampled {
        if self.is_achromatic() {
            return Sampled { nodes: vec![([1.0; 3], self.at(550.0))] };
        }
        Sampled { nodes: nodes.iter().map(|n| (n.weight, self.at(n.wavelength_nm))).collect() }
    }
}

/// An interface at one wavelength.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Monochrome {
    /// Index above, real.
    pub above: Complex64,
    /// Films from the top down.
    pub films: Vec<FilmLayer>,
    /// Index below.
    pub below: Complex64,
}

impl Monochrome {
    /// Unpolarised reflectance.
    pub fn reflectance(&self, cos_theta_i: f64) -> f64 {
        coated(self.above, &self.films, self.below, cos_theta_i).unpolarised()
    }
}

/// An interface at the wavelengths of a colour mode, ready to evaluate.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sampled {
    /// Channel weights and the interface at each wavelength.
    pub nodes: Vec<(Rgb, Monochrome)>,
}

/// Media that absorb as much reflect smoothly at all angles.
const NO_KINK: f64 = 1e-2;

/// Absorption that does not count: what data sets of clear glass and water have in the visible.
const TRACE_OF_ABSORPTION: f64 = 1e-6;

impl Sampled {
    /// Squared cotangent of the critical angle, `1 / eta^2 - 1`, at the wavelength of the largest index below over that above: all light
    /// flatter than that is totally reflected. 0 where some wavelength never is, and where films or the medium below absorb.
    pub fn critical_cot_sq(&self) -> f64 {
        let is_clear = |index: Complex64| index.im <= TRACE_OF_ABSORPTION;
        let is_total = |at: &Monochrome| is_clear(at.below) && at.films.iter().all(|film| is_clear(film.ior));
        let interfaces = || self.nodes.iter().map(|(_, at)| at);
        let eta = interfaces().map(|at| at.below.re / at.above.re).fold(0.0, f64::max);
        if eta > 0.0 && eta < 1.0 && interfaces().all(is_total) { 1.0 / (eta * eta) - 1.0 } else { 0.0 }
    }

    /// Unpolarised reflectance per channel.
    pub fn rgb(&self, cos_theta_i: f64) -> Rgb {
        self.sum(|interface| interface.reflectance(cos_theta_i))
    }

    /// Schlick's form of each channel: through its reflectance at normal incidence. Linear in the reflectances at the wavelengths, so that in
    /// spectral colour it is the sum of their forms.
    pub fn schlick(&self) -> [Lazanyi; 3] {
        self.rgb(1.0).map(|f0| Lazanyi { f0, a: 0.0, exponent: 1.0 })
    }

    /// Lazanyi and Szirmay-Kalos' curve of each channel, fitted to the reflectance of the channel.
    pub fn lazanyi(&self) -> [Lazanyi; 3] {
        let f0 = self.rgb(1.0);
        let values: Vec<Rgb> = Lazanyi::cosines().map(|cos| self.rgb(cos)).collect();
        [0, 1, 2].map(|c: usize| Lazanyi::through(f0[c], &values.iter().map(|rgb| rgb[c]).collect::<Vec<_>>()))
    }

    /// Weighted sum over the wavelengths of any function of the interface.
    pub fn sum(&self, mut f: impl FnMut(&Monochrome) -> f64) -> Rgb {
        let mut rgb = [0.0; 3];
        for (weight, interface) in &self.nodes {
            let value = f(interface);
            for c in 0..3 {
                rgb[c] += weight[c] * value;
            }
        }
        rgb
    }
}
