//! Colour from spectra: wavelengths with a weight per channel.

use std::sync::OnceLock;

use crate::Rgb;
use crate::rows::rows;

/// Red, green and blue wavelengths of Granier and Heidrich 2003, the default of the three-wavelength mode.
pub const GRANIER_WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// Luminance of linear Rec.709 (IEC 61966-2-1, second row of the RGB to XYZ matrix).
pub const LUMINANCE: Rgb = [0.2126, 0.7152, 0.0722];

/// Rule by which a function of wavelength becomes three numbers.
///
/// ```
/// use luthier_optics::color::Color;
///
/// // A perfect reflector is white.
/// let nodes = Color::Spectral.nodes();
/// let white = nodes.iter().fold([0.0; 3], |sum, node| [0, 1, 2].map(|c| sum[c] + node.weight[c]));
/// assert!(white.iter().all(|channel| (channel - 1.0).abs() < 1e-12));
/// assert_eq!(Color::ThreeWavelengths([645.0, 525.0, 445.0]).nodes().len(), 3);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Color {
    /// Integrated over 360 to 830 nm in 5 nm steps against the CIE 1931 2-degree observer under D65, in linear Rec.709.
    /// A perfect reflector is exactly (1, 1, 1). Channels may leave 0..1: real colours exceed the gamut.
    Spectral,
    /// The value at three wavelengths (R, G, B, in nm), taken for the channels: the habit of real-time rendering.
    ThreeWavelengths([f64; 3]),
}

/// A wavelength, and the weight of its reflectance in each channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WavelengthNode {
    /// Vacuum wavelength.
    pub wavelength_nm: f64,
    /// Weight per channel.
    pub weight: Rgb,
}

impl Color {
    /// The wavelengths to evaluate; the weights of each channel sum to one.
    pub fn nodes(&self) -> Vec<WavelengthNode> {
        match self {
            Self::Spectral => cie_1931_d65().to_vec(),
            Self::ThreeWavelengths(wavelengths) => {
                let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                std::iter::zip(wavelengths, unit)
                    .map(|(&wavelength_nm, weight)| WavelengthNode { wavelength_nm, weight })
                    .collect()
            }
        }
    }

    /// Fewer wavelengths for costly integrands that vary as given spectra do: `spectra` have a value per node of
    /// [`Color::nodes`]. A node is left out if straight lines between others follow all spectra there; the neighbours that are kept share
    /// its weight.
    ///
    /// For each spectrum, the differences to the lines, times the largest weight of each node, sum to at most `tolerance`. The sum bounds
    /// the error of the integral in every channel. The node with the largest difference is kept next (Ramer 1972). Three wavelengths stay
    /// as they are.
    pub fn sparse_nodes(&self, spectra: &[Vec<f64>], tolerance: f64) -> Vec<WavelengthNode> {
        let nodes = self.nodes();
        if matches!(self, Self::ThreeWavelengths(_)) {
            return nodes;
        }
        let mut kept = vec![0, nodes.len() - 1];
        loop {
            let mut missed = vec![0.0; spectra.len()];
            let mut worst = (0.0, 0);
            for pair in kept.windows(2) {
                for i in pair[0] + 1..pair[1] {
                    let t = between(&nodes, i, pair[0], pair[1]);
                    let weight = nodes[i].weight.iter().fold(0.0, |max: f64, w| max.max(w.abs()));
                    for (sum, spectrum) in missed.iter_mut().zip(spectra) {
                        let line = (1.0 - t) * spectrum[pair[0]] + t * spectrum[pair[1]];
                        let here = weight * (spectrum[i] - line).abs();
                        *sum += here;
                        if here > worst.0 {
                            worst = (here, i);
                        }
                    }
                }
            }
            if missed.iter().all(|sum| *sum <= tolerance) {
                return lump(&nodes, &kept);
            }
            kept.insert(kept.partition_point(|&k| k < worst.1), worst.1);
        }
    }
}

/// Fraction of the way from node `a` to node `b` at which node `i` lies.
fn between(nodes: &[WavelengthNode], i: usize, a: usize, b: usize) -> f64 {
    let [i, a, b] = [i, a, b].map(|node| nodes[node].wavelength_nm);
    (i - a) / (b - a)
}

/// The kept nodes, with the weights of the others shared out linearly.
fn lump(nodes: &[WavelengthNode], kept: &[usize]) -> Vec<WavelengthNode> {
    let mut lumped: Vec<WavelengthNode> = kept.iter().map(|&i| nodes[i]).collect();
    for (k, pair) in kept.windows(2).enumerate() {
        for i in pair[0] + 1..pair[1] {
            let t = between(nodes, i, pair[0], pair[1]);
            for c in 0..3 {
                lumped[k].weight[c] += (1.0 - t) * nodes[i].weight[c];
                lumped[k + 1].weight[c] += t * nodes[i].weight[c];
            }
        }
    }
    lumped
}

/// First and last wavelength of the observer's table, in nm: colours depend on none outside.
pub const VISIBLE_NM: (f64, f64) = (360.0, 830.0);

/// Relative luminance of linear Rec.709.
pub fn luminance(rgb: Rgb) -> f64 {
    LUMINANCE[0] * rgb[0] + LUMINANCE[1] * rgb[1] + LUMINANCE[2] * rgb[2]
}

