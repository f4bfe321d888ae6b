//! Tables of linearly transformed cosines as engines read them.

use luthier_lut::{Image, balance};
use luthier_optics::masking::Correlation;
use luthier_optics::split_sum::{Masking, SplitSumSurface};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use super::fit::{Shape, fit_column};
use super::target::{Rules, Surface, Target};
use super::{Lobe, clipped_sphere_form_factor};
use crate::{Layout, Nodes, Stored};

/// A pair of tables for area lights by linearly transformed cosines. Its fields state the tables; the texels follow
/// from them.
#[derive(Debug, Clone, PartialEq)]
pub struct LtcTable {
    /// Slope distribution.
    pub distribution: Distribution,
    /// Smith's masking, correlated by height or separable.
    pub masking: Correlation,
    /// Axes and nodes of both tables. The fourth channel of the norms has axes of its own, see [`LtcTexels::norms`].
    pub layout: Layout,
    /// Texels across and down.
    pub size: [u32; 2],
    /// Number type of the texels.
    pub stored: Stored,
}

/// Both tables, as a shader reads them.
#[derive(Debug, Clone, PartialEq)]
pub struct LtcTexels {
    /// The inverse matrices: m11, m31, m13, m33 of [`Lobe`].
    pub matrices: Image,
    /// Albedo for f0 = 1, bias of the split sum, 0, and [`clipped_sphere_form_factor`]. Across, the cosine of its
    /// elevation runs from -1 to 1; down, its length runs from 0 to 1.
    pub norms: Image,
}

impl LtcTable {
    /// The layout of engines: 64 x 64 half floats, roughness across, the square root of one less the cosine down, ends
    /// at texel centres.
    ///
    /// Sources are the shaders of three.js (npm three 0.187.0, `RectAreaLightTexturesLib`), Babylon.js (npm
    /// @babylonjs/core 9.35.0, `ltcHelperFunctions`, a file with the eight channels of a texel side by side) and Bevy
    /// (bevy_pbr 0.20.1, `ltc.ktx2`, an array of two layers with the half floats of three.js).
    pub fn of_engines(distribution: Distribution) -> Self {
        Self {
            distribution,
            masking: Correlation::Height,
            layout: Layout::parse("roughness,sqrt_one_minus_cos_theta", Nodes::Ends)
                .unwrap_or_else(|error| unreachable!("{error}")),
            size: [64, 64],
            stored: Stored::Half,
        }
    }

    pub(super) fn surface(&self) -> Surface {
        Surface { distribution: self.distribution, correlation: self.masking }
    }

    /// Cosine and alpha of a place along both axes.
    fn at(&self, along_angle: u32, along_slope: u32) -> [f64; 2] {
        let [theta, alpha] = self.layout.at_texel(self.size, self.layout.texel(along_angle, along_slope));
        [libm::cos(theta).max(0.0), alpha]
    }

    /// Both tables.
    ///
    /// A matrix is the one whose lobe shares most energy with the BRDF times the cosine: half the L1 distance of the
    /// densities is least. A simplex search at fixed nodes of a quadrature finds it, from normal to grazing incidence.
    /// The paper minimises the third power of the difference for three entries; here all four are free. The norms come
    /// by quadrature. Deterministic, whatever the number of threads.
    pub fn bake(&self) -> LtcTexels {
        LtcTexels { matrices: self.stored.quantise(&self.matrices()), norms: self.stored.quantise(&self.norms()) }
    }

    fn matrices(&self) -> Image {
        let [a, s] = self.layout.order();
        let rules = Rules::fitting();
        let angles = self.size[a];
        // From normal incidence on.
        let mut order: Vec<u32> = (0..angles).collect();
        order.sort_by(|&i, &j| self.at(j, 0)[0].total_cmp(&self.at(i, 0)[0]));
        let columns: Vec<Vec<Shape>> = (0..self.size[s])
            .into_par_iter()
            .map(|slope| {
                let targets = order.iter().map(|&angle| {
                    let [cos, alpha] = self.at(angle, slope);
                    Target::new(&rules, self.surface(), alpha, cos)
                });
                fit_column(targets)
            })
            .collect();
        let mut image = Image::zeros(self.size[0], self.size[1], 4);
        for (slope, column) in (0..).zip(columns) {
            for (&angle, shape) in order.iter().zip(column) {
                let [x, y] = self.layout.texel(angle, slope);
                image.texel_mut(x, y).copy_from_slice(&shape.lobe().texel().map(|entry| entry as f32));
            }
        }
        image
    }

