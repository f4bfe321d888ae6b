//! Directions as the command line and lists have them: degrees.

use std::path::Path;
use std::str::FromStr;

use glam::DVec3;
use luthier_terminal::{Failure, Outcome};

use crate::input;

/// Angle from the normal and around it, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Angles {
    pub(crate) theta_deg: f64,
    pub(crate) phi_deg: f64,
}

impl Angles {
    fn new(theta: &str, phi: &str) -> Result<Self, String> {
        let number = |name: &str, text: &str| match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(format!("{name} is `{}`, expected degrees", text.trim())),
        };
        let (theta_deg, phi_deg) = (number("theta", theta)?, number("phi", phi)?);
        if !(0.0..=90.0).contains(&theta_deg) {
            return Err(format!("theta is {theta_deg}, expected 0 to 90 degrees"));
        }
        Ok(Self { theta_deg, phi_deg })
    }

    /// The unit direction.
    pub(crate) fn direction(self) -> DVec3 {
        let (sin_theta, cos_theta) = libm::sincos(self.theta_deg.to_radians());
        let (sin_phi, cos_phi) = libm::sincos(self.phi_deg.to_radians());
        DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
    }

    pub(crate) fn to_array(self) -> [f64; 2] {
        [self.theta_deg, self.phi_deg]
    }
}

impl FromStr for Angles {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (theta, phi) = text.split_once(',').ok_or("expected theta,phi in degrees, such as 30,0")?;
        Self::new(theta, phi)
    }
}

/// Pairs (wi, wo) of a CSV file, or of standard input for `-`. Empty lines and lines that begin with `#` do not count.
pub(crate) fn read(path: &Path) -> Outcome<Vec<[Angles; 2]>> {
    let (text, label) = if path == Path::new("-") {
        (input::standard()?, "standard input".to_owned())
    } else {
        (input::named_text(path)?, path.display().to_string())
    };
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.trim().starts_with('#'));
    let pairs: Vec<_> = lines
        .map(|(i, line)| pair(line).map_err(|what| Failure::Input(anyhow::anyhow!("{label}:{}: {what}", i + 1))))
        .collect::<Outcome<_>>()?;
    if pairs.is_empty() {
        return Err(Failure::Input(anyhow::anyhow!("{label}: no directions")));
    }
    Ok(pairs)
}

fn pair(line: &str) -> Result<[Angles; 2], String> {
    let fields: Vec<&str> = line.split(',').collect();
    let [theta_i, phi_i, theta_o, phi_o] = fields[..] else {
        return Err(format!("expected theta_i,phi_i,theta_o,phi_o, found {} fields", fields.len()));
    };
    let named = |which: &'static str| move |what: String| format!("{which}: {what}");
    let wi = Angles::new(theta_i, phi_i).map_err(named("wi"))?;
    Ok([wi, Angles::new(theta_o, phi_o).map_err(named("wo"))?])
}
