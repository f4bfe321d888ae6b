//! Tables of the split sum: what they state, their texels, their error.

use luthier_lut::{Comparison, ErrorStats, Image, Scan, TexelFormat, WeightBits, balance, bilinear, measure_scan};
use luthier_optics::split_sum::{Masking, SplitSum, SplitSumSurface, split_sum};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use crate::Layout;

/// Fraction bits of the sampler's weights.
const WEIGHTS: WeightBits = WeightBits::Fixed(8);
/// Points of the scan for errors, along each axis.
const SCAN_POINTS: u32 = 96;
/// Halvings of the climb to the worst error.
const REFINEMENTS: u32 = 8;

/// Content of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Value {
    /// Factor of f0.
    Scale,
    /// Summand beside the factor of f0.
    Bias,
    /// Sum of scale and bias: the albedo for f0 = 1.
    Albedo,
    /// 1 less the albedo: small where the albedo is near 1, so that half floats hold it more closely.
    Loss,
    /// 0: a channel that the engine keeps for something else.
    Zero,
}

impl Value {
    /// All contents.
    pub const ALL: [Self; 5] = [Self::Scale, Self::Bias, Self::Albedo, Self::Loss, Self::Zero];

    /// Its name in files and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scale => "scale",
            Self::Bias => "bias",
            Self::Albedo => "albedo",
            Self::Loss => "loss",
            Self::Zero => "zero",
        }
    }

    /// The content for a split sum.
    pub fn of(self, sum: SplitSum) -> f64 {
        match self {
            Self::Scale => sum.scale,
            Self::Bias => sum.bias,
            Self::Albedo => sum.albedo(),
            Self::Loss => 1.0 - sum.albedo(),
            Self::Zero => 0.0,
        }
    }
}

/// Number type of texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stored {
    /// A byte over 255.
    Unorm8,
    /// Ten bits over 1023.
    Unorm10,
    /// Two bytes over 65535.
    Unorm16,
    /// Half float.
    Half,
    /// 32-bit float.
    Float,
}

impl Stored {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unorm8 => "unorm8",
            Self::Unorm10 => "unorm10",
            Self::Unorm16 => "unorm16",
            Self::Half => "half",
            Self::Float => "float",
        }
    }

    /// Bytes of one value; three values of ten bits share four.
    pub fn bytes(self) -> usize {
        match self {
            Self::Unorm8 | Self::Unorm10 => 1,
            Self::Unorm16 | Self::Half => 2,
            Self::Float => 4,
        }
    }

    /// The values that a shader reads, of an image of up to four channels.
    pub fn quantise(self, image: &Image) -> Image {
        let format = match self {
            Self::Unorm8 => TexelFormat::Rgba8Unorm,
            Self::Unorm10 => TexelFormat::Rgb10a2Unorm,
            Self::Unorm16 => TexelFormat::Rgba16Unorm,
            Self::Half => TexelFormat::Rgba16Float,
            Self::Float => return image.clone(),
        };
        let read = format.quantise(image);
        let channels = image.channels as usize;
        let data = read.texels().flat_map(|texel| texel[..channels].iter().copied()).collect();
        Image { channels: image.channels, data, ..read }
    }
}

/// A table of the split sum of image-based lighting (Karis 2013): a statement, from which its texels follow.
#[derive(Debug, Clone, PartialEq)]
pub struct DfgTable {
    /// Slope distribution.
    pub distribution: Distribution,
    /// Masking term.
    pub masking: Masking,
    /// Axes and nodes.
    pub layout: Layout,
    /// Content of each channel, one to four.
    pub values: Vec<Value>,
    /// Texels across and down.
    pub size: [u32; 2],
    /// Number type of the texels.
    pub stored: Stored,
}

impl DfgTable {
    /// The texels, as a shader reads them: values at the nodes within 2e-6 (GGX) or 2e-4 (Beckmann), moved by a sixteenth of their second differences, so
    /// that reads between them err to both sides alike, then rounded. Deterministic, whatever the number of threads.
    pub fn bake(&self) -> Image {
        self.bake_from(&SplitSumSurface::new(self.distribution, self.masking))
    }

    /// As [`Self::bake`], from the surface of this distribution and masking term.
    pub(crate) fn bake_from(&self, surface: &SplitSumSurface) -> Image {
        let [width, height] = self.size;
        let [angles, slopes] = self.layout.order();
        let channels = self.values.len();
        // Lines of one slope: rows, or columns of a transposed table.
        let lines: Vec<Vec<f32>> = (0..self.size[slopes])
            .into_par_iter()
            .map(|line| {
                let at = |along: u32| {
                    let mut texel = [0; 2];
                    (texel[angles], texel[slopes]) = (along, line);
                    self.layout.at_texel(self.size, texel)
                };
                let row = surface.row(at(0)[1]);
                let values = (0..self.size[angles]).map(|along| row.at(libm::cos(at(along)[0]).max(0.0)));
                values.flat_map(|sum| self.values.iter().map(move |value| value.of(sum) as f32)).collect()
            })
            .collect();
        let mut image = Image::zeros(width, height, channels as u32);
        for (line, values) in (0..).zip(&lines) {
            for (along, texel) in (0..).zip(values.chunks_exact(channels)) {
                let mut place = [0; 2];
                (place[angles], place[slopes]) = (along, line);
                image.texel_mut(place[0], place[1]).copy_from_slice(texel);
            }
        }
        self.stored.quantise(&balance(&image, 0.0))
    }

