//! Fresnel reflectances of an interface by name: exact ones and approximations.

use luthier_optics::Rgb;
use luthier_optics::film_color::{BelcourBarla, granier_two_beam};
use luthier_optics::schlick::{F82, F82_COS_THETA, Lazanyi, complex_f0, f0, schlick};

use crate::formulas::transfer_matrix::transfer_matrix;
use crate::memo::Memo;
use crate::monochrome::{Monochrome, MonochromeLayer};

/// Formula for the reflectance of an interface. All but [`Fresnel::Exact`] and [`Fresnel::TransferMatrix`] are approximations; their errors
/// are in [`luthier_optics::schlick`] and [`luthier_optics::film_color`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fresnel {
    /// Fresnel's formulas for any complex index; films by Airy's formula, applied from the bottom up.
    Exact,
    /// Fresnel's formulas for any complex index; films by characteristic matrices.
    TransferMatrix,
    /// Schlick 1994, from the interface's own reflectance at normal incidence, films included.
    Schlick,
    /// Schlick's form with the F0 of the complex index below; no films.
    ComplexF0,
    /// Lazanyi and Szirmay-Kalos 2005, the correction fitted to the interface at the wavelength; no films.
    Lazanyi,
    /// F82-tint through the interface's own reflectance at normal incidence and at 81.8 degrees, films included; at most 1.
    F82,
    /// Granier and Heidrich 2003, two beams of the first film, aligned boundaries; Schlick's without a film. May exceed 1.
    TwoBeams,
    /// Belcour and Barla 2017, first film only and without its absorption; exact without a film. At one wavelength their series of
    /// two orders, clamped to 0..=1; in spectral colour prefiltered.
    BelcourBarla,
}

/// Orders of interference of [`Fresnel::BelcourBarla`], those of the published shaders.
const ORDERS: u32 = 2;

/// Fits of [`Fresnel::Lazanyi`], by index above and complex index below.
pub(crate) type LazanyiMemo = Memo<[u64; 3], Lazanyi>;

impl Fresnel {
    /// Reflectance of an interface for light from above; 0 for a diffuse base, which has no interface. All formulas agree on a bare interface with an F0:
    /// it has Schlick's reflectance, and no index for which they could differ.
    pub(crate) fn reflectance(self, fits: &LazanyiMemo, layer: &MonochromeLayer, cos_theta_i: f64) -> f64 {
        let Some(below) = layer.index_below() else { return 0.0 };
        if layer.bare_f0().is_some() {
            return layer.reflectance(cos_theta_i);
        }
        let above = layer.above;
        match self {
            Self::Exact => layer.reflectance(cos_theta_i),
            Self::TransferMatrix => transfer_matrix(above, &layer.films, below, cos_theta_i).unpolarised(),
            Self::Schlick => schlick(layer.reflectance(1.0), cos_theta_i),
            Self::ComplexF0 => complex_f0(above, below, cos_theta_i),
            Self::Lazanyi => {
                let key = [above, below.re, below.im].map(f64::to_bits);
                fits.get(key, || Lazanyi::fit(above, below)).eval(cos_theta_i)
            }
            Self::F82 => {
                let f82 = F82::through(layer.reflectance(1.0), layer.reflectance(F82_COS_THETA));
                f82.eval(cos_theta_i).min(1.0)
            }
            Self::TwoBeams => match layer.films.first() {
                Some(film) => {
                    let eta = film.ior.re / above;
                    let [value, ..] = granier_two_beam([eta; 3], [1.0; 3], film.waves * above, cos_theta_i);
                    value
                }
                None => schlick(f0(above, below), cos_theta_i),
            },
            Self::BelcourBarla => match belcour_barla(layer, 1.0) {
                Some(film) => film.monochrome(1.0, cos_theta_i).clamp(0.0, 1.0),
                None => layer.reflectance(cos_theta_i),
            },
        }
    }

    /// Reflectance of the first interface in spectral colour, for the one formula whose colour is not a sum over wavelengths; `None` for others. Each
    /// channel has the indices of its wavelength.
    pub(crate) fn rgb(self, channels: &[(f64, Monochrome); 3], cos_theta_i: f64) -> Option<Rgb> {
        if self != Self::BelcourBarla {
            return None;
        }
        let mut rgb = [0.0; 3];
        for (c, (wavelength_nm, stack)) in channels.iter().enumerate() {
            rgb[c] = belcour_barla(stack.layers.first()?, *wavelength_nm)?.rgb(cos_theta_i)[c];
        }
        Some(rgb)
    }
}

