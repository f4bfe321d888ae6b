//! The shapes of the tables of a bake: those that materials ask for, those that a lock keeps, and those that a search finds.

use luthier_layers::lobes::LOBES;
use luthier_lut::{AtlasLayout, TableKind, TexelFormat};
use luthier_manifest::{Budget, CandidateForm, Decision, MeasuredError, Search};
use luthier_material::{Material, Severity};

use crate::assemble::check;
use crate::graph::{JobKind, Observer, Results};
use crate::kinds::{self, lobes};
use crate::plan::{ImageReader, Plan, TileList};
use crate::search::{self, Found, Refusal};
use crate::settings::{Settings, Shape};
use crate::tile::apron;
use crate::{BakeError, DEFAULT_BUDGET, Options, Store, limits};

/// A plan whose settings are final, results that were needed to find them, and what the search found.
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

/// Often enough for the error of every choice to be confirmed or refuted by the exact measurement.
const ROUNDS: usize = 24;

impl Fixed {
    /// The plan of what materials and options ask for. Lobes have the most parts, as long as nothing is fitted.
    pub(crate) fn new(
        materials: &[Material],
        options: &Options<'_>,
        read_image: ImageReader<'_>,
    ) -> Result<Self, BakeError> {
        check(materials, options).map_err(|mut errors| errors.swap_remove(0))?;
        let mut settings = Settings::of(materials)?;
        settings.formats = options.formats;
        if let Some(rows) = options.rows {
            settings.take_rows(rows);
        }
        let asked = budget(materials, &options.budget)?;
        settings.lobes = (options.search && asked.limits_lobes()).then_some(LOBES);
        let plan = Plan::new(materials, settings.clone(), read_image)?;
        Ok(Self { settings, plan, asked })
    }

    /// The limits on texels, and whether there are any; otherwise those that bakes aim at.
    pub(crate) fn budget(&self) -> (Budget, bool) {
        let asked = self.asked.of_texels();
        if asked.is_empty() { (DEFAULT_BUDGET, false) } else { (asked, true) }
    }

    /// The settings that a bake without a stated budget tries first: those of the lock, or of a search. None where nothing is searched.
    pub(crate) fn first_choice(&self, options: &Options<'_>, store: &dyn Store) -> Settings {
        let mut settings = self.settings.clone();
        if let Some(decisions) = self.locked(options) {
            decisions.iter().for_each(|decision| settings.apply(decision.kind, &decision.candidate.form));
            return settings;
        }
        let found = found(self, &Results::default(), store);
        for (kind, choice) in found.iter().zip(search::best_effort(&found, &DEFAULT_BUDGET)) {
            settings.apply(kind.kind, &kind.candidates[choice].form);
        }
        settings
    }

    /// The decisions of the lock for the kinds that a bake without a stated budget searches, where it has one for each of them.
    fn locked(&self, options: &Options<'_>) -> Option<Vec<Decision>> {
        let is_open = |kind: &TableKind| {
            !self.plan.tiles[*kind as usize].tiles.is_empty() && !self.settings.asked(*kind).is_any()
        };
        let decision = |kind: TableKind| {
            let is_fit = |decision: &&Decision| match &decision.candidate.form {
                CandidateForm::ClosedForm => true,
                CandidateForm::Table { format, .. } => options.formats.has(*format),
            };
            options.locked.iter().find(|decision| decision.kind == kind).filter(is_fit).cloned()
        };
        let open = search::SEARCHED_BY_DEFAULT.into_iter().filter(is_open);
        let decisions: Vec<Decision> = open.map(decision).collect::<Option<_>>()?;
        (!decisions.is_empty()).then_some(decisions)
    }
}

