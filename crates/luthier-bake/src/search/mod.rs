//! The search for the shapes of a bake's tables: requested by materials, kept from a lock, or chosen to hold a budget.
//!
//! Thickness textures, which are pictures, and escape tiles are not searched. Lobes come first and have limits of their
//! own ([`lobes::decide`]): their errors are errors of the fit, not of texels.

mod decisions;
mod refusal;

use std::collections::BTreeMap;

use luthier_lut::{AtlasLayout, TableKind};
use luthier_manifest::{Budget, CandidateForm, Decision, Search};
use luthier_material::Material;

use self::decisions::{kept, kept_decisions};
use self::refusal::{refused, worst_of};
use crate::candidates::{DEFAULT_BUDGET, Found, Refusal, best_effort, choose, locked, report};
use crate::check::check;
use crate::graph::{Graph, JobKind, Observer, Results, Store};
use crate::kinds::{self, lobes};
use crate::limits::{self, layouts};
use crate::options::{Options, budget};
use crate::plan::Plan;
use crate::relief::ImageReader;
use crate::settings::Settings;
use crate::{BakeError, planner};

/// The kinds that are searched without a stated budget.
const SEARCHED_BY_DEFAULT: [TableKind; 2] = [TableKind::Fresnel, TableKind::Distribution];

/// A plan with final settings, the results that were needed to find them, and the reports of the search.
pub(crate) struct Planned {
    pub(crate) plan: Plan,
    pub(crate) results: Results,
    pub(crate) searches: Vec<Search>,
}

/// A plan before any search for texels.
pub(crate) struct Fixed {
    pub(crate) settings: Settings,
    pub(crate) plan: Plan,
    /// The limits that materials and options state, on texels and on lobes.
    pub(crate) asked: Budget,
}

/// Most rounds of a search: enough for the exact measurement to confirm or refute the error of every choice.
const ROUNDS: usize = 24;

impl Fixed {
    /// The plan that materials and options request. Until lobes are fitted, their tiles have the most parts.
    pub(crate) fn new(
        materials: &[Material],
        options: &Options<'_>,
        read_image: ImageReader<'_>,
    ) -> Result<Self, BakeError> {
        check(materials, options).map_err(|mut errors| errors.swap_remove(0))?;
        let mut settings = planner::settings(materials)?;
        settings.formats = options.formats;
        if let Some(rows) = options.rows {
            settings.take_rows(rows);
        }
        let asked = budget(materials, &options.budget)?;
        let have_forms = materials.iter().any(|material| material.bake.lobes.is_some());
        settings.lobes = (options.search && asked.limits_lobes() && !have_forms).then(BTreeMap::new);
        settings.take_layout(lobes::layout(materials, options, &asked));
        let plan = planner::plan(materials, settings.clone(), read_image)?;
        Ok(Self { settings, plan, asked })
    }

    /// The limits on texels, and whether any are stated; else the limits that bakes aim at.
    pub(crate) fn budget(&self) -> (Budget, bool) {
        let asked = self.asked.of_texels();
        if asked.is_empty() { (DEFAULT_BUDGET, false) } else { (asked, true) }
    }

    /// The settings that a bake without a stated budget tries first, from the lock or from a search.
    pub(crate) fn first_choice(&self, options: &Options<'_>, store: &dyn Store) -> Settings {
        let mut settings = self.settings.clone();
        if let Some(decisions) = self.locked(options) {
            decisions.iter().for_each(|decision| settings.apply(decision.kind, &decision.candidate.form));
            return settings;
        }
        let found = found(self, &Results::default(), store);
        for (kind, choice) in found.iter().zip(best_effort(&found, &DEFAULT_BUDGET)) {
            settings.apply(kind.kind, &kind.candidates[choice].form);
        }
        settings
    }

    /// The decisions of the lock for the kinds that a bake without a stated budget searches, if it has one for each of
    /// them.
    fn locked(&self, options: &Options<'_>) -> Option<Vec<Decision>> {
        let open = SEARCHED_BY_DEFAULT
            .into_iter()
            .filter(|kind| !self.plan.tiles[*kind as usize].tiles.is_empty() && !self.settings.asked(*kind).is_any());
        let decisions = open.map(|kind| {
            let decision = options.locked.iter().find(|decision| decision.kind == kind)?;
            match decision.candidate.form {
                CandidateForm::Table { format, .. } if !options.formats.has(format) => None,
                _ => Some(decision.clone()),
            }
        });
        let decisions: Vec<Decision> = decisions.collect::<Option<_>>()?;
        (!decisions.is_empty()).then_some(decisions)
    }
}

/// The candidates for the tables of a plan. Tables that no texture holds are left out.
fn found(fixed: &Fixed, results: &Results, store: &dyn Store) -> Vec<Found> {
    let (budget, is_asked) = fixed.budget();
    let (plan, colors) = (&fixed.plan, budget.delta_e.is_some());
    let kinds: &[TableKind] = if is_asked { &TableKind::ALL } else { &SEARCHED_BY_DEFAULT };
    let found = kinds.iter().filter_map(|&kind| {
        kept(plan, kind, is_asked, colors, store, &|| {
            if is_asked { candidates(plan, kind, results, colors) } else { by_default(plan, kind) }
        })
    });
    let mut found: Vec<Found> = found.collect();
    found.iter_mut().for_each(|found| fitting(found, plan));
    found.retain(|found| !found.candidates.is_empty());
    found
}

/// The candidates of a kind, if one comes near the default budget. Rows that no candidate serves do not count.
fn by_default(plan: &Plan, kind: TableKind) -> Option<Found> {
    kinds::of(kind).candidates_by_default(plan).filter(|f| f.comes_near(&DEFAULT_BUDGET))
}

