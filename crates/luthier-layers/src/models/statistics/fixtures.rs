//! Energies and directions that tests of the statistical models share.

use glam::DVec3;

use super::energy::Energy;
use crate::monochrome::Monochrome;

/// Fresnel's reflectances in place of FGD-infinity.
pub(crate) fn fresnel(stack: &Monochrome) -> impl Energy<1> {
    |layer: usize, cos: f64, _: f64| stack.layers[layer].reflectance(cos)
}

/// Energies without total reflection, as the two-layer formulas have them.
pub(crate) struct NotTotal<E>(pub(crate) E);

impl<E: Energy<1>> Energy<1> for NotTotal<E> {
    fn fgd(&self, layer: usize, cos: f64, alpha: f64) -> [f64; 1] {
        self.0.fgd(layer, cos, alpha)
    }

    fn escaping(&self, _: usize, _: f64, _: f64, _: f64) -> f64 {
        1.0
    }
}

/// Energies read linearly from 64 cosines of each of two layers.
pub(crate) fn tabulated(energy: &impl Energy<1>) -> impl Energy<1> {
    let row = |layer| (0..64).map(|i| energy.fgd(layer, f64::from(i) / 63.0, 0.2)[0]).collect();
    let table: [Vec<f64>; 2] = [0, 1].map(row);
    move |layer: usize, cos: f64, _: f64| {
        let i = ((cos * 63.0) as usize).min(62);
        let row = &table[layer];
        row[i] + (row[i + 1] - row[i]) * (cos * 63.0 - i as f64)
    }
}

/// The direction of a cosine and an azimuth.
pub(crate) fn direction(cos: f64, phi: f64) -> DVec3 {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
}
