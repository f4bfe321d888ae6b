//! Decisions that stay: those of a lock, and searches that a store has.

use std::sync::Arc;

use luthier_lut::TableKind;
use luthier_manifest::{Candidate, CandidateForm, Decision, MeasuredError, Search};

use crate::candidates::{AIM, DEFAULT_BUDGET, Found};
use crate::graph::{Artefact, JobKind, Key, Results, Store, Task};
use crate::plan::Plan;

/// Changes whenever the same plan gives other candidates, or other errors of them, than before.
const REVISION: u32 = 2;

/// The kind of searches in stores.
const SEARCH: JobKind = JobKind::part("search");

/// The candidates that a search finds for a kind of a plan, from the store where it has been made before. Its truths are those of the jobs of the tiles: what makes
/// the tiles of other kinds does not decide it.
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
    // As text: the names of forms are part of the values.
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

/// The reports of decisions of a lock on a plan that has taken them, where no budget is stated: none where a table is off by more than bakes aim at, and by more
/// than when it was locked.
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
