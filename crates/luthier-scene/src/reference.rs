//! The reference at the directions of a scene, with as many samples as a decision takes.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use luthier_layers::model::{Estimate, Estimator};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::Stack;
use rayon::prelude::*;

use crate::error::Value;
use crate::probe::Probe;

/// First number of samples at each wavelength; every refinement doubles it.
const FIRST: u64 = 256;

/// The most samples of one probe at each wavelength.
const MOST: u64 = 1 << 20;

/// Largest change of a reflectance that leaving out wavelengths may cause.
const SPECTRUM_TOLERANCE: f64 = 1e-3;

/// Cosines at which spectra are compared to decide which wavelengths are left out.
const SPECTRUM_COS_THETA: [f64; 3] = [1.0, 0.6, 0.2];

/// `layered-mc` in colour at some probes. Equal calls give equal numbers.
#[derive(Debug)]
pub(crate) struct Reference {
    /// The stack at each wavelength, with its weight in each channel.
    spectrum: Vec<(Monochrome, Rgb)>,
    probes: Vec<(Probe, Tallies)>,
}

#[derive(Debug)]
struct Tallies {
    /// One per wavelength.
    tallies: Vec<Tally>,
    batches: u64,
}

/// Count, mean and squared deviations of samples.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    count: f64,
    mean: f64,
    squares: f64,
}

impl Tally {
    /// This tally merged with more samples (Chan, Golub and LeVeque 1983).
    fn with(self, estimate: Estimate, count: u64) -> Self {
        let n = count as f64;
        let squares = estimate.variance() * n * (n - 1.0);
        let (all, step) = (self.count + n, estimate.mean - self.mean);
        Self {
            count: all,
            mean: self.mean + step * n / all,
            squares: self.squares + squares + step * step * self.count * n / all,
        }
    }

    fn variance(self) -> f64 {
        self.squares / (self.count * (self.count - 1.0))
    }
}

impl Reference {
    /// The reference of a stack at some probes, with a first few samples.
    pub(crate) fn new(stack: &Stack, color: Color, probes: Vec<Probe>) -> Self {
        let spectrum = spectrum(stack, color);
        let probes = probes.into_par_iter().map(|probe| {
            let mut tallies = Tallies { tallies: vec![Tally::default(); spectrum.len()], batches: 0 };
            more(&spectrum, &probe, &mut tallies);
            (probe, tallies)
        });
        Self { probes: probes.collect(), spectrum }
    }

    /// The values at all probes.
    pub(crate) fn values(&self) -> Vec<Value> {
        self.probes.iter().map(|(_, tallies)| self.value(tallies)).collect()
    }

    fn value(&self, tallies: &Tallies) -> Value {
        let (mut rgb, mut variance) = ([0.0; 3], [0.0; 3]);
        for ((_, weight), tally) in self.spectrum.iter().zip(&tallies.tallies) {
            for c in 0..3 {
                rgb[c] += weight[c] * tally.mean;
                variance[c] += weight[c] * weight[c] * tally.variance();
            }
        }
        Value { rgb, std_err: variance.map(f64::sqrt) }
    }

    /// Doubles the samples of some probes. Returns false, and adds none, if one of them would exceed [`MOST`].
    pub(crate) fn refine(&mut self, numbers: &[usize]) -> bool {
        if numbers.iter().any(|&number| samples(self.probes[number].1.batches + 1) > MOST) {
            return false;
        }
        let spectrum = &self.spectrum;
        let open = self.probes.par_iter_mut().enumerate().filter(|(i, _)| numbers.contains(i));
        open.for_each(|(_, (probe, tallies))| more(spectrum, probe, tallies));
        true
    }

    /// Samples at all probes and wavelengths.
    pub(crate) fn samples(&self) -> u64 {
        let each = self.spectrum.len() as u64;
        self.probes.iter().map(|(_, tallies)| each * samples(tallies.batches)).sum()
    }
}