/// The film of an interface, its thickness in units of the wavelength's.
fn belcour_barla(layer: &MonochromeLayer, wavelength: f64) -> Option<BelcourBarla> {
    let (film, below) = (layer.films.first()?, layer.index_below()?);
    let thickness_nm = film.waves * wavelength;
    Some(BelcourBarla { above: layer.above, film: film.ior.re, thickness_nm, below, orders: ORDERS })
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;
    use crate::monochrome::MonochromeBelow;
    use luthier_optics::fresnel::FilmLayer;
    use luthier_optics::stack::Surface;

    const ALL: [Fresnel; 8] = [
        Fresnel::Exact,
        Fresnel::TransferMatrix,
        Fresnel::Schlick,
        Fresnel::ComplexF0,
        Fresnel::Lazanyi,
        Fresnel::F82,
        Fresnel::TwoBeams,
        Fresnel::BelcourBarla,
    ];

    fn layer(films: &[(f64, f64)], ior: Complex64) -> MonochromeLayer {
        let films = films.iter().map(|&(n, waves)| FilmLayer { ior: Complex64::new(n, 0.0), waves }).collect();
        MonochromeLayer {
            surface: Surface::smooth(),
            above: 1.0,
            films,
            below: MonochromeBelow::Conductor { ior },
            f0: None,
        }
    }

    /// All formulas agree at normal incidence without films: |(n - 1)/(n + 1)|^2, by hand.
    #[test]
    fn all_agree_at_normal_incidence_without_films() {
        let (n, k) = (1.04, 2.583);
        let expected = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
        for fresnel in ALL {
            let found = fresnel.reflectance(&Memo::new(), &layer(&[], Complex64::new(n, k)), 1.0);
            assert!((found - expected).abs() < 1e-14, "{fresnel:?}: {found}");
        }
    }

    /// Copper's green at 81.8 degrees: the documented errors are bounds, and the approximations are none of each other.
    #[test]
    fn approximations_are_off_by_at_most_the_documented_error() {
        let copper = layer(&[], Complex64::new(1.04, 2.583));
        let at = |fresnel: Fresnel| fresnel.reflectance(&Memo::new(), &copper, 0.3);
        let exact = at(Fresnel::Exact);
        for (fresnel, error) in [(Fresnel::ComplexF0, 0.0404), (Fresnel::Lazanyi, 0.0012), (Fresnel::F82, 0.0056)] {
            let found = (at(fresnel) - exact).abs();
            assert!(found > 0.0 && found < error + 1e-4, "{fresnel:?}: {found}");
        }
    }

    /// Oracles: Airy sums evaluated elsewhere, 300 nm of 1.33 in air at 550 nm, 0 and 60 degrees; and two beams by hand at the normal:
    /// F = 0.0200583, T = (1 - F)^2, phase 4 pi 1.33 300/550.
    #[test]
    fn films() {
        let soap = layer(&[(1.33, 300.0 / 550.0)], Complex64::ONE);
        for (cos, expected) in [(1.0, 0.07543020), (0.5, 0.5 * (0.05362888 + 0.00171259))] {
            // Two orders leave out 2 T R^3 of either polarisation: with R = 0.1135 of s at 60 degrees, 1.3e-3 of the mean.
            for (fresnel, tolerance) in
                [(Fresnel::Exact, 1e-8), (Fresnel::TransferMatrix, 1e-8), (Fresnel::BelcourBarla, 1.3e-3)]
            {
                let found = fresnel.reflectance(&Memo::new(), &soap, cos);
                assert!((found - expected).abs() < tolerance, "{fresnel:?}: {found}");
            }
        }
        let f = 0.33 * 0.33 / (2.33 * 2.33);
        let t = (1.0 - f) * (1.0 - f);
        let phase = 4.0 * std::f64::consts::PI * 1.33 * 300.0 / 550.0;
        let expected = f + t + 2.0 * libm::cos(phase) * libm::sqrt(f * t);
        let found = Fresnel::TwoBeams.reflectance(&Memo::new(), &soap, 1.0);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }

    /// A film in a denser medium is the same film, its wavelength and the indices scaled.
    #[test]
    fn two_beams_take_relative_indices() {
        let film = layer(&[(1.5, 0.4)], Complex64::new(2.0, 0.0));
        let mut inside = layer(&[(1.5 * 1.3, 0.4 / 1.3)], Complex64::new(2.0 * 1.3, 0.0));
        inside.above = 1.3;
        let at = |layer: &MonochromeLayer| Fresnel::TwoBeams.reflectance(&Memo::new(), layer, 0.6);
        assert!((at(&film) - at(&inside)).abs() < 1e-12);
    }

    #[test]
    fn colour_of_its_own_has_prefiltering_alone() {
        let stack = |nm: f64| Monochrome { exterior: 1.0, layers: vec![layer(&[(1.5, 400.0 / nm)], Complex64::ONE)] };
        let channels = [645.0, 525.0, 445.0].map(|nm| (nm, stack(nm)));
        for fresnel in ALL {
            assert_eq!(fresnel.rgb(&channels, 0.7).is_some(), fresnel == Fresnel::BelcourBarla);
        }
        let film = BelcourBarla { above: 1.0, film: 1.5, thickness_nm: 400.0, below: Complex64::ONE, orders: 2 };
        let found = Fresnel::BelcourBarla.rgb(&channels, 0.7).unwrap();
        for (found, expected) in found.into_iter().zip(film.rgb(0.7)) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
}
