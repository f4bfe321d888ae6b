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

/// A comparison of numbers of the figure, by their names in its table.
#[derive(Clone, Copy)]
pub(crate) enum Check {
    /// Each number is larger than the next.
    Falls(&'static [&'static str]),
    /// A number lies between two, ends included.
    Within(&'static str, f64, f64),
}

/// The outcome of a claim, and the comparisons that decide it, with their numbers.
pub(crate) struct Verdict {
    pub(crate) holds: bool,
    /// All comparisons if the claim holds, else those that fail.
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
        match *self {
            Self::Falls(names) => {
                let values = names.iter().map(|name| value(figure, measured, name)).collect::<Outcome<Vec<f64>>>()?;
                let holds = values.is_sorted_by(|a, b| a > b);
                let texts: Vec<String> =
                    names.iter().zip(values).map(|(name, value)| format!("{name} {}", number(value))).collect();
                Ok((holds, texts.join(if holds { " > " } else { ", then " })))
            }
            Self::Within(name, from, to) => {
                let value = value(figure, measured, name)?;
                let holds = (from..=to).contains(&value);
                let [value, from, to] = [value, from, to].map(number);
                Ok((holds, format!("{name} {value}, {} {from} to {to}", if holds { "within" } else { "not within" })))
            }
        }
    }
}

fn value(figure: &str, measured: &[Measured], name: &str) -> Outcome<f64> {
    measured.iter().find(|m| m.what == name).map(|m| m.value).ok_or_else(|| {
        Failure::Input(anyhow::anyhow!(
            "{figure}: the claim is about `{name}`, which was not measured; make the figure anew"
        ))
    })
}

#[cfg(test)]
mod tests;