/// Number of samples after some batches: each batch after the first doubles it.
fn samples(batches: u64) -> u64 {
    if batches == 0 { 0 } else { FIRST << (batches - 1) }
}

fn more(spectrum: &[(Monochrome, Rgb)], probe: &Probe, tallies: &mut Tallies) {
    let count = samples(tallies.batches + 1) - samples(tallies.batches);
    let reference = LayeredMc { mode: InterfaceMode::SmithWalk, samples: count, seed: tallies.batches };
    for ((stack, _), tally) in spectrum.iter().zip(&mut tallies.tallies) {
        let estimate = match *probe {
            Probe::Pair { wi, wo } => reference.eval_with_error(stack, wi, wo),
            Probe::Sky { wo } => Estimate::sum([(FRAC_1_PI, reference.albedo_with_error(stack, wo, DVec3::Z))]),
        };
        *tally = tally.with(estimate, count);
    }
    tallies.batches += 1;
}

/// The wavelengths that a stack needs. Channels and wavelengths with equal stacks share one.
fn spectrum(stack: &Stack, color: Color) -> Vec<(Monochrome, Rgb)> {
    let nodes = color.nodes();
    let interfaces: Vec<Interface> = (0..stack.layers.len()).filter_map(|i| Interface::of(stack, i)).collect();
    let mut spectra = Vec::new();
    for interface in &interfaces {
        for cos in SPECTRUM_COS_THETA {
            for channel in interface.channels() {
                spectra.push(nodes.iter().map(|n| interface.at(n.wavelength_nm, channel).reflectance(cos)).collect());
            }
        }
    }
    let mut found: Vec<(Monochrome, Rgb)> = Vec::new();
    for node in color.sparse_nodes(&spectra, SPECTRUM_TOLERANCE) {
        for channel in 0..3 {
            if node.weight[channel] == 0.0 {
                continue;
            }
            let one = Monochrome::new(stack, node.wavelength_nm, channel);
            match found.iter_mut().find(|(known, _)| *known == one) {
                Some((_, weight)) => weight[channel] += node.weight[channel],
                None => {
                    let mut weight = [0.0; 3];
                    weight[channel] = node.weight[channel];
                    found.push((one, weight));
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Surface};

    use super::*;

    fn lacquer() -> Stack {
        let surface = Surface::isotropic(Distribution::Ggx, 0.2);
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.1, 0.5, 0.5] };
        let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let base = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
        let layer = |base| Layer { films: Vec::new(), surface, base };
        Stack { exterior: Ior::vacuum(), layers: vec![layer(coat), layer(base)] }
    }

    #[test]
    fn channels_that_are_equal_are_walked_once() {
        let found = spectrum(&lacquer(), Color::Spectral);
        // Two ends of the spectrum, whose indices are equal: one stack for red, one for green and blue.
        assert_eq!(found.len(), 2, "{found:?}");
        let sums = [0, 1, 2].map(|c| found.iter().map(|(_, w)| w[c]).sum::<f64>());
        assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 1e-12), "{sums:?}");
    }

    /// Refined in steps it is the mean of all samples, and noise falls as it should.
    #[test]
    fn refining_lowers_the_noise() {
        let w = DVec3::new(0.3, 0.1, 0.9).normalize();
        let probes = vec![Probe::Pair { wi: w, wo: w }, Probe::Sky { wo: w }];
        let mut reference = Reference::new(&lacquer(), Color::Spectral, probes);
        let first = reference.values();
        for _ in 0..4 {
            assert!(reference.refine(&[0, 1]));
        }
        for (a, b) in first.iter().zip(reference.values()) {
            for c in 0..3 {
                // 16 times the samples: a quarter of the noise, within half of that.
                let ratio = b.std_err[c] / a.std_err[c];
                assert!((0.125..0.5).contains(&ratio), "{ratio}");
                assert!((a.rgb[c] - b.rgb[c]).abs() < 5.0 * a.std_err[c]);
            }
        }
        assert_eq!(reference.samples(), 2 * 2 * 16 * FIRST);
    }
}
