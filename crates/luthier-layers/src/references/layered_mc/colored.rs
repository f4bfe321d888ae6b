//! Paths in the colour of a material: three channels on one path.
//!
//! Three wavelengths share paths if light goes the same ways at them ([`JointPaths`]). In a spectrum a path has one wavelength, which decides its
//! directions. Absorption and diffuse albedo, which a material states by channel, go with the path as three weights. Wavelengths are drawn as often
//! as they weigh in colour, so that the mean over the paths is the integral over the spectrum. Wavelengths with equal interfaces count as one.
//!
//! The first numbers of the paths fill their cube evenly ([`Stream::even`]). With 16,000 paths the albedos of nine stacks had two to ten times
//! less noise than with independent numbers.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use super::joint::{JointPath, JointPaths};
use super::random::Stream;
use crate::monochrome::Monochrome;

/// A stack made ready for paths in colour.
#[derive(Debug, Clone)]
pub struct ColorPaths {
    parts: Vec<Part>,
}

/// Paths that go one way for all channels.
#[derive(Debug, Clone)]
struct Part {
    paths: JointPaths,
    /// Weight in each channel over the probability.
    weight: Rgb,
    /// Sum of the probabilities up to this one, itself included.
    cumulated: f64,
}

impl ColorPaths {
    /// The paths of a stack in a colour.
    pub fn new(stack: &Stack, color: &Color) -> Self {
        // How often each part is drawn, its weight by channel, its paths.
        let leads: Vec<(f64, Rgb, JointPaths)> = match color {
            Color::ThreeWavelengths(nm) => {
                let stacks = [0, 1, 2].map(|c: usize| Monochrome::new(stack, nm[c], c));
                let sets = JointPaths::new(&stacks).into_iter().map(|paths| {
                    let weight = paths.channels().map(|is_its| if is_its { 1.0 } else { 0.0 });
                    (weight.iter().sum(), weight, paths)
                });
                sets.collect()
            }
            Color::Spectral => spectral(stack, color),
        };
        let total: f64 = leads.iter().map(|(strength, ..)| strength).sum();
        let mut cumulated = 0.0;
        let parts = leads.into_iter().filter(|(strength, ..)| *strength > 0.0).map(|(strength, weight, paths)| {
            let chance = strength / total;
            cumulated += chance;
            Part { paths, weight: weight.map(|w| w / chance), cumulated }
        });
        Self { parts: parts.collect() }
    }

    /// The paths with facets of Beckmann's distribution drawn by rejection: a third of the time, and less even. For means over many stacks, whose noise
    /// is their own.
    #[must_use]
    pub fn rejecting(mut self) -> Self {
        self.parts = self.parts.into_iter().map(|part| Part { paths: part.paths.rejecting(), ..part }).collect();
        self
    }

    /// Follows `count` paths from `wo` (unit, away from the surface), and shows to `visit` those that leave upward. Weights are by channel, and
    /// are not divided by the count.
    pub fn trace(&self, seed: u64, count: u64, wo: DVec3, mut visit: impl FnMut(JointPath)) {
        if wo.z <= 0.0 {
            return;
        }
        for path in 0..count {
            // Parts in turn: the same share of each stretch of paths.
            let place = (path as f64 + 0.5) / count as f64;
            let number = self.parts.partition_point(|part| part.cumulated <= place).min(self.parts.len() - 1);
            let Part { paths, weight, .. } = &self.parts[number];
            if let Some(found) = paths.path(&mut Stream::even(seed, path), wo) {
                visit(JointPath { weight: [0, 1, 2].map(|c: usize| weight[c] * found.weight[c]), ..found });
            }
        }
    }
}

