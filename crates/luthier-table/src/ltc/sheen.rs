//! The table of sheen by linearly transformed cosines.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_lut::{Image, bilinear};
use rayon::prelude::*;

use super::fibres::{FibreLayer, kernel_rules};
use super::judge::{WEIGHTS, difference, place};
use super::simplex::minimise;
use super::target::{Node, Target};
use super::{Lobe, LtcError, PlacedError};
use crate::{Layout, Nodes, Stored};

/// Lowest cosine, and lowest roughness, as in the paper.
const LOWEST: f64 = 0.01;
/// Ordinates beside the table's, for light near the surface.
const ORDINATES: [f64; 11] = [0.001, 0.003, 0.006, 0.01, 0.015, 0.02, 0.026, 0.04, 0.048, 0.056, 0.08];
/// Widest gap between ordinates.
const GAP: f64 = 0.035;
/// Midpoints over half the azimuth.
const AZIMUTHS: u32 = 48;

/// A table of sheen by linearly transformed cosines (Zeltner, Burley and Chiang 2022, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines").
///
/// Sheen is the reflection of a layer of fibres along the normal, of unit thickness and density, without absorption.
/// The cross section of the fibres is the square of the roughness. The inverse matrix is [a 0 b; 0 a 0; 0 0 1], with x
/// towards the side of the viewer.
///
/// ```
/// use luthier_table::SheenTable;
///
/// let texels = SheenTable { size: [3, 3], ..SheenTable::of_engines() }.bake();
/// let [grazing, normal] = [0, 2].map(|x| texels.texel(x, 2)[2]);
/// assert!(grazing > normal); // sheen shows at grazing angles
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SheenTable {
    /// Axes and nodes.
    pub layout: Layout,
    /// Texels across and down.
    pub size: [u32; 2],
    /// Number type of the texels.
    pub stored: Stored,
}

impl SheenTable {
    /// The layout of the paper's table: 32 x 32 floats, the cosine across, the roughness down, ends at texel centres.
    /// Blender's Cycles reads the three channels as planes, one after the other.
    pub fn of_engines() -> Self {
        let layout = Layout::parse("cos_theta,roughness", Nodes::Ends).unwrap_or_else(|error| unreachable!("{error}"));
        Self { layout, size: [32, 32], stored: Stored::Float }
    }

    /// Reflections at all texels, or half-way between them: one line of cosines for each cross section.
    fn targets(&self, offset: [f64; 2]) -> Vec<Vec<Target>> {
        let [a, s] = self.layout.order();
        let [angles, slopes] = [a, s].map(|k| self.size[k] - u32::from(offset[k] > 0.0));
        let rules = kernel_rules();
        let cosines: Vec<f64> = (0..angles).map(|angle| self.at([angle, 0], offset)[0]).collect();
        let ordinates = ordinates(&cosines);
        (0..slopes)
            .into_par_iter()
            .map(|slope| {
                let sigma = self.at([0, slope], offset)[1];
                let layer = FibreLayer::new(&rules, sigma, ordinates.clone());
                cosines.iter().map(|cos| target(&layer, sigma, *cos)).collect()
            })
            .collect()
    }

    /// Cosine and cross section at a place along both axes.
    fn at(&self, [angle, slope]: [u32; 2], offset: [f64; 2]) -> [f64; 2] {
        let [theta, sigma] = place(&self.layout, self.size, self.layout.texel(angle, slope), offset);
        [libm::cos(theta).clamp(LOWEST, 1.0), sigma.clamp(LOWEST * LOWEST, 1.0)]
    }

