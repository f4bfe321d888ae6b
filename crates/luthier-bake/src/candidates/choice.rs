//! The choice among candidates, and its report.

use std::cmp::Ordering;

use luthier_lut::TableKind;
use luthier_manifest::{Budget, Candidate, CandidateForm, Decision, MeasuredError, Search};
use thiserror::Error;

use super::Found;

/// Why no candidates hold a budget.
#[derive(Debug, Error)]
pub(crate) enum Refusal {
    /// No candidate of one kind is good enough.
    #[error("no table is good enough; nearest: {words}; `{hint}` would do")]
    Error {
        /// Place of the kind among those found, and place of the nearest candidate in it.
        nearest: (usize, usize),
        /// Names of the limits that it exceeds.
        limits: Vec<&'static str>,
        /// The candidate in words.
        words: String,
        /// Limits that this candidate would hold.
        hint: String,
    },
    /// Candidates are good enough, but together too large or too slow.
    #[error("{reason} {limit} allows; `{hint}` would do")]
    Whole {
        /// Name of the limit.
        limit: &'static str,
        /// Words for the quantity of a limit, before its value.
        reason: String,
        /// A limit that would be met.
        hint: String,
    },
}

/// The Pareto front: candidates that no other beats or equals in bytes, cost and errors at once. The first of equals
/// stays.
fn front(candidates: &[Candidate]) -> Vec<usize> {
    (0..candidates.len()).filter(|&i| !is_beaten(candidates, i)).collect()
}

fn is_beaten(candidates: &[Candidate], i: usize) -> bool {
    let mut others = candidates.iter().enumerate().filter(|(j, _)| *j != i);
    others.any(|(j, other)| beats(other, &candidates[i]) && (j < i || !beats(&candidates[i], other)))
}

/// Whether a candidate is as good as another in each respect, or better.
fn beats(a: &Candidate, b: &Candidate) -> bool {
    // Rows of lobes have errors of their own in place of an absolute one.
    let errors = |c: &Candidate| [Some(c.error.max_abs), c.error.lobe, c.error.albedo].map(Option::unwrap_or_default);
    let is_as_exact = errors(a).iter().zip(errors(b)).all(|(a, b)| *a <= b);
    a.bytes <= b.bytes && a.cost <= b.cost && is_as_exact
}

/// Bytes first, then cost, then error.
fn cheaper(a: &Candidate, b: &Candidate) -> Ordering {
    a.bytes.cmp(&b.bytes).then_with(|| a.cost.total_cmp(&b.cost).then(a.error.max_abs.total_cmp(&b.error.max_abs)))
}

/// One candidate for each kind. Together they hold the budget with the fewest bytes, then with the lowest cost; of lobes alone with the lowest cost, then with the
/// fewest bytes. `fixed_bytes` is the size of the tables that are not searched.
///
/// Without a limit on errors, the limit is the least absolute error that bytes and cost allow.
///
/// # Errors
/// [`Refusal`] when no combination holds. It names the nearest candidate and a limit that could be met.
pub(crate) fn choose(found: &[Found], budget: &Budget, fixed_bytes: u64) -> Result<Vec<usize>, Refusal> {
    if budget.limits_errors() {
        let chosen = cheapest(found, budget, fixed_bytes, &|c| holds(c, budget));
        return chosen.ok_or_else(|| nearest(found, budget, fixed_bytes));
    }
    let mut limits: Vec<f64> = found.iter().flat_map(|f| f.candidates.iter().map(|c| c.error.max_abs)).collect();
    limits.sort_by(f64::total_cmp);
    limits.dedup();
    // The smallest limit that works: every larger one works too.
    let first = limits.partition_point(|&limit| within(found, budget, fixed_bytes, limit).is_none());
    let chosen = limits.get(first).and_then(|&limit| within(found, budget, fixed_bytes, limit));
    chosen.ok_or_else(|| nearest(found, budget, fixed_bytes))
}

/// The cheapest combination of candidates whose absolute errors are at most `max_abs`.
fn within(found: &[Found], budget: &Budget, fixed_bytes: u64, max_abs: f64) -> Option<Vec<usize>> {
    cheapest(found, budget, fixed_bytes, &|c| c.error.max_abs <= max_abs)
}

