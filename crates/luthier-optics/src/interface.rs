//! One interface of a stack as a function of wavelength and angle.

use num_complex::Complex64;

use crate::Rgb;
use crate::color::{Color, WavelengthNode};
use crate::fresnel::{FilmLayer, coated};
use crate::ior::Ior;
use crate::schlick::{F82, Lazanyi, index_below_film};
use crate::stack::{Base, Film, Stack};

/// The optics of one interface: the medium above, films, the medium below. No micro-surface.
///
/// ```
/// use luthier_optics::{color::Color, constants::dataset, interface::Interface, ior::Ior};
///
/// let gold = dataset("au").unwrap().ior.clone();
/// let interface = Interface { above: Ior::vacuum(), films: Vec::new(), below: gold };
/// let [red, green, blue] = interface.sampled(&Color::Spectral).rgb(1.0);
/// assert!(red > 0.9 && green < 0.85 && blue < 0.5);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    /// Transparent medium above (its k is ignored: light that reaches the interface has been attenuated already).
    pub above: Ior,
    /// Films from the top down, at their nominal thickness.
    pub films: Vec<Film>,
    /// Medium below. Where it has an F0 ([`Ior::with_f0`]), the interface reflects by Schlick's formula with its edge tint, and under films as if the medium had the index of
    /// that F0 ([`index_below_film`]).
    pub below: Ior,
}

impl Interface {
    /// The interface at the top of a layer, with the media that its reflectance is computed from. `None` for a diffuse base, which has no
    /// interface, below an opaque layer, and for a number out of range.
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
        let above = if layer > 0 && below.reflects_as_in_air() { Ior::vacuum() } else { above };
        Some(Self { above, films: here.films.clone(), below })
    }

    /// Index above, films and index below at one wavelength, for colour channel 0, 1 or 2. Channels differ in the F0 alone, or under films in its index, if
    /// there is one.
    pub fn at(&self, wavelength_nm: f64, channel: usize) -> Monochrome {
        let above = self.above.at(wavelength_nm).re;
        let f0 = self.below.f0().map(|f0| f0[channel]);
        let index = f0.filter(|_| !self.films.is_empty()).map(|f0| Complex64::new(index_below_film(above, f0), 0.0));
        Monochrome {
            f0: self.below.f82(channel).filter(|_| index.is_none()),
            above: Complex64::new(above, 0.0),
            films: self.films.iter().map(|film| film.at(wavelength_nm)).collect(),
            below: index.unwrap_or_else(|| self.below.at(wavelength_nm)),
        }
    }

    /// The channels whose spectra stand for all: each by itself under films over a coloured F0, else the first.
    pub fn channels(&self) -> std::ops::Range<usize> {
        let is_colored = self.below.f0().is_some_and(|[r, g, b]| r != g || g != b);
        0..if is_colored && !self.films.is_empty() { 3 } else { 1 }
    }

    /// Index below over index above that bends light at a wavelength, where films lie over an F0: they interfere by another. `None` elsewhere.
    pub fn eta_under_films(&self, wavelength_nm: f64) -> Option<f64> {
        let is_other = self.below.f0().is_some() && !self.films.is_empty();
        is_other.then(|| self.below.at(wavelength_nm).re / self.above.at(wavelength_nm).re)
    }

    /// Whether the reflectance has kinks over the cosine of incidence and over the cosine of the refracted direction alike. It does if some
    /// wavelength of a colour mode is totally reflected, and critical angles differ or media absorb.
    pub fn has_kink(&self, color: &Color) -> bool {
        let sampled = self.sampled(color);
        // Schlick's formula has none.
        let clear = sampled.nodes.iter().map(|(_, at)| at).filter(|at| at.f0.is_none() && at.below.im <= NO_KINK);
        let etas = clear.map(|at| at.below.re / at.above.re);
        let (least, most) = etas.fold((f64::INFINITY, 0.0), |(a, b), eta| (f64::min(a, eta), f64::max(b, eta)));
        least < 1.0 && (least < most || sampled.critical_cot_sq() == 0.0)
    }

    /// Whether the reflectance of each channel is the same at every wavelength.
    pub fn is_achromatic(&self) -> bool {
        self.films.is_empty() && self.above.is_constant() && self.below.is_constant()
    }

    /// The interface at every node of a colour mode; a single node when it is achromatic.
    pub fn sampled(&self, color: &Color) -> Sampled {
        self.at_nodes(&color.nodes())
    }

    /// The interface at given wavelength nodes; a single node when it is achromatic.
    pub fn at_nodes(&self, nodes: &[WavelengthNode]) -> Sampled {
        let single = [WavelengthNode { wavelength_nm: 550.0, weight: [1.0; 3] }];
        let nodes = if self.is_achromatic() { &single } else { nodes };
        let nodes = if self.below.is_grey_f0() {
            nodes.iter().map(|n| (n.weight, self.at(n.wavelength_nm, 0))).collect()
        } else {
            // Each channel by itself.
            nodes.iter().flat_map(|n| (0..3).map(|c| (channel_of(n.weight, c), self.at(n.wavelength_nm, c)))).collect()
        };
        Sampled { nodes }
    }
}

