//! Choice of the first candidate that holds the budget.

use luthier_layers::models::shade::ShaderTerms;
use luthier_manifest::{ColorMode, Form, MaterialChoice, SceneBudget, SceneCandidate, SceneError, Verdict};
use luthier_material::{Light, Material, View};

use crate::candidate::{Candidate, color_of};
use crate::cost::CostTable;
use crate::error::{Miss, Standing, Value, largest};
use crate::probe::{Probe, footprint, probes};
use crate::reference::Reference;
use crate::simplify::LeaveOut;

/// The most samples of the reference for one material: about a minute of one core.
pub const MAX_SAMPLES: u64 = 16_000_000;

/// Relative noise of the reference before the first candidate is judged. With more noise, the reported errors of candidates that fail early would
/// be mostly noise.
const NOISE_AT_FIRST: f64 = 0.02;

/// The most samples that the first step may take.
const SAMPLES_AT_FIRST: u64 = 2_000_000;

/// Share of every limit that models may use.
pub const MODEL_SHARE: f64 = 0.75;

/// Share of every limit that is left for tables.
pub const TABLE_SHARE: f64 = 1.0 - MODEL_SHARE;

/// One material of a scene: its candidates, and the reference at the directions of the scene. Values and samples are kept for the next
/// choice, so that a tighter budget costs little.
#[derive(Debug)]
pub struct Judge {
    name: String,
    candidates: Vec<Candidate>,
    probes: Vec<Probe>,
    reference: Reference,
    footprint_deg: f64,
}

impl Judge {
    /// A judge of a material under some lights; candidates are of one form.
    pub fn new(material: &Material, form: Form, lights: &[Light], view: &View, costs: &CostTable) -> Self {
        let stack = footprint(&material.stack, view.footprint_deg);
        let probes = probes(&stack, lights, view);
        let color = color_of(material.bake.color.unwrap_or_default(), material);
        let mut reference = Reference::new(&stack, color, probes.clone());
        loop {
            let values = reference.values();
            let open: Vec<usize> = (0..values.len()).filter(|&i| values[i].noise() > NOISE_AT_FIRST).collect();
            if open.is_empty() || reference.samples() > SAMPLES_AT_FIRST || !reference.refine(&open) {
                break;
            }
        }
        Self {
            name: material.name.clone(),
            candidates: Candidate::all(material, form, costs),
            reference,
            probes,
            footprint_deg: view.footprint_deg,
        }
    }

    /// The cheapest candidate that holds [`MODEL_SHARE`] of a budget. If none holds, the choice is the most accurate candidate within `max_cost`, and
    /// the [`MaterialChoice`] says that it does not hold. Its `chosen` is an index into [`Self::candidates`], too.
    ///
    /// `None` if every candidate costs more than `max_cost`.
    pub fn choose(&mut self, budget: &SceneBudget, max_cost: Option<f64>) -> Option<MaterialChoice> {
        let budget = &budget.scaled(MODEL_SHARE);
        let mut tried: Vec<(SceneCandidate, f64)> = Vec::new();
        let mut holder = None;
        for number in 0..self.candidates.len() {
            if max_cost.is_some_and(|most| self.candidates[number].cost > most) {
                break;
            }
            let judged = self.judge(number, budget);
            let holds = judged.0.verdict == Verdict::Holds;
            tried.push(judged);
            if holds {
                holder = Some(number);
                break;
            }
        }
        let nearest = (0..tried.len()).min_by(|&a, &b| tried[a].1.total_cmp(&tried[b].1))?;
        let chosen = holder.unwrap_or(nearest);
        let cost = tried[chosen].0.cost;
        let cheaper = (0..tried.len()).filter(|&i| tried[i].0.cost < cost);
        // Among equal costs, the most accurate.
        let next_cheaper = cheaper.max_by(|&a, &b| {
            let by_cost = tried[a].0.cost.total_cmp(&tried[b].0.cost);
            by_cost.then(tried[b].1.total_cmp(&tried[a].1)).then(b.cmp(&a))
        });
        let tried: Vec<SceneCandidate> = tried.into_iter().map(|(candidate, _)| candidate).collect();
        let reason = reason(&tried, chosen, next_cheaper, budget);
        Some(MaterialChoice {
            name: self.name.clone(),
            budget: *budget,
            chosen,
            next_cheaper,
            reason,
            tried,
            probes: self.probes.len() as u32,
            samples: self.reference.samples(),
            table_error: None,
        })
    }

