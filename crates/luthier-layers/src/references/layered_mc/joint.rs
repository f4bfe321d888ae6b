//! Paths of a stack at three wavelengths at once: each goes one way and has a weight for every wavelength.
//!
//! Refracted directions depend on real indices alone. Wavelengths with equal indices share a path: reflectances, absorption and albedos go with it
//! as weights. Reflection or refraction is drawn by the means over the wavelengths ([`JointOptics`]). Wavelengths with other indices have their own
//! paths.
//!
//! Light that meets one facet of the first interface and nothing else has a closed form, [`JointPaths::first_facet`]. Paths say whether they are
//! such light, so that a mean over paths can leave it out.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::stack::Diffuse;

use super::chance::{JointOptics, Share};
use super::facets::Facets;
use super::interface::{rotated, scatter_smooth, turn};
use super::optics::{Optics, Side};
use super::path::{EVENTS_SURE, survives};
use super::random::Stream;
use super::rough::{Rough, Sided};
use super::{one_facet, walk};
use crate::formulas::oren_nayar;
use crate::monochrome::{Monochrome, MonochromeBelow};

/// A stack at wavelengths that share their paths.
#[derive(Debug, Clone)]
pub struct JointPaths {
    interfaces: Vec<JointInterface>,
    /// Optical depth along the normal of the slab below each interface.
    optical_depths: Vec<Rgb>,
    /// The wavelengths of these paths.
    channels: [bool; 3],
}

/// Light that has left the stack upward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointPath {
    /// Direction in which it left.
    pub wi: DVec3,
    /// Weight by wavelength. The density of directions, times weight, is `f cos_theta_i`.
    pub weight: Rgb,
    /// Whether it met one facet of the first interface and nothing else.
    pub is_first_facet: bool,
    /// How often it met a diffuse base.
    pub base_visits: u32,
    /// How often the lowest interface, which may be the first, reflected it back up.
    pub reflections: u32,
    /// How many facets of that interface it met on these occasions.
    pub facets: u32,
    /// Length of its way through the slab below the first interface, over the thickness.
    pub length: f64,
}

#[derive(Debug, Clone)]
struct JointInterface {
    kind: Kind,
    /// Cosine and sine of the angle from the stack's tangent to the interface's, where it matters.
    rotation: Option<(f64, f64)>,
}

#[derive(Debug, Clone)]
enum Kind {
    Smooth(JointOptics),
    Rough(Rough<JointOptics>),
    Diffuse(Diffuse),
}

impl JointPaths {
    /// The paths of a stack that is given at each of three wavelengths: one set for each group of wavelengths with the same ways.
    pub fn new(stacks: &[Monochrome; 3]) -> Vec<Self> {
        let mut left = [true; 3];
        let mut all = Vec::new();
        while let Some(lead) = left.iter().position(|is_left| *is_left) {
            let mut channels = [0, 1, 2].map(|c| c == lead);
            let mut found = Self::of(stacks, lead, channels);
            for other in (lead + 1..3).filter(|other| left[*other]) {
                let more = [0, 1, 2].map(|c: usize| channels[c] || c == other);
                let joined = Self::of(stacks, lead, more);
                if joined.is_some() {
                    (found, channels) = (joined, more);
                }
            }
            all.extend(found);
            left = [0, 1, 2].map(|c: usize| left[c] && !channels[c]);
        }
        all
    }

    /// The paths of some channels; `None` if they do not go the same ways. Other channels get the numbers of `lead`, and no weight.
    fn of(stacks: &[Monochrome; 3], lead: usize, channels: [bool; 3]) -> Option<Self> {
        let stacks = [0, 1, 2].map(|c: usize| &stacks[if channels[c] { c } else { lead }]);
        let layers = 0..stacks[0].layers.len();
        let interfaces = layers.clone().map(|layer| JointInterface::new(stacks, layer)).collect::<Option<_>>()?;
        let depths = layers.map(|layer| stacks.map(|stack| stack.layers[layer].below.optical_depth()));
        Some(Self { interfaces, optical_depths: depths.collect(), channels })
    }

    /// The paths with facets of Beckmann's distribution drawn by rejection: faster, and less even.
    pub(super) fn rejecting(mut self) -> Self {
        for interface in &mut self.interfaces {
            if let Kind::Rough(rough) = &mut interface.kind {
                rough.facets = rough.facets.rejecting();
            }
        }
        self
    }