/// How often each wavelength of a spectrum is drawn, its weight by channel, and its paths. Wavelengths that are alike are one.
fn spectral(stack: &Stack, color: &Color) -> Vec<(f64, Rgb, JointPaths)> {
    // Channel 1 stands for all: the others differ in absorption and albedo, which go with the path.
    let mut leads: Vec<(Monochrome, f64, Rgb)> = Vec::new();
    for node in color.nodes() {
        let lead = Monochrome::new(stack, node.wavelength_nm, 1);
        match leads.iter_mut().find(|(known, ..)| *known == lead) {
            Some((.., weight)) => (0..3).for_each(|c| weight[c] += node.weight[c]),
            None => leads.push((lead, node.wavelength_nm, node.weight)),
        }
    }
    let mut joined = Vec::new();
    for (_, nm, weight) in leads {
        let channels = [0, 1, 2].map(|c: usize| Monochrome::new(stack, nm, c));
        let strength = weight.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        joined.extend(JointPaths::new(&channels).into_iter().map(|paths| (strength, weight, paths)));
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::layered_mc::{InterfaceMode, LayeredMc};
    use luthier_optics::ior::{Ior, IorSample};
    use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Surface};

    fn tinted(base: Base) -> Stack {
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.1, 0.4, 0.9] };
        let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let layer =
            |alpha, base| Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Ggx, alpha), base };
        Stack { exterior: Ior::vacuum(), layers: vec![layer(0.2, coat), layer(0.3, base)] }
    }

    /// Oracle: the paths of the reference at each channel's own wavelength.
    #[test]
    fn each_channel_is_the_reference_at_its_wavelength() {
        let sample = |wavelength_nm, n, k| IorSample { wavelength_nm, n, k };
        let copper = Ior::sampled(vec![sample(450.0, 1.2, 2.4), sample(550.0, 1.0, 2.6), sample(650.0, 0.2, 3.6)]);
        let nm = [650.0, 550.0, 450.0];
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let diffuse = Base::Diffuse(Diffuse { albedo: [0.8, 0.5, 0.2], sigma: 0.4 });
        for base in [Base::Conductor { ior: copper.unwrap() }, diffuse] {
            let stack = tinted(base);
            let (mut sum, mut first) = ([0.0; 3], [0.0; 3]);
            let count = 90_000;
            ColorPaths::new(&stack, &Color::ThreeWavelengths(nm)).trace(3, count, wo, |path| {
                for c in 0..3 {
                    sum[c] += path.weight[c] / count as f64;
                    first[c] += if path.is_first_facet { path.weight[c] / count as f64 } else { 0.0 };
                }
            });
            for c in 0..3 {
                let mono = Monochrome::new(&stack, nm[c], c);
                let mc = LayeredMc { seed: 9, ..LayeredMc::new(InterfaceMode::SmithWalk) };
                let expected = mc.albedo(&mono, wo, 30_000);
                let tolerance = 4.0 * 1.5 * expected.std_err;
                assert!((sum[c] - expected.mean).abs() < tolerance, "{c}: {} {expected:?}", sum[c]);
                // Light that met one facet of the coat: its share of the reflectance at index 1.5, about 4 %.
                assert!(first[c] > 0.03 && first[c] < 0.08, "{first:?}");
            }
        }
    }

    /// Indices that do not depend on the wavelength: white stays white, without noise between the channels.
    #[test]
    fn wavelengths_that_are_alike_are_one() {
        let mut stack = tinted(Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() });
        if let Base::Dielectric { slab, .. } = &mut stack.layers[0].base {
            slab.absorption_per_um = [0.0; 3];
        }
        let paths = ColorPaths::new(&stack, &Color::Spectral);
        assert_eq!(paths.parts.len(), 1);
        paths.trace(1, 100, DVec3::Z, |path| {
            let [r, g, b] = path.weight;
            assert!((r - g).abs() < 1e-9 && (g - b).abs() < 1e-9, "{path:?}");
        });
    }

    /// Three wavelengths of a metal share all paths; those of a glass whose index differs share none.
    #[test]
    fn three_wavelengths_share_what_they_can() {
        let sample = |wavelength_nm, n, k| IorSample { wavelength_nm, n, k };
        let copper = Ior::sampled(vec![sample(450.0, 1.2, 2.4), sample(650.0, 0.2, 3.6)]).unwrap();
        let mut stack = tinted(Base::Conductor { ior: copper });
        let parts = |stack: &Stack| ColorPaths::new(stack, &Color::ThreeWavelengths([650.0, 550.0, 450.0])).parts.len();
        assert_eq!(parts(&stack), 1);
        if let Base::Dielectric { ior, .. } = &mut stack.layers[0].base {
            *ior = Ior::sampled(vec![sample(450.0, 1.52, 0.0), sample(650.0, 1.5, 0.0)]).unwrap();
        }
        assert_eq!(parts(&stack), 3);
    }
}