    /// Errors of a candidate on the terms of tables, against exact terms, at the directions of the scene.
    pub fn table_error(&self, candidate: usize, terms: &(impl ShaderTerms + Sync), with_delta_e: bool) -> SceneError {
        let candidate = &self.candidates[candidate];
        let (exact, found) = candidate.values_with(terms, &self.probes, self.footprint_deg);
        let exact = exact.iter().map(|&rgb| Value { rgb, std_err: [0.0; 3] });
        let misses: Vec<Miss> = found.iter().zip(exact).map(|(f, e)| Miss::of(*f, &e, with_delta_e)).collect();
        largest(&misses, &self.probes)
    }

    /// The candidates, cheapest first.
    pub fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    /// The directions.
    pub fn probes(&self) -> &[Probe] {
        &self.probes
    }

    /// Judges a candidate against a budget: its figures with the verdict, and its largest ratio of an error to a limit.
    fn judge(&mut self, number: usize, budget: &SceneBudget) -> (SceneCandidate, f64) {
        let candidate = &self.candidates[number];
        let found = candidate.values(&self.probes, self.footprint_deg).to_vec();
        loop {
            let values = self.reference.values();
            let misses: Vec<Miss> =
                found.iter().zip(&values).map(|(f, v)| Miss::of(*f, v, budget.delta_e.is_some())).collect();
            let standings: Vec<Standing> = misses.iter().map(|miss| miss.standing(budget)).collect();
            let open: Vec<usize> = (0..misses.len()).filter(|&i| standings[i] == Standing::Open).collect();
            let verdict = if standings.contains(&Standing::Outside) {
                Verdict::Fails
            } else if open.is_empty() {
                Verdict::Holds
            } else if self.reference.samples() < MAX_SAMPLES && self.reference.refine(&open) {
                continue;
            } else {
                Verdict::Undecided
            };
            let candidate = &self.candidates[number];
            let judged = SceneCandidate {
                model: candidate.model,
                color: candidate.color,
                left_out: candidate.left_out.iter().map(|part| LeaveOut::name(*part)).collect(),
                cost: candidate.cost,
                cost_is_of_similar: candidate.cost_is_of_similar,
                error: largest(&misses, &self.probes),
                verdict,
            };
            return (judged, misses.iter().map(|miss| miss.excess(budget)).fold(0.0, f64::max));
        }
    }
}

/// A candidate in a few words: model, colour, parts that are left out.
pub fn label(candidate: &SceneCandidate) -> String {
    let color = if candidate.color == ColorMode::Spectral { "" } else { " at three wavelengths" };
    let without = if candidate.left_out.is_empty() {
        String::new()
    } else {
        format!(" without {}", candidate.left_out.join(", "))
    };
    format!("{}{color}{without}", candidate.model.name())
}

fn reason(tried: &[SceneCandidate], chosen: usize, next_cheaper: Option<usize>, budget: &SceneBudget) -> String {
    let own = &tried[chosen];
    let verdict = match own.verdict {
        Verdict::Holds => "the cheapest that holds",
        Verdict::Undecided => {
            "none holds for certain; this comes nearest, and the noise of the reference leaves it open"
        }
        Verdict::Fails => "none holds; this comes nearest",
    };
    let place = own.error.at.filter(|_| own.verdict != Verdict::Holds).map_or_else(String::new, |at| format!("; {at}"));
    let mut text =
        format!("{} for {:.0} cycles: {verdict} (error {}{place})", label(own), own.cost, errors(own, budget));
    if let Some(cheaper) = next_cheaper.map(|i| &tried[i]) {
        let outcome = if cheaper.verdict == Verdict::Undecided { "could not be told apart from" } else { "would have" };
        text.push_str(&format!(
            "; {} for {:.0} cycles {outcome} {}",
            label(cheaper),
            cheaper.cost,
            errors(cheaper, budget)
        ));
    }
    text
}

/// The errors of a candidate that a budget limits, each with its limit.
fn errors(SceneCandidate { error, .. }: &SceneCandidate, budget: &SceneBudget) -> String {
    let known = [
        ("relative", budget.max_rel, Some(error.max_rel)),
        ("absolute", budget.max_abs, Some(error.max_abs)),
        ("delta E", budget.delta_e, error.delta_e),
    ];
    let parts = known.map(|(name, limit, error)| Some(format!("{name} {:.2e} of {:.2e}", error?, limit?)));
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
