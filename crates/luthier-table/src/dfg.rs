//! Tables of the split sum: their statements, their texels, their error.

use luthier_lut::{Comparison, ErrorStats, Image, Scan, WeightBits, balance, bilinear, measure_scan};
use luthier_optics::split_sum::{Masking, SplitSum, SplitSumSurface};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use crate::value::{Line, Needs, Parts};
use crate::{Base, Layout, Stored, Value};

/// Fraction bits of the sampler's weights.
const WEIGHTS: WeightBits = WeightBits::Fixed(8);
/// Points of the scan for errors, along each axis.
const SCAN_POINTS: u32 = 96;
/// Halvings of the climb to the worst error.
const REFINEMENTS: u32 = 8;

/// A table of the split sum of image-based lighting (Karis 2013). Its fields state the table; the texels follow from
/// them.
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
    /// The closed form under the texels, which then hold its rest; for channels of the split sum.
    pub base: Option<Base>,
}

impl DfgTable {
    /// The content of each channel at an alpha and a cosine, by quadrature. Missing channels are 0.
    pub fn at(&self, alpha: f64, cos_theta: f64) -> [f64; 4] {
        let needs = Needs::of(&self.values);
        self.contents(&Parts::exact(needs, self.distribution, self.masking, alpha, cos_theta))
    }

    /// The texels, as a shader reads them.
    ///
    /// Values at the nodes are moved by a sixteenth of their second differences, so that reads between them err to both
    /// sides alike, then rounded. Reads beyond a last node at a texel centre are constant: its value is the mean of the
    /// values there and at the end of the axis (a cosine or alpha of 1, at grazing angles a cosine of 0.01).
    ///
    /// Values are within 2e-6 (GGX and cloth) or 2e-4 (Beckmann); values of cloth above 1 relatively. Deterministic,
    /// whatever the number of threads.
    pub fn bake(&self) -> Image {
        let surface = Needs::of(&self.values).split_sum.then(|| SplitSumSurface::new(self.distribution, self.masking));
        self.bake_from(surface.as_ref())
    }

    /// As [`Self::bake`], from the surface of this distribution and masking term. No surface is needed if no content
    /// needs a split sum.
    pub(crate) fn bake_from(&self, surface: Option<&SplitSumSurface>) -> Image {
        let [width, height] = self.size;
        let [angles, slopes] = self.layout.order();
        let channels = self.values.len();
        let needs = Needs::of(&self.values);
        // Lines of one slope: rows, or columns of a transposed table.
        let lines: Vec<Vec<f32>> = (0..self.size[slopes])
            .into_par_iter()
            .map(|line| {
                let [_, alpha] = self.layout.at_texel(self.size, self.layout.texel(0, line));
                let row = Line::new(needs, surface, alpha);
                let beyond = self.layout.slope.and_then(|axis| axis.beyond(line, self.size[slopes]));
                let beyond_row = beyond.map(|alpha| Line::new(needs, surface, alpha));
                let texels = (0..self.size[angles]).map(|along| {
                    let [theta, _] = self.layout.at_texel(self.size, self.layout.texel(along, line));
                    let cos = libm::cos(theta).max(0.0);
                    let here = self.texel_of(&row, cos);
                    let across = beyond_row.as_ref().map(|row| self.texel_of(row, cos));
                    let end = self.layout.angle.beyond(along, self.size[angles]);
                    let ahead = end.map(|theta| self.texel_of(&row, libm::cos(theta).max(0.0)));
                    // Halfway to the value at the end, so that the node and the end err alike.
                    let [across, ahead] = [across, ahead].map(|other| other.unwrap_or(here));
                    std::array::from_fn(|c| here[c] + 0.5 * (across[c] - here[c]) + 0.5 * (ahead[c] - here[c]))
                });
                texels.flat_map(|texel: [f64; 4]| texel.into_iter().take(channels).map(|value| value as f32)).collect()
            })
            .collect();
        let mut image = Image::zeros(width, height, channels as u32);
        for (line, values) in (0..).zip(&lines) {
            for (along, texel) in (0..).zip(values.chunks_exact(channels)) {
                let [x, y] = self.layout.texel(along, line);
                image.texel_mut(x, y).copy_from_slice(texel);
            }
        }
        // Rests have both signs.
        let floor = if self.base.is_some() { f64::NEG_INFINITY } else { 0.0 };
        self.stored.quantise(&balance(&image, floor))
    }

