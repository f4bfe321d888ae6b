//! Decisions that stay: decisions of a lock, and searches in a store.

use std::sync::Arc;

use luthier_lut::TableKind;
use luthier_manifest::{Candidate, CandidateForm, Decision, MeasuredError, Search};

use crate::candidates::{AIM, DEFAULT_BUDGET, Found};
use crate::graph::{Artefact, JobKind, Key, Results, Store, Task};
use crate::plan::Plan;

/// Changes whenever an unchanged plan gives other candidates or other errors than before.
const REVISION: u32 = 2;

/// The kind of searches in stores.
const SEARCH: JobKind = JobKind::part("search");

/// The candidates of a search for a kind of a plan, from the store if it was made before. Only the jobs of the kind's
/// own tiles decide the result: jobs of other kinds are not part of the address.
pub(super) fn kept(
    plan: &Plan,
    kind: TableKind,
    is_asked: bool,
    colors: bool,
    store: &dyn Store,
    search: &dyn Fn() -> Option<Found>,
) -> Option<Found> {
    let (settings, tiles) = (&plan.settings, &plan.tiles[kind as usize].tiles);
    if tiles.is_empty() {
        return None;
    }
    let (asked, fixed, formats) = (settings.asked(kind), settings.fixed(kind), settings.formats);
    let (version, name) = (env!("CARGO_PKG_VERSION"), kind.name());
    let mut text =
        format!("luthier-bake {version} search {REVISION} {name} {is_asked} {colors} {asked:?} {fixed:?} {formats:?}");
    let addresses = tiles.iter().filter_map(|(_, key)| plan.graph.address(*key));
    addresses.for_each(|address| text.push_str(&address.to_string()));
    // Stored as text, because the values contain the names of forms.
    let task = Task::new(SEARCH, Key::of(text.as_bytes()), Artefact::decode::<String>);
    if let Some(found) = store.get(&task).and_then(|artefact| serde_json::from_str(artefact.get::<String>()?).ok()) {
        return found;
    }
    let found = search();
    if let Ok(text) = serde_json::to_string(&found) {
        store.put(&task, &Arc::new(Artefact::new(text)));
    }
    found
}

/// Reports of a lock's decisions on a plan that has taken them, for bakes without a stated budget. None where a table
/// errs by more than [`AIM`] and by more than when it was locked.
pub(super) fn kept_decisions(plan: &Plan, results: &Results, decisions: &[Decision]) -> Option<Vec<Search>> {
    let reports = decisions.iter().map(|decision| {
        let Candidate { form, cost, error, .. } = &decision.candidate;
        let found = plan.worst(results, decision.kind, &[]);
        if found > error.max_abs.max(AIM) {
            return None;
        }
        let tiles = plan.tiles[decision.kind as usize].tiles.len() as u32;
        let error = match form {
            CandidateForm::ClosedForm => *error,
            CandidateForm::Table { .. } => MeasuredError { max_abs: found, ..*error },
        };
        let candidate = Candidate { form: form.clone(), bytes: form.bytes(tiles), cost: *cost, error };
        Some(Search { kind: decision.kind, budget: DEFAULT_BUDGET, chosen: 0, front: vec![candidate], measured: 1 })
    });
    reports.collect()
}