/// Whether the errors of a candidate hold a budget.
fn holds(candidate: &Candidate, budget: &Budget) -> bool {
    budget.excess(&candidate.error) <= 1.0
}

/// The cheapest candidate of each kind within the budget; the one that exceeds it least where none is.
pub(crate) fn best_effort(found: &[Found], budget: &Budget) -> Vec<usize> {
    let choices = found.iter().map(|f| {
        let best = (0..f.candidates.len()).min_by(|&i, &j| {
            let candidates = [i, j].map(|i| &f.candidates[i]);
            let [a, b] = candidates.map(|c| budget.excess(&c.error).max(1.0));
            a.total_cmp(&b).then(cheaper(candidates[0], candidates[1]))
        });
        best.unwrap_or_default()
    });
    choices.collect()
}

/// The candidates of a lock, if it has one of each kind and they hold the budget together.
pub(crate) fn locked(found: &[Found], lock: &[Decision], budget: &Budget, fixed_bytes: u64) -> Option<Vec<usize>> {
    let places = found.iter().map(|found| {
        let decision = lock.iter().find(|decision| decision.kind == found.kind)?;
        found.candidates.iter().position(|candidate| candidate.form == decision.candidate.form)
    });
    let places: Vec<usize> = places.collect::<Option<_>>()?;
    let chosen: Vec<&Candidate> = found.iter().zip(&places).map(|(found, &place)| &found.candidates[place]).collect();
    let bytes = fixed_bytes + chosen.iter().map(|candidate| candidate.bytes).sum::<u64>();
    let cost = chosen.iter().map(|candidate| candidate.cost).sum::<f64>();
    let holds = chosen.iter().all(|candidate| holds(candidate, budget))
        && budget.max_bytes.is_none_or(|most| bytes <= most)
        && budget.max_cost.is_none_or(|most| cost <= most);
    (holds && !places.is_empty()).then_some(places)
}

/// The cheapest combination of candidates that pass `holds`, within the limits on bytes and cost.
fn cheapest(
    found: &[Found],
    budget: &Budget,
    fixed_bytes: u64,
    holds: &dyn Fn(&Candidate) -> bool,
) -> Option<Vec<usize>> {
    // Pareto fronts in bytes and cost, combined kind by kind and sorted by bytes: a dominated part can never be in the
    // cheapest whole.
    let mut partial: Vec<(u64, f64, Vec<usize>)> = vec![(fixed_bytes, 0.0, Vec::new())];
    for kind in found {
        let mut order: Vec<usize> = (0..kind.candidates.len()).filter(|&i| holds(&kind.candidates[i])).collect();
        order.sort_by(|&a, &b| cheaper(&kind.candidates[a], &kind.candidates[b]));
        let mut least = f64::INFINITY;
        order.retain(|&i| {
            let cost = kind.candidates[i].cost;
            let is_less = cost < least;
            least = least.min(cost);
            is_less
        });
        let combined = partial.iter().flat_map(|(bytes, cost, chosen)| {
            order.iter().map(move |&i| {
                let c = &kind.candidates[i];
                (bytes + c.bytes, cost + c.cost, [chosen.as_slice(), &[i]].concat())
            })
        });
        let mut combined: Vec<_> = combined.collect();
        combined.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut least = f64::INFINITY;
        combined.retain(|(_, cost, _)| {
            let is_less = *cost < least;
            least = least.min(*cost);
            is_less
        });
        partial = combined;
    }
    let mut within = partial.into_iter().filter(|(bytes, cost, _)| {
        budget.max_bytes.is_none_or(|max| *bytes <= max) && budget.max_cost.is_none_or(|max| *cost <= max)
    });
    // Rows of lobes are small, and each part of them is read at each place: the lowest cost wins, which is last.
    let is_of_lobes = found.iter().all(|kind| kind.kind == TableKind::Lobes);
    let chosen = if is_of_lobes { within.next_back() } else { within.next() };
    chosen.map(|(_, _, chosen)| chosen)
}

