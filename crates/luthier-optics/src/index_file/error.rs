//! Faults of files of indices.

use thiserror::Error;

use super::{NOISE_K, ROWS_MAX, VALUE_MAX};
use crate::color::VISIBLE_NM;
use crate::dispersion::FormulaError;
use crate::rows::CELLS_MAX;

/// Why a file gives no index, and where.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}{}{reason}", line.map(|line| format!("line {line}: ")).unwrap_or_default(), column.map(|column| format!("column {column}: ")).unwrap_or_default())]
pub struct IndexFileError {
    /// Line of the text, from 1, if it is about one.
    pub line: Option<usize>,
    /// Column of the table, from 1, if it is about one.
    pub column: Option<usize>,
    /// The reason.
    pub reason: Reason,
}

/// Why a file gives no index.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// A table without rows.
    #[error("there is no row of numbers")]
    Empty,
    /// A header that lacks the wavelength, or n and k.
    #[error("the header `{found}` has no column of {lacks}")]
    Header {
        /// The header.
        found: String,
        /// The part that is missing.
        lacks: &'static str,
    },
    /// Photon energies in place of wavelengths.
    #[error("`{0}` is an energy, and a table begins with wavelengths")]
    Energy(String),
    /// Rows of other than two or three numbers, without a header.
    #[error("{0} columns without a header")]
    NoHeader(usize),
    /// Wavelengths that may be nanometres or micrometres.
    #[error("wavelengths from {0} to {1} may be nanometres or micrometres, and nothing names the unit")]
    Unit(f64, f64),
    /// A row of another length than the header.
    #[error("{found} columns where the header has {expected}")]
    Columns {
        /// Columns found.
        found: usize,
        /// Columns of the header.
        expected: usize,
    },
    /// A cell that is no number.
    #[error("`{0}` is not a number")]
    Number(String),
    /// A wavelength that is not positive.
    #[error("the wavelength {0} is not positive")]
    Wavelength(f64),
    /// A negative index.
    #[error("n = {n} at {nm} nm: an index is not negative")]
    NegativeN {
        /// Where.
        nm: f64,
        /// The value.
        n: f64,
    },
    /// A negative extinction coefficient, beyond noise.
    #[error("k = {k} at {nm} nm: k is not negative, and noise ends at {NOISE_K}")]
    NegativeK {
        /// Where.
        nm: f64,
        /// The value.
        k: f64,
    },
    /// A value that no medium has.
    #[error("{name} = {value} at {nm} nm is that of no medium: it is at most {VALUE_MAX}")]
    TooLarge {
        /// `n` or `k`.
        name: &'static str,
        /// Where.
        nm: f64,
        /// The value.
        value: f64,
    },
    /// n and k that are both 0.
    #[error("n and k are both 0 at {0} nm, which no medium is")]
    Nothing(f64),
    /// Samples outside the visible range alone.
    #[error("no sample of this index is visible: they lie from {0} to {1} nm")]
    NotVisible(f64, f64),
    /// k alone.
    #[error("there is k, and no n")]
    OnlyK,
    /// More rows than any table has.
    #[error("more than {ROWS_MAX} rows")]
    TooManyRows,
    /// More cells than any row has.
    #[error("more than {CELLS_MAX} cells in a row")]
    TooManyCells,
    /// Text that is no YAML.
    #[error("not YAML: {0}")]
    Yaml(String),
    /// Lists in lists in lists.
    #[error("more than {0} levels of lists and mappings")]
    TooDeep(usize),
    /// An alias in place of data.
    #[error("an alias stands for data")]
    Alias,
    /// Not a page of the database.
    #[error("there is no list `DATA` of tables or formulas")]
    NoData,
    /// A kind of data that gives no index.
    #[error("`{0}` is no type of data that gives n or k")]
    Type(String),
    /// An entry that lacks a key.
    #[error("`{0}` is missing from this entry of `DATA`")]
    Missing(&'static str),
    /// A second source of the same quantity.
    #[error("a second entry of `DATA` gives {0}")]
    Twice(&'static str),
    /// A range that is not two ascending wavelengths.
    #[error("`wavelength_range` is `{0}`, not two ascending wavelengths in um")]
    Range(String),
    /// An unknown formula, or one with wrong coefficients.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// A formula with a pole.
    #[error("the formula gives no index at {0} nm")]
    Pole(f64),
}

impl Reason {
    pub(super) fn at(self, line: impl Into<Option<usize>>) -> IndexFileError {
        IndexFileError { line: line.into(), column: None, reason: self }
    }

    pub(super) fn in_column(self, line: usize, column: usize) -> IndexFileError {
        IndexFileError { line: Some(line), column: Some(column), reason: self }
    }
}

impl IndexFileError {
    /// Advice to the author of the file.
    pub fn hint(&self) -> String {
        let (low, high) = VISIBLE_NM;
        match &self.reason {
            Reason::Header { .. } | Reason::Empty => {
                "a table begins with a row of names such as `wavelength_nm,n,k`; k may be left out".into()
            }
            Reason::Energy(_) => "a wavelength in nm is 1239.84 over the energy in eV".into(),
            Reason::NoHeader(_) | Reason::Unit(..) => {
                "write a first row that names the columns: `wavelength_nm,n,k` or `wavelength_um,n,k`".into()
            }
            Reason::Columns { .. } => "numbers with decimal commas need semicolons between them".into(),
            Reason::Number(_) | Reason::Wavelength(_) => {
                "a row has a wavelength and its n and k; text stands in lines that begin with #".into()
            }
            Reason::NegativeN { .. } | Reason::TooLarge { .. } => "were columns exchanged?".into(),
            Reason::NegativeK { .. } => "an index is n + ik here: a medium that absorbs has a positive k".into(),
            Reason::Nothing(_) => "leave the row out".into(),
            Reason::NotVisible(_, last) if *last < 100.0 => {
                "were micrometres meant? Then name the column `wavelength_um`".into()
            }
            Reason::NotVisible(..) => format!("give samples from {low} to {high} nm"),
            Reason::OnlyK => "take a page that has both, or add the column n".into(),
            Reason::TooManyRows | Reason::TooManyCells => format!("keep the rows from {low} to {high} nm"),
            Reason::Yaml(_) | Reason::NoData => {
                "download a page of refractiveindex.info as YAML, or give a CSV file".into()
            }
            Reason::TooDeep(_) | Reason::Alias | Reason::Missing(_) | Reason::Range(_) => {
                "an entry has `type` and `data`, or `type`, `wavelength_range` and `coefficients`".into()
            }
            Reason::Type(_) => "`tabulated nk`, `tabulated n`, `tabulated k` and `formula 1` to `formula 9` do".into(),
            Reason::Twice(_) => "keep one of the two".into(),
            Reason::Formula(_) => "the page `Dispersion formulas` of refractiveindex.info has them".into(),
            Reason::Pole(_) => "give a `wavelength_range` without it".into(),
        }
    }
}

/// A wavelength in messages: products of decimals have more digits than a reader needs.
pub(super) fn plain(value: f64) -> f64 {
    let rounded = (value * 1e4).round() / 1e4;
    if rounded == 0.0 { value } else { rounded }
}
