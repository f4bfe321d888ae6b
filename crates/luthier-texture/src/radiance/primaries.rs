//! Colours of other primaries and whites, brought to linear Rec.709.

use luthier_lut::Image;

type Matrix = [[f64; 3]; 3];

/// Chromaticities of primaries and white, CIE 1931 xy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Primaries {
    pub(super) red: [f64; 2],
    pub(super) green: [f64; 2],
    pub(super) blue: [f64; 2],
    pub(super) white: [f64; 2],
}

/// ITU-R BT.709, white D65.
const REC709: Primaries =
    Primaries { red: [0.64, 0.33], green: [0.3, 0.6], blue: [0.15, 0.06], white: [0.3127, 0.329] };

/// Largest difference of coordinates that count as equal: some files state those of Rec.709 with other numbers of
/// digits.
const NEAR: f64 = 1e-3;

/// Bradford's responses of cones (Lam 1985), from XYZ.
const BRADFORD: Matrix = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

impl Primaries {
    /// CIE XYZ as primaries, with the white of equal energy, as in Radiance's XYZE.
    pub(super) const XYZ: Self =
        Self { red: [1.0, 0.0], green: [0.0, 1.0], blue: [0.0, 0.0], white: [1.0 / 3.0, 1.0 / 3.0] };

    /// Whether these are CIE XYZ, with any white.
    pub(super) fn is_xyz(&self) -> bool {
        self.near(&Self { white: self.white, ..Self::XYZ })
    }

    fn coordinates(&self) -> [f64; 8] {
        let [[a, b], [c, d], [e, f], [g, h]] = [self.red, self.green, self.blue, self.white];
        [a, b, c, d, e, f, g, h]
    }

    pub(super) fn is_rec709(&self) -> bool {
        self.near(&REC709)
    }

    fn near(&self, other: &Self) -> bool {
        self.coordinates().iter().zip(other.coordinates()).all(|(a, b)| (a - b).abs() <= NEAR)
    }

    /// The matrix from these primaries to CIE XYZ. 1 of each is white of luminance 1.
    fn to_xyz(self) -> Option<Matrix> {
        let columns = [self.red, self.green, self.blue].map(|[x, y]| [x, y, 1.0 - x - y]);
        let unscaled: Matrix = [0, 1, 2].map(|row| columns.map(|column| column[row]));
        let scale = apply(&inverse(&unscaled)?, self.white_xyz()?);
        Some(unscaled.map(|row| [0, 1, 2].map(|k| row[k] * scale[k])))
    }

    fn white_xyz(self) -> Option<[f64; 3]> {
        let [x, y] = self.white;
        (y > 0.0).then(|| [x / y, 1.0, (1.0 - x - y) / y])
    }

    /// The matrix to linear Rec.709 that turns white into white, by Bradford's adaptation. `None` if the primaries span
    /// no colours.
    pub(super) fn to_rec709(self) -> Option<Matrix> {
        let [from, to] = [self, REC709].map(|primaries| primaries.white_xyz().map(|white| apply(&BRADFORD, white)));
        let (from, to) = (from?, to?);
        let mut adapted = BRADFORD;
        for (k, row) in adapted.iter_mut().enumerate() {
            *row = row.map(|v| v * to[k] / from[k]);
        }
        let adaptation = product(&inverse(&BRADFORD)?, &adapted);
        let matrix = product(&inverse(&REC709.to_xyz()?)?, &product(&adaptation, &self.to_xyz()?));
        matrix.iter().flatten().all(|v| v.is_finite()).then_some(matrix)
    }

    /// The matrix from these primaries to linear Rec.709 that keeps every colour, white included.
    pub(super) fn to_rec709_unadapted(self) -> Option<Matrix> {
        Some(product(&inverse(&REC709.to_xyz()?)?, &self.to_xyz()?))
    }

    /// The coordinates, for a sentence.
    pub(super) fn words(&self) -> String {
        let [red, green, blue, white] =
            [self.red, self.green, self.blue, self.white].map(|[x, y]| format!("{x:.4}, {y:.4}"));
        format!("red {red}; green {green}; blue {blue}; white {white}")
    }
}

/// Brings all texels of an image to Rec.709.
pub(super) fn convert(image: &mut Image, matrix: &Matrix) {
    for texel in image.data.as_chunks_mut::<3>().0 {
        *texel = apply(matrix, texel.map(f64::from)).map(|v| v as f32);
    }
}

fn apply(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|row| m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| (0..3).map(|k| a[row][k] * b[k][column]).sum()))
}

fn inverse(m: &Matrix) -> Option<Matrix> {
    let determinant: f64 = (0..3).map(|c| m[0][c] * cofactor(m, 0, c)).sum();
    (determinant.abs() > 1e-12).then(|| [0, 1, 2].map(|r| [0, 1, 2].map(|c| cofactor(m, c, r) / determinant)))
}

/// A cofactor, from the two rows and columns that follow in the cycle.
fn cofactor(m: &Matrix, row: usize, column: usize) -> f64 {
    let [a, b] = [1, 2].map(|k| m[(row + k) % 3]);
    let [c, d] = [1, 2].map(|k| (column + k) % 3);
    a[c] * b[d] - a[d] * b[c]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: Matrix, expected: Matrix, tolerance: f64) {
        let off = found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < tolerance, "{found:?}");
    }

    /// Oracles: IEC 61966-2-1 for sRGB to XYZ; ITU-R BT.2087 for BT.2020 to BT.709; Lindbloom's matrix of Bradford from E to D65, whose
    /// white has one digit more.
    #[test]
    fn published_matrices() {
        let srgb = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        near(REC709.to_xyz().unwrap(), srgb, 1e-4);
        let wide = Primaries { red: [0.708, 0.292], green: [0.17, 0.797], blue: [0.131, 0.046], white: REC709.white };
        let bt2087 = [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]];
        near(wide.to_rec709().unwrap(), bt2087, 2e-4);
        let e_to_d65 = [
            [0.9531874, -0.0265906, 0.0238731],
            [-0.0382467, 1.0288406, 0.0094060],
            [0.0026068, -0.0030332, 1.0892565],
        ];
        near(product(&REC709.to_xyz().unwrap(), &Primaries::XYZ.to_rec709().unwrap()), e_to_d65, 3e-4);
    }

    #[test]
    fn white_stays_and_lines_span_nothing() {
        let line = Primaries { red: [0.1, 0.1], green: [0.2, 0.2], blue: [0.3, 0.3], white: [0.3, 0.3] };
        assert_eq!(line.to_rec709(), None);
        assert_eq!(Primaries { white: [0.3, 0.0], ..REC709 }.to_rec709(), None);
        let grey = apply(&Primaries::XYZ.to_rec709().unwrap(), [2.0; 3]);
        assert!(grey.iter().all(|v| (v - 2.0).abs() < 1e-9) && REC709.is_rec709() && !Primaries::XYZ.is_rec709());
    }
}