/// The reason why no combination holds, the nearest candidate, and a limit that could be met.
fn nearest(found: &[Found], budget: &Budget, fixed_bytes: u64) -> Refusal {
    // First reason: one kind has no candidate with small enough errors, whatever its bytes and cost.
    for (number, kind) in found.iter().enumerate() {
        let candidates = kind.candidates.iter().enumerate();
        let best = candidates
            .min_by(|(_, a), (_, b)| budget.excess(&a.error).total_cmp(&budget.excess(&b.error)).then(cheaper(a, b)));
        if let Some((choice, best)) = best.filter(|(_, c)| !holds(c, budget)) {
            let (mut limits, mut would) = (Vec::new(), Vec::new());
            for (name, limit, error) in [
                ("max_abs", budget.max_abs, Some(best.error.max_abs)),
                ("max_rel", budget.max_rel, Some(best.error.max_rel)),
                ("delta_e", budget.delta_e, best.error.delta_e),
                ("max_lobe_err", budget.max_lobe_err, best.error.lobe),
                ("max_albedo_err", budget.max_albedo_err, best.error.albedo),
            ] {
                if let (Some(limit), Some(error)) = (limit, error)
                    && error > limit
                {
                    limits.push(name);
                    would.push(format!("{name} = {}", above(error)));
                }
            }
            let (form, errors) = (in_words(&best.form), errors_in_words(&best.error));
            return Refusal::Error {
                nearest: (number, choice),
                limits,
                words: format!("{form}, {} bytes, {errors}", best.bytes),
                hint: would.join(" and "),
            };
        }
    }
    // Second reason: the errors are small enough, but bytes or cost are too high. Reported is the least of the two that
    // errors allow.
    let least_cost: f64 = found
        .iter()
        .map(|f| f.candidates.iter().filter(|c| holds(c, budget)).map(|c| c.cost).fold(f64::INFINITY, f64::min))
        .sum();
    if budget.max_cost.is_some_and(|max| least_cost > max) {
        return Refusal::Whole {
            limit: "max_cost",
            reason: format!("look-ups cost at least {least_cost:.0}, more than"),
            hint: format!("max_cost = {}", libm::ceil(least_cost)),
        };
    }
    let within_cost = Budget { max_bytes: None, ..*budget };
    let least = cheapest(found, &within_cost, fixed_bytes, &|c| holds(c, budget)).map_or(fixed_bytes, |chosen| {
        fixed_bytes + found.iter().zip(chosen).map(|(f, i)| f.candidates[i].bytes).sum::<u64>()
    });
    let kept = if fixed_bytes > 0 {
        format!(", {fixed_bytes} of them in tables that are not searched")
    } else {
        String::new()
    };
    Refusal::Whole {
        limit: "max_bytes",
        reason: format!("tables take at least {least} bytes{kept}, more than"),
        hint: format!("max_bytes = {least}"),
    }
}

/// The report of a search.
pub(crate) fn report(found: &Found, chosen: usize, budget: &Budget) -> Search {
    let keep = front(&found.candidates);
    let mut front: Vec<(usize, &Candidate)> = keep.iter().map(|&i| (i, &found.candidates[i])).collect();
    if !keep.contains(&chosen) {
        front.push((chosen, &found.candidates[chosen]));
    }
    front.sort_by(|(_, a), (_, b)| cheaper(a, b));
    Search {
        kind: found.kind,
        budget: *budget,
        chosen: front.iter().position(|(i, _)| *i == chosen).unwrap_or(0),
        measured: found.candidates.len() as u32,
        front: front.into_iter().map(|(_, c)| c.clone()).collect(),
    }
}

/// The value rounded up to two digits. The factor keeps a value that is round already from being raised by its last
/// bit.
fn above(value: f64) -> String {
    let step = libm::pow(10.0, libm::floor(libm::log10(value)) - 1.0);
    format!("{:.1e}", libm::ceil(value / step * (1.0 - 1e-9)) * step)
}

