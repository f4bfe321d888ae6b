//! Numbers and names for readers.

use luthier_lut::{Axis, Mapping};
use luthier_manifest::{LayerKind, LayerRecord};

/// An error in three significant digits: `1.23e-4`; plain from a hundredth to a hundred.
pub(crate) fn error(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if !value.is_finite() {
        "not finite".to_owned()
    } else if (0.01..100.0).contains(&value.abs()) {
        significant(value, 3)
    } else {
        format!("{value:.2e}")
    }
}

/// An error with its standard error, where it has one: `1.23e-4 ± 2e-6`.
pub(crate) fn uncertain(value: f64, standard_error: Option<f64>) -> String {
    match standard_error {
        Some(e) if e > 0.0 => format!("{} ± {e:.0e}", error(value)),
        _ => error(value),
    }
}

/// A value in five significant digits, for comparison with others.
pub(crate) fn value(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) { number(rounded(value, 5)) } else { format!("{value:.4e}") }
}

/// A quantity in at most six significant digits, without trailing zeros.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    if !(1e-4..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let text = significant(value, 6);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn significant(value: f64, digits: i32) -> String {
    let magnitude = libm::floor(libm::log10(value.abs())) as i32;
    let decimals = (digits - 1 - magnitude).max(0) as usize;
    format!("{value:.decimals$}")
}

/// A value rounded to a number of significant decimal digits. It is short in JSON; charts need no more.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A dash, for a missing value.
pub(crate) fn none() -> String {
    "–".to_owned()
}

/// A size: `6.0 KiB`.
pub(crate) fn bytes(count: u64) -> String {
    let units = [(1 << 20, "MiB"), (1 << 10, "KiB")];
    match units.into_iter().find(|(unit, _)| count >= *unit) {
        Some((unit, name)) => format!("{:.1} {name}", count as f64 / unit as f64),
        None => format!("{count} B"),
    }
}

/// A layer in words.
pub(crate) fn layer(record: &LayerRecord) -> String {
    let film = if record.film_thickness_max_nm > 0.0 {
        format!(", film {} nm", number(record.film_thickness_nm))
    } else {
        String::new()
    };
    let surface = format!("{} alpha {}", record.distribution.name(), number(record.alpha));
    match record.kind {
        LayerKind::Dielectric => format!("dielectric, index ratio {}, {surface}{film}", number(record.eta)),
        LayerKind::Conductor => format!("conductor, {surface}{film}"),
        LayerKind::Diffuse if record.sigma > 0.0 => format!("Oren-Nayar base, sigma {} rad", number(record.sigma)),
        LayerKind::Diffuse => "Lambert base".to_owned(),
    }
}

/// An axis in words: quantity, range, nodes and mapping.
pub(crate) fn axis(axis: &Axis) -> String {
    let mapping = match axis.mapping {
        Mapping::Linear => "linear".to_owned(),
        Mapping::Power { exponent } => format!("u^{}", number(exponent)),
        Mapping::Rational { bend } => format!("bent by {}", number(bend)),
        Mapping::Logarithmic => "logarithmic".to_owned(),
        Mapping::Periodic => "periodic".to_owned(),
        Mapping::Apart => "apart".to_owned(),
    };
    let unit = if axis.unit.is_empty() { String::new() } else { format!(" {}", axis.unit) };
    let (min, max) = (number(axis.min), number(axis.max));
    format!("{} {min} to {max}{unit}, {} nodes, {mapping}", axis.quantity, axis.size)
}

/// Text for HTML or SVG, in content and in attributes.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // XML does not allow control characters, and they are invisible.
            c if c.is_control() && c != '\n' && c != '\t' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A pair of directions in words.
pub(crate) fn angles(wi: [f32; 3], wo: [f32; 3]) -> String {
    let [phi_i, phi_o] = [wi, wo].map(|w| libm::atan2(f64::from(w[1]), f64::from(w[0])).to_degrees());
    let turn = libm::fabs(libm::remainder(phi_o - phi_i, 360.0));
    format!("θᵢ\u{a0}{}°, θₒ\u{a0}{}°, Δφ\u{a0}{:.1}°", number_deg(theta_deg(wi)), number_deg(theta_deg(wo)), turn)
}

/// Angle of a direction to the normal.
pub(crate) fn theta_deg(w: [f32; 3]) -> f64 {
    // Tangential part and height together keep all digits: the arc cosine loses them near the normal, and an f32 sine near the horizon.
    let [x, y, z] = w.map(f64::from);
    libm::atan2(libm::hypot(x, y), z).to_degrees()
}

/// An angle in degrees, to four decimals.
pub(crate) fn number_deg(degrees: f64) -> String {
    number((degrees * 1e4).round() / 1e4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_three_digits() {
        let cases = [(0.0, "0"), (1.2345e-4, "1.23e-4"), (0.012345, "0.0123"), (1.0, "1.00"), (3141.6, "3.14e3")];
        for (value, text) in cases {
            assert_eq!(error(value), text);
        }
        assert_eq!(error(f64::INFINITY), "not finite");
    }

    #[test]
    fn numbers_drop_trailing_zeros() {
        for (value, text) in [(0.25, "0.25"), (1.0, "1"), (100.0, "100"), (2.345_678_9, "2.34568"), (1e-6, "1.000e-6")]
        {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn values_have_five_digits() {
        for (value, text) in [(0.171_237_89, "0.17124"), (19.755_844, "19.756"), (58_234_140.0, "5.8234e7"), (0.0, "0")]
        {
            assert_eq!(super::value(value), text);
        }
    }

    #[test]
    fn rounding_keeps_significant_digits() {
        for (value, digits, expected) in [(0.123_456, 3, 0.123), (-98_765.0, 2, -99_000.0), (0.0, 4, 0.0)] {
            assert_eq!(rounded(value, digits), expected);
        }
        assert!(rounded(f64::NAN, 4).is_nan());
    }

    #[test]
    fn sizes_have_units() {
        assert_eq!([bytes(384), bytes(6144), bytes(1 << 20)], ["384 B", "6.0 KiB", "1.0 MiB"]);
    }

    #[test]
    fn markup_is_text() {
        assert_eq!(escape("<a href=\"x\">&'\u{7}"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;\u{fffd}");
    }
}
