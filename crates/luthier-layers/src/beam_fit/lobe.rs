//! Lobes as lists of values.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::rows::{Row, rows};

use crate::angles::Angles;

/// A value of a lobe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Direction to the light, unit.
    pub wi: DVec3,
    /// Direction to the eye, unit.
    pub wo: DVec3,
    /// f cos_theta_i, RGB.
    pub value: Rgb,
}

/// Error of a text that is no lobe: the line, counted from 1, if the error has one, and the reason.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", line.map(|line| format!(":{line}")).unwrap_or_default())]
pub struct LobeError {
    /// Line of the text.
    pub line: Option<usize>,
    /// The reason.
    pub reason: String,
}

/// Columns of a lobe, in any order; others are ignored.
const COLUMNS: [&str; 7] = ["theta_i", "phi_i", "theta_o", "phi_o", "r", "g", "b"];

/// The samples of a CSV text as `luthier eval` prints it. A line of names, `theta_i,phi_i,theta_o,phi_o,r,g,b`, comes first; then each line has
/// angles in degrees and f cos_theta_i in three channels. Other columns are ignored. [`luthier_optics::rows`] has the separators.
///
/// ```
/// let lobe = luthier_layers::beam_fit::samples("theta_i,phi_i,theta_o,phi_o,r,g,b\n30,0,30,180,1,0.9,0.8\n").unwrap();
/// assert_eq!(lobe[0].value, [1.0, 0.9, 0.8]);
/// ```
///
/// # Errors
/// [`LobeError`], whose text continues the name of the file.
pub fn samples(text: &str) -> Result<Vec<Sample>, LobeError> {
    let mut rows =
        rows(text).map(|row| row.map_err(|error| LobeError { line: Some(error.line), reason: error.to_string() }));
    let empty = LobeError { line: None, reason: "no values".to_owned() };
    let names = rows.next().ok_or_else(|| empty.clone())??;
    let mut places = [0; 7];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        let found = names.cells.iter().position(|name| name.to_lowercase() == column);
        *place = found.ok_or_else(|| {
            let reason = format!("no column `{column}`; expected {}", COLUMNS.join(","));
            LobeError { line: Some(names.line), reason }
        })?;
    }
    let mut found = Vec::new();
    for row in rows {
        let row = row?;
        found.push(sample(&row, places).map_err(|reason| LobeError { line: Some(row.line), reason })?);
    }
    if found.is_empty() { Err(empty) } else { Ok(found) }
}

/// The sample of a row whose columns are at `places`, in the order of [`COLUMNS`].
fn sample(row: &Row, places: [usize; 7]) -> Result<Sample, String> {
    let mut numbers = [0.0; 7];
    for ((number, place), column) in numbers.iter_mut().zip(places).zip(COLUMNS) {
        let field = row.cells.get(place).map_or("", String::as_str);
        *number = row.number(place).ok_or_else(|| format!("{column} is `{field}`, expected a number"))?;
    }
    let [theta_i, phi_i, theta_o, phi_o, r, g, b] = numbers;
    for (name, theta) in [("theta_i", theta_i), ("theta_o", theta_o)] {
        if !(0.0..90.0).contains(&theta) {
            return Err(format!("{name} is {theta}, expected 0 to less than 90 degrees"));
        }
    }
    if [r, g, b].iter().any(|value| *value < 0.0) {
        return Err("a value is negative, which no lobe of the model is".to_owned());
    }
    let [wi, wo] =
        [(theta_i, phi_i), (theta_o, phi_o)].map(|(theta_deg, phi_deg)| Angles { theta_deg, phi_deg }.direction());
    Ok(Sample { wi, wo, value: [r, g, b] })
}
