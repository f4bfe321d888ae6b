//! Tables of indices in CSV.

use super::columns::{Columns, NM, UM, number};
use super::curves::{Point, joined};
use super::error::plain;
use super::{IndexFile, IndexFileError, ROWS_MAX, Reason};
use crate::rows::{Row, rows};

/// Longest wavelength of a table in um, if nothing names the unit: a table in nm has longer ones.
const UM_MOST: f64 = 30.0;
/// Shortest wavelength of a table in nm, if nothing names the unit.
const NM_LEAST: f64 = 100.0;

/// Reads an index from CSV text: rows of a wavelength, n and k below a row of names.
///
/// Names are `wavelength`, `wl` or `lambda` with a unit in any writing (`wavelength_nm`, `Wavelength (um)`), or the unit alone; `n` and `k`.
/// Where k is left out it is 0. Without a unit, wavelengths up to 30 are um, and those from 100 on nm. A further row of names begins further
/// rows, as in the exports of refractiveindex.info, which have n first and then k. [`crate::rows`] has the separators.
///
/// ```
/// let file = luthier_optics::index_file::csv("wl,n\n0.45,1.4\n0.65,0.2\nwl,k\n0.45,1.9\n0.65,3.5\n").unwrap();
/// assert_eq!(file.ior.at(650.0), luthier_optics::num_complex::Complex64::new(0.2, 3.5));
/// ```
///
/// # Errors
/// [`IndexFileError`], with the line and the column.
pub fn csv(text: &str) -> Result<IndexFile, IndexFileError> {
    let mut notes = Vec::new();
    let mut columns: Option<Columns> = None;
    let (mut n, mut k): (Vec<Point>, Vec<Point>) = (Vec::new(), Vec::new());
    // Least and greatest wavelength without a unit: together they tell it.
    let mut bare: Option<(f64, f64)> = None;
    let mut bare_line = None;
    let mut count = 0;
    for row in rows(text) {
        let row = row.map_err(|error| Reason::TooManyCells.at(error.line))?;
        let begins = match &columns {
            None => row.number(0).is_none(),
            Some(_) => row.number(0).is_none() && Columns::named(&row).is_ok(),
        };
        if begins {
            let named = Columns::named(&row)?;
            if !named.others.is_empty() {
                notes.push(format!("columns that are not read: {}", named.others.join(", ")));
            }
            columns = Some(named);
            continue;
        }
        let has_header = columns.is_some();
        let columns = match &mut columns {
            Some(columns) => columns,
            none => none.insert(headless(&row)?),
        };
        if !has_header {
            notes.push(format!(
                "there is no header: the columns are read as wavelength, n{}",
                if columns.k.is_some() { ", k" } else { "" }
            ));
        }
        count += 1;
        if count > ROWS_MAX {
            return Err(Reason::TooManyRows.at(row.line));
        }
        if row.cells.len() != columns.count {
            return Err(Reason::Columns { found: row.cells.len(), expected: columns.count }.at(row.line));
        }
        let wavelength = number(&row, columns.wavelength)?;
        if wavelength <= 0.0 {
            return Err(Reason::Wavelength(wavelength).in_column(row.line, columns.wavelength + 1));
        }
        if columns.unit.is_none() {
            let (least, most) = bare.unwrap_or((wavelength, wavelength));
            bare = Some((least.min(wavelength), most.max(wavelength)));
            bare_line.get_or_insert(row.line);
        }
        for (curve, cell) in [(&mut n, columns.n), (&mut k, columns.k)] {
            let Some(cell) = cell else { continue };
            let value = number(&row, cell)?;
            curve.push(Point {
                nm: wavelength,
                unit: columns.unit,
                value,
                line: Some(row.line),
                column: Some(cell + 1),
            });
        }
    }
    let unit = match bare {
        None => NM,
        Some((_, most)) if most <= UM_MOST => UM,
        Some((least, _)) if least >= NM_LEAST => NM,
        Some((least, most)) => return Err(Reason::Unit(plain(least), plain(most)).at(bare_line)),
    };
    for point in n.iter_mut().chain(&mut k) {
        point.nm = point.unit.unwrap_or(unit).nm(point.nm);
    }
    let ior = joined(n, k, &mut notes)?;
    Ok(IndexFile { ior, notes })
}

/// The columns of a first row of numbers.
fn headless(row: &Row) -> Result<Columns, IndexFileError> {
    match row.cells.len() {
        count @ (2 | 3) => Ok(Columns::plain(count)),
        count => Err(Reason::NoHeader(count).at(row.line)),
    }
}