/// The observer's functions times D65, in Rec.709. The white of the matrix from XYZ is the white of the table, so that weights sum to one.
fn cie_1931_d65() -> &'static [WavelengthNode] {
    static NODES: OnceLock<Vec<WavelengthNode>> = OnceLock::new();
    NODES.get_or_init(|| {
        let rows = rows(include_str!("../data/cie_1931_d65.csv")).map_while(Result::ok);
        let rows = rows.map(|row| std::array::from_fn(|cell| row.number(cell).unwrap_or(f64::NAN)));
        let rows: Vec<[f64; 5]> = rows.collect();
        let mut white = [0.0; 3];
        for [_, x, y, z, power] in &rows {
            for (sum, bar) in white.iter_mut().zip([x, y, z]) {
                *sum += bar * power;
            }
        }
        let scale = 1.0 / white[1];
        let to_rgb = xyz_to_rec709(white.map(|w| w * scale));
        rows.iter()
            .map(|&[wavelength_nm, x, y, z, power]| {
                let xyz = [x, y, z].map(|bar| bar * power * scale);
                WavelengthNode { wavelength_nm, weight: multiply(&to_rgb, xyz) }
            })
            .collect()
    })
}

pub(crate) type Matrix = [[f64; 3]; 3];

/// A matrix of rows times a vector.
pub fn multiply(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|r: usize| m[r][0] * v[0] + m[r][1] * v[1] + m[r][2] * v[2])
}

/// Matrix from XYZ to linear RGB with the Rec.709 primaries and the given white (SMPTE RP 177-1993).
pub(crate) fn xyz_to_rec709(white: [f64; 3]) -> Matrix {
    let primaries = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
    let xyz = primaries.map(|[x, y]: [f64; 2]| [x / y, 1.0, (1.0 - x - y) / y]);
    let columns: Matrix = [0, 1, 2].map(|r: usize| [xyz[0][r], xyz[1][r], xyz[2][r]]);
    let scale = multiply(&inverse(&columns), white);
    inverse(&columns.map(|row| [row[0] * scale[0], row[1] * scale[1], row[2] * scale[2]]))
}

fn inverse(m: &Matrix) -> Matrix {
    let determinant = (0..3).map(|c| m[0][c] * cofactor(m, 0, c)).sum::<f64>();
    [0, 1, 2].map(|r: usize| [0, 1, 2].map(|c: usize| cofactor(m, c, r) / determinant))
}

/// The determinant without a row and a column, with its sign: rows and columns behind them wrap around.
fn cofactor(m: &Matrix, r: usize, c: usize) -> f64 {
    let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
    m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sums(nodes: &[WavelengthNode]) -> Rgb {
        [0, 1, 2].map(|c: usize| nodes.iter().map(|n| n.weight[c]).sum())
    }

    #[test]
    fn a_perfect_reflector_is_white() {
        let wave = Color::Spectral.nodes().iter().map(|n| libm::sin(0.1 * n.wavelength_nm)).collect();
        for nodes in [Color::Spectral.nodes(), Color::Spectral.sparse_nodes(&[wave], 0.1)] {
            for channel in sums(&nodes) {
                assert!((channel - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn matrix_matches_the_standard() {
        // IEC 61966-2-1 prints four decimals, for the white (0.3127, 0.3290).
        let m = xyz_to_rec709([0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290]);
        let printed = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        for (row, expected) in m.iter().zip(printed) {
            for (a, b) in row.iter().zip(expected) {
                assert!((a - b).abs() < 4e-4, "{a} against {b}");
            }
        }
    }

    #[test]
    fn sparse_nodes_keep_to_their_tolerance() {
        let nodes = Color::Spectral.nodes();
        let edge = |nm: f64| 0.5 + libm::atan((nm - 510.0) / 15.0) / std::f64::consts::PI;
        let line = |nm: f64| 0.2 + 0.001 * nm;
        let spectrum = |f: &dyn Fn(f64) -> f64| nodes.iter().map(|n| f(n.wavelength_nm)).collect::<Vec<f64>>();
        let spectra = [spectrum(&edge), spectrum(&|nm| edge(nm) * edge(nm)), spectrum(&line)];
        let integrate = |nodes: &[WavelengthNode], f: &dyn Fn(f64) -> f64| {
            [0, 1, 2].map(|c: usize| nodes.iter().map(|n| n.weight[c] * f(n.wavelength_nm)).sum::<f64>())
        };
        let mut counts = Vec::new();
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let sparse = Color::Spectral.sparse_nodes(&spectra, tolerance);
            for (a, b) in integrate(&nodes, &edge).into_iter().zip(integrate(&sparse, &edge)) {
                assert!((a - b).abs() <= tolerance);
            }
            for (a, b) in integrate(&nodes, &line).into_iter().zip(integrate(&sparse, &line)) {
                assert!((a - b).abs() < 1e-12);
            }
            counts.push(sparse.len());
        }
        assert!(counts[0] < counts[1] && counts[1] < counts[2] && counts[2] < 60, "{counts:?}");
        assert_eq!(Color::Spectral.sparse_nodes(&spectra[2..], 1e-6).len(), 2);
    }
}