    fn norms(&self) -> Image {
        let [a, s] = self.layout.order();
        let masking = match self.masking {
            Correlation::Height => Masking::SmithCorrelated,
            Correlation::Separable => Masking::SmithSeparable,
        };
        let surface = SplitSumSurface::new(self.distribution, masking);
        let mut sums = Image::zeros(self.size[0], self.size[1], 2);
        for slope in 0..self.size[s] {
            let row = surface.row(self.at(0, slope)[1]);
            for angle in 0..self.size[a] {
                let sum = row.at(self.at(angle, slope)[0]);
                let [x, y] = self.layout.texel(angle, slope);
                sums.texel_mut(x, y).copy_from_slice(&[sum.albedo() as f32, sum.bias as f32]);
            }
        }
        let sums = balance(&sums, 0.0);
        let mut norms = Image::zeros(self.size[0], self.size[1], 4);
        for y in 0..self.size[1] {
            let length = part(y, self.size[1]);
            for x in 0..self.size[0] {
                let sphere = clipped_sphere_form_factor(2.0 * part(x, self.size[0]) - 1.0, length);
                let sum = sums.texel(x, y);
                norms.texel_mut(x, y).copy_from_slice(&[sum[0], sum[1], 0.0, sphere as f32]);
            }
        }
        norms
    }
}

/// Place of a texel between the first and the last, in 0..=1.
fn part(texel: u32, size: u32) -> f64 {
    if size < 2 { 0.5 } else { f64::from(texel) / f64::from(size - 1) }
}

impl LtcTexels {
    /// The lobe of a texel.
    pub fn lobe(&self, x: u32, y: u32) -> Lobe {
        Lobe::of_texel(std::array::from_fn(|c| f64::from(self.matrices.texel(x, y)[c])))
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::split_sum::split_sum;

    use super::*;

    fn small(distribution: Distribution) -> LtcTable {
        LtcTable { size: [9, 8], stored: Stored::Float, ..LtcTable::of_engines(distribution) }
    }

    #[test]
    fn tables_do_not_depend_on_threads() {
        let table = small(Distribution::Ggx);
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| table.bake());
        let many = rayon::ThreadPoolBuilder::new().num_threads(5).build().unwrap().install(|| table.bake());
        assert_eq!(alone, many);
    }

    #[test]
    fn texels_lie_where_the_layout_says() {
        let table = small(Distribution::Beckmann);
        let turned = LtcTable {
            layout: Layout::parse("-sqrt_one_minus_cos_theta,roughness", Nodes::Ends).unwrap(),
            size: [8, 9],
            ..table.clone()
        };
        let (plain, turned) = (table.bake(), turned.bake());
        for y in 0..8 {
            for x in 0..9 {
                for (a, b) in plain.matrices.texel(x, y).iter().zip(turned.matrices.texel(7 - y, x)) {
                    assert!((a - b).abs() <= 2e-3 * (1.0 + a.abs()), "{x} {y}: {a} {b}");
                }
                assert!((plain.norms.texel(x, y)[0] - turned.norms.texel(7 - y, x)[0]).abs() < 1e-6);
            }
        }
    }

    /// The lobe about the normal is upright, with the scale of the reflected lobe of a smooth surface: about twice the slopes.
    #[test]
    fn normal_incidence_is_upright() {
        let table = small(Distribution::Ggx);
        let texels = table.bake();
        for x in 0..9 {
            let lobe = texels.lobe(x, 0);
            assert!(lobe.m31 == 0.0 && lobe.m13 == 0.0 && (lobe.m11 - 1.0).abs() < 1e-7, "{lobe:?}");
            let alpha = f64::from(x * x) / 64.0;
            if (0.01..0.2).contains(&alpha) {
                assert!((lobe.m33 / (2.0 * alpha) - 1.0).abs() < 0.05, "{alpha}: {lobe:?}");
            }
        }
        // Elsewhere the lobe's axis is on the side of the mirror direction.
        assert!(texels.lobe(4, 4).m13 > 0.1 && texels.lobe(4, 4).m31 < -0.01);
    }

    /// A shader's amplitude is the albedo: the lobe's own integral is 1.
    #[test]
    fn norms_are_the_split_sum() {
        let table = LtcTable::of_engines(Distribution::Ggx);
        let norms = table.norms();
        for [x, y] in [[20, 10], [40, 32], [50, 50], [63, 20]] {
            let [cos, alpha] = table.at(y, x);
            let exact = split_sum(Distribution::Ggx, Masking::SmithCorrelated, alpha, cos);
            let texel = norms.texel(x, y);
            // Texels are balanced: moved by a sixteenth of their second differences.
            assert!((f64::from(texel[0]) - exact.albedo()).abs() < 2e-4, "{x} {y}: {texel:?} {exact:?}");
            assert!((f64::from(texel[1]) - exact.bias).abs() < 2e-4, "{x} {y}: {texel:?} {exact:?}");
        }
        assert_eq!(norms.texel(63, 0)[3], 1.0);
        assert_eq!(norms.texel(0, 0)[3], 0.0);
        assert_eq!(norms.texel(63, 63)[3], 1.0);
        assert_eq!(norms.texel(0, 63)[3], 0.0);
    }
}
