//! Clear thin films over bases whose F0 hangs on the place: Airy's formula as a series whose interference is one row of a table.
//!
//! Simplifications: the indices of a film bend and split light as at one wavelength, and echoes beyond the fourth interfere as the fourth does.

use std::f64::consts::{PI, TAU};

use crate::Rgb;
use crate::color::WavelengthNode;
use crate::ior::Ior;
use crate::schlick::index_below_film;

/// Waves of the optical path at the end of a row of [`interference`]. White light that is off by as many hardly interferes.
pub const WAVES_MAX: f64 = 12.0;

/// Echoes of a film that have an interference of their own.
pub const ORDERS: u32 = 4;

/// Interference of light that is late by an optical path, RGB: the mean of `2 cos` of its phase over the wavelengths of the channel. `waves` counts those of
/// `middle_nm` along the path.
pub fn interference(film: &Ior, nodes: &[WavelengthNode], middle_nm: f64, waves: f64) -> Rgb {
    let path = waves * middle_nm / film.at(middle_nm).re;
    let mut rgb = [0.0; 3];
    for WavelengthNode { wavelength_nm, weight } in nodes {
        let both = 2.0 * libm::cos(TAU * path * film.at(*wavelength_nm).re / wavelength_nm);
        (0..3).for_each(|c| rgb[c] += weight[c] * both);
    }
    rgb
}

/// A clear film over an F0, whose base has the index of [`index_below_film`].
///
/// With amplitudes r and q of its boundaries it lets through `(1 - r^2)(1 - q^2) / (1 + p^2 + 2 p cos)`, p being r q: a series of the cosines of multiples of
/// the phase, whose means over a channel are [`interference`] at multiples of the path.
///
/// Against characteristic matrices at all wavelengths (films of 1.2 to 2, 5 to 1200 nm, F0 from .02 to .99) channels are off by .0004 in the root mean square for
/// cosines from .5 on, and by .002 from .2 on, below a medium of 1.5 by .002 and .003. Flatter light takes more echoes.
///
/// A plain index of 1.3 to 1.8 in air is that of its own F0: under films of 1.3 to 2, 100 to 1000 nm, the series over it is off by .0007 at most for cosines from
/// .02 on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmOverF0 {
    /// Real index of the film over that of the medium above.
    pub ior: f64,
    /// Optical path down and up the film along its normal, in waves of each channel. The middle one counts, but for light that tunnels.
    pub waves: Rgb,
}

impl FilmOverF0 {
    /// Reflectance over an F0 at a cosine in the medium above, by channel; `interference` is that at so many waves. In the mean over directions whose squared
    /// sines have the standard deviation `spread`, echoes fade as those of a normal distribution of paths.
    pub fn reflectance(&self, f0: Rgb, cos_theta: f64, spread: f64, interference: impl Fn(f64) -> Rgb) -> Rgb {
        let sin_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
        let over = f0.map(|f0| 1.0 / index_below_film(1.0, f0));
        let cos_below = over.map(|over| (1.0 - sin_sq * over * over).sqrt());
        let cos_film_sq = 1.0 - sin_sq / (self.ior * self.ior);
        if cos_film_sq <= 0.0 {
            let decay = (-cos_film_sq).sqrt();
            return [0, 1, 2].map(|c: usize| {
                let kept = libm::exp(-TAU * self.waves[c] * decay);
                let s = tunnelled([cos_theta, self.ior * decay, cos_below[c] / over[c]], kept);
                let p = tunnelled([cos_theta, decay / self.ior, cos_below[c] * over[c]], kept);
                1.0 - 0.5 * (s + p)
            });
        }
        let cos_film = cos_film_sq.sqrt();
        let top = boundary([cos_theta, cos_film], 1.0 / self.ior);
        let apart = PI * self.waves[1] * spread / (self.ior * self.ior * cos_film.max(COS_MIN));
        let orders = [1.0, 2.0, 3.0, 4.0].map(|order: f64| {
            let faded = libm::exp(-0.5 * order * order * apart * apart);
            interference(order * self.waves[1] * cos_film).map(|echo| faded * echo)
        });
        [0, 1, 2].map(|c: usize| {
            let bottom = boundary([cos_film, cos_below[c]], self.ior * over[c]);
            let passed = |r: f64, q: f64| {
                let p = r * q;
                let last = orders[3][c] / (1.0 + p);
                let echoes = p * (orders[0][c] - p * (orders[1][c] - p * (orders[2][c] - p * last)));
                (1.0 - r * r) * (1.0 - q * q) / (1.0 - p * p).max(ROUND_MIN) * (1.0 - echoes)
            };
            // A series that ends may exceed 1 at flat angles. Colours out of gamut are below 0.
            (1.0 - 0.5 * (passed(top[0], bottom[0]) + passed(top[1], bottom[1]))).min(1.0)
        })
    }
}