    /// The wavelengths of these paths; the others have no weight.
    pub fn channels(&self) -> [bool; 3] {
        self.channels
    }

    /// Follows paths of a family of even random numbers from `wo` (unit, away from the surface), and shows to `visit` those
    /// that leave upward. Weights are not divided by the count. Ranges that follow each other are one longer range.
    pub fn trace(&self, seed: u64, paths: Range<u64>, wo: DVec3, mut visit: impl FnMut(JointPath)) {
        if wo.z > 0.0 {
            paths.filter_map(|path| self.path(&mut Stream::even(seed, path), wo)).for_each(&mut visit);
        }
    }

    /// One path.
    pub(super) fn path(&self, stream: &mut Stream, wo: DVec3) -> Option<JointPath> {
        let mut from = Sided { side: Side::Above, direction: wo };
        let (mut number, mut events, mut base_visits) = (0, 0, 0);
        let (mut reflections, mut facets, mut length) = (0, 0, 0.0);
        let lowest = self.interfaces.iter().rposition(|interface| !matches!(interface.kind, Kind::Diffuse(_)));
        let mut weight = [0, 1, 2].map(|c: usize| if self.channels[c] { 1.0 } else { 0.0 });
        loop {
            let interface = self.interfaces.get(number)?;
            let (to, kept, met) = interface.scatter(stream, from)?;
            base_visits += u32::from(matches!(interface.kind, Kind::Diffuse(_)));
            if lowest == Some(number) && [from.side, to.side] == [Side::Above; 2] {
                reflections += 1;
                facets += met;
            }
            weight = weight.times(kept);
            let (next, slab, side) = match to.side {
                Side::Above if number == 0 => {
                    let is_first_facet = events == 0 && met == 1;
                    return Some(JointPath {
                        wi: to.direction,
                        weight,
                        is_first_facet,
                        base_visits,
                        reflections,
                        facets,
                        length,
                    });
                }
                Side::Above => (number - 1, number - 1, Side::Below),
                Side::Below => (number + 1, number, Side::Above),
            };
            let depth = self.optical_depths[slab];
            if depth != [0.0; 3] {
                weight = weight.times(depth.map(|depth| libm::exp(-depth / to.direction.z)));
            }
            if slab == 0 {
                length += 1.0 / to.direction.z;
            }
            let DVec3 { x, y, z } = to.direction;
            from = Sided { side, direction: DVec3::new(-x, -y, z) };
            number = next;
            events += 1;
            weight = weight.over(survives(stream, weight.brightest(), events < EVENTS_SURE)?);
        }
    }

    /// `f cos_theta_i` of light from `wi` that meets one facet of the first interface and nothing else. Both directions are above the surface.
    /// Zero for a smooth interface, whose light goes one way, and for a diffuse base.
    ///
    /// `R D G2 / (4 cos_theta_o)`, G2 being `1 / (1 + Lambda_i + Lambda_o)`: the mean over the depths of the facet.
    pub fn first_facet(&self, wi: DVec3, wo: DVec3) -> Rgb {
        let Some(JointInterface { kind: Kind::Rough(rough), rotation }) = self.interfaces.first() else {
            return [0.0; 3];
        };
        let [wo, wi] = [wo, wi].map(|d| rotation.map_or(d, |(cos, sin)| rotated(d, cos, -sin)));
        let wh = (wi + wo).normalize();
        let area = rough.facets.visible_area(wo);
        let density = rough.facets.density(wh) / (4.0 * area) * one_facet::masking(&rough.facets, wo, wi);
        let reflectance = rough.optics.reflectance(Side::Above, wo.dot(wh));
        self.masked(reflectance.map(|reflectance| reflectance * density))
    }

    /// Share of light that a smooth first interface mirrors; zero for another.
    pub fn mirrored(&self, wo: DVec3) -> Rgb {
        match self.interfaces.first() {
            Some(JointInterface { kind: Kind::Smooth(optics), .. }) => {
                self.masked(optics.reflectance(Side::Above, wo.z))
            }
            _ => [0.0; 3],
        }
    }

    /// Values of the wavelengths of these paths; zero for the others.
    fn masked(&self, values: Rgb) -> Rgb {
        [0, 1, 2].map(|c: usize| if self.channels[c] { values[c] } else { 0.0 })
    }
}