/// The candidates for the tables of a plan; none that no texture holds.
fn found(fixed: &Fixed, results: &Results, store: &dyn Store) -> Vec<Found> {
    let (budget, is_asked) = fixed.budget();
    let (plan, colors) = (&fixed.plan, budget.delta_e.is_some());
    let kinds: &[TableKind] = if is_asked { &TableKind::ALL } else { &search::SEARCHED_BY_DEFAULT };
    let of = |&kind: &TableKind| {
        search::kept(plan, kind, is_asked, colors, store, &|| {
            if is_asked { search::candidates(plan, kind, results, colors) } else { search::by_default(plan, kind) }
        })
    };
    let mut found: Vec<Found> = kinds.iter().filter_map(of).collect();
    found.iter_mut().for_each(|found| fitting(found, plan));
    found.retain(|found| !found.candidates.is_empty());
    found
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
        results = fits.run(observer, store, results);
        let limits = fixed.asked.of_lobes();
        let decided = lobes::decide(&mut fixed.settings, &fixed.plan, materials, &results, &limits, options.locked);
        searches.extend(decided.map_err(|(refusal, errors)| {
            let worst = worst_of(&errors, &limits).map(|material| (material, None));
            refused(refusal, TableKind::Lobes, worst, materials, options)
        })?);
        fixed.plan = Plan::new(materials, fixed.settings.clone(), read_image)?;
    }
    let fixed_layouts = layouts(&fixed.plan)?;
    if !options.search {
        return Ok(Planned { plan: fixed.plan, results, searches });
    }
    let (budget, is_asked) = fixed.budget();
    if !is_asked && let Some(decisions) = fixed.locked(options) {
        let mut settings = fixed.settings.clone();
        decisions.iter().for_each(|decision| settings.apply(decision.kind, &decision.candidate.form));
        let plan = Plan::new(materials, settings, read_image)?;
        results = exact(&plan, &decisions.iter().map(|d| d.kind).collect::<Vec<_>>()).run(observer, store, results);
        if let Some(kept) = search::kept_decisions(&plan, &results, &decisions) {
            searches.extend(kept);
            return Ok(Planned { plan, results, searches });
        }
    }
    // Costly tables are made once; candidates are compared with them.
    if is_asked {
        results = fixed.plan.graph.intermediate().run(observer, store, results);
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
    // One plan at a time: of many materials it is large.
    let mut last = Some(plan);
    let (mut chosen, mut refusal) = (Vec::new(), None);
    let refuse = |refusal: Refusal, plan: &Plan, results: &Results, found: &[Found]| {
        let Refusal::Error { nearest: (number, candidate), .. } = refusal else {
            return refused(refusal, TableKind::Lobes, None, materials, options);
        };
        let Found { kind, candidates, .. } = &found[number];
        let errors = kinds::of(*kind).errors(plan, results, &candidates[candidate].form);
        let worst = worst_of(&errors, &budget).and_then(|tile| plan.reader(*kind, tile as u32));
        refused(refusal, *kind, worst, materials, options)
    };
    for _ in 0..ROUNDS {
        // What a refusal says would do is confirmed too, before it is said.
        refusal = None;
        chosen = if !is_asked {
            search::best_effort(&found, &budget)
        } else if let Some(locked) = search::locked(&found, options.locked, &budget, fixed_bytes) {
            locked
        } else {
            match search::choose(&found, &budget, fixed_bytes) {
                Ok(chosen) => chosen,
                Err(error) => {
                    let unlimited = Budget { max_bytes: None, max_cost: None, ..budget };
                    let Ok(would) = search::choose(&found, &unlimited, fixed_bytes) else {
                        let plan = last.unwrap_or_else(|| unreachable!("there is a plan before each round"));
                        return Err(refuse(error, &plan, &results, &found));
                    };
                    refusal = Some(error);
                    would
                }
            }
        };
        let mut settings = settings.clone();
        for (kind, &choice) in found.iter().zip(&chosen) {
            settings.apply(kind.kind, &kind.candidates[choice].form);
        }
        drop(last.take());
        let plan = last.insert(Plan::new(materials, settings, read_image)?);
        // The measurement of the bake itself climbs to the worst points; it has the last word.
        results = exact(plan, &searched).run(observer, store, results);
        let mut is_confirmed = true;
        for (kind, &choice) in found.iter_mut().zip(&chosen) {
            is_confirmed &= kind.confirm(choice, worst(plan, &results, kind.kind, &kind.left_out));
        }
        if is_confirmed {
            break;
        }
    }
    let plan = last.unwrap_or_else(|| unreachable!("there is a plan after each round"));
    if let Some(error) = refusal {
        return Err(refuse(error, &plan, &results, &found));
    }
    searches.extend(found.iter().zip(&chosen).map(|(f, &choice)| search::report(f, choice, &budget)));
    Ok(Planned { plan, results, searches })
}

/// The number with the error that exceeds a budget most.
fn worst_of(errors: &[(usize, MeasuredError)], budget: &Budget) -> Option<usize> {
    let excess = |(_, error): &(usize, MeasuredError)| budget.excess(error);
    errors.iter().max_by(|a, b| excess(a).total_cmp(&excess(b))).map(|(number, _)| *number)
}