    /// The absolute error of reads (bilinear, 8-bit weights) from these texels against quadrature, in every channel,
    /// over cosines and alphas from the given ones on.
    ///
    /// The search for the largest error climbs in every channel by itself.
    pub fn error(&self, texels: &Image, min_cos: f64, min_alpha: f64) -> ErrorStats {
        let all = self.error_against(texels, [min_cos, min_alpha], SCAN_POINTS, |alpha, cos| self.at(alpha, cos));
        if self.values.len() < 2 {
            return all;
        }
        (0..).zip(self.channel_errors(texels, min_cos, min_alpha)).fold(all, |all, (channel, mut alone)| {
            alone.worst.channel = channel;
            all.with_worst_of(alone)
        })
    }

    /// As [`Self::error`], for each channel apart: cloth errs by far the most.
    pub fn channel_errors(&self, texels: &Image, min_cos: f64, min_alpha: f64) -> Vec<ErrorStats> {
        self.values
            .iter()
            .enumerate()
            .map(|(channel, value)| {
                let data = texels.texels().map(|texel| texel[channel]).collect();
                let alone = Image { channels: 1, data, ..*texels };
                Self { values: vec![*value], ..self.clone() }.error(&alone, min_cos, min_alpha)
            })
            .collect()
    }

    /// The content of each channel for a split sum, if no content needs more.
    pub(crate) fn of_split_sum(&self, sum: SplitSum) -> [f64; 4] {
        self.contents(&sum.into())
    }

    fn contents(&self, parts: &Parts) -> [f64; 4] {
        let mut contents = [0.0; 4];
        for (content, value) in contents.iter_mut().zip(&self.values) {
            *content = value.of(parts);
        }
        contents
    }

    /// Values of a texel of a line at a cosine.
    fn texel_of(&self, line: &Line, cos: f64) -> [f64; 4] {
        let contents = self.contents(&line.at(cos));
        let Some(base) = &self.base else { return contents };
        let form = self.of_split_sum(base.sum(line.alpha, cos));
        self.beside(contents, form, |content, form| base.texel(content, form))
    }

    /// The content of each channel as a shader reads it from the texels (bilinear, 8-bit weights), with the base added,
    /// if any. Missing channels are 0.
    pub fn read(&self, texels: &Image, cos_theta: f64, alpha: f64) -> [f64; 4] {
        self.read_at(texels, [libm::acos(cos_theta), alpha])
    }

    fn read_at(&self, texels: &Image, [theta, alpha]: [f64; 2]) -> [f64; 4] {
        let form = self.base.as_ref().map(|base| base.sum(alpha, libm::cos(theta).max(0.0)));
        self.read_beside(texels, [theta, alpha], form.unwrap_or_default())
    }

    /// As [`Self::read`], with the known split sum of the base.
    pub(crate) fn read_beside(&self, texels: &Image, at: [f64; 2], form: SplitSum) -> [f64; 4] {
        let texel = bilinear(texels, self.layout.position(self.size, at), WEIGHTS);
        let mut contents = [0.0; 4];
        contents[..self.values.len()].copy_from_slice(&texel[..self.values.len()]);
        let Some(base) = &self.base else { return contents };
        self.beside(contents, self.of_split_sum(form), |texel, form| base.content(texel, form))
    }

    /// Combines channels of the split sum with the base. Other channels stay.
    fn beside(&self, mut contents: [f64; 4], form: [f64; 4], of: impl Fn(f64, f64) -> f64) -> [f64; 4] {
        for (c, value) in self.values.iter().enumerate() {
            if value.is_split_sum() {
                contents[c] = of(contents[c], form[c]);
            }
        }
        contents
    }

    /// Bytes of the texels.
    pub fn bytes(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize * self.stored.texel_bytes(self.values.len())
    }

    /// The largest error of all channels of a read at one cosine and alpha, against quadrature.
    pub fn error_at(&self, texels: &Image, cos_theta: f64, alpha: f64) -> f64 {
        let read = self.read(texels, cos_theta, alpha);
        let exact = self.at(alpha, cos_theta);
        exact.iter().zip(read).take(self.values.len()).fold(0.0, |worst, (value, read)| (value - read).abs().max(worst))
    }