impl JointInterface {
    fn new(stacks: [&Monochrome; 3], layer: usize) -> Option<Self> {
        let layers = stacks.map(|stack| &stack.layers[layer]);
        let surface = &layers[0].surface;
        if let MonochromeBelow::Diffuse { sigma, .. } = layers[0].below {
            let albedo = layers.map(|layer| match layer.below {
                MonochromeBelow::Diffuse { albedo, .. } => albedo,
                MonochromeBelow::Dielectric { .. } | MonochromeBelow::Conductor { .. } => 0.0,
            });
            return Some(Self { kind: Kind::Diffuse(Diffuse { albedo, sigma }), rotation: None });
        }
        let optics = JointOptics::new(layers.map(Optics::of))?;
        let kind = match Facets::new(surface) {
            Some(facets) if !optics.is_absent() => Kind::Rough(Rough { optics, facets }),
            _ => Kind::Smooth(optics),
        };
        Some(Self { kind, rotation: turn(surface) })
    }

    /// Direction in which light from `a` goes on, what is left of it, and how many facets it met, by chance; `None` when it is lost. A diffuse base has
    /// no facets.
    fn scatter(&self, stream: &mut Stream, a: Sided) -> Option<(Sided, Rgb, u32)> {
        match &self.kind {
            Kind::Smooth(optics) => {
                let (b, kept) = scatter_smooth(optics, stream, a);
                Some((b, kept, 1))
            }
            Kind::Diffuse(diffuse) => {
                let (direction, u) = stream.direction_and_uniform();
                let sin = u.sqrt();
                let b = DVec3::new(sin * direction.x, sin * direction.y, (1.0 - u).sqrt());
                let brdf = oren_nayar::brdf(diffuse.albedo, diffuse.sigma, b, a.direction);
                Some((Sided { direction: b, ..a }, brdf.map(|brdf| PI * brdf), 0))
            }
            Kind::Rough(rough) => {
                let (b, kept, facets_before) = walk::scatter(rough, stream, a.inside(self.rotation))?;
                Some((b.outside(self.rotation), kept, facets_before + 1))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::layered_mc::{InterfaceMode, LayeredMc};
    use luthier_optics::fresnel::FilmLayer;
    use luthier_optics::stack::{Distribution, Surface};
    use num_complex::Complex64;

    fn rough(alpha: f64) -> Surface {
        Surface::isotropic(Distribution::Ggx, alpha)
    }

    /// A tinted coat with a film over a metal, at three wavelengths; its index by wavelength.
    fn coated_metal(coat: [f64; 3], alpha: f64) -> [Monochrome; 3] {
        [0, 1, 2].map(|c: usize| {
            let metal = MonochromeBelow::Conductor { ior: Complex64::new([0.2, 0.9, 1.3][c], [3.5, 2.6, 2.2][c]) };
            let slab = MonochromeBelow::dielectric(coat[c], [0.1, 0.3, 0.8][c]);
            let brushed = Surface { distribution: Distribution::Beckmann, alpha_x: 0.4, alpha_y: 0.1, rotation: 0.5 };
            let mut stack = Monochrome::bare(&[(rough(alpha), slab), (brushed, metal)]);
            stack.layers[0].films = vec![FilmLayer { ior: Complex64::new(2.2, 0.0), waves: [0.3, 0.35, 0.42][c] }];
            stack
        })
    }

    /// Oracle: independent paths at each wavelength by itself. Energies of eight octants and the mean direction.
    #[test]
    fn every_wavelength_has_its_own_light() {
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let moments = |wi: DVec3, weight: f64| {
            let octant = usize::from(wi.x > -0.6) + 2 * usize::from(wi.y > 0.0) + 4 * usize::from(wi.z > 0.7);
            let mut values = [0.0; 10];
            values[octant] = weight;
            (values[8], values[9]) = (weight, weight * wi.x);
            values
        };
        let diffuse = [0.8, 0.5, 0.2].map(|albedo| {
            let base = MonochromeBelow::Diffuse { albedo, sigma: 0.4 };
            Monochrome::bare(&[(rough(0.1), MonochromeBelow::dielectric(1.5, 1.0 - albedo)), (rough(0.0), base)])
        });
        for (stacks, sets) in [
            (coated_metal([1.5; 3], 0.2), 1),
            (coated_metal([1.5, 1.52, 1.5], 0.2), 2),
            (coated_metal([1.5, 1.52, 1.54], 0.0), 3),
            (diffuse, 1),
        ] {
            let all = JointPaths::new(&stacks);
            assert_eq!(all.len(), sets);
            let count = 40_000;
            let mut found = [[0.0; 10]; 3];
            for paths in &all {
                paths.trace(7, 0..count, wo, |path| {
                    for (found, weight) in found.iter_mut().zip(path.weight) {
                        let values = moments(path.wi, weight / count as f64);
                        found.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                    }
                });
            }
            for (c, stack) in stacks.iter().enumerate() {
                let mc = LayeredMc { seed: 9, samples: count, ..LayeredMc::new(InterfaceMode::SmithWalk) };
                let (mut sums, mut squares) = ([0.0; 10], [0.0; 10]);
                for (wi, weight) in mc.paths(stack, wo).flatten() {
                    for (i, value) in moments(wi, weight).into_iter().enumerate() {
                        sums[i] += value / count as f64;
                        squares[i] += value * value / count as f64;
                    }
                }
                for i in 0..10 {
                    let deviation = ((squares[i] - sums[i] * sums[i]) / count as f64).sqrt();
                    // Weights of joint paths spread more than those of one wavelength, up to three times.
                    let apart = (found[c][i] - sums[i]).abs();
                    assert!(apart < 4.0 * 1.5 * deviation + 1e-12, "{sets} {c} {i}: {apart} {deviation}");
                }
            }
        }
    }

    /// Oracle: paths that met one facet alone, in the quarters of the hemisphere, against the closed form over a grid of directions.
    #[test]
    fn the_first_facet_has_its_closed_form() {
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let quarter = |wi: DVec3| usize::from(wi.x > -0.6) + 2 * usize::from(wi.y > 0.0);
        let [paths] = &JointPaths::new(&coated_metal([1.5; 3], 0.3))[..] else { panic!("one set") };
        let count = 60_000;
        let mut traced = [[0.0; 3]; 4];
        paths.trace(3, 0..count, wo, |path| {
            if path.is_first_facet {
                (0..3).for_each(|c| traced[quarter(path.wi)][c] += path.weight[c] / count as f64);
            }
        });
        let side = 300;
        let mut expected = [[0.0; 3]; 4];
        for i in 0..side * side {
            let [u, v] = [i / side, i % side].map(|i| (f64::from(i) + 0.5) / f64::from(side));
            let (sin_phi, cos_phi) = libm::sincos(2.0 * PI * v);
            let sin = (1.0 - u * u).sqrt();
            let wi = DVec3::new(sin * cos_phi, sin * sin_phi, u);
            let value = paths.first_facet(wi, wo);
            (0..3).for_each(|c| expected[quarter(wi)][c] += value[c] * 2.0 * PI / f64::from(side * side));
        }
        for (traced, expected) in traced.iter().flatten().zip(expected.iter().flatten()) {
            let deviation = (1.5 * expected / count as f64).sqrt();
            assert!((traced - expected).abs() < 4.0 * deviation, "{traced} {expected}");
        }
        assert_eq!(paths.mirrored(wo), [0.0; 3]);
        // A smooth one mirrors, and every facet is the first.
        let stacks = coated_metal([1.5; 3], 0.0);
        let [paths] = &JointPaths::new(&stacks)[..] else { panic!("one set") };
        for (mirrored, stack) in paths.mirrored(wo).into_iter().zip(&stacks) {
            assert!((mirrored - stack.layers[0].reflectance(wo.z)).abs() < 1e-12);
        }
        assert_eq!(paths.first_facet(wo, wo), [0.0; 3]);
    }

    /// A range in two parts is the whole.
    #[test]
    fn ranges_join() {
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let paths = &JointPaths::new(&coated_metal([1.5; 3], 0.3))[0];
        let of = |ends: &[u64]| {
            let mut all = Vec::new();
            ends.windows(2).for_each(|ends| paths.trace(1, ends[0]..ends[1], wo, |path| all.push(path)));
            all
        };
        assert_eq!(of(&[0, 100]), of(&[0, 30, 100]));
    }
}
