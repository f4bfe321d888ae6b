//! Columns of a table of indices, and their names in a header.

use super::error::{IndexFileError, Reason};
use crate::rows::Row;

/// Nanometres in a unit of wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit(pub(super) f64);

pub(super) const NM: Unit = Unit(1.0);
pub(super) const UM: Unit = Unit(1e3);

impl Unit {
    /// A wavelength in nm, without the digits that the product of decimals adds.
    pub(super) fn nm(self, value: f64) -> f64 {
        if self == NM { value } else { (value * self.0 * 1e9).round() / 1e9 }
    }
}

/// Places of quantities among the cells of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    pub(super) wavelength: usize,
    /// The unit of wavelengths, if the header names it.
    pub(super) unit: Option<Unit>,
    pub(super) n: Option<usize>,
    pub(super) k: Option<usize>,
    pub(super) count: usize,
    /// Names of columns that are not read.
    pub(super) others: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    Wavelength(Option<Unit>),
    Unit(Unit),
    N,
    K,
    Energy,
    Other,
}

impl Columns {
    /// Columns of rows without a header.
    pub(super) fn plain(count: usize) -> Self {
        Self { wavelength: 0, unit: None, n: Some(1), k: (count > 2).then_some(2), count, others: Vec::new() }
    }

    /// Columns that a header names.
    pub(super) fn named(row: &Row) -> Result<Self, IndexFileError> {
        let mut names = row.cells.clone();
        // A comma or a space before the unit makes two cells of `wavelength, um`.
        let split = names
            .windows(2)
            .position(|pair| role(&pair[0]) == Role::Wavelength(None) && matches!(role(&pair[1]), Role::Unit(_)));
        if let Some(at) = split {
            let unit = names.remove(at + 1);
            names[at] = format!("{} {unit}", names[at]);
        }
        let roles: Vec<Role> = names.iter().map(|name| role(name)).collect();
        let Some(wavelength) = roles.iter().position(|role| matches!(role, Role::Wavelength(_) | Role::Unit(_))) else {
            return Err(match roles.iter().position(|role| *role == Role::Energy) {
                Some(at) => Reason::Energy(clipped(&names[at])).in_column(row.line, at + 1),
                None => lacking("wavelengths", &names).at(row.line),
            });
        };
        let unit = match roles[wavelength] {
            Role::Wavelength(unit) => unit,
            Role::Unit(unit) => Some(unit),
            _ => None,
        };
        let [n, k] = [Role::N, Role::K].map(|wanted| roles.iter().position(|role| *role == wanted));
        if n.is_none() && k.is_none() {
            return Err(lacking("n or k", &names).at(row.line));
        }
        let others = (0..names.len()).filter(|&at| ![Some(wavelength), n, k].contains(&Some(at)));
        let others = others.map(|at| clipped(&names[at])).collect();
        Ok(Self { wavelength, unit, n, k, count: names.len(), others })
    }
}

/// The fault of a header that names no column of a quantity.
fn lacking(lacks: &'static str, names: &[String]) -> Reason {
    Reason::Header { found: clipped(&names.join(",")), lacks }
}

/// The number of a cell, or a fault with its text and its place.
pub(super) fn number(row: &Row, cell: usize) -> Result<f64, IndexFileError> {
    let text = row.cells.get(cell).map_or("", String::as_str);
    row.number(cell).ok_or_else(|| Reason::Number(clipped(text)).in_column(row.line, cell + 1))
}

/// Characters of a text of the file in messages.
const QUOTED_MAX: usize = 60;

pub(super) fn clipped(text: &str) -> String {
    match text.char_indices().nth(QUOTED_MAX) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

fn role(name: &str) -> Role {
    let plain = name.to_lowercase().replace(['\u{b5}', '\u{3bc}'], "u");
    let words: Vec<&str> = plain.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let is_wavelength =
        |word: &str| matches!(word, "wavelength" | "wavelengths" | "wl" | "wvl" | "wave" | "lambda" | "lam" | "λ");
    match words.as_slice() {
        ["n" | "ior" | "index" | "eta"] | ["refractive", "index"] | ["n", "real"] | ["re", "n"] => Role::N,
        ["k" | "kappa" | "extinction"] | ["extinction", "coefficient"] | ["n", "imag"] | ["im", "n"] => Role::K,
        [word, ..] if matches!(*word, "energy" | "ev" | "photon") || words.contains(&"ev") => Role::Energy,
        [word] => match unit(word) {
            Some(unit) => Role::Unit(unit),
            None if is_wavelength(word) => Role::Wavelength(None),
            None => Role::Other,
        },
        [word, .., last] if is_wavelength(word) => Role::Wavelength(unit(last)),
        _ => Role::Other,
    }
}

fn unit(word: &str) -> Option<Unit> {
    match word {
        "nm" | "nanometer" | "nanometers" | "nanometre" | "nanometres" => Some(NM),
        "um" | "micron" | "microns" | "micrometer" | "micrometers" | "micrometre" | "micrometres" => Some(UM),
        "å" | "angstrom" | "angstroms" | "ångström" => Some(Unit(0.1)),
        "m" | "meter" | "metre" => Some(Unit(1e9)),
        _ => None,
    }
}