/// A weight of one channel alone.
fn channel_of(weight: Rgb, channel: usize) -> Rgb {
    let mut one = [0.0; 3];
    one[channel] = weight[channel];
    one
}

/// An interface at one wavelength.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(from = "Stored", into = "Stored"))]
pub struct Monochrome {
    /// Index above, real.
    pub above: Complex64,
    /// Films from the top down.
    pub films: Vec<FilmLayer>,
    /// Index below.
    pub below: Complex64,
    /// Reflectance at normal incidence and edge tint, if Schlick's formula takes the place of Fresnel's. There are no films then.
    pub f0: Option<F82>,
}

impl Monochrome {
    /// Unpolarised reflectance: Fresnel's formulas, with the films by Airy's; or `f0 + (1 - f0)(1 - cos)^5` (Schlick 1994), with an edge tint
    /// ([`F82`]).
    pub fn reflectance(&self, cos_theta_i: f64) -> f64 {
        if let Some(curve) = self.f0 {
            return curve.eval(cos_theta_i);
        }
        coated(self.above, &self.films, self.below, cos_theta_i).unpolarised()
    }
}

/// An interface as stores keep it. The form has no place for an F0: an F0 is the imaginary part of the index above, and an imaginary part of
/// the edge tint less 2 below marks it, -1 without a tint.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Stored {
    above: Complex64,
    films: Vec<FilmLayer>,
    below: Complex64,
}

#[cfg(feature = "serde")]
impl From<Monochrome> for Stored {
    fn from(Monochrome { mut above, films, mut below, f0 }: Monochrome) -> Self {
        if let Some(F82 { f0, tint }) = f0 {
            (above.im, below.im) = (f0, tint - 2.0);
        }
        Self { above, films, below }
    }
}

#[cfg(feature = "serde")]
impl From<Stored> for Monochrome {
    fn from(Stored { mut above, films, mut below }: Stored) -> Self {
        let f0 = (below.im < 0.0).then_some(F82 { f0: above.im, tint: 2.0 + below.im });
        if f0.is_some() {
            (above.im, below.im) = (0.0, 0.0);
        }
        Self { above, films, below, f0 }
    }
}

/// An interface at the wavelengths of a colour mode, ready to evaluate.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sampled {
    /// Channel weights and the interface at each wavelength.
    pub nodes: Vec<(Rgb, Monochrome)>,
}

/// Extinction coefficient above which media reflect smoothly at all angles.
const NO_KINK: f64 = 1e-2;

/// Extinction coefficient that counts as none: data sets of clear glass and water reach it in the visible.
const TRACE_OF_ABSORPTION: f64 = 1e-6;

impl Sampled {
    /// Squared cotangent of the critical angle, `1 / eta^2 - 1`, at the wavelength of the largest relative index `eta`: flatter light is
    /// totally reflected at every wavelength. 0 if some wavelength never is, if films or the medium below absorb, and for Schlick's
    /// formula, which has no total reflection.
    pub fn critical_cot_sq(&self) -> f64 {
        let eta = self.nodes.iter().map(|(_, at)| at.below.re / at.above.re).fold(0.0, f64::max);
        let is_clear = self.nodes.iter().all(|(_, at)| {
            let mut indices = at.films.iter().map(|film| film.ior).chain([at.below]);
            at.f0.is_none() && indices.all(|index| index.im <= TRACE_OF_ABSORPTION)
        });
        if eta > 0.0 && eta < 1.0 && is_clear { 1.0 / (eta * eta) - 1.0 } else { 0.0 }
    }

    /// Unpolarised reflectance per channel.
    pub fn rgb(&self, cos_theta_i: f64) -> Rgb {
        self.sum(|interface| interface.reflectance(cos_theta_i))
    }