/// Least cosine in the film of directions over which paths are even.
const COS_MIN: f64 = 0.1;

/// Least share of light that a round through the film loses.
const ROUND_MIN: f64 = 1e-6;

/// Share of light that tunnels through a film that would reflect it totally, by the wave numbers along the normal, each over that of its polarisation, above, in
/// and below it. `kept` is what an amplitude keeps down and up the film.
fn tunnelled([above, film, below]: [f64; 3], kept: f64) -> f64 {
    let [a, k, b] = [above, film, below].map(|x| x * x);
    let cross = 4.0 * above * below * k;
    let all = (1.0 + kept * kept) * (a + k) * (k + b) + 2.0 * kept * ((a - k) * (k - b) + cross);
    4.0 * kept * cross / all.max(ALL_MIN)
}

/// Least divisor of light that tunnels.
const ALL_MIN: f64 = 1e-9;

/// Amplitudes of both polarisations at a boundary, by the cosines above and below it, and the index above over that below.
fn boundary([above, below]: [f64; 2], relative: f64) -> [f64; 2] {
    [(relative * above - below) / (relative * above + below), (above - relative * below) / (above + relative * below)]
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;
    use crate::color::Color;

    const MIDDLE_NM: f64 = 550.0;

    /// Reflectance by the characteristic matrix of a film (Abeles 1950; Born and Wolf 1.6.2), one polarisation by its admittances.
    fn of_matrix([above, film, below]: [Complex64; 3], delta: Complex64) -> f64 {
        let i = Complex64::I;
        let (b, c) = (delta.cos() + i * delta.sin() * below / film, i * film * delta.sin() + delta.cos() * below);
        ((above * b - c) / (above * b + c)).norm_sqr()
    }

    /// Unpolarised reflectance over an F0 in the medium `above`, RGB, from matrices at every wavelength of the colour.
    fn exact(above: f64, film: f64, thickness_nm: f64, f0: f64, cos: f64) -> Rgb {
        let root = f0.sqrt();
        let indices = [above, film, above * (1.0 + root) / (1.0 - root)].map(|n| Complex64::new(n, 0.0));
        let across = above * (1.0 - cos * cos).sqrt();
        let mut rgb = [0.0; 3];
        for WavelengthNode { wavelength_nm, weight } in Color::Spectral.nodes() {
            let normal = indices.map(|n| (n * n - across * across).sqrt());
            let delta = normal[1] * (TAU * thickness_nm / wavelength_nm);
            let p = [0, 1, 2].map(|k: usize| indices[k] * indices[k] / normal[k]);
            let mean = 0.5 * (of_matrix(normal, delta) + of_matrix(p, delta));
            (0..3).for_each(|c| rgb[c] += weight[c] * mean);
        }
        rgb
    }

    fn found(above: f64, film: f64, thickness_nm: f64, f0: f64, cos: f64) -> Rgb {
        let waves = [611.0, MIDDLE_NM, 465.0].map(|nm| 2.0 * film * thickness_nm / nm);
        let (nodes, index) = (Color::Spectral.nodes(), Ior::constant(film, 0.0).unwrap());
        let here = FilmOverF0 { ior: film / above, waves };
        here.reflectance([f0; 3], cos, 0.0, |waves| interference(&index, &nodes, MIDDLE_NM, waves.min(WAVES_MAX)))
    }

    /// Oracle: the characteristic matrix. Cosines run from a least one to 1; no film and a white base are exact.
    #[test]
    fn the_series_is_the_characteristic_matrix() {
        for (above, from, [rms_max, worst_max]) in [
            (1.0, 0.5, [0.0005, 0.012]),
            (1.0, 0.2, [0.002, 0.06]),
            (1.5, 0.5, [0.002, 0.03]),
            (1.5, 0.2, [0.003, 0.03]),
        ] {
            let (mut worst, mut sum, mut count) = (0.0f64, 0.0, 0);
            for ior in [1.2, 1.35, 1.5, 1.8, 2.0] {
                for nm in [5.0, 50.0, 120.0, 250.0, 400.0, 550.0, 850.0, 1200.0] {
                    for f0 in [0.02, 0.04, 0.25, 0.5, 0.8, 0.95, 0.99] {
                        for i in 0..8 {
                            let cos = from + (1.0 - from) * f64::from(i) / 7.0;
                            let [a, b] = [exact, found].map(|of| of(above, ior, nm, f0, cos));
                            for c in 0..3 {
                                worst = worst.max((a[c] - b[c]).abs());
                                sum += (a[c] - b[c]) * (a[c] - b[c]);
                                count += 1;
                            }
                        }
                    }
                }
            }
            let rms = (sum / f64::from(count)).sqrt();
            assert!(rms < rms_max && worst < worst_max, "above {above} from {from}: {rms} {worst}");
        }
        for (above, cos) in [(1.0, 1.0), (1.0, 0.3), (1.5, 0.9), (1.5, 0.2)] {
            let [thin, white] = [found(above, 1.35, 1e-6, 0.3, cos), found(above, 1.35, 400.0, 1.0, cos)];
            let bare = exact(above, 1.35, 0.0, 0.3, cos);
            assert!(
                (0..3).all(|c| (thin[c] - bare[c]).abs() < 1e-4 && (white[c] - 1.0).abs() < 2e-3),
                "{thin:?} {white:?}"
            );
        }
    }

    /// Oracle: the characteristic matrix of the index. In air an index is that of its own F0, so that the series over a plain index is off by its echoes alone.
    #[test]
    fn the_series_over_the_f0_of_an_index_is_the_film_on_that_index() {
        for (from, [rms_max, worst_max]) in [(0.5, [2e-5, 3e-4]), (0.02, [4e-5, 8e-4])] {
            let (mut worst, mut sum, mut count) = (0.0f64, 0.0, 0);
            for index in [1.3, 1.4, 1.5, 1.65, 1.8] {
                let f0 = crate::schlick::f0(1.0, Complex64::new(index, 0.0));
                assert!((index_below_film(1.0, f0) - index).abs() < 1e-12, "{index}");
                for ior in [1.3, 1.45, 1.6, 1.8, 2.0] {
                    for step in 0..10 {
                        let nm = 100.0 + 100.0 * f64::from(step);
                        for i in 0..8 {
                            let cos = from + (1.0 - from) * f64::from(i) / 7.0;
                            let [a, b] = [exact, found].map(|of| of(1.0, ior, nm, f0, cos));
                            for c in 0..3 {
                                worst = worst.max((a[c] - b[c]).abs());
                                sum += (a[c] - b[c]) * (a[c] - b[c]);
                                count += 1;
                            }
                        }
                    }
                }
            }
            let rms = (sum / f64::from(count)).sqrt();
            assert!(rms < rms_max && worst < worst_max, "from {from}: {rms} {worst}");
        }
    }
}
