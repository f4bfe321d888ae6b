//! Approximations of thin films in RGB, without the spectral integral of [`fresnel::coated`](crate::fresnel::coated).
//!
//! [`BelcourBarla`] integrates the interference of every order against Gaussian fits of the matching functions, in closed form.
//! [`granier_two_beam`] takes three wavelengths and two beams. The tests state the errors of both.

use std::f64::consts::PI;
use std::sync::OnceLock;

use num_complex::Complex64;

use crate::Rgb;
use crate::color::{self, Matrix};
use crate::fresnel::amplitudes;
use crate::schlick::schlick;

/// A lossless film of constant index between a transparent medium and any base.
///
/// Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence". Exact amplitudes at
/// both boundaries; only the integral over wavelengths is approximate, and indices do not depend on the wavelength.
///
/// ```
/// use luthier_optics::{film_color::BelcourBarla, fresnel::{FilmLayer, coated}, num_complex::Complex64};
///
/// let [film, below] = [1.33, 1.5].map(|n| Complex64::new(n, 0.0));
/// let soap = BelcourBarla { above: 1.0, film: 1.33, thickness_nm: 300.0, below, orders: 8 };
/// // At one wavelength the series converges to Airy's formula.
/// let exact = coated(Complex64::ONE, &[FilmLayer { ior: film, waves: 300.0 / 550.0 }], below, 0.8).unpolarised();
/// assert!((soap.monochrome(550.0, 0.8) - exact).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BelcourBarla {
    /// Real index above.
    pub above: f64,
    /// Real index of the film.
    pub film: f64,
    /// Thickness of the film.
    pub thickness_nm: f64,
    /// Index below.
    pub below: Complex64,
    /// Orders of interference; the published shaders have 2.
    pub orders: u32,
}

impl BelcourBarla {
    /// Unpolarised reflectance in linear Rec.709, white for a perfect reflector. Channels may leave 0..1.
    ///
    /// Total reflection at the top of the film gives 1, as published: the series has no frustrated total reflection.
    pub fn rgb(&self, cos_theta_i: f64) -> Rgb {
        let xyz = self.mean(cos_theta_i, |path_nm, order, shift| sensitivity(order * path_nm, shift));
        let (rgb, white) = (color::multiply(rec709(), xyz), color::multiply(rec709(), sensitivity(0.0, 0.0)));
        // The fits are for equal energy, whose (1, 1, 1) is (1.205, .948, .909) of D65's Rec.709: each channel is scaled to white.
        // Scaling X, Y and Z instead errs by half as much again.
        [0, 1, 2].map(|c: usize| rgb[c] / white[c])
    }

    /// The colour of the shaders that apply the D65 Rec.709 matrix to the oscillating terms and not to the constant one: a constant
    /// spectrum is white, its oscillation tinted by (1.205, .948, .909).
    pub fn rgb_tinted(&self, cos_theta_i: f64) -> Rgb {
        let constant = self.mean(cos_theta_i, |_, order, _| if order == 0.0 { [1.0; 3] } else { [0.0; 3] });
        let full = self.mean(cos_theta_i, |path_nm, order, shift| sensitivity(order * path_nm, shift));
        let oscillating = [0, 1, 2].map(|c: usize| full[c] - constant[c]);
        let tinted = color::multiply(rec709(), oscillating);
        [0, 1, 2].map(|c: usize| constant[c] + tinted[c])
    }

    /// Reflectance at one wavelength through the same series: the exact one as `orders` grows.
    pub fn monochrome(&self, wavelength_nm: f64, cos_theta_i: f64) -> f64 {
        self.mean(cos_theta_i, |path_nm, order, shift| {
            [libm::cos(2.0 * PI * order * path_nm / wavelength_nm + shift), 0.0, 0.0]
        })[0]
    }

