//! A re-radiation matrix in linear Rec.709: from the colour of incident light to the colour of the light that comes out.

use std::sync::OnceLock;

use super::Matrix;
use crate::Rgb;
use crate::color::Color;
use crate::rows::rows;

/// Half a step of the wavelengths of [`Color::Spectral`], nm.
const HALF_STEP_NM: f64 = 2.5;

/// Light of D65 around one wavelength: its power, and the shares of the power in lights of the primary colours.
struct Light {
    wavelength_nm: f64,
    power: f64,
    primaries: Rgb,
    weight: Rgb,
}

/// Rows of `rgb_out = M rgb_in`, both linear Rec.709 whose white (1, 1, 1) is D65.
///
/// ```text
/// M_ij = sum over bins `to` of  W_i(to) / E(to)  sum over bins `from` of  share(to, from) E_j(from)
/// ```
///
/// `E(bin)` is the power of D65 in a bin, `E_j(bin)` the power of a light of the j-th primary colour there. `W_i(bin)` is the value of channel i
/// under D65 if a perfect reflector covers the bin alone. The spectra of the primaries sum to D65, so that the sum of a row is exact: it is
/// the colour under white light, 1 for a perfect reflector. Other lights have the smoothest spectrum of their colour (Mallett and
/// Yuksel 2019). A row may sum to more than 1, because a channel receives light of others. Entries may be negative, because colours may be
/// outside the gamut.
///
/// A bin reaches half-way to its neighbours, the first and the last one as far outwards as inwards; within a bin, light that comes out is
/// spread as D65 is. Light outside all bins is absorbed, and so is light below 360 and above 830 nm, where D65 has no power here. The bin of
/// a matrix of one bin reaches from 360 to 830 nm.
pub fn rgb(matrix: &Matrix) -> [Rgb; 3] {
    let nm = &matrix.wavelengths_nm;
    let count = nm.len();
    let middles: Vec<f64> = nm.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    // Of each bin: power of D65, that of the primaries, weights of the channels.
    let bins: Vec<(f64, Rgb, Rgb)> = (0..count)
        .map(|i| {
            let [from, to] = match count {
                1 => [0.0, f64::MAX],
                _ if i == 0 => [2.0 * nm[0] - middles[0], middles[0]],
                _ if i + 1 == count => [middles[i - 1], 2.0 * nm[i] - middles[i - 1]],
                _ => [middles[i - 1], middles[i]],
            };
            let mut bin = (0.0, [0.0; 3], [0.0; 3]);
            for light in d65() {
                let [low, high] = [light.wavelength_nm - HALF_STEP_NM, light.wavelength_nm + HALF_STEP_NM];
                let part = (high.min(to) - low.max(from)).max(0.0) / (2.0 * HALF_STEP_NM);
                bin.0 += part * light.power;
                for c in 0..3 {
                    bin.1[c] += part * light.power * light.primaries[c];
                    bin.2[c] += part * light.weight[c];
                }
            }
            bin
        })
        .collect();
    let mut out = [[0.0; 3]; 3];
    for (to, (power, _, weight)) in bins.iter().enumerate().filter(|(_, bin)| bin.0 > 0.0) {
        let row = &matrix.shares[to * count..][..count];
        let emitted = [0, 1, 2]
            .map(|j: usize| row.iter().zip(&bins).map(|(share, (_, lights, _))| share * lights[j]).sum::<f64>());
        for (sums, weight) in out.iter_mut().zip(weight) {
            for (sum, emitted) in sums.iter_mut().zip(emitted) {
                *sum += weight * emitted / power;
            }
        }
    }
    out
}

