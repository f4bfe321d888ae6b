//! Bases of rows: the shader computes the base of a Fresnel row, and texels hold the difference.

use serde::{Deserialize, Serialize};

use crate::{Image, TexelFormat};

/// Base that a look-up adds to the texels of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RowBase {
    /// Nothing.
    #[default]
    Zero,
    /// A closed form of Fresnel reflectance, whose coefficients lie behind the nodes of each row: see [`SchlickBase`]. The nodes
    /// hold the difference. The axis is `cos_theta`, the format one of unsigned normalised channels.
    Schlick,
}

impl RowBase {
    /// Whether nothing is added.
    pub fn is_zero(&self) -> bool {
        *self == Self::Zero
    }

    /// Texels behind the nodes of a row.
    pub fn header_texels(self) -> u32 {
        match self {
            Self::Zero => 0,
            Self::Schlick => SchlickBase::TEXELS,
        }
    }
}

/// `F = f0 + (f90 - f0) w - edge c (1 - c) w + scale (2 t - 1)` with `w = (1 - c)^5`: Schlick 1994, and a term of one more power as in
/// Hoffman, "Fresnel Equations Considered Harmful", 2019. The rest of the exact function is in t, a texel. The factor 2 is a little less, so
/// that one code of a texel means no rest: [`SchlickBase::span`].
///
/// Three texels of a row hold it: `f0 / 1.25` and in A f90, which is 0 or 1; `(edge + 16) / 32`; `scale`.
///
/// ```
/// use luthier_lut::SchlickBase;
///
/// let base = SchlickBase { f0: [0.04; 3], f90: 1.0, edge: [0.0; 3], scale: [0.01; 3] };
/// assert_eq!(base.closed_form(1.0), [0.04; 3]);
/// // Halfway, Schlick's form adds a 32nd of the rest to 1.
/// assert!((base.closed_form(0.5)[0] - (0.04 + 0.96 / 32.0)).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SchlickBase {
    /// Reflectance at normal incidence, RGB, up to [`SchlickBase::F0_MAX`]: colours beyond the gamut exceed 1.
    pub f0: [f64; 3],
    /// Reflectance at grazing incidence: 1, or 0 if there is no interface.
    pub f90: f64,
    /// Coefficient of the dip before grazing angles, RGB, of magnitude up to [`SchlickBase::EDGE_MAX`].
    pub edge: [f64; 3],
    /// Largest value that a texel can add, RGB, 0..=1.
    pub scale: [f64; 3],
}

impl SchlickBase {
    /// Texels of the coefficients.
    pub const TEXELS: u32 = 3;
    /// Largest reflectance at normal incidence.
    pub const F0_MAX: f64 = 1.25;
    /// Largest magnitude of `edge`.
    pub const EDGE_MAX: f64 = 16.0;

    /// The coefficients as texels, one after the other.
    pub fn texels(&self) -> [[f32; 4]; 3] {
        let f0 = self.f0.map(|f| f / Self::F0_MAX);
        let edge = self.edge.map(|e| (e + Self::EDGE_MAX) / (2.0 * Self::EDGE_MAX));
        [(f0, self.f90), (edge, 1.0), (self.scale, 1.0)].map(|([r, g, b], a)| [r, g, b, a].map(|value| value as f32))
    }

    /// The coefficients that texels hold; `first` is the texel of f0.
    pub fn read(image: &Image, first: [u32; 2]) -> Self {
        let [f0, edge, scale] = [0, 1, 2].map(|k| image.texel(first[0] + k, first[1]));
        let [f0_rgb, edge, scale] = [f0, edge, scale].map(|texel| [0, 1, 2].map(|c: usize| f64::from(texel[c])));
        Self {
            f0: f0_rgb.map(|t| Self::F0_MAX * t),
            f90: f64::from(f0[3]),
            edge: edge.map(|t| 2.0 * Self::EDGE_MAX * t - Self::EDGE_MAX),
            scale,
        }
    }

    /// The coefficients as a format keeps them.
    #[must_use]
    pub fn quantised(&self, format: TexelFormat) -> Self {
        let texels = Image { width: Self::TEXELS, height: 1, channels: 4, data: self.texels().concat() };
        Self::read(&format.quantise(&texels), [0, 0])
    }

    /// The closed form alone.
    pub fn closed_form(&self, cos_theta: f64) -> [f64; 3] {
        let away = 1.0 - cos_theta;
        let w = away * away * away * away * away;
        let dip = cos_theta * away * w;
        [0, 1, 2].map(|c: usize| self.f0[c] + (self.f90 - self.f0[c]) * w - self.edge[c] * dip)
    }

    /// Factor on a texel: the code `(max + 1) / 2` then adds nothing, which makes grazing reflectance exactly f90.
    pub fn span(format: TexelFormat) -> f64 {
        format.unorm_max().map_or(2.0, |max| 2.0 * max / (max + 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_survive_their_texels() {
        let base = SchlickBase { f0: [1.04, 0.0, 0.5], f90: 1.0, edge: [-3.0, 0.0, 15.0], scale: [0.0, 0.25, 1.0] };
        // Half steps of ten bits over the ranges of f0, edge and scale.
        let found = base.quantised(TexelFormat::Rgb10a2Unorm);
        for c in 0..3 {
            assert!((found.f0[c] - base.f0[c]).abs() < 1.25 / 2045.0);
            assert!((found.edge[c] - base.edge[c]).abs() < 32.0 / 2045.0);
            assert!((found.scale[c] - base.scale[c]).abs() < 1.0 / 2045.0);
        }
        assert_eq!(found.f90, 1.0);
        assert_eq!(found.quantised(TexelFormat::Rgb10a2Unorm), found);
    }

    #[test]
    fn the_middle_code_adds_nothing() {
        for (format, middle) in [(TexelFormat::Rgba8Unorm, 128.0 / 255.0), (TexelFormat::Rgb10a2Unorm, 512.0 / 1023.0)]
        {
            assert!((SchlickBase::span(format) * middle - 1.0).abs() < 1e-15, "{format}");
        }
    }

    #[test]
    fn grazing_and_normal_reflectance_are_the_coefficients() {
        let base = SchlickBase { f0: [0.04, 0.5, 1.1], f90: 1.0, edge: [2.0; 3], scale: [0.0; 3] };
        assert_eq!(base.closed_form(1.0), base.f0);
        assert!(base.closed_form(0.0).iter().all(|f| (f - 1.0).abs() < 1e-15));
    }
}
