//! Directions as people write them: degrees, on command lines and in lists.

use std::str::FromStr;

use glam::DVec3;
use luthier_optics::rows::{Row, rows};

/// Angle from the normal and around it, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angles {
    /// Angle from the normal, 0 to 90.
    pub theta_deg: f64,
    /// Angle around the normal.
    pub phi_deg: f64,
}

/// Error of a text that is no direction.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct AnglesError(String);

/// Error of a text that is no list of directions: the line, counted from 1, if the error has one, and the reason.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", line.map(|line| format!(":{line}")).unwrap_or_default())]
pub struct PairsError {
    /// Line of the text.
    pub line: Option<usize>,
    /// The reason.
    pub reason: String,
}

impl Angles {
    fn new(theta: &str, phi: &str) -> Result<Self, AnglesError> {
        let (theta_deg, phi_deg) = (degrees("theta", theta)?, degrees("phi", phi)?);
        if !(0.0..=90.0).contains(&theta_deg) {
            return Err(AnglesError(format!("theta is {theta_deg}, expected 0 to 90 degrees")));
        }
        Ok(Self { theta_deg, phi_deg })
    }

    /// The unit direction.
    pub fn direction(self) -> DVec3 {
        let (sin_theta, cos_theta) = libm::sincos(self.theta_deg.to_radians());
        let (sin_phi, cos_phi) = libm::sincos(self.phi_deg.to_radians());
        DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
    }

    /// Both angles, that from the normal first.
    pub fn to_array(self) -> [f64; 2] {
        [self.theta_deg, self.phi_deg]
    }
}

impl FromStr for Angles {
    type Err = AnglesError;

    /// `theta,phi`.
    fn from_str(text: &str) -> Result<Self, AnglesError> {
        let (theta, phi) = text
            .split_once(',')
            .ok_or_else(|| AnglesError("expected theta,phi in degrees, such as 30,0".to_owned()))?;
        Self::new(theta, phi)
    }
}

/// The finite number of one angle; `name` is for the error.
fn degrees(name: &str, text: &str) -> Result<f64, AnglesError> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(AnglesError(format!("{name} is `{}`, expected degrees", text.trim()))),
    }
}

/// Pairs (wi, wo) of a CSV text, a pair in a row of `theta_i,phi_i,theta_o,phi_o`; a first row of names does not count.
/// [`luthier_optics::rows`] has the separators.
///
/// ```
/// let pairs = luthier_layers::angles::pairs("# mirror\n30,0,30,180\n").unwrap();
/// assert_eq!(pairs[0].map(|angles| angles.to_array()), [[30.0, 0.0], [30.0, 180.0]]);
/// ```
///
/// # Errors
/// [`PairsError`], whose text continues the name of the file.
pub fn pairs(text: &str) -> Result<Vec<[Angles; 2]>, PairsError> {
    let mut pairs = Vec::new();
    for (count, row) in rows(text).enumerate() {
        let row = row.map_err(|error| PairsError { line: Some(error.line), reason: error.to_string() })?;
        let is_header = count == 0 && row.cells.iter().map(|name| name.to_lowercase()).eq(COLUMNS);
        if !is_header {
            pairs.push(pair(&row).map_err(|reason| PairsError { line: Some(row.line), reason })?);
        }
    }
    if pairs.is_empty() {
        return Err(PairsError { line: None, reason: "no directions".to_owned() });
    }
    Ok(pairs)
}

const COLUMNS: [&str; 4] = ["theta_i", "phi_i", "theta_o", "phi_o"];

fn pair(row: &Row) -> Result<[Angles; 2], String> {
    if row.cells.len() != COLUMNS.len() {
        return Err(format!("expected {}, found {} fields", COLUMNS.join(","), row.cells.len()));
    }
    let mut angles = [0.0; 4];
    for (i, angle) in angles.iter_mut().enumerate() {
        *angle = row.number(i).ok_or_else(|| format!("{} is `{}`, expected degrees", COLUMNS[i], row.cells[i]))?;
    }
    for i in [0, 2] {
        if !(0.0..=90.0).contains(&angles[i]) {
            return Err(format!("{} is {}, expected 0 to 90 degrees", COLUMNS[i], angles[i]));
        }
    }
    let [theta_i, phi_i, theta_o, phi_o] = angles;
    Ok([[theta_i, phi_i], [theta_o, phi_o]].map(|[theta_deg, phi_deg]| Angles { theta_deg, phi_deg }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As spreadsheets write them.
    #[test]
    fn lists_are_read_in_any_writing() {
        for text in
            ["\u{feff}30,0,45.5,180\r\n", "30;0;45,5;180\r", "Theta_i\tphi_i\ttheta_o\tphi_o\n30\t0\t45,5\t180\n"]
        {
            assert_eq!(pairs(text).unwrap()[0].map(Angles::to_array), [[30.0, 0.0], [45.5, 180.0]], "{text}");
        }
    }

    #[test]
    fn mistakes_are_pointed_at() {
        for (text, expected) in [
            ("# nothing\n", ": no directions"),
            ("\n30,0,30\n", ":2: expected theta_i,phi_i,theta_o,phi_o, found 3 fields"),
            ("30,0,91,0\n", ":1: theta_o is 91, expected 0 to 90 degrees"),
            ("30,0,1,nan\n", ":1: phi_o is `nan`, expected degrees"),
        ] {
            assert_eq!(pairs(text).unwrap_err().to_string(), expected);
        }
        assert_eq!(pairs(&"1,".repeat(10_000)).unwrap_err().line, Some(1));
        assert_eq!("30".parse::<Angles>().unwrap_err().to_string(), "expected theta,phi in degrees, such as 30,0");
    }
}
