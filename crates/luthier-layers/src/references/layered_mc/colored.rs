//! Paths in the colour of a material: three channels on one path.
//!
//! A path has one wavelength, which decides where it goes. Absorption and diffuse albedo, which a material states by channel, go with it
//! as three weights. Wavelengths are drawn as often as they weigh in colour, so that the mean over the paths is the integral over the
//! spectrum. Wavelengths at which all interfaces are alike count as one.
//!
//! The first numbers of the paths fill their cube evenly ([`Stream::even`]). With 16,000 paths the albedos of nine stacks had two to ten times
//! less noise than with independent numbers.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Stack};

use super::InterfaceMode;
use super::interface::Interface;
use super::optics::Side;
use super::path::{EVENTS_SURE, survives};
use super::random::Stream;
use super::rough::Sided;
use crate::monochrome::Monochrome;

/// A stack made ready for paths in colour.
#[derive(Debug, Clone)]
pub struct ColorPaths {
    wavelengths: Vec<Wavelength>,
    /// Optical depth along the normal of the slab below each interface.
    optical_depths: Vec<Rgb>,
    /// Albedo of the diffuse base.
    albedo: Rgb,
}

/// The interfaces at a wavelength.
#[derive(Debug, Clone)]
struct Wavelength {
    interfaces: Vec<Interface>,
    /// Weight in each channel over the probability.
    weight: Rgb,
    /// Sum of the probabilities up to this one, itself included.
    cumulated: f64,
}

/// Light that has left the stack upward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorPath {
    /// Direction in which it left.
    pub wi: DVec3,
    /// Weight by channel. The density of directions, times weight, is `f cos_theta_i`.
    pub weight: Rgb,
    /// Whether it met one facet of the first interface and nothing else.
    pub is_first_facet: bool,
}

impl ColorPaths {
    /// The paths of a stack in a colour.
    pub fn new(stack: &Stack, color: &Color) -> Self {
        // Channel 1 stands for all: the others differ in absorption and albedo, which go with the path.
        let mut leads: Vec<(Monochrome, Rgb)> = Vec::new();
        for node in color.nodes() {
            let lead = Monochrome::new(stack, node.wavelength_nm, 1);
            match leads.iter_mut().find(|(known, _)| *known == lead) {
                Some((_, weight)) => (0..3).for_each(|c| weight[c] += node.weight[c]),
                None => leads.push((lead, node.weight)),
            }
        }
        let strength = |weight: &Rgb| weight.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        let total: f64 = leads.iter().map(|(_, weight)| strength(weight)).sum();
        let mut cumulated = 0.0;
        let wavelengths = leads.iter().filter(|(_, weight)| strength(weight) > 0.0).map(|(lead, weight)| {
            let chance = strength(weight) / total;
            cumulated += chance;
            let interface = |layer| Interface::new(layer, InterfaceMode::SmithWalk);
            Wavelength {
                interfaces: lead.layers.iter().map(interface).collect(),
                weight: weight.map(|w| w / chance),
                cumulated,
            }
        });
        let wavelengths = wavelengths.collect();
        let depth = |base: &Base| match base {
            Base::Dielectric { slab, .. } => slab.optical_depth(),
            Base::Conductor { .. } | Base::Diffuse(_) => [0.0; 3],
        };
        let albedo = stack.layers.last().map_or([0.0; 3], |layer| match &layer.base {
            Base::Diffuse(diffuse) => diffuse.albedo,
            Base::Dielectric { .. } | Base::Conductor { .. } => [0.0; 3],
        });
        Self { wavelengths, optical_depths: stack.layers.iter().map(|layer| depth(&layer.base)).collect(), albedo }
    }

    /// Follows `count` paths from `wo` (unit, away from the surface), and shows to `visit` those that leave upward. Weights are not divided
    /// by the count.
    pub fn trace(&self, seed: u64, count: u64, wo: DVec3, mut visit: impl FnMut(ColorPath)) {
        if wo.z <= 0.0 {
            return;
        }
        for path in 0..count {
            // Wavelengths in turn: the same share of each stretch of paths.
            let place = (path as f64 + 0.5) / count as f64;
            let number = self.wavelengths.partition_point(|w| w.cumulated <= place).min(self.wavelengths.len() - 1);
            let mut stream = Stream::even(seed, path);
            if let Some(found) = self.path(&mut stream, number, wo) {
                visit(found);
            }
        }
    }

    fn path(&self, stream: &mut Stream, wavelength: usize, wo: DVec3) -> Option<ColorPath> {
        let Wavelength { interfaces, weight: channels, .. } = &self.wavelengths[wavelength];
        let mut from = Sided { side: Side::Above, direction: wo };
        // `weight` times the greatest of `tint` is what decides survival.
        let (mut number, mut events, mut weight, mut tint) = (0, 0, 1.0, [1.0; 3]);
        loop {
            let interface = interfaces.get(number)?;
            let scattered = interface.scatter_tinted(stream, from, self.albedo)?;
            weight *= scattered.weight;
            (0..3).for_each(|c| tint[c] *= scattered.tint[c]);
            let to = scattered.to;
            let (next, slab, side) = match to.side {
                Side::Above if number == 0 => {
                    let is_facet = !interface.is_diffuse() && scattered.facets_before == 0;
                    return Some(ColorPath {
                        wi: to.direction,
                        weight: [0, 1, 2].map(|c: usize| channels[c] * tint[c] * weight),
                        is_first_facet: events == 0 && is_facet,
                    });
                }
                Side::Above => (number - 1, number - 1, Side::Below),
                Side::Below => (number + 1, number, Side::Above),
            };
            let depth = self.optical_depths[slab];
            if depth != [0.0; 3] {
                (0..3).for_each(|c| tint[c] *= libm::exp(-depth[c] / to.direction.z));
            }
            let DVec3 { x, y, z } = to.direction;
            from = Sided { side, direction: DVec3::new(-x, -y, z) };
            number = next;
            events += 1;
            weight /= survives(stream, weight * tint.iter().copied().fold(0.0, f64::max), events < EVENTS_SURE)?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layered_mc::LayeredMc;
    use luthier_optics::ior::{Ior, IorSample};
    use luthier_optics::stack::{Diffuse, Distribution, Layer, Slab, Surface};

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
        assert_eq!(paths.wavelengths.len(), 1);
        paths.trace(1, 100, DVec3::Z, |path| {
            let [r, g, b] = path.weight;
            assert!((r - g).abs() < 1e-9 && (g - b).abs() < 1e-9, "{path:?}");
        });
    }
}