    /// Mean over the polarisations of C_0 S_0 + sum 2 C_m S_m, where `response` gives S for an optical path (nm), an order and a phase
    /// shift.
    ///
    /// Airy's |r|^2 expanded in r_21 r_23 = rho e^{i phi}: C_0 = R12 + R_s, C_m = rho^m (R_s - T12),
    /// R_s = T12^2 R23/(1 - R12 R23).
    fn mean(&self, cos_theta_i: f64, response: impl Fn(f64, f64, f64) -> [f64; 3]) -> [f64; 3] {
        let relative = self.above / self.film;
        let cos_film_sq = 1.0 - relative * relative * (1.0 - cos_theta_i * cos_theta_i);
        if cos_film_sq <= 0.0 {
            return response(0.0, 0.0, 0.0);
        }
        let cos_film = libm::sqrt(cos_film_sq);
        let path_nm = 2.0 * self.film * self.thickness_nm * cos_film;
        let [above, film] = [self.above, self.film].map(|ior| Complex64::new(ior, 0.0));
        let [top, bottom] = [amplitudes(above, film, cos_theta_i), amplitudes(film, self.below, cos_film)];
        let mut sum = [0.0; 3];
        for (r12, r23) in std::iter::zip(top, bottom) {
            let (refl_12, refl_23) = (r12.re * r12.re, r23.norm_sqr());
            let through = 1.0 - refl_12;
            let round = refl_12 * refl_23;
            let later = if round < 1.0 { through * through * refl_23 / (1.0 - round) } else { 0.0 };
            let echo = r23 * -r12.re;
            let (rho, phi) = (libm::sqrt(round), libm::atan2(echo.im, echo.re));
            let (mut weight, mut power) = (refl_12 + later, later - through);
            for order in (0..=self.orders).map(f64::from) {
                for (s, r) in sum.iter_mut().zip(response(path_nm, order, order * phi)) {
                    *s += 0.5 * weight * r;
                }
                power *= rho;
                weight = 2.0 * power;
            }
        }
        sum
    }
}

/// Gaussians in wave number that fit the matching functions: those of x, y and z, then the second of x. Weight (m^2, scaled), centre (1/m),
/// variance (1/m^2). The authors' shader, 2017.
const GAUSSIANS: [[f64; 3]; 4] = [
    [5.4856e-13, 1.6810e6, 4.3278e9],
    [4.4201e-13, 1.7953e6, 9.3046e9],
    [5.2481e-13, 2.2084e6, 6.6121e9],
    [9.7470e-14, 2.2399e6, 4.5282e9],
];

/// Divisor of the authors, by which y integrates to 1.
const NORM: f64 = 1.0685e-7;

/// XYZ of cos(2 pi path/wavelength + shift) under equal energy.
fn sensitivity(path_nm: f64, shift: f64) -> [f64; 3] {
    let p = 2.0 * PI * path_nm * 1e-9;
    let [x, y, z, second_x] = GAUSSIANS.map(|[value, centre, variance]| {
        value * libm::sqrt(2.0 * PI * variance) * libm::cos(centre * p + shift) * libm::exp(-variance * p * p) / NORM
    });
    [x + second_x, y, z]
}

/// XYZ to Rec.709 for D65 (chromaticity 0.3127, 0.3290).
fn rec709() -> &'static Matrix {
    static MATRIX: OnceLock<Matrix> = OnceLock::new();
    MATRIX.get_or_init(|| color::xyz_to_rec709([0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290]))
}

