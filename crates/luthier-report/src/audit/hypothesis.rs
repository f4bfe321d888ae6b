//! Hypotheses about the contents of a table: a statement with a few mistakes.

use serde::Serialize;

use super::truth::{Term, Truth};
use luthier_table::{AxisSpec, Layout, Nodes};

/// Encoding of values before they were stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Linear,
    /// Values encoded by the sRGB transfer function, as colours are.
    Srgb,
    /// Values encoded by the inverse of the sRGB transfer function: linear values taken for sRGB ones.
    Linearised,
}

impl Encoding {
    pub(super) const ALL: [Self; 3] = [Self::Linear, Self::Srgb, Self::Linearised];

    /// The value before it was encoded. Values outside 0..1 stay, because the transfer functions end there.
    pub(super) fn decode(self, v: f64) -> f64 {
        match self {
            Self::Srgb if v > 0.04045 && v <= 1.0 => libm::pow((v + 0.055) / 1.055, 2.4),
            Self::Srgb if v > 0.0 && v <= 1.0 => v / 12.92,
            Self::Linearised if v > 0.003_130_8 && v <= 1.0 => 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055,
            Self::Linearised if v > 0.0 && v <= 1.0 => v * 12.92,
            _ => v,
        }
    }
}

/// One way in which a table differs from its statement.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mistake {
    /// Kind of the mistake, for programs: `axes`, `flip`, `nodes`, `quantity`, `range`, `model`, `channels`, `encoding`, `clamp`.
    pub kind: &'static str,
    /// Description; it follows the words `fits better as`.
    pub text: String,
}

/// A guess at the contents of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hypothesis {
    pub(super) layout: Layout,
    pub(super) variant: usize,
    pub(super) terms: Vec<Term>,
    pub(super) encoding: Encoding,
    /// Whether values below 0 count as 0.
    pub(super) clamped: bool,
}

impl Hypothesis {
    /// The stored value of a channel, decoded and scaled so that errors of all terms are comparable.
    pub(super) fn comparable(&self, channel: usize, stored: f64, alpha: f64) -> f64 {
        let value = self.encoding.decode(stored) * self.terms[channel].scale(alpha);
        if self.clamped { value.max(0.0) } else { value }
    }

    /// The differences of the hypothesis from the statement.
    pub(super) fn mistakes(&self, stated: &Self, truth: &Truth) -> Vec<Mistake> {
        let mut found = Vec::new();
        let mut add = |kind, text: String| found.push(Mistake { kind, text });
        let (layout, other) = (&self.layout, &stated.layout);
        if layout.transposed != other.transposed {
            add("axes", "axes swapped".to_owned());
        }
        let [across, down] = layout.order().map(|k| if k == 0 { "x" } else { "y" });
        let slopes = layout.slope.zip(other.slope);
        let pairs = [Some((layout.angle, other.angle, across)), slopes.map(|(a, b)| (a, b, down))];
        for (found, stated, place) in pairs.into_iter().flatten() {
            if found.descending != stated.descending {
                add("flip", format!("flipped in {place}"));
            }
        }
        let changed: Vec<_> = pairs.iter().flatten().filter(|(found, stated, _)| found.nodes != stated.nodes).collect();
        match changed.as_slice() {
            [(a, stated, _), (b, other, _)] if a.nodes == b.nodes && stated.nodes == other.nodes => {
                add("nodes", nodes(a, stated, "both axes"));
            }
            each => each.iter().for_each(|(found, stated, place)| add("nodes", nodes(found, stated, place))),
        }
        for (found, stated, _) in pairs.into_iter().flatten() {
            if found.quantity != stated.quantity || (found.mapping != stated.mapping) {
                let (is, should) = (found.quantity.name(), stated.quantity.name());
                let text = if is == should {
                    format!("{is} linear, not as mapped")
                } else {
                    format!("{is} where {should} was stated")
                };
                add("quantity", text);
            }
            // A quantity that was not stated begins at 0 by default.
            let same = found.quantity == stated.quantity && found.mapping == stated.mapping;
            let min = if same { stated.min } else { 0.0 };
            if found.min != min {
                add("range", format!("{} from {} on, not {min}", found.quantity.name(), found.min));
            }
            if found.floor != stated.floor {
                add("range", format!("{} never below {}", found.quantity.name(), found.floor));
            }
        }
        if self.variant != stated.variant {
            add("model", truth.variants[self.variant].clone());
        }
        if self.terms != stated.terms {
            let mut sorted = [self.terms.clone(), stated.terms.clone()];
            sorted.iter_mut().for_each(|terms| terms.sort_by_key(|t| t.name()));
            let [is, should] =
                [&self.terms, &stated.terms].map(|terms| terms.iter().map(|t| t.name()).collect::<Vec<_>>().join(","));
            let swapped = if sorted[0] == sorted[1] { "channels swapped: " } else { "" };
            add("channels", format!("{swapped}{is} where {should} was stated"));
        }
        match self.encoding {
            Encoding::Linear => {}
            Encoding::Srgb => add("encoding", "sRGB-encoded".to_owned()),
            Encoding::Linearised => add("encoding", "linearised as if it had been sRGB".to_owned()),
        }
        if self.clamped {
            add("clamp", "values below 0 not clamped".to_owned());
        }
        found
    }
}

fn nodes(found: &AxisSpec, stated: &AxisSpec, place: &str) -> String {
    let offsets = [found.nodes, stated.nodes].map(|nodes| match nodes {
        Nodes::Offset(offset) => Some(offset - 0.5),
        Nodes::Ends => None,
    });
    match offsets {
        [None, _] => format!("half-texel remap in {place}: the first and last nodes are the ends of the axis"),
        [Some(0.0), None] => format!("no half-texel remap in {place}: nodes are texel centres of 0..1"),
        [Some(by), _] => {
            let size = if by.abs() < 0.75 { "half a texel" } else { "a texel" };
            let way = if by > 0.0 { "high" } else { "low" };
            format!("{size} off in {place}: coordinates too {way}")
        }
    }
}

/// Arrangements of terms over the channels: the stated one first, then all others without repetition.
pub(super) fn arrangements(stated: &[Term], terms: &[Term]) -> Vec<Vec<Term>> {
    let mut all = vec![stated.to_vec()];
    let mut grow: Vec<Vec<Term>> = vec![Vec::new()];
    for _ in stated {
        grow = grow
            .iter()
            .flat_map(|start| terms.iter().filter(|t| !start.contains(t)).map(|t| [start.as_slice(), &[*t]].concat()))
            .collect();
    }
    all.extend(grow.into_iter().filter(|terms| terms != stated));
    all
}
