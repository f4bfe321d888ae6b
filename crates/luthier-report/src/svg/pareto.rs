//! Chart of price against error: cost or bytes.

use super::frame::{Frame, Margin, Series};
use super::scale::Scale;

/// Errors below this share the end of an axis.
const SMALLEST: f64 = 1e-9;

/// Room for a label, across and down. A label nearer to another one is left out; the tooltip has it.
const LABEL: [f64; 2] = [100.0, 13.0];

/// A thing that could be chosen.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Choice {
    /// Cost or bytes of the choice.
    pub(crate) price: f64,
    /// Its error.
    pub(crate) error: f64,
    /// Description of the choice.
    pub(crate) tip: String,
    /// A word beside its mark, if there is room for it.
    pub(crate) label: &'static str,
    /// Colour and mark of the choice.
    pub(crate) series: Series,
    /// Whether it was chosen.
    pub(crate) is_chosen: bool,
}

/// The axis of prices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Price {
    /// Bytes, logarithmic. Zero bytes sit at the left end.
    Bytes,
    /// Operations or cycles, from 0.
    Cost,
}

/// A chart of all choices. A line connects those that no other beats in both price and error; a ring marks the chosen one; another line shows the limit
/// on the error.
pub(crate) fn pareto(
    label: &str,
    kind: Price,
    [x_title, y_title]: [&str; 2],
    choices: &[Choice],
    limit: Option<(f64, &str)>,
) -> String {
    let finite: Vec<&Choice> = choices.iter().filter(|c| c.error.is_finite() && c.price.is_finite()).collect();
    let prices = finite.iter().map(|c| c.price);
    let x = match kind {
        Price::Bytes => Scale::decades(prices, 1.0),
        Price::Cost => Scale::round(prices),
    };
    let y = Scale::decades(finite.iter().map(|c| c.error).chain(limit.map(|l| l.0)), SMALLEST);
    let margin = Margin { left: 44.0, right: 16.0, top: 24.0, bottom: 38.0 };
    let mut frame = Frame::new([490.0, 250.0], margin, x, y);
    frame.x_axis(x_title);
    frame.y_axis(y_title);
    if let Some((limit, name)) = limit {
        frame.rule_y(limit, name);
    }
    let stairs = front(&finite);
    // Stairs: between two prices, the cheaper choice is the best.
    let corners = stairs.iter().zip(stairs.iter().skip(1).map(Some).chain([None]));
    let steps = corners.flat_map(|(c, next)| [Some((c.price, c.error)), next.map(|n| (n.price, c.error))]);
    frame.line("front", "best for its price", steps.flatten().map(Some));
    for choice in &finite {
        let (x, y) = (frame.px(choice.price), frame.py(choice.error));
        frame.mark(choice.series, x, y, &choice.tip);
    }
    let mut labels: Vec<[f64; 2]> = Vec::new();
    let (chosen, others): (Vec<&Choice>, Vec<&Choice>) = finite.iter().partition(|c| c.is_chosen);
    for choice in chosen.iter().chain(&others).filter(|c| !c.label.is_empty()) {
        let at = [frame.px(choice.price), frame.py(choice.error)];
        if labels.iter().all(|l| (l[0] - at[0]).abs() > LABEL[0] || (l[1] - at[1]).abs() > LABEL[1]) {
            frame.text(at[0] + 8.0, at[1] - 8.0, "start", "tick", choice.label);
            labels.push(at);
        }
    }
    for choice in chosen {
        frame.ring(frame.px(choice.price), frame.py(choice.error));
    }
    frame.finish(label)
}

/// The choices that no other beats in price and error, cheapest first.
fn front<'a>(choices: &[&'a Choice]) -> Vec<&'a Choice> {
    let mut sorted: Vec<&Choice> = choices.to_vec();
    sorted.sort_by(|a, b| a.price.total_cmp(&b.price).then(a.error.total_cmp(&b.error)));
    let mut best = f64::INFINITY;
    sorted.retain(|c| {
        let is_better = c.error < best;
        best = best.min(c.error);
        is_better
    });
    sorted
}

#[cfg(test)]
mod tests {
    use super::super::frame::Mark;
    use super::*;

    fn choice(price: f64, error: f64) -> Choice {
        let series = Series { class: "s-tables", name: "", mark: Mark::Circle };
        Choice { price, error, tip: format!("{price}"), label: "", series, is_chosen: price == 2.0 }
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let all = [choice(3.0, 0.1), choice(1.0, 0.5), choice(2.0, 0.6), choice(3.0, 0.2), choice(2.0, 0.3)];
        let refs: Vec<&Choice> = all.iter().collect();
        let found: Vec<(f64, f64)> = front(&refs).iter().map(|c| (c.price, c.error)).collect();
        assert_eq!(found, [(1.0, 0.5), (2.0, 0.3), (3.0, 0.1)]);
    }

    #[test]
    fn every_choice_is_drawn_and_the_chosen_one_ringed() {
        let all = [choice(0.0, 0.5), choice(2.0, 0.3), choice(3.0, f64::INFINITY)];
        let svg = pareto("bytes", Price::Bytes, ["bytes", "error"], &all, Some((0.4, "limit")));
        assert_eq!(svg.matches("<circle class=\"mark").count(), 2, "what is not finite has no place");
        assert_eq!(svg.matches("class=\"chosen\"").count(), 1);
        assert!(svg.contains(">limit<"));
    }
}