/// A candidate, for messages.
fn in_words(form: &CandidateForm) -> String {
    match form {
        CandidateForm::ClosedForm => "closed form".to_owned(),
        CandidateForm::Table { x, y, format, .. } => {
            let rows = y.as_ref().map_or(1, |y| y.size);
            format!("{} x {rows} {format}", x.size)
        }
    }
}

/// The errors of a candidate, for messages.
fn errors_in_words(error: &MeasuredError) -> String {
    match (error.lobe, error.albedo) {
        (Some(lobe), Some(albedo)) => format!("lobe error {lobe:.3}, error of the albedo {albedo:.4}"),
        _ => format!("error {:.2e}", error.max_abs),
    }
}

#[cfg(test)]
mod tests {
    use luthier_lut::TableKind;

    use super::*;

    fn candidate(bytes: u64, cost: f64, max_abs: f64) -> Candidate {
        let error = MeasuredError { max_abs, max_rel: max_abs, ..MeasuredError::default() };
        Candidate { form: CandidateForm::ClosedForm, bytes, cost, error }
    }

    fn kind(candidates: &[(u64, f64, f64)]) -> Found {
        let candidates = candidates.iter().map(|&(b, c, e)| candidate(b, c, e)).collect();
        Found::new(TableKind::Fresnel, 0.0, candidates)
    }

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let candidates =
            kind(&[(10, 1.0, 0.5), (20, 1.0, 0.5), (20, 1.0, 0.1), (5, 9.0, 0.5), (20, 1.0, 0.1)]).candidates;
        assert_eq!(front(&candidates), [0, 2, 3]);
    }

    /// Rows of lobes have no absolute error: their front is by lobe error and albedo error.
    #[test]
    fn the_front_of_lobes_is_by_their_errors() {
        let of = |cost, lobe, albedo| {
            let Candidate { form, bytes, .. } = candidate(1, cost, 0.0);
            let error = MeasuredError { lobe: Some(lobe), albedo: Some(albedo), ..MeasuredError::default() };
            Candidate { form, bytes, cost, error }
        };
        let candidates = [of(1.0, 0.3, 0.01), of(2.0, 0.1, 0.01), of(3.0, 0.2, 0.02), of(4.0, 0.2, 0.001)];
        assert_eq!(front(&candidates), [0, 1, 3]);
    }

    #[test]
    fn bytes_come_before_cost_and_limits_hold_together() {
        let found = [kind(&[(10, 9.0, 0.1), (20, 1.0, 0.1), (1, 1.0, 0.9)]), kind(&[(10, 9.0, 0.1), (30, 1.0, 0.01)])];
        let errors = Budget { max_abs: Some(0.2), ..Budget::default() };
        assert_eq!(choose(&found, &errors, 0).unwrap(), [0, 0]);
        assert_eq!(choose(&found, &Budget { max_cost: Some(10.0), ..errors }, 0).unwrap(), [1, 0]);
        assert_eq!(choose(&found, &Budget { max_cost: Some(2.0), ..errors }, 0).unwrap(), [1, 1]);
        let message = |budget: &Budget, fixed| match choose(&found, budget, fixed).unwrap_err() {
            Refusal::Error { hint, .. } | Refusal::Whole { hint, .. } => hint,
        };
        assert!(message(&Budget { max_cost: Some(1.0), ..errors }, 0).contains("max_cost = 2"));
        assert!(message(&Budget { max_bytes: Some(15), ..errors }, 4).contains("max_bytes = 24"));
        assert!(message(&Budget { max_abs: Some(0.03), ..errors }, 0).contains("max_abs = 1.0e-1"));
    }

    #[test]
    fn bytes_alone_buy_the_least_error() {
        let found = [kind(&[(10, 1.0, 0.1), (20, 1.0, 0.05)]), kind(&[(10, 1.0, 0.2), (30, 1.0, 0.01)])];
        let bytes = |max| choose(&found, &Budget { max_bytes: Some(max), ..Budget::default() }, 0).unwrap();
        assert_eq!(bytes(20), [0, 0]);
        assert_eq!(bytes(40), [0, 1]);
        assert_eq!(bytes(50), [1, 1]);
    }
}