    /// The error of reads (bilinear, 8-bit weights) from texels of this statement, over cosines and alphas from the given ones on: absolute, of
    /// every channel, against quadrature.
    pub fn error(&self, texels: &Image, min_cos: f64, min_alpha: f64) -> ErrorStats {
        let exact = |alpha: f64, cos: f64| split_sum(self.distribution, self.masking, alpha, cos);
        self.error_against(texels, [min_cos, min_alpha], SCAN_POINTS, exact)
    }

    /// The largest error of all channels of a read at one cosine and alpha, against quadrature.
    pub fn error_at(&self, texels: &Image, cos_theta: f64, alpha: f64) -> f64 {
        let texel = bilinear(texels, self.layout.position(self.size, [libm::acos(cos_theta), alpha]), WEIGHTS);
        let sum = split_sum(self.distribution, self.masking, alpha, cos_theta);
        self.values.iter().zip(texel).fold(0.0, |worst, (value, read)| (value.of(sum) - read).abs().max(worst))
    }

    pub(crate) fn error_against(
        &self,
        texels: &Image,
        [min_cos, min_alpha]: [f64; 2],
        points: u32,
        exact: impl Fn(f64, f64) -> SplitSum + Sync,
    ) -> ErrorStats {
        let Layout { angle, slope, .. } = self.layout;
        let ends = |a: f64, b: f64| (a.min(b), a.max(b));
        let (from, to) = ends(angle.coordinate(0.0), angle.coordinate(libm::acos(min_cos.clamp(0.0, 1.0))));
        let mut scan =
            Scan { points: [points, 1], from: [from, 0.5], to: [to, 0.5], nodes: [0, 0], refinements: REFINEMENTS };
        if let Some(slope) = slope {
            let (from, to) = ends(slope.coordinate(min_alpha), slope.coordinate(1.0));
            (scan.points[1], scan.from[1], scan.to[1]) = (points, from, to);
        }
        let canonical = |u: [f64; 2]| {
            [angle.canonical_of_coordinate(u[0]), slope.map_or(0.0, |slope| slope.canonical_of_coordinate(u[1]))]
        };
        let compare = |u: [f64; 2]| {
            let at = canonical(u);
            let texel = bilinear(texels, self.layout.position(self.size, at), WEIGHTS);
            let sum = exact(at[1], libm::cos(at[0]).max(0.0));
            let mut result = Comparison { expected: [0.0; 4], sampled: [0.0; 4] };
            for (c, value) in self.values.iter().enumerate() {
                (result.expected[c], result.sampled[c]) = (value.of(sum), texel[c]);
            }
            result
        };
        measure_scan(&scan, compare, |u| {
            let [theta, alpha] = canonical(u);
            vec![libm::cos(theta), alpha]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Nodes;

    fn table(axes: &str, nodes: Nodes, size: [u32; 2]) -> DfgTable {
        DfgTable {
            distribution: Distribution::Ggx,
            masking: Masking::SmithCorrelated,
            layout: Layout::parse(axes, nodes).unwrap(),
            values: vec![Value::Scale, Value::Bias, Value::Albedo, Value::Loss],
            size,
            stored: Stored::Float,
        }
    }

    /// Texels of a straight part of the function are the function there; a transposed or falling table holds the same texels elsewhere.
    #[test]
    fn texels_lie_where_the_layout_says() {
        let plain = table("cos_theta,roughness", Nodes::CENTRES, [16, 8]).bake();
        let turned = table("-roughness,cos_theta", Nodes::CENTRES, [8, 16]).bake();
        for y in 0..8 {
            for x in 0..16 {
                assert_eq!(plain.texel(x, y), turned.texel(7 - y, x));
            }
        }
        // The corner is not moved along either axis.
        let expected = split_sum(Distribution::Ggx, Masking::SmithCorrelated, 0.9375 * 0.9375, 31.0 / 32.0);
        let corner = plain.texel(15, 7);
        for (value, found) in Value::ALL.into_iter().zip(corner) {
            assert!((value.of(expected) - f64::from(*found)).abs() < 3e-6, "{value:?} {found}");
        }
    }

    /// A table twice as fine errs a quarter as much, until rounding: the mark of linear interpolation of a smooth function.
    #[test]
    fn errors_fall_with_the_square_of_the_size() {
        let error = |n: u32| {
            let table = table("cos_theta,alpha", Nodes::Ends, [n, n]);
            table.error(&table.bake(), 0.2, 0.2).max_abs_err
        };
        let (coarse, fine) = (error(17), error(33));
        assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }

    #[test]
    fn texels_are_rounded_as_stored() {
        let image = Image { width: 1, height: 1, channels: 2, data: vec![0.3, 0.700_1] };
        for stored in [Stored::Unorm8, Stored::Unorm10, Stored::Unorm16, Stored::Half, Stored::Float] {
            let read = stored.quantise(&image);
            assert_eq!(read.channels, 2);
            let step = match stored {
                Stored::Unorm8 => 1.0 / 255.0,
                Stored::Unorm10 => 1.0 / 1023.0,
                Stored::Unorm16 => 1.0 / 65535.0,
                Stored::Half => 1.0 / 2048.0,
                Stored::Float => 0.0,
            };
            assert!((read.data[1] - 0.700_1).abs() <= 0.5 * step + 1e-7, "{stored:?}");
        }
    }
}
