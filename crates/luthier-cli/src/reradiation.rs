//! Re-radiation matrices of fluorescent bases as files.
//!
//! CSV: the first row has the wavelengths of the light, in nm, ascending, after a first field that is free; each row below
//! has a wavelength that comes out, the same ones in the same order, and for each wavelength of the light the share of its power that
//! comes out there. Shares are not negative; no column sums to more than 1. Empty lines and lines that begin with `#` do not
//! count.

use std::path::Path;

use luthier_layers::fluorescence::{Fluorescent, Reradiated};
use luthier_layers::monochrome::Monochrome;
use luthier_terminal::{Failure, Outcome};

use crate::input;

/// A matrix and the wavelengths of its bins.
#[derive(Debug, PartialEq)]
pub(crate) struct Reradiation {
    label: String,
    wavelengths_nm: Vec<f64>,
    /// Entry `to * bins + from`.
    shares: Vec<f64>,
}

impl Reradiation {
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let text = input::named_text(path)?;
        let label = path.display().to_string();
        Self::parse(&text, label.clone()).map_err(|what| Failure::Input(anyhow::anyhow!("{label}{what}")))
    }

    /// Errors begin with what comes after the name of the file.
    fn parse(text: &str, label: String) -> Result<Self, String> {
        let lines = text.lines().map(str::trim).enumerate();
        let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')).map(|(i, l)| (i + 1, l));
        let (at, head) = lines.next().ok_or(": no matrix")?;
        let (_, head) =
            head.split_once(',').ok_or(format!(":{at}: expected the wavelengths of the light after a comma"))?;
        let wavelengths_nm = numbers(head).map_err(|what| format!(":{at}: {what}"))?;
        if !wavelengths_nm.is_sorted_by(|a, b| a < b) {
            return Err(format!(":{at}: wavelengths have to ascend"));
        }
        let bins = wavelengths_nm.len();
        let mut shares = Vec::with_capacity(bins * bins);
        for (row, (at, line)) in lines.enumerate() {
            let fields = numbers(line).map_err(|what| format!(":{at}: {what}"))?;
            match (fields.split_first(), wavelengths_nm.get(row)) {
                (_, None) => return Err(format!(":{at}: expected {bins} rows, as many as there are wavelengths")),
                (Some((nm, _)), Some(expected)) if nm != expected => {
                    return Err(format!(":{at}: the row is for {nm} nm, expected {expected} nm"));
                }
                (Some((_, row)), _) if row.len() == bins => shares.extend(row),
                _ => {
                    let found = fields.len().saturating_sub(1);
                    return Err(format!(":{at}: expected {bins} shares after the wavelength, found {found}"));
                }
            }
        }
        let rows = shares.len() / bins;
        if rows < bins {
            return Err(format!(": expected {bins} rows, as many as there are wavelengths, found {rows}"));
        }
        Ok(Self { label, wavelengths_nm, shares })
    }

    /// The model of light at `excitation_nm` seen at `wavelength_nm`, on the stack that `at` has for a wavelength; and the wavelengths
    /// of the two bins, which are the nearest.
    pub(crate) fn between(
        &self,
        excitation_nm: f64,
        wavelength_nm: f64,
        at: impl Fn(f64) -> Monochrome,
    ) -> Outcome<(Reradiated, [f64; 2])> {
        let [from, to] = [self.bin(excitation_nm)?, self.bin(wavelength_nm)?];
        let coats = self.wavelengths_nm.iter().map(|&nm| at(nm)).collect();
        let surface = Fluorescent::new(coats, &self.shares)
            .map_err(|source| Failure::Input(anyhow::anyhow!("{}: {source}", self.label)))?;
        Ok((Reradiated { surface, from, to }, [from, to].map(|bin| self.wavelengths_nm[bin])))
    }

    fn bin(&self, nm: f64) -> Outcome<usize> {
        let away = |bin: &usize| (self.wavelengths_nm[*bin] - nm).abs();
        let nearest = (0..self.wavelengths_nm.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
        let [first, last] = [self.wavelengths_nm.first(), self.wavelengths_nm.last()].map(|x| x.copied().unwrap_or(nm));
        nearest.filter(|_| (first..=last).contains(&nm)).ok_or_else(|| {
            Failure::Usage(anyhow::anyhow!("{} is for {first} to {last} nm; {nm} nm is not among them", self.label))
        })
    }
}

fn numbers(line: &str) -> Result<Vec<f64>, String> {
    let number = |field: &str| match field.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{}` is not a number", field.trim())),
    };
    line.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_read_row_by_row() {
        let text = "# green to orange\nnm,530,600\n530, 0.1, 0\n\n600, 0.7, 0.2\n";
        let matrix = Reradiation::parse(text, "m.csv".to_owned()).unwrap();
        assert_eq!(matrix.wavelengths_nm, [530.0, 600.0]);
        assert_eq!(matrix.shares, [0.1, 0.0, 0.7, 0.2]);
        assert_eq!([530.0, 564.0, 566.0, 600.0].map(|nm| matrix.bin(nm).unwrap()), [0, 0, 1, 1]);
        assert!(matrix.bin(529.0).is_err() && matrix.bin(601.0).is_err());
    }

    #[test]
    fn mistakes_are_pointed_at() {
        for (text, expected) in [
            ("# nothing\n", ": no matrix"),
            ("530\n", ":1: expected the wavelengths of the light after a comma"),
            ("nm,530,green\n", ":1: `green` is not a number"),
            ("nm,600,530\n", ":1: wavelengths have to ascend"),
            ("nm,530,600\n530,0,0\n", ": expected 2 rows, as many as there are wavelengths, found 1"),
            ("nm,530,600\n600,0,0\n", ":2: the row is for 600 nm, expected 530 nm"),
            ("nm,530,600\n530,0\n", ":2: expected 2 shares after the wavelength, found 1"),
            ("nm,530\n530,0\n600,0\n", ":3: expected 1 rows, as many as there are wavelengths"),
        ] {
            assert_eq!(Reradiation::parse(text, String::new()).unwrap_err(), expected);
        }
    }
}