/// The refusal of a budget: what no tables of a kind are good enough for, a layer of a material or all of it, and the material that states the limit.
fn refused(
    refusal: Refusal,
    kind: TableKind,
    worst: Option<(usize, Option<usize>)>,
    materials: &[Material],
    options: &Options<'_>,
) -> BakeError {
    let limit = |budget: &Budget, name: &str| budget.limits().into_iter().find(|(limit, _)| *limit == name)?.1;
    // The tightest limit of files counts, unless an option replaces it.
    let stated = |name: &str| {
        let all = materials.iter().enumerate().filter_map(|(number, m)| Some((number, limit(&m.budget, name)?)));
        let tightest = all.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(number, _)| number);
        tightest.filter(|_| limit(&options.budget, name).is_none())
    };
    let key = |name: &str| format!("budget.{name}");
    let of = |name: &str| {
        let stating = stated(name).map(|number| &materials[number]);
        let value = limit(stating.map_or(&options.budget, |material| &material.budget), name).unwrap_or_default();
        let place = stating.map_or(String::new(), |material| format!(" of {}", material.place(&key(name))));
        let value = if value >= 1.0 { format!("{value}") } else { format!("{value:e}") };
        format!("{name} = {value}{place}")
    };
    let (reason, hint, place) = match refusal {
        Refusal::Error { limits, words, hint, .. } => {
            let layer = |layer: Option<usize>| layer.map_or("name".to_owned(), |layer| format!("layer.{layer}"));
            let whom = worst.map_or(String::new(), |(number, at)| {
                let (material, which) = (&materials[number], at.map_or(String::new(), |at| format!("layer {at} of ")));
                format!(" for {which}`{}` ({})", material.name, material.place(&layer(at)))
            });
            let under: Vec<String> = limits.iter().map(|name| of(name)).collect();
            let own = |number: usize| limits.iter().find(|name| stated(name) == Some(number)).map(|name| key(name));
            let reason = format!(
                "no {} table is good enough{whom} under {}; nearest: {words}",
                kind.name(),
                under.join(" and ")
            );
            (reason, hint, worst.map(|(number, at)| (number, own(number).unwrap_or_else(|| layer(at)))))
        }
        Refusal::Whole { limit, reason, hint } => {
            (format!("{reason} {}", of(limit)), hint, stated(limit).map(|number| (number, key(limit))))
        }
    };
    let mut error = BakeError::Budget { reason, hint, diagnostics: Vec::new() };
    let message = error.to_string();
    if let (BakeError::Budget { diagnostics, hint, .. }, Some((number, key))) = (&mut error, place) {
        let hint = Some(format!("write `{hint}`, or leave the limit out"));
        diagnostics.push(materials[number].diagnostic(Severity::Error, &key, message, hint));
    }
    error
}

/// The jobs of the tiles of some kinds.
fn exact(plan: &Plan, kinds: &[TableKind]) -> crate::graph::Graph {
    plan.graph.only(|job| kinds.iter().any(|&kind| job.kind() == JobKind::tile(kind)))
}

/// The largest error of the tiles of a kind, without some of them.
pub(crate) fn worst(plan: &Plan, results: &Results, kind: TableKind, left_out: &[usize]) -> f64 {
    let tiles = plan.tiles[kind as usize].tiles.iter().enumerate();
    let counted = tiles.filter(|(tile, _)| !left_out.contains(tile)).map(|(_, (_, key))| *key);
    counted.filter_map(|key| results.find(key)).map(|t| t.error.max_abs_err).fold(0.0, f64::max)
}

/// Drops the candidates whose table no texture holds.
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

/// The limits of the materials, the tightest of each; those of the options in their place.
pub(crate) fn budget(materials: &[Material], given: &Budget) -> Result<Budget, BakeError> {
    let stated = materials.iter().map(|material| material.budget).fold(Budget::default(), |a, b| a.tighter(&b));
    let budget = Budget {
        max_abs: given.max_abs.or(stated.max_abs),
        max_rel: given.max_rel.or(stated.max_rel),
        delta_e: given.delta_e.or(stated.delta_e),
        max_bytes: given.max_bytes.or(stated.max_bytes),
        max_cost: given.max_cost.or(stated.max_cost),
        max_lobe_err: given.max_lobe_err.or(stated.max_lobe_err),
        max_albedo_err: given.max_albedo_err.or(stated.max_albedo_err),
    };
    let examples = ["1e-3", "1e-2", "0.5", "65536", "200", "0.05", "0.01"];
    for ((name, value), example) in budget.limits().into_iter().zip(examples) {
        if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
            return Err(BakeError::BudgetValue { name, value, example });
        }
    }
    Ok(budget)
}

/// The tables that a plan has.
pub(crate) fn used(tiles: &[TileList; TableKind::ALL.len()]) -> impl Iterator<Item = (TableKind, &TileList)> {
    TableKind::ALL.into_iter().zip(tiles).filter(|(_, tiles)| !tiles.tiles.is_empty())
}

/// Kind, layout and texel format of each table of a plan, in binding order.
pub(crate) fn layouts(plan: &Plan) -> Result<Vec<(TableKind, AtlasLayout, TexelFormat)>, BakeError> {
    let layout = |(kind, tiles): (TableKind, &TileList)| {
        let Shape { x, y, base, format } = plan.settings.shape(kind)?.clone();
        let (apron, count) = (apron(std::iter::once(&x).chain(&y)), tiles.tiles.len() as u32);
        let layout = AtlasLayout { x, y, apron, columns: 1, tiles: count, base };
        let columns = if tiles.has_runs { limits::one_column(&layout) } else { limits::columns(&layout) };
        Some(match columns {
            Some(columns) => Ok((kind, AtlasLayout { columns, ..layout }, format)),
            None => Err(limits::too_many_tiles(kind, &layout)),
        })
    };
    used(&plan.tiles).filter_map(layout).collect()
}
