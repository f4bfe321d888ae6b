//! Effect of layers on the light of a diffuse base below them, for the models that follow it (`belcour`, `yamaguchi`).

use luthier_layers::models::statistics::evaluate::Memory;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_optics::Rgb;
use luthier_optics::color::{Color, WavelengthNode, luminance};
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};

/// Largest change by wavelengths that are left out, as a share of the light.
const SPECTRUM_TOLERANCE: f64 = 1e-3;

/// Where spectra are compared to decide which wavelengths are left out.
const SPECTRUM_COS_THETA: [f64; 3] = [1.0, 0.6, 0.2];

/// Internal reflectance in colour, and the luminance of the upward loss beyond the downward loss. Both are 0 if no
/// layer covers a diffuse base.
pub(crate) fn veil(stack: &Stack, color: &Color) -> (Rgb, f64) {
    let covered = stack.layers.iter().position(|layer| matches!(layer.base, Base::Diffuse(_)));
    let Some(base @ 1..) = covered else { return ([0.0; 3], 0.0) };
    let memory = Memory::default();
    let (mut internal, mut loss) = ([0.0; 3], [0.0; 3]);
    for node in wavelengths(stack, base, color) {
        for c in 0..3 {
            // The albedo of the base does not matter. `Memory` computes channels that differ in nothing else once.
            let mut one = Monochrome::new(stack, node.wavelength_nm, c);
            one.layers[base].below = MonochromeBelow::Diffuse { albedo: 0.0, sigma: 0.0 };
            if let Some(veil) = memory.prepared(&one).veil() {
                internal[c] += node.weight[c] * veil.internal[0];
                loss[c] += node.weight[c] * (1.0 - veil.upward[0]);
            }
        }
    }
    (internal, luminance(loss))
}

/// Wavelengths that suffice for the layers above the base: a single one if nothing is dispersive.
fn wavelengths(stack: &Stack, base: usize, color: &Color) -> Vec<WavelengthNode> {
    let nodes = color.nodes();
    let interfaces: Vec<Interface> = (0..base).filter_map(|i| Interface::of(stack, i)).collect();
    if interfaces.iter().all(Interface::is_achromatic) {
        return vec![WavelengthNode { weight: [1.0; 3], ..nodes[nodes.len() / 2] }];
    }
    let mut spectra: Vec<Vec<f64>> = Vec::new();
    for cos in SPECTRUM_COS_THETA {
        for interface in &interfaces {
            for channel in interface.channels() {
                spectra.push(nodes.iter().map(|n| interface.at(n.wavelength_nm, channel).reflectance(cos)).collect());
            }
        }
    }
    color.sparse_nodes(&spectra, SPECTRUM_TOLERANCE)
}