/// Measures the candidates of a kind of a plan. `results` has the intermediate results of its graph.
fn candidates(plan: &Plan, kind: TableKind, results: &Results, colors: bool) -> Option<Found> {
    kinds::of(kind).candidates(plan, results, colors).filter(|f| !f.candidates.is_empty())
}

/// The final plan.
///
/// # Errors
/// See [`BakeError`].
pub(crate) fn plan(
    materials: &[Material],
    options: &Options<'_>,
    read_image: ImageReader<'_>,
    observer: &dyn Observer,
    store: &dyn Store,
) -> Result<Planned, BakeError> {
    let mut fixed = Fixed::new(materials, options, read_image)?;
    let (mut results, mut searches) = (Results::default(), Vec::new());
    if let Some(fits) = lobes::fits(&fixed.plan.graph).filter(|_| options.fits) {
        results = fits.run(observer, store, results)?;
        let limits = fixed.asked.of_lobes();
        let decided = lobes::decide(&mut fixed.settings, &fixed.plan, materials, &results, &limits, options);
        searches.extend(decided.map_err(|(refusal, errors)| {
            let worst = worst_of(&errors, &limits).map(|material| (material, None));
            refused(refusal, TableKind::Lobes, worst, materials, options)
        })?);
        fixed.plan = planner::plan(materials, fixed.settings.clone(), read_image)?;
    }
    let fixed_layouts = layouts(&fixed.plan)?;
    if !options.search {
        return Ok(Planned { plan: fixed.plan, results, searches });
    }
    let (budget, is_asked) = fixed.budget();
    if !is_asked && let Some(decisions) = fixed.locked(options) {
        let mut settings = fixed.settings.clone();
        decisions.iter().for_each(|decision| settings.apply(decision.kind, &decision.candidate.form));
        let plan = planner::plan(materials, settings, read_image)?;
        results = exact(&plan, &decisions.iter().map(|d| d.kind).collect::<Vec<_>>()).run(observer, store, results)?;
        if let Some(kept) = kept_decisions(&plan, &results, &decisions) {
            searches.extend(kept);
            return Ok(Planned { plan, results, searches });
        }
    }
    // Costly truths are computed once; all candidates are compared with them.
    if is_asked {
        results = fixed.plan.graph.intermediate().run(observer, store, results)?;
    }
    let mut found = found(&fixed, &results, store);
    let searched: Vec<TableKind> = found.iter().map(|f| f.kind).collect();
    let fixed_bytes = fixed_layouts
        .iter()
        .filter(|(kind, ..)| !searched.contains(kind))
        .map(|(_, layout, format)| {
            let [width, height] = layout.size();
            u64::from(width) * u64::from(height) * u64::from(format.texel_bytes())
        })
        .sum();
    let Fixed { settings, plan, .. } = fixed;
    // One plan at a time: the plan of many materials takes much memory.
    let mut last = Some(plan);
    let (mut chosen, mut refusal) = (Vec::new(), None);
    for _ in 0..ROUNDS {
        // The hint of a refusal is confirmed too, before it is given.
        refusal = None;
        chosen = if !is_asked {
            best_effort(&found, &budget)
        } else if let Some(locked) = locked(&found, options.locked, &budget, fixed_bytes) {
            locked
        } else {
            match choose(&found, &budget, fixed_bytes) {
                Ok(chosen) => chosen,
                Err(error) => {
                    let unlimited = Budget { max_bytes: None, max_cost: None, ..budget };
                    refusal = Some(error);
                    let Ok(would) = choose(&found, &unlimited, fixed_bytes) else { break };
                    would
                }
            }
        };
        let mut settings = settings.clone();
        for (kind, &choice) in found.iter().zip(&chosen) {
            settings.apply(kind.kind, &kind.candidates[choice].form);
        }
        drop(last.take());
        let plan = last.insert(planner::plan(materials, settings, read_image)?);
        // The bake's own measurement climbs to the worst points and has the last word.
        results = exact(plan, &searched).run(observer, store, results)?;
        let mut is_confirmed = true;
        for (kind, &choice) in found.iter_mut().zip(&chosen) {
            is_confirmed &= kind.confirm(choice, plan.worst(&results, kind.kind, &kind.left_out));
        }
        if is_confirmed {
            break;
        }
    }
    let plan = last.unwrap_or_else(|| unreachable!("there is a plan before and after each round"));
    if let Some(refusal) = refusal {
        let Refusal::Error { nearest: (number, candidate), .. } = refusal else {
            return Err(refused(refusal, TableKind::Lobes, None, materials, options));
        };
        let Found { kind, candidates, .. } = &found[number];
        let errors = kinds::of(*kind).errors(&plan, &results, &candidates[candidate].form);
        let worst = worst_of(&errors, &budget).and_then(|tile| plan.reader(*kind, tile as u32));
        return Err(refused(refusal, *kind, worst, materials, options));
    }
    searches.extend(found.iter().zip(&chosen).map(|(f, &choice)| report(f, choice, &budget)));
    Ok(Planned { plan, results, searches })
}

/// The jobs of the tiles of some kinds.
fn exact(plan: &Plan, kinds: &[TableKind]) -> Graph {
    plan.graph.only(|job| kinds.iter().any(|&kind| job.kind() == JobKind::tile(kind)))
}

/// Drops the candidates with a table that no texture holds.
fn fitting(found: &mut Found, plan: &Plan) {
    let tiles = plan.tiles[found.kind as usize].tiles.len() as u32;
    found.candidates.retain(|candidate| match &candidate.form {
        CandidateForm::ClosedForm => true,
        CandidateForm::Table { x, y, base, .. } => {
            let layout = AtlasLayout { x: x.clone(), y: y.clone(), apron: 0, columns: 1, tiles, base: *base };
            limits::columns(&layout).is_some()
        }
    });
}
