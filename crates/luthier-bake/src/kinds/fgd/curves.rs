//! Reflectance curves of an interface, at the wavelengths that the bounces of light need.

use luthier_optics::Rgb;
use luthier_optics::albedo::{FacetStatistics, ReflectanceCurves};
use luthier_optics::color::{Color, WavelengthNode, luminance};
use luthier_optics::interface::{Interface, Sampled};
use rayon::prelude::*;

/// Largest error by left-out wavelengths in the light after the first bounce. The first bounce has all wavelengths.
const SPECTRUM_TOLERANCE: f64 = 4e-4;

/// Largest error by left-out wavelengths in the crossed part of films, which is a fraction of the light.
const CROSSED_SPECTRUM_TOLERANCE: f64 = 2e-2;

/// Cosines at which spectra are compared to decide which wavelengths are left out.
const SPECTRUM_COS_THETA: [f64; 5] = [1.0, 0.6, 0.3, 0.15, 0.05];

/// Highest power of the reflectance that is compared: as many reflections.
const SPECTRUM_POWERS: i32 = 3;

/// Step between the points of the error scan that take all wavelengths. It divides neither 16 nor 10, the lengths of the
/// scan's rows, so that these points lie in all columns.
const SPECTRUM_PROBES: usize = 23;

/// Reflectance curves of an interface at the wavelengths of a colour mode: all, and enough for later bounces.
pub(super) struct Curves {
    all: Weighted,
    later: Weighted,
}

/// Albedo of the first bounce, and share of the remaining light that comes out in the end.
pub(super) struct Bounces {
    pub(super) first: Rgb,
    pub(super) later_share: Rgb,
}

impl Curves {
    pub(super) fn new(interface: &Interface, color: &Color) -> Self {
        Self {
            all: Weighted::new(interface.at_nodes(&color.nodes())),
            later: Weighted::new(interface.at_nodes(&sparse(interface, color, SPECTRUM_TOLERANCE))),
        }
    }

    pub(super) fn bounces(&self, statistics: &FacetStatistics) -> Bounces {
        Bounces {
            first: self.all.rgb(&statistics.single_scattering(&self.all.curves)),
            later_share: self.later.rgb(&statistics.later_share(&self.later.curves)),
        }
    }

    /// Largest and root mean square error of albedos by the left-out wavelengths, at some points of the error scan.
    pub(super) fn spectrum_error(&self, probes: &[([f64; 2], FacetStatistics)]) -> [f64; 2] {
        let errors: Vec<f64> = probes
            .par_iter()
            .step_by(SPECTRUM_PROBES)
            .map(|(_, statistics)| {
                let [a, b] = [&self.all, &self.later].map(|c| c.rgb(&statistics.later_share(&c.curves)));
                (0..3).map(|c| statistics.remaining() * (a[c] - b[c]).abs()).fold(0.0, f64::max)
            })
            .collect();
        let squares = errors.iter().map(|e| e * e).sum::<f64>();
        [errors.iter().copied().fold(0.0, f64::max), (squares / errors.len() as f64).sqrt()]
    }
}

/// Curves at some wavelengths, and the weights of these.
pub(super) struct Weighted {
    pub(super) weights: Vec<Rgb>,
    pub(super) curves: ReflectanceCurves,
}

impl Weighted {
    fn new(sampled: Sampled) -> Self {
        let (weights, interfaces): (Vec<_>, Vec<_>) = sampled.nodes.into_iter().unzip();
        let curves = ReflectanceCurves::new(interfaces.len(), |k, cos| interfaces[k].reflectance(cos));
        Self { weights, curves }
    }

    pub(super) fn rgb(&self, values: &[f64]) -> Rgb {
        let mut rgb = [0.0; 3];
        for (weights, value) in self.weights.iter().zip(values) {
            for (c, weight) in weights.iter().enumerate() {
                rgb[c] += weight * value;
            }
        }
        rgb
    }
}

/// Wavelengths that suffice for products of a few reflectances.
fn sparse(interface: &Interface, color: &Color, tolerance: f64) -> Vec<WavelengthNode> {
    let nodes = color.nodes();
    let mut spectra = Vec::new();
    for channel in interface.channels() {
        for cos in SPECTRUM_COS_THETA {
            let at = |n: &WavelengthNode| interface.at(n.wavelength_nm, channel).reflectance(cos);
            let reflectance: Vec<f64> = nodes.iter().map(at).collect();
            let mut power = vec![1.0; nodes.len()];
            for _ in 0..SPECTRUM_POWERS {
                power.iter_mut().zip(&reflectance).for_each(|(p, r)| *p *= r);
                spectra.push(power.clone());
            }
        }
    }
    color.sparse_nodes(&spectra, tolerance)
}

/// The curves of an interface in its crossed part. Films colour it strongly and get a curve per wavelength; a coloured
/// F0 gets one per channel. The index of other bare interfaces varies little: their mean by luminance serves all
/// channels.
pub(super) fn crossed_curves(interface: &Interface, color: &Color) -> Weighted {
    if !interface.below.is_grey_f0() {
        return Weighted::new(interface.at_nodes(&sparse(interface, color, CROSSED_SPECTRUM_TOLERANCE)));
    }
    if interface.films.is_empty() {
        let sampled = interface.sampled(color);
        let mean = ReflectanceCurves::new(1, |_, cos| luminance(sampled.rgb(cos)).clamp(0.0, 1.0));
        return Weighted { weights: vec![[1.0; 3]], curves: mean };
    }
    Weighted::new(interface.at_nodes(&sparse(interface, color, CROSSED_SPECTRUM_TOLERANCE)))
}