    /// Texels of three channels: a, b and the albedo.
    ///
    /// Albedo and reflection come by adding and doubling; the paper samples random walks of at most 16 bounces. The
    /// lobe is the one of this form that shares most energy with the reflection, found from rough to smooth; the paper
    /// minimises the third power of the difference. Deterministic, whatever the number of threads.
    ///
    /// Where the albedo is at least 0.01, energy differs by 0.030 in the median and 0.21 at worst; in the paper's own
    /// table by 0.031 and 0.44. The albedo follows random walks within their noise of 0.002. The paper's is too low by
    /// up to 0.23 for thin fibres at grazing angles, which scatter light more than 16 times. The example `judge_sheen`
    /// measures these.
    pub fn bake(&self) -> Image {
        let [a, s] = self.layout.order();
        let targets = self.targets([0.0; 2]);
        // From rough to smooth.
        let mut order: Vec<u32> = (0..self.size[s]).collect();
        order.sort_by(|&i, &j| targets[j as usize][0].alpha.total_cmp(&targets[i as usize][0].alpha));
        let lines: Vec<Vec<[f64; 2]>> = (0..self.size[a])
            .into_par_iter()
            .map(|angle| {
                let mut last = [1.0, 0.0];
                order
                    .iter()
                    .map(|&slope| {
                        last = fit(&targets[slope as usize][angle as usize], last);
                        last
                    })
                    .collect()
            })
            .collect();
        let mut image = Image::zeros(self.size[0], self.size[1], 3);
        for (angle, line) in (0..).zip(&lines) {
            for (&slope, &[a, b]) in order.iter().zip(line) {
                let albedo = targets[slope as usize][angle as usize].albedo_dir;
                let [x, y] = self.layout.texel(angle, slope);
                image.texel_mut(x, y).copy_from_slice(&[a as f32, b as f32, albedo as f32]);
            }
        }
        self.stored.quantise(&image)
    }

    /// Differences of energy at texels with an albedo of at least `min_albedo`, as in
    /// [`LtcTable::error_at_texels`](super::LtcTable::error_at_texels), and absolute errors of the albedo. The slope
    /// parameter of places is the cross section. At least one texel must have that albedo.
    pub fn error_at_texels(&self, texels: &Image, min_albedo: f64) -> [LtcError; 2] {
        self.error(texels, min_albedo, [0.0; 2])
    }

    /// As [`Self::error_at_texels`], half-way between texels, for bilinear reads with weights of 8 bits.
    pub fn error_between_texels(&self, texels: &Image, min_albedo: f64) -> [LtcError; 2] {
        self.error(texels, min_albedo, [0.5; 2])
    }

    fn error(&self, texels: &Image, min_albedo: f64, offset: [f64; 2]) -> [LtcError; 2] {
        let mut differences = Vec::new();
        let mut albedos = Vec::new();
        let targets = self.targets(offset);
        let places = targets
            .iter()
            .zip(0..)
            .flat_map(|(line, slope)| line.iter().zip(0..).map(move |(t, angle)| (t, angle, slope)));
        for (target, angle, slope) in places.filter(|(target, ..)| target.albedo_dir >= min_albedo) {
            let at = place(&self.layout, self.size, self.layout.texel(angle, slope), offset);
            let [a, b, albedo, _] = bilinear(texels, self.layout.position(self.size, at), WEIGHTS);
            // A table may leave out lobes that reflect too little.
            let entry = if a > 0.0 { [a, b] } else { [1.0, 0.0] };
            let errors = [difference((lobe(entry), albedo), target), (albedo - target.albedo_dir).abs()];
            let &Target { cos_theta_o, alpha, .. } = target;
            let [energy, albedo] = errors.map(|error| PlacedError { error, cos_theta_o, alpha });
            differences.push(energy);
            albedos.push(albedo);
        }
        [LtcError::of(differences), LtcError::of(albedos)]
    }
}

/// The lobe of an a and a b.
fn lobe([a, b]: [f64; 2]) -> Lobe {
    Lobe { m11: 1.0, m31: 0.0, m13: b / a, m33: 1.0 / a }
}

/// The a and b of the lobe that shares most energy with a reflection, searched from `start`. At normal incidence the
/// lobe is upright.
fn fit(target: &Target, start: [f64; 2]) -> [f64; 2] {
    if target.cos_theta_o > 1.0 - 1e-9 {
        let a = [-0.2, 0.05].into_iter().fold(start[0], |a, edge| {
            let [by] = minimise([edge], |[by]| 1.0 - target.shared(lobe([a * libm::exp(by), 0.0]), 1.0));
            a * libm::exp(by)
        });
        return [a, 0.0];
    }
    [[-0.2, -0.2], [0.05, 0.05]].into_iter().fold(start, |start, edges| {
        moved(start, minimise(edges, |by| 1.0 - target.shared(lobe(moved(start, by)), 1.0)))
    })
}

/// An a and a b after a step. The step of b is in units of a, which is the width of the lobe.
fn moved([a, b]: [f64; 2], by: [f64; 2]) -> [f64; 2] {
    let scaled = a * libm::exp(by[0]);
    [scaled, scaled * (b / a + by[1])]
}

