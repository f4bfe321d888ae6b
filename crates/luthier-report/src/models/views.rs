//! One view of a material at one wavelength.

use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};

use super::cells::Cells;
use super::paths::Histogram;
use super::{ModelSubject, PHI_DEG, direction};

/// A material at one wavelength, seen from one direction.
pub(super) struct View {
    pub(super) wavelength_nm: f64,
    pub(super) stack: Monochrome,
    pub(super) cells: Cells,
}

impl View {
    pub(super) fn new(subject: &ModelSubject, channel: usize, theta_deg: f64) -> Self {
        let wavelength_nm = subject.wavelengths_nm[channel];
        let stack = Monochrome::new(&subject.stack, wavelength_nm, channel);
        Self { wavelength_nm, stack, cells: Cells::new(direction(theta_deg, PHI_DEG)) }
    }

    /// Histogram of simulated paths. Seeds of families are 2^32 apart, so that neighbouring seeds share no paths.
    pub(super) fn trace(&self, mode: InterfaceMode, family: u64, samples: u32, seed: u64) -> Histogram {
        let estimator = LayeredMc { mode, samples: samples.into(), seed: seed.wrapping_add(family << 32) };
        Histogram::trace(estimator, &self.stack, &self.cells)
    }
}
