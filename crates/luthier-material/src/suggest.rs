//! Suggestions for misspelt words, and the formatting of values in messages.

/// Characters of the longest word that can be a misspelt key or name.
const WORD_MAX: usize = 64;

/// The candidate that a misspelt word most likely stands for, if one is close enough: a few edits away, or the word
/// continued (`thickness` for `thickness_um`).
pub fn did_you_mean<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    if word.len() > WORD_MAX {
        return None;
    }
    let word = word.to_lowercase().replace('-', "_");
    let distances = candidates.into_iter().map(|word_of_ours| {
        let candidate = word_of_ours.to_lowercase().replace('-', "_");
        let continued = word.len() >= 3 && candidate.strip_prefix(&word).is_some_and(|rest| rest.starts_with('_'));
        (if continued { 0 } else { strsim::damerau_levenshtein(&word, &candidate) }, word_of_ours)
    });
    let (distance, nearest) = distances.min_by_key(|&(distance, _)| distance)?;
    let allowed = match word.chars().count() {
        0..=2 => 0,
        3..=5 => 1,
        6..=9 => 2,
        _ => 3,
    };
    (distance <= allowed).then_some(nearest)
}

/// A number as a person would write it: at most five significant digits, no trailing zeros. TOML reads it.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = libm::floor(libm::log10(value.abs()));
    if !(-5.0..9.0).contains(&magnitude) {
        let text = format!("{value:.4e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", without_zeros(digits));
    }
    let decimals = (4.0 - magnitude).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { without_zeros(&text).to_owned() } else { text }
}

/// A decimal fraction without the zeros at its end, and without a point that ends it.
fn without_zeros(fraction: &str) -> &str {
    fraction.trim_end_matches('0').trim_end_matches('.')
}

/// Names in backquotes: "`a`, `b` or `c`".
pub(crate) fn one_of(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => format!("`{one}`"),
        [rest @ .., last] => {
            let rest: Vec<String> = rest.iter().map(|name| format!("`{name}`")).collect();
            format!("{} or `{last}`", rest.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        let keys = ["thickness_um", "absorption_per_um", "roughness", "ior"];
        assert_eq!(did_you_mean("rougness", keys), Some("roughness"));
        assert_eq!(did_you_mean("thickness", keys), Some("thickness_um"));
        assert_eq!(did_you_mean("absorbtion_per_um", keys), Some("absorption_per_um"));
        assert_eq!(did_you_mean("colour", keys), None);
        assert_eq!(did_you_mean("", keys), None);
        assert_eq!(did_you_mean("x", []), None);
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.5, "0.5"),
            (1.0, "1"),
            (0.09, "0.09"),
            (0.349_065_85, "0.34907"),
            (123_456.0, "123456"),
            (0.0, "0"),
            (-2.4, "-2.4"),
            (1e-5, "0.00001"),
            (1e300, "1e300"),
            (-1.25e-12, "-1.25e-12"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}