/// The cosines of the table and those near the surface, with more where gaps are wide.
pub(super) fn ordinates(cosines: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = cosines.iter().copied().chain(ORDINATES).chain([1.0]).collect();
    all.sort_by(f64::total_cmp);
    // Merges cosines that differ by rounding only.
    all.dedup_by(|b, a| *b - *a < 1e-4);
    let mut filled = vec![all[0]];
    for pair in all.windows(2) {
        let pieces = libm::ceil((pair[1] - pair[0]) / GAP).max(1.0) as u32;
        filled.extend((1..pieces).map(|k| pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(pieces)));
        filled.push(pair[1]);
    }
    filled
}

fn target(layer: &FibreLayer, sigma: f64, cos_theta_o: f64) -> Target {
    let offs = layer.cosines.iter().map(|cos| (cos - cos_theta_o).abs());
    let row = layer.row(offs.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i));
    let albedo_dir = row.albedo_dir();
    let mut nodes = Vec::new();
    for k in 0..AZIMUTHS {
        let step = PI / f64::from(AZIMUTHS);
        let phi = (f64::from(k) + 0.5) * step;
        for [cos, width, value] in row.at_azimuth(phi) {
            let sin = libm::sqrt((1.0 - cos) * (1.0 + cos));
            nodes.push(Node {
                w: DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos),
                solid_angle: 2.0 * width * step,
                density: value / albedo_dir,
            });
        }
    }
    Target { cos_theta_o, alpha: sigma, nodes, albedo_dir }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small() -> SheenTable {
        SheenTable { size: [6, 5], ..SheenTable::of_engines() }
    }

    /// Albedos of the paper's own table, of random walks: roughness 8/31, 16/31, 24/31 and 1 down, cosine 4/31, 16/31 and 1 across. Low roughnesses are
    /// left out: there the paper's walks of 16 bounces at most are too short.
    #[test]
    fn albedos_are_those_of_the_paper() {
        let published = [
            (8, [0.31773, 0.00733, 0.00030]),
            (16, [0.52099, 0.15718, 0.02208]),
            (24, [0.61414, 0.35421, 0.15588]),
            (31, [0.68291, 0.49191, 0.34187]),
        ];
        for (y, albedos) in published {
            let roughness = f64::from(y) / 31.0;
            let cosines = [4.0 / 31.0, 16.0 / 31.0, 1.0];
            let layer = FibreLayer::new(&kernel_rules(), roughness * roughness, ordinates(&cosines));
            for (cos, expected) in cosines.into_iter().zip(albedos) {
                let found = target(&layer, roughness * roughness, cos).albedo_dir;
                assert!((found - expected).abs() < 1.5e-3, "{y} {cos}: {found} {expected}");
            }
        }
    }

    #[test]
    fn tables_do_not_depend_on_threads() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| small().bake());
        let many = rayon::ThreadPoolBuilder::new().num_threads(5).build().unwrap().install(|| small().bake());
        assert_eq!(alone, many);
    }

    /// The lobe leans to the viewer, as fibres send light back; not at normal incidence, nor on a layer of spheres.
    #[test]
    fn sheen_goes_back() {
        let texels = small().bake();
        for y in 1..4 {
            for x in 0..5 {
                assert!(texels.texel(x, y)[1] < 0.0, "{x} {y}: {:?}", texels.texel(x, y));
            }
            assert_eq!(texels.texel(5, y)[1], 0.0);
        }
        for x in 0..6 {
            assert!(texels.texel(x, 4)[1].abs() < 1e-3, "{x}: {:?}", texels.texel(x, 4));
        }
    }

    /// The fit is better than its neighbours, and its energy is the albedo.
    #[test]
    fn fits_are_best_and_hold_the_energy() {
        let table = small();
        let texels = table.bake();
        let [difference, albedo] = table.error_at_texels(&texels, 0.01);
        assert!(difference.max.error < 0.5 && albedo.max.error < 1e-6, "{difference:?} {albedo:?}");
        for (y, line) in table.targets([0.0; 2]).iter().enumerate() {
            for (x, target) in line.iter().enumerate().filter(|(_, target)| target.albedo_dir > 1e-3) {
                let [a, b] = [0, 1].map(|c: usize| f64::from(texels.texel(x as u32, y as u32)[c]));
                let best = target.shared(lobe([a, b]), 1.0);
                for other in [[1.05 * a, b], [0.95 * a, b], [a, b + 0.05 * a], [a, b - 0.05 * a]] {
                    assert!(target.shared(lobe(other), 1.0) < best + 1e-6, "{x} {y}: {a} {b}");
                }
            }
        }
    }
}
