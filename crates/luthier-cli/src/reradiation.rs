//! Re-radiation matrices of fluorescent bases that the command line names.

use std::path::Path;

use luthier_layers::effects::fluorescence::{Fluorescent, Reradiated};
use luthier_layers::luthier_optics::reradiation::Matrix;
use luthier_layers::monochrome::Monochrome;
use luthier_terminal::{Failure, Outcome};

use crate::input;

/// A matrix, and the name of its file.
pub(crate) struct Reradiation {
    label: String,
    matrix: Matrix,
}

impl Reradiation {
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let text = input::named_text(path)?;
        let label = path.display().to_string();
        let matrix = Matrix::parse(&text).map_err(|what| Failure::Input(anyhow::anyhow!("{label}{what}")))?;
        Ok(Self { label, matrix })
    }

    /// The model of light at `excitation_nm` seen at `wavelength_nm`, on the stack that `at` gives for a wavelength; and the wavelengths of the two
    /// nearest bins.
    pub(crate) fn between(
        &self,
        excitation_nm: f64,
        wavelength_nm: f64,
        at: impl Fn(f64) -> Monochrome,
    ) -> Outcome<(Reradiated, [f64; 2])> {
        let [from, to] = [self.bin(excitation_nm)?, self.bin(wavelength_nm)?];
        let Matrix { wavelengths_nm, shares } = &self.matrix;
        let coats = wavelengths_nm.iter().map(|&nm| at(nm)).collect();
        let surface = Fluorescent::new(coats, shares)
            .map_err(|source| Failure::Input(anyhow::anyhow!("{}: {source}", self.label)))?;
        Ok((Reradiated { surface, from, to }, [from, to].map(|bin| wavelengths_nm[bin])))
    }

    fn bin(&self, nm: f64) -> Outcome<usize> {
        let [first, last] = self.matrix.ends();
        self.matrix.bin(nm).ok_or_else(|| {
            Failure::Usage(anyhow::anyhow!("{} is for {first} to {last} nm; {nm} nm is not among them", self.label))
        })
    }
}
