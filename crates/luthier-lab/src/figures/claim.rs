//! Statement that a figure must prove, and the verdict by its numbers.

use luthier_terminal::{Failure, Outcome};

use super::figure::Measured;
use super::page::number;

/// A statement about a figure, and the comparisons of its numbers that decide whether it holds.
#[derive(Clone, Copy)]
pub(crate) struct Claim {
    /// The statement, of the paper where it makes one.
    pub(crate) text: &'static str,
    pub(crate) checks: &'static [Check],
}

/// A comparison of numbers, which it names as the table of the figure does.
#[derive(Clone, Copy)]
pub(crate) enum Check {
    /// Each number is larger than the next.
    Falls(&'static [&'static str]),
    /// A number lies between two, ends included.
    Within(&'static str, f64, f64),
}

/// Whether a claim holds, and the comparisons that say so, with their numbers.
pub(crate) struct Verdict {
    pub(crate) holds: bool,
    /// All comparisons of a claim that holds; of another those that fail.
    pub(crate) because: Vec<String>,
}

impl Claim {
    /// The verdict by numbers.
    pub(crate) fn verdict(&self, figure: &str, measured: &[Measured]) -> Outcome<Verdict> {
        let checked = self.checks.iter().map(|check| check.outcome(figure, measured)).collect::<Outcome<Vec<_>>>()?;
        let holds = checked.iter().all(|(holds, _)| *holds);
        let because = checked.into_iter().filter(|(one, _)| *one == holds).map(|(_, text)| text).collect();
        Ok(Verdict { holds, because })
    }
}

impl Check {
    /// Whether a comparison holds, and its text with the numbers.
    fn outcome(&self, figure: &str, measured: &[Measured]) -> Outcome<(bool, String)> {
        let value = |name: &str| {
            let missing = || {
                Failure::Input(anyhow::anyhow!(
                    "{figure}: the claim is about `{name}`, which was not measured; make the figure anew"
                ))
            };
            measured.iter().find(|m| m.what == name).map(|m| m.value).ok_or_else(missing)
        };
        match *self {
            Self::Falls(names) => {
                let values = names.iter().map(|name| value(name)).collect::<Outcome<Vec<f64>>>()?;
                let holds = values.is_sorted_by(|a, b| a > b);
                let texts: Vec<String> =
                    names.iter().zip(values).map(|(name, value)| format!("{name} {}", number(value))).collect();
                Ok((holds, texts.join(if holds { " > " } else { ", then " })))
            }
            Self::Within(name, from, to) => {
                let value = value(name)?;
                let holds = (from..=to).contains(&value);
                let [value, from, to] = [value, from, to].map(number);
                Ok((holds, format!("{name} {value}, {} {from} to {to}", if holds { "within" } else { "not within" })))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::figures;
    use super::*;

    fn verdict(checks: &'static [Check], values: &[(&str, f64)]) -> Outcome<Verdict> {
        let measured: Vec<Measured> =
            values.iter().map(|(what, value)| Measured { what: (*what).to_owned(), value: *value }).collect();
        Claim { text: "it is so", checks }.verdict("elek-2", &measured)
    }

    #[test]
    fn a_claim_fails_with_its_first_number_that_does() {
        const CHECKS: [Check; 2] = [Check::Falls(&["a", "b", "c"]), Check::Within("a", 2.0, 3.0)];
        let all = verdict(&CHECKS, &[("a", 3.0), ("b", 2.0), ("c", 1.0)]).ok();
        let all = all.filter(|all| all.holds).map(|all| all.because);
        assert_eq!(
            all,
            Some(vec!["a 3.000 > b 2.000 > c 1.000".to_owned(), "a 3.000, within 2.000 to 3.000".to_owned()])
        );
        let one = verdict(&CHECKS, &[("a", 3.0), ("b", 2.0), ("c", 2.0)]).ok();
        let one = one.filter(|one| !one.holds).map(|one| one.because);
        assert_eq!(one, Some(vec!["a 3.000, then b 2.000, then c 2.000".to_owned()]));
        for nothing in [f64::NAN, 3.1, 1.9] {
            assert!(verdict(&CHECKS[1..], &[("a", nothing)]).is_ok_and(|verdict| !verdict.holds), "{nothing}");
        }
        assert!(verdict(&CHECKS, &[("a", 3.0)]).is_err());
    }

    /// A claim without a comparison would hold always.
    #[test]
    fn every_figure_has_a_claim_that_can_fail() {
        for figure in figures() {
            assert!(!figure.claim.checks.is_empty() && figure.claim.text.ends_with('.'), "{}", figure.name);
        }
    }
}
