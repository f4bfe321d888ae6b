//! Re-radiation matrices of fluorescent bases as texts.
//!
//! CSV: the first row has the wavelengths of the light, in nm, ascending, after a first field that is free; each row below
//! has a wavelength that comes out, the same ones in the same order, and for each wavelength of the light the share of its power that
//! comes out there. Shares are not negative; no column sums to more than 1. [`crate::rows`] has the separators.

mod rgb;

use crate::rows::{Row, rows};

pub use self::rgb::rgb;

/// Excess over 1 that the sum of a column may have, because decimals are rounded.
const GAIN_TOLERANCE: f64 = 1e-9;

/// A matrix and the wavelengths of its bins.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// Wavelengths in nm, ascending; at least one.
    pub wavelengths_nm: Vec<f64>,
    /// Shares of power: entry `to * bins + from`.
    pub shares: Vec<f64>,
}

/// Why a text is no matrix: the line, counted from 1, if it is about one, and the reason.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", line.map(|line| format!(":{line}")).unwrap_or_default())]
pub struct MatrixError {
    /// Line of the text.
    pub line: Option<usize>,
    /// The reason.
    pub reason: String,
}

impl Matrix {
    /// Reads a matrix.
    ///
    /// ```
    /// let matrix = luthier_optics::reradiation::Matrix::parse("nm,530,600\n530,0.1,0\n600,0.7,0.2\n").unwrap();
    /// assert_eq!(matrix.wavelengths_nm, [530.0, 600.0]);
    /// assert_eq!(matrix.shares, [0.1, 0.0, 0.7, 0.2]);
    /// ```
    ///
    /// # Errors
    /// [`MatrixError`], whose text continues the name of the file.
    pub fn parse(text: &str) -> Result<Self, MatrixError> {
        let mut rows = rows(text).map(|row| row.map_err(|error| wrong(error.line, error.to_string())));
        let head = rows.next().ok_or_else(|| wrong(None, "no matrix"))??;
        let at = head.line;
        if head.cells.len() < 2 {
            return Err(wrong(at, "expected the wavelengths of the light after a comma"));
        }
        let wavelengths_nm = numbers(&head, 1).map_err(|reason| wrong(at, reason))?;
        if !wavelengths_nm.is_sorted_by(|a, b| a < b) {
            return Err(wrong(at, "wavelengths have to ascend"));
        }
        let bins = wavelengths_nm.len();
        // Grows with the rows: the head alone may promise a matrix that no memory holds.
        let mut shares = Vec::new();
        for (number, row) in rows.enumerate() {
            let row = row?;
            let fields = numbers(&row, 0).map_err(|reason| wrong(row.line, reason))?;
            match (fields.split_first(), wavelengths_nm.get(number)) {
                (_, None) => {
                    return Err(wrong(row.line, format!("expected {bins} rows, as many as there are wavelengths")));
                }
                (Some((nm, _)), Some(expected)) if nm != expected => {
                    return Err(wrong(row.line, format!("the row is for {nm} nm, expected {expected} nm")));
                }
                (Some((_, values)), _) if values.len() == bins => {
                    if let Some((from, share)) = values.iter().enumerate().find(|(_, share)| **share < 0.0) {
                        let nm = wavelengths_nm[from];
                        return Err(wrong(row.line, format!("the share {share} of the light at {nm} nm is negative")));
                    }
                    shares.extend(values);
                }
                _ => {
                    let found = fields.len().saturating_sub(1);
                    return Err(wrong(row.line, format!("expected {bins} shares after the wavelength, found {found}")));
                }
            }
        }
        let rows = shares.len() / bins;
        if rows < bins {
            return Err(wrong(None, format!("expected {bins} rows, as many as there are wavelengths, found {rows}")));
        }
        for (from, nm) in wavelengths_nm.iter().enumerate() {
            let power: f64 = shares.iter().skip(from).step_by(bins).sum();
            if power > 1.0 + GAIN_TOLERANCE {
                // Sums of decimals have more digits than a reader needs.
                let power = (power * 1e6).round() / 1e6;
                let reason = format!("{power} of the power of the light at {nm} nm comes out; it has to be 1 at most");
                return Err(wrong(at, reason));
            }
        }
        Ok(Self { wavelengths_nm, shares })
    }

    /// The bin that is nearest to a wavelength; `None` outside all bins.
    pub fn bin(&self, nm: f64) -> Option<usize> {
        let distances = self.wavelengths_nm.iter().map(|bin| (bin - nm).abs()).enumerate();
        let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1));
        let [first, last] = self.ends();
        nearest.filter(|_| (first..=last).contains(&nm)).map(|(bin, _)| bin)
    }

    /// The first and the last wavelength.
    pub fn ends(&self) -> [f64; 2] {
        [self.wavelengths_nm.first(), self.wavelengths_nm.last()].map(|nm| nm.copied().unwrap_or(f64::NAN))
    }
}

fn wrong(line: impl Into<Option<usize>>, reason: impl Into<String>) -> MatrixError {
    MatrixError { line: line.into(), reason: reason.into() }
}

/// The numbers of a row from a cell on.
fn numbers(row: &Row, first: usize) -> Result<Vec<f64>, String> {
    let cells = row.cells.iter().enumerate().skip(first);
    cells.map(|(cell, text)| row.number(cell).ok_or_else(|| format!("`{text}` is not a number"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_read_row_by_row() {
        let text = "# green to orange\nnm,530,600\n530, 0.1, 0\n\n600, 0.7, 0.2\n";
        let matrix = Matrix::parse(text).unwrap();
        assert_eq!(matrix.wavelengths_nm, [530.0, 600.0]);
        assert_eq!(matrix.shares, [0.1, 0.0, 0.7, 0.2]);
        assert_eq!([530.0, 564.0, 566.0, 600.0].map(|nm| matrix.bin(nm).unwrap()), [0, 0, 1, 1]);
        assert!(matrix.bin(529.0).is_none() && matrix.bin(601.0).is_none());
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
            ("nm,530,600\n530,0,0\n600,0.5,-0.1\n", ":3: the share -0.1 of the light at 600 nm is negative"),
            (
                "nm,530,600\n530,0.5,0\n600,0.7,0\n",
                ":1: 1.2 of the power of the light at 530 nm comes out; it has to be 1 at most",
            ),
        ] {
            assert_eq!(Matrix::parse(text).unwrap_err().to_string(), expected);
        }
    }

    /// A row of half a megabyte, and a head of eight thousand wavelengths that promises half a gigabyte.
    #[test]
    fn a_promise_takes_no_memory() {
        let head = |bins: usize| (1..=bins).fold("nm".to_owned(), |head, nm| format!("{head},{nm}"));
        let error = Matrix::parse(&head(100_000)).unwrap_err();
        assert_eq!(error.to_string(), ":1: more than 8192 cells in a row");
        let error = Matrix::parse(&head(8000)).unwrap_err();
        assert_eq!(error.reason, "expected 8000 rows, as many as there are wavelengths, found 0");
    }

    #[test]
    fn a_matrix_is_read_in_any_writing() {
        let expected = Matrix { wavelengths_nm: vec![530.0, 600.0], shares: vec![0.125, 0.0, 0.75, 0.25] };
        for text in
            ["\u{feff},530,600\r\n530,0.125,0,\r\n600,0.75,0.25,\r\n", "nm;530;600\r530;0,125;0\r600;0,75;0,25\r"]
        {
            assert_eq!(Matrix::parse(text).as_ref(), Ok(&expected), "{text}");
        }
    }
}
