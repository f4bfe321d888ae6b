//! Numbers on the command line: each with its range, and a sentence that expects it.

/// A wavelength of visible light, nm.
pub(crate) fn wavelength(text: &str) -> Result<f64, String> {
    let nm = number(text).ok().filter(|nm| (360.0..=830.0).contains(nm));
    nm.ok_or_else(|| "expected a wavelength from 360 to 830 nm".to_owned())
}

/// An angle from the normal, degrees.
pub(crate) fn angle(text: &str) -> Result<f64, String> {
    let angle = number(text.trim()).ok().filter(|angle| (0.0..=90.0).contains(angle));
    angle.ok_or_else(|| "expected an angle from 0 to 90 degrees".to_owned())
}

/// A positive number.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|x| *x > 0.0).ok_or_else(|| "expected a positive number, such as 1e-3".to_owned())
}

/// A finite number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| "expected a number".to_owned())
}

/// A number from 0 up.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|x| *x >= 0.0).ok_or_else(|| "expected a number from 0 up".to_owned())
}

/// A number from 0 to 1.
pub(crate) fn share(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|x| (0.0..=1.0).contains(x)).ok_or_else(|| "expected a number from 0 to 1".to_owned())
}