/// Reflectance of a film as Granier and Heidrich 2003 have it, with aligned boundaries and in the mirror direction: eq. 5 with
/// R = F and T = (1 - F)(1 - F(cos_t)) at three wavelengths taken as R, G and B.
///
/// `film` is its index per channel, against vacuum above. Faithful to the paper: Schlick's Fresnel, two beams, no base
/// (all light that is not reflected first comes back), so energy is not conserved; up to 1.94 at 80 degrees for an index of 1.5.
pub fn granier_two_beam(film: [f64; 3], wavelengths_nm: [f64; 3], thickness_nm: f64, cos_theta_i: f64) -> Rgb {
    [0, 1, 2].map(|c: usize| {
        let n = film[c];
        let f0 = (1.0 - n) * (1.0 - n) / ((1.0 + n) * (1.0 + n));
        let cos_film_sq = 1.0 - (1.0 - cos_theta_i * cos_theta_i) / (n * n);
        if cos_film_sq <= 0.0 {
            return 1.0;
        }
        let cos_film = libm::sqrt(cos_film_sq);
        let reflected = schlick(f0, cos_theta_i);
        let transmitted = (1.0 - reflected) * (1.0 - schlick(f0, cos_film));
        let two_phi = 4.0 * PI * n * thickness_nm / wavelengths_nm[c] * cos_film;
        reflected + transmitted + 2.0 * libm::cos(two_phi) * libm::sqrt(reflected * transmitted)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{Color, GRANIER_WAVELENGTHS_NM};
    use crate::fresnel::{FilmLayer, coated};

    /// A film in vacuum on a base, an angle in degrees, and the largest errors over thicknesses up to 3 um against the spectral
    /// integral: Airy at three wavelengths; the same up to 300 nm; Belcour-Barla; Belcour-Barla tinted; Granier's two beams.
    const CASES: [(f64, Complex64, f64, [f64; 5]); 4] = [
        (1.5, Complex64::new(1.0, 0.0), 0.0, [0.107, 0.031, 0.010, 0.019, 1.370]),
        (1.5, Complex64::new(1.0, 0.0), 60.0, [0.194, 0.046, 0.017, 0.031, 1.494]),
        (1.33, Complex64::new(1.0, 0.0), 0.0, [0.056, 0.009, 0.005, 0.010, 1.271]),
        (1.4, Complex64::new(1.0, 6.69), 0.0, [0.053, 0.022, 0.005, 0.009, 0.424]),
    ];

    fn airy(film: f64, below: Complex64, d: f64, nm: f64, cos: f64) -> f64 {
        coated(Complex64::ONE, &[FilmLayer { ior: Complex64::new(film, 0.0), waves: d / nm }], below, cos).unpolarised()
    }

    #[test]
    fn errors_against_the_spectral_integral() {
        let nodes = Color::Spectral.nodes();
        for (film, below, deg, expected) in CASES {
            let cos = libm::cos(deg.to_radians());
            let mut worst = [0.0f64; 5];
            for i in 1..=1000 {
                let thickness_nm = f64::from(i) * 3.0;
                let mut exact = [0.0; 3];
                for node in &nodes {
                    let r = airy(film, below, thickness_nm, node.wavelength_nm, cos);
                    for (sum, weight) in exact.iter_mut().zip(node.weight) {
                        *sum += weight * r;
                    }
                }
                let three = GRANIER_WAVELENGTHS_NM.map(|nm| airy(film, below, thickness_nm, nm, cos));
                let prefiltered = BelcourBarla { above: 1.0, film, thickness_nm, below, orders: 2 };
                let thin = if thickness_nm <= 300.0 { three } else { exact };
                let beams = granier_two_beam([film; 3], GRANIER_WAVELENGTHS_NM, thickness_nm, cos);
                let all = [three, thin, prefiltered.rgb(cos), prefiltered.rgb_tinted(cos), beams];
                for (worst, rgb) in worst.iter_mut().zip(all) {
                    *worst = (0..3).map(|c: usize| (rgb[c] - exact[c]).abs()).fold(*worst, f64::max);
                }
            }
            for (found, expected) in worst.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-3, "{film} {below} {deg}: {worst:?}");
            }
        }
    }

    #[test]
    fn the_series_is_airys_formula() {
        for (film, below, d, cos) in [
            (1.7, Complex64::new(0.5, 2.0), 333.0, 0.3),
            (1.33, Complex64::new(1.0, 0.0), 120.0, 0.9),
            (1.2, Complex64::new(2.4, 0.0), 800.0, 0.5),
        ] {
            let series = BelcourBarla { above: 1.0, film, thickness_nm: d, below, orders: 60 };
            let exact = airy(film, below, d, 550.0, cos);
            assert!((series.monochrome(550.0, cos) - exact).abs() < 1e-12, "{film} {below}");
        }
    }

    #[test]
    fn fits_are_white_at_zero_path_and_the_matrix_alone_is_not() {
        for (found, expected) in sensitivity(0.0, 0.0).into_iter().zip([1.0005, 1.0002, 1.0011]) {
            assert!((found - expected).abs() < 1e-4);
        }
        for (found, expected) in color::multiply(rec709(), [1.0; 3]).into_iter().zip([1.205, 0.948, 0.909]) {
            assert!((found - expected).abs() < 1e-3);
        }
        let mirror =
            BelcourBarla { above: 1.0, film: 1.5, thickness_nm: 400.0, below: Complex64::new(0.0, 1e6), orders: 2 };
        for channel in mirror.rgb(0.7) {
            assert!((channel - 1.0).abs() < 1e-5, "{channel}");
        }
    }

    /// Luminance contrast of a film between equal media dies within an optical path difference of 3.5 um; at one wavelength never.
    #[test]
    fn contrast_decays_with_thickness() {
        let swing = |from: f64, f: &dyn Fn(f64) -> f64| {
            let values = (0..400).map(|i| f(from + f64::from(i)));
            values.fold((f64::INFINITY, 0.0f64), |(low, high), y| (low.min(y), high.max(y)))
        };
        let prefiltered = |d: f64| {
            let film = BelcourBarla { above: 1.0, film: 1.5, thickness_nm: d, below: Complex64::ONE, orders: 2 };
            color::luminance(film.rgb(1.0))
        };
        let (low, high) = swing(1400.0, &prefiltered);
        assert!((high - low) / (high + low) < 0.01, "{low} {high}");
        let (low, high) = swing(1400.0, &|d| airy(1.5, Complex64::ONE, d, 525.0, 1.0));
        assert!((high - low) / (high + low) > 0.99, "{low} {high}");
    }

    #[test]
    fn two_beams_gain_energy() {
        let cos = libm::cos(80f64.to_radians());
        let most = (0..2000)
            .map(|d| granier_two_beam([1.5; 3], GRANIER_WAVELENGTHS_NM, f64::from(d), cos)[1])
            .fold(0.0, f64::max);
        assert!((most - 1.94).abs() < 5e-3, "{most}");
    }
}