    /// Schlick's form of each channel, through its reflectance at normal incidence. The form is linear in this reflectance: in spectral
    /// colour it is the sum of the forms of all wavelengths.
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

#[cfg(test)]
mod tests {
    use super::*;

    const F0: Rgb = [0.955, 0.638, 0.538];

    fn schlick_on(above: Ior, below: Ior) -> Interface {
        Interface { above, films: Vec::new(), below: below.with_f0(F0) }
    }

    /// Schlick 1994 by hand at 60 degrees, where (1 - cos)^5 = 1/32; in every colour mode, whatever lies above.
    #[test]
    fn an_f0_is_a_colour_in_every_mode() {
        let glass = Ior::constant(1.5, 0.0).unwrap();
        let sample = |wavelength_nm, n| crate::ior::IorSample { wavelength_nm, n, k: 0.0 };
        let dispersive = Ior::sampled(vec![sample(400.0, 1.54), sample(700.0, 1.5)]).unwrap();
        for above in [Ior::vacuum(), glass, dispersive] {
            let interface = schlick_on(above, Ior::vacuum());
            for color in [Color::Spectral, Color::ThreeWavelengths([645.0, 525.0, 445.0])] {
                let found = interface.sampled(&color).rgb(0.5);
                for (found, f0) in found.into_iter().zip(F0) {
                    assert!((found - (f0 + (1.0 - f0) / 32.0)).abs() < 1e-12, "{color:?}: {found} {f0}");
                }
                assert!(!interface.has_kink(&color) && interface.sampled(&color).critical_cot_sq() == 0.0);
            }
        }
    }

    #[test]
    fn one_channel_is_one_node_and_three_are_three() {
        let nodes = |f0| {
            let below = Ior::constant(1.5, 0.0).unwrap().with_f0(f0);
            Interface { above: Ior::vacuum(), films: Vec::new(), below }.sampled(&Color::Spectral).nodes.len()
        };
        assert_eq!([nodes([0.04; 3]), nodes(F0)], [1, 3]);
    }

    /// By hand: F0 = ((n - a)^2 + k^2) / ((n + a)^2 + k^2) of n = 2, k = 1 is 0.2 in air and 5/53 below glass of a = 1.5. The exterior, of a
    /// = 1.25, is above the first interface in either case.
    #[test]
    fn lower_interfaces_reflect_as_in_air_and_the_first_does_not() {
        use crate::stack::{Layer, Slab, Surface};
        let index = |n, k| Ior::constant(n, k).unwrap();
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] };
        let layer = |base| Layer { films: Vec::new(), surface: Surface::smooth(), base };
        let layers = vec![
            layer(Base::Dielectric { ior: index(1.5, 0.0), slab }),
            layer(Base::Conductor { ior: index(2.0, 1.0) }),
        ];
        let stack = Stack { exterior: index(1.25, 0.0), layers };
        let f0 = |stack: &Stack, layer| Interface::of(stack, layer).unwrap().sampled(&Color::Spectral).rgb(1.0)[0];
        let in_air = stack.with_lower_in_air();
        for (found, expected) in [
            (f0(&stack, 1), 5.0 / 53.0),
            (f0(&in_air, 1), 0.2),
            (f0(&stack, 0), 0.0625 / 7.5625),
            (f0(&in_air, 0), 0.0625 / 7.5625),
        ] {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        // A layer that has lost those above it is the first.
        let bare = Stack { layers: in_air.layers[1..].to_vec(), ..in_air };
        assert!((f0(&bare, 0) - (0.75 * 0.75 + 1.0) / (3.25 * 3.25 + 1.0)).abs() < 1e-12);
    }

    #[cfg(feature = "serde")]
    #[test]
    fn stores_keep_an_f0() {
        let with = schlick_on(Ior::vacuum(), Ior::constant(1.5, 0.0).unwrap());
        let tinted = Interface { below: with.below.clone().with_f82_tint([0.7, 0.123_456_789, 0.0]), ..with.clone() };
        let [with, tinted, black] = [with.at(550.0, 1), tinted.at(550.0, 1), tinted.at(550.0, 2)];
        let without = Interface { above: Ior::vacuum(), films: Vec::new(), below: Ior::constant(0.2, 3.0).unwrap() };
        for one in [with, tinted, black, without.at(550.0, 1)] {
            assert_eq!(Monochrome::from(Stored::from(one.clone())), one);
        }
    }
}