/// The nodes of [`Color::Spectral`], with the power of D65 there and the spectra of the primaries.
fn d65() -> &'static [Light] {
    static LIGHTS: OnceLock<Vec<Light>> = OnceLock::new();
    LIGHTS.get_or_init(|| {
        let powers = rows(include_str!("../../data/cie_1931_d65.csv")).map_while(Result::ok);
        let primaries = rows(include_str!("../../data/rec709_primaries.csv")).map_while(Result::ok);
        (Color::Spectral.nodes().iter().zip(powers).zip(primaries))
            .map(|((node, power), primaries)| {
                let [red, green] = [1, 2].map(|cell| primaries.number(cell).unwrap_or(f64::NAN));
                Light {
                    wavelength_nm: node.wavelength_nm,
                    power: power.number(4).unwrap_or(f64::NAN),
                    primaries: [red, green, 1.0 - red - green],
                    weight: node.weight,
                }
            })
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(wavelengths_nm: Vec<f64>, share: impl Fn(usize, usize) -> f64) -> Matrix {
        let n = wavelengths_nm.len();
        let shares = (0..n * n).map(|at| share(at / n, at % n)).collect();
        Matrix { wavelengths_nm, shares }
    }

    fn steps() -> Vec<f64> {
        (0..95).map(|i| 360.0 + 5.0 * f64::from(i)).collect()
    }

    /// Conditions that the method of Mallett and Yuksel puts on the data file.
    #[test]
    fn primaries_sum_to_d65_and_have_their_colours() {
        assert_eq!(d65().len(), 95);
        for i in 0..3 {
            for j in 0..3 {
                let found: f64 = d65().iter().map(|light| light.weight[i] * light.primaries[j]).sum();
                assert!((found - if i == j { 1.0 } else { 0.0 }).abs() < 1e-9, "{i} {j}: {found}");
            }
        }
        assert!(d65().iter().all(|light| light.primaries.iter().all(|&share| (-1e-12..=1.0).contains(&share))));
    }

    /// No light changes its wavelength: the identity, whatever the bins, sums to white.
    #[test]
    fn a_perfect_reflector_is_white() {
        let same = |to: usize, from: usize| if to == from { 1.0 } else { 0.0 };
        let fine = rgb(&matrix(steps(), same));
        for (i, row) in fine.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert!((value - same(i, j)).abs() < 1e-9, "{fine:?}");
            }
        }
        for wavelengths in
            [vec![550.0], vec![450.0, 550.0, 700.0], (0..60).map(|i| 357.0 + 8.0 * f64::from(i)).collect()]
        {
            let rows = rgb(&matrix(wavelengths.clone(), same));
            let sums = rows.map(|row| row.iter().sum::<f64>());
            assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 0.02), "{wavelengths:?} {sums:?}");
        }
    }

    /// Oracle: the colour of a reflectance by the nodes of the colour mode, and of a dye by hand.
    #[test]
    fn the_sum_of_a_row_is_the_colour_under_white_light() {
        let reflectance = |nm: f64| 0.4 + 0.3 * libm::sin(0.02 * nm);
        let nm = steps();
        let plain = rgb(&matrix(nm.clone(), |to, from| if to == from { reflectance(nm[to]) } else { 0.0 }));
        let nodes = Color::Spectral.nodes();
        for (i, row) in plain.iter().enumerate() {
            let expected: f64 = nodes.iter().map(|node| node.weight[i] * reflectance(node.wavelength_nm)).sum();
            assert!((row.iter().sum::<f64>() - expected).abs() < 1e-9);
        }
        // Light from 440 to 500 nm comes out at 600 nm, half of its power.
        let is_taken = |from: usize| (440.0..=500.0).contains(&steps()[from]);
        let dye = rgb(&matrix(steps(), |to, from| if to == 48 && is_taken(from) { 0.5 } else { 0.0 }));
        let taken: f64 = d65().iter().enumerate().filter(|(i, _)| is_taken(*i)).map(|(_, light)| light.power).sum();
        for (i, row) in dye.iter().enumerate() {
            let expected = nodes[48].weight[i] * 0.5 * taken / d65()[48].power;
            assert!((row.iter().sum::<f64>() - expected).abs() < 1e-9, "{dye:?} {expected}");
        }
        // Blue light becomes orange; red light is absorbed. The red of white light is more than a perfect reflector's.
        assert!(dye[0][2] > 0.5 && dye[0][0] < 0.05 && dye[2][2].abs() < 0.05, "{dye:?}");
    }

    /// Bins of 5 nm and of 20 nm of one dye agree within what the bins blur.
    #[test]
    fn bins_of_another_width_give_nearly_the_same() {
        let absorbed = |nm: f64| libm::exp(-(nm - 480.0) * (nm - 480.0) / 1800.0);
        let emitted =
            |nm: f64| libm::exp(-(nm - 580.0) * (nm - 580.0) / 1250.0) / libm::sqrt(1250.0 * std::f64::consts::PI);
        let of = |width: f64| {
            let nm: Vec<f64> = (0..(480.0 / width) as usize).map(|i| 355.0 + width * (i as f64 + 0.5)).collect();
            rgb(&matrix(nm.clone(), |to, from| 0.6 * absorbed(nm[from]) * emitted(nm[to]) * width))
        };
        let (fine, coarse) = (of(5.0), of(20.0));
        for (a, b) in fine.iter().flatten().zip(coarse.iter().flatten()) {
            assert!((a - b).abs() < 0.02, "{fine:?} {coarse:?}");
        }
    }
}
