//! Corrections of numbers outside their range: guesses at the number that was meant.

use crate::grammar::{REFLECTANCES, Range};
use crate::suggest::short;

/// A hint with the corrected value of `name`, which is outside `range`. In a list the value stands alone.
pub(crate) fn corrected(name: &str, range: Range, value: f64, in_list: bool) -> Option<String> {
    let write = |v: f64| {
        // Five digits may round out of the range.
        let short = short(v);
        let text = if short.parse().is_ok_and(|v| range.contains(v)) { short } else { format!("{v}") };
        if in_list { format!("`{text}`") } else { format!("`{name} = {text}`") }
    };
    if !value.is_finite() {
        return None;
    }
    if value < 0.0 && range.min == 0.0 && !matches!(name, "n" | "ior") {
        // Nothing in the file says that the number without its sign was meant.
        return match name {
            "k" if range.contains(-value) => {
                Some(format!("k > 0 absorbs (phase e^{{+i beta}}): write {}", write(-value)))
            }
            _ if REFLECTANCES.contains(&name) => {
                Some("the colour lies outside Rec.709: convert it to linear Rec.709, and clip it there".to_owned())
            }
            _ => Some("a minus makes no sense here: give the number that is meant".to_owned()),
        };
    }
    match name {
        "n" | "ior" if value <= range.min => return Some(format!("vacuum has {}", write(1.0))),
        "alpha" | "alpha_x" | "alpha_y" if value > 1.0 && value <= 45.0 => {
            let slope = short(libm::tan(value.to_radians()));
            return Some(format!("alpha is a slope, not an angle: {} degrees is `{name} = {slope}`", short(value)));
        }
        "roughness" if value > 1.0 && value <= 100.0 => {
            return Some(format!("{} per cent is {}", short(value), write(value / 100.0)));
        }
        "sigma" if value > 0.0 && value <= 90.0 => {
            return Some(format!("sigma is in radians: {} degrees is {}", short(value), write(value.to_radians())));
        }
        "albedo" | "base_color" | "diffuse_albedo" | "f0" | "tarnish" if (3.0..=255.0).contains(&value) => {
            let (share, linear) = (short(value / 255.0), write(srgb_to_linear(value / 255.0)));
            let value = short(value);
            return Some(format!(
                "divide by 255: {value} is {share}, and of an 8-bit sRGB picture {linear} in linear light"
            ));
        }
        "wavelengths_nm" if value < 20.0 && range.contains(value * 1000.0) => {
            return Some(format!("wavelengths are in nm: {} um is {}", short(value), write(value * 1000.0)));
        }
        _ => {}
    }
    let nearest = if value > range.max { range.max } else { range.min };
    range.contains(nearest).then(|| format!("the nearest allowed is {}", write(nearest)))
}

/// IEC 61966-2-1.
fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grammar::{NOT_NEGATIVE, POSITIVE, UNIT};

    fn hint(name: &str, range: Range, value: f64) -> String {
        corrected(name, range, value, false).unwrap()
    }

    #[test]
    fn hints_hold_the_corrected_value() {
        assert!(hint("k", NOT_NEGATIVE, -2.4).contains("`k = 2.4`"));
        assert!(hint("n", POSITIVE, 0.0).contains("`n = 1`"));
        assert!(hint("roughness", UNIT, 35.0).contains("`roughness = 0.35`"));
        assert!(hint("sigma", UNIT, 20.0).contains("`sigma = 0.34907`"));
        assert!(hint("extent", UNIT, 7.0).contains("`extent = 1`"));
        // tan 12 degrees
        assert!(hint("alpha", UNIT, 12.0).contains("`alpha = 0.21256`"));
        // Oracle: sRGB 188 is the code value of linear 0.5029.
        assert!(hint("albedo", UNIT, 188.0).contains("`albedo = 0.50289`"));
        assert!(hint("n", Range { max: 1e6, ..POSITIVE }, 1e300).contains("`n = 1000000`"));
        // Rounded to five digits it would be above the range.
        let below = std::f64::consts::FRAC_PI_2;
        assert!(hint("sigma", Range { max: below, ..UNIT }, 100.0).contains(&format!("`sigma = {below}`")));
        assert_eq!(corrected("alpha", UNIT, f64::NAN, false), None);
        // No sign is dropped but that of k, which is a convention.
        assert!(!hint("thickness_um", NOT_NEGATIVE, -3.0).contains('3'));
        assert!(!hint("albedo", UNIT, -0.2775).contains("0.2775"));
        assert_eq!(corrected("albedo", UNIT, 1.2, true).as_deref(), Some("the nearest allowed is `1`"));
    }
}