    pub(crate) fn error_against(
        &self,
        texels: &Image,
        [min_cos, min_alpha]: [f64; 2],
        points: u32,
        exact: impl Fn(f64, f64) -> [f64; 4] + Sync,
    ) -> ErrorStats {
        let Layout { angle, slope, .. } = self.layout;
        let [from, to] = angle.ends_from_cosine(min_cos);
        // Scans the nodes too. The first and last are the ends of the axes, where errors are largest.
        let nodes = [points, 0];
        let mut scan = Scan { points: [points, 1], from: [from, 0.5], to: [to, 0.5], nodes, refinements: REFINEMENTS };
        if let Some(slope) = slope {
            let [from, to] = slope.ends([min_alpha, 1.0]);
            (scan.points[1], scan.nodes[1], scan.from[1], scan.to[1]) = (points, points, from, to);
        }
        measure_scan(
            &scan,
            |u| {
                let [theta, alpha] = self.layout.canonical(u);
                let expected = exact(alpha, libm::cos(theta).max(0.0));
                Comparison { expected, sampled: self.read_at(texels, [theta, alpha]) }
            },
            |u| {
                let [theta, alpha] = self.layout.canonical(u);
                vec![libm::cos(theta), alpha]
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::cloth::{ClothVisibility, cloth_albedo};
    use luthier_optics::diffuse_albedo::disney_albedo;

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
            base: None,
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
        // The smoothest row is not moved; corners go halfway to each end.
        let statement = table("cos_theta,roughness", Nodes::CENTRES, [16, 8]);
        let smooth = 0.0625 * 0.0625;
        let lower = [0, 1, 2, 3].map(|c| 0.5 * (statement.at(smooth, 1.0 / 32.0)[c] + statement.at(smooth, 0.01)[c]));
        let (alpha, cos) = (0.9375 * 0.9375, 31.0 / 32.0);
        let [here, ahead, across] = [statement.at(alpha, cos), statement.at(alpha, 1.0), statement.at(1.0, cos)];
        for (c, value) in statement.values.iter().enumerate() {
            let upper = 0.5 * (ahead[c] + across[c]);
            for (expected, found) in [(lower[c], plain.texel(0, 0)[c]), (upper, plain.texel(15, 7)[c])] {
                assert!((expected - f64::from(found)).abs() < 3e-6, "{value:?} {found} {here:?}");
            }
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

    /// Channels beside the split sum, against the functions that they are of.
    #[test]
    fn other_channels_hold_what_they_say() {
        let axes = Layout::parse("cos_theta=0.1..0.9,roughness=0.1..0.9", Nodes::Ends).unwrap();
        let values = vec![Value::Cloth, Value::Sheen, Value::Disney, Value::One];
        let table =
            DfgTable { values, ..DfgTable { layout: axes, ..table("cos_theta,alpha", Nodes::CENTRES, [8, 8]) } };
        let texels = table.bake();
        // The corner is not moved along either axis.
        let (roughness, cos) = (0.9, 0.9);
        let alpha = roughness * roughness;
        let expected = [
            cloth_albedo(ClothVisibility::Neubelt, alpha, cos),
            cloth_albedo(ClothVisibility::EstevezKulla, alpha, cos),
            disney_albedo(roughness, cos) / 1.035_714_285_714_285_7 - 0.5,
            1.0,
        ];
        for (expected, found) in expected.into_iter().zip(texels.texel(7, 7)) {
            assert!((expected - f64::from(*found)).abs() < 3e-6, "{expected} {found}");
        }
        assert_eq!(table.at(alpha, cos)[3], 1.0);
    }

    /// Each channel's error is the error of a table of this channel alone, and the largest of all is that of the whole.
    #[test]
    fn channels_err_apart() {
        let values = vec![Value::Bias, Value::Cloth];
        let table = DfgTable { values, ..table("cos_theta,roughness", Nodes::CENTRES, [16, 16]) };
        let texels = table.bake();
        let [bias, cloth] = table.channel_errors(&texels, 0.1, 0.1).try_into().unwrap();
        let all = table.error(&texels, 0.1, 0.1).max_abs_err;
        assert!(bias.max_abs_err < 0.5 * cloth.max_abs_err && (all - cloth.max_abs_err).abs() < 0.1 * all);
    }
}
