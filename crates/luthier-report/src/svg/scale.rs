//! Scales from values to pixels, and their ticks.

use crate::text::format::{number, rounded};

/// One axis of a chart.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    min: f64,
    max: f64,
    log: bool,
    /// Distance of labelled ticks on a linear scale. On a logarithmic scale 0 means ticks at 1, 2 and 5 of each decade; other values mean whole decades.
    step: f64,
}

impl Scale {
    /// Linear from `min` to `max` with a tick every `step`.
    pub(crate) fn linear(min: f64, max: f64, step: f64) -> Self {
        Self { min, max, log: false, step }
    }

    /// A scale from 0 to a round number that holds all values, with at most six ticks.
    pub(crate) fn round(values: impl Iterator<Item = f64>) -> Self {
        let largest = values.filter(|v| v.is_finite()).fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let power = libm::pow(10.0, libm::floor(libm::log10(largest / 5.0)));
        let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
        let step = steps.into_iter().find(|step| largest / step <= 5.0 + 1e-9).unwrap_or(10.0 * power);
        Self::linear(0.0, step * libm::ceil(largest / step - 1e-9), step)
    }

    /// The scale for the page's script: kind and ends. Ends of a logarithmic scale are exponents of ten.
    pub(crate) fn describe(&self) -> String {
        format!("{} {} {}", if self.log { "log" } else { "lin" }, self.min, self.max)
    }

    /// Logarithmic over whole decades that hold all positive values; at least one decade, none below `smallest`.
    pub(crate) fn decades(values: impl Iterator<Item = f64>, smallest: f64) -> Self {
        let mut range: Option<(f64, f64)> = None;
        for value in values.filter(|v| *v > 0.0 && v.is_finite()) {
            let value = value.max(smallest);
            range = Some(range.map_or((value, value), |(lo, hi)| (lo.min(value), hi.max(value))));
        }
        let (lo, hi) = range.unwrap_or((1e-4, 1e-3));
        let first = libm::floor(libm::log10(lo) + 1e-9);
        let last = libm::ceil(libm::log10(hi) - 1e-9).max(first + 1.0);
        Self { min: first, max: last, log: true, step: 1.0 }
    }

    /// Logarithmic from the last 1, 2 or 5 of a decade before all positive values to the first behind them, labelled there.
    pub(crate) fn fine(values: impl Iterator<Item = f64>) -> Self {
        let logs = values.filter(|v| *v > 0.0 && v.is_finite()).map(libm::log10);
        let range = logs
            .fold(None, |range: Option<(f64, f64)>, v| Some(range.map_or((v, v), |(lo, hi)| (lo.min(v), hi.max(v)))));
        let (lo, hi) = range.unwrap_or((0.0, 1.0));
        let ticks: Vec<f64> = fine_ticks(lo - 1.0, hi + 1.0).map(|(v, _)| v).collect();
        let min = ticks.iter().copied().filter(|v| *v <= lo - 0.02).fold(lo - 1.0, f64::max);
        let max = ticks.iter().copied().filter(|v| *v >= hi + 0.02).fold(hi + 1.0, f64::min);
        Self { min, max, log: true, step: 0.0 }
    }

    /// Position in 0..1; values beyond the ends, and zero on a logarithmic scale, sit at the end.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        let v = match (self.log, value > 0.0) {
            (true, true) => libm::log10(value),
            (true, false) => self.min,
            (false, _) => value,
        };
        ((v - self.min) / (self.max - self.min)).clamp(0.0, 1.0)
    }

    /// Position in 0..1 and label of every tick; on a logarithmic scale at most eight.
    pub(crate) fn ticks(&self) -> Vec<(f64, String)> {
        let span = self.max - self.min;
        if self.log && self.step == 0.0 {
            let ticks = fine_ticks(self.min - 1e-9, self.max + 1e-9);
            return ticks.map(|(v, label)| ((v - self.min) / span, label)).collect();
        }
        let step = if self.log { libm::ceil(span / 7.0) } else { self.step };
        let count = libm::floor(span / step + 1e-9) as u32;
        (0..=count)
            .map(|i: u32| {
                let v = self.min + f64::from(i) * step;
                let label = if self.log { power_of_ten(v as i32) } else { number((v * 1e9).round() / 1e9) };
                ((v - self.min) / span, label)
            })
            .collect()
    }
}

/// Logarithms of 1, 2 and 5 of every decade within two others, and the numbers.
fn fine_ticks(min: f64, max: f64) -> impl Iterator<Item = (f64, String)> {
    let decades = libm::floor(min) as i32..=libm::ceil(max) as i32;
    let ticks = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| (digit, decade)));
    ticks.filter_map(move |(digit, decade)| {
        let v = f64::from(decade) + libm::log10(digit);
        let (unit, shift) = match decade {
            6.. => ("M", 6),
            4 | 5 => ("k", 3),
            _ => ("", 0),
        };
        let scaled = digit * libm::pow(10.0, f64::from(decade - shift));
        let label = number(rounded(scaled, 3)) + unit;
        (min..=max).contains(&v).then_some((v, label))
    })
}

/// `10⁻⁴`.
fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    if exponent == 0 {
        return "1".to_owned();
    }
    let mut out = String::from("10");
    for c in exponent.to_string().chars() {
        out.push(c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize]));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_hold_their_values() {
        let s = Scale::decades([3e-5, 2e-3, 0.0, f64::NAN].into_iter(), 1e-9);
        assert_eq!(s.ticks().iter().map(|t| t.1.as_str()).collect::<Vec<_>>(), ["10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"]);
        assert!((s.fraction(1e-4) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!((s.fraction(0.0), s.fraction(5.0)), (0.0, 1.0));
    }

    #[test]
    fn an_empty_scale_is_still_a_scale() {
        assert_eq!(Scale::decades(std::iter::empty(), 1e-9).ticks().len(), 2);
    }

    #[test]
    fn round_scales_hold_their_values() {
        for (largest, end, ticks) in [(113.0, 150.0, 4), (0.42, 0.5, 6), (1000.0, 1000.0, 6), (0.0, 1.0, 6)] {
            let s = Scale::round([largest, f64::NAN].into_iter());
            assert!((s.max - end).abs() < 1e-9 && s.ticks().len() == ticks, "{largest}: {s:?}");
        }
    }

    #[test]
    fn fine_scales_end_at_round_numbers() {
        let s = Scale::fine([26.0, 413.0, 0.0, f64::INFINITY].into_iter());
        assert_eq!(s.ticks().into_iter().map(|t| t.1).collect::<Vec<_>>(), ["20", "50", "100", "200", "500"]);
        assert!((s.fraction(100.0) - 0.5).abs() < 1e-12, "20 and 500 are as far from 100");
        assert_eq!(s.fraction(0.0), 0.0);
        let s = Scale::fine([15_000.0, 4.2e6].into_iter());
        let labels: Vec<String> = s.ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(labels, ["10k", "20k", "50k", "100k", "200k", "500k", "1M", "2M", "5M"]);
        assert!(Scale::fine(std::iter::empty()).ticks().len() > 3);
    }

    #[test]
    fn linear_ticks() {
        let s = Scale::linear(0.0, 90.0, 30.0);
        assert_eq!(s.ticks().into_iter().map(|t| t.1).collect::<Vec<_>>(), ["0", "30", "60", "90"]);
    }
}
