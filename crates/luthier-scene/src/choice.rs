//! Choice of the first candidate that holds the budget.

use luthier_cost::CostUnit;
use luthier_layers::models::lobes::LOBES;
use luthier_layers::models::shade::ShaderTerms;
use luthier_manifest::{
    ColorMode, Form, LobesForm, MaterialChoice, SceneBudget, SceneCandidate, SceneError, ShadingModel, Verdict,
};
use luthier_material::{Light, Material, View};

use crate::candidate::{Candidate, color_of};
use crate::cost::CostTable;
use crate::divergence::Shaded;
use crate::error::{Miss, Standing, Value, largest};
use crate::probe::{Probe, footprint, probes};
use crate::reference::Reference;
use crate::shape::shape;
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

/// Rows of `lobes` that one set has together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Widths {
    /// Lobes have one width, or there are none.
    One,
    /// Lobes have two.
    Two,
    /// All materials of the model have a short lobe.
    Short,
}

impl Widths {
    pub(crate) const ALL: [Self; 3] = [Self::Short, Self::One, Self::Two];

    fn have(self, candidate: &Candidate) -> bool {
        match candidate.lobes {
            Some(LobesForm::NoLobe) => self != Self::Short,
            Some(LobesForm::ShortLobe) => self == Self::Short,
            Some(LobesForm::OneWidth) => self == Self::One,
            Some(LobesForm::OneLobe | LobesForm::TwoLobes | LobesForm::ThreeLobes) => self == Self::Two,
            // Rows over more than the view have two widths.
            None => self == Self::Two || !candidate.model.is_fitted(),
        }
    }
}

/// One material of a scene: its candidates, and the reference at the directions of the scene. Values and samples are kept for the next
/// choice, so that a tighter budget costs little.
#[derive(Debug)]
pub struct Judge {
    name: String,
    candidates: Vec<Candidate>,
    probes: Vec<Probe>,
    reference: Reference,
    footprint_deg: f64,
    form: Form,
    unit: CostUnit,
    /// Model and colour of the material by itself.
    own: (ShadingModel, ColorMode),
}

/// Candidates of a material that were judged against a budget, cheapest first.
#[derive(Debug)]
pub(crate) struct Tried {
    budget: SceneBudget,
    /// Figures with the verdict, and the largest ratio of an error to a limit.
    judged: Vec<(SceneCandidate, f64)>,
    /// Share of neighbours that differ in the choice to come.
    neighbours_differ: f64,
}

impl Tried {
    /// The cheapest candidate of each model that holds, cheapest first; the nearest one if none holds. `None` if nothing was judged.
    pub(crate) fn eligible(&self) -> Option<Vec<usize>> {
        let holds = |i: &usize| self.judged[*i].0.verdict == Verdict::Holds;
        let mut found: Vec<usize> = Vec::new();
        for i in (0..self.judged.len()).filter(holds) {
            if !found.iter().any(|&other| self.judged[other].0.model == self.judged[i].0.model) {
                found.push(i);
            }
        }
        if found.is_empty() {
            found.push((0..self.judged.len()).min_by(|&a, &b| self.judged[a].1.total_cmp(&self.judged[b].1))?);
        }
        Some(found)
    }

    pub(crate) fn shaded(&self, i: usize) -> Shaded {
        let SceneCandidate { model, cost, .. } = self.judged[i].0;
        Shaded { model, cost }
    }
}

impl Judge {
    /// A judge of a material under some lights; candidates are of one form, see [`Candidate::all`].
    pub fn new(
        material: &Material,
        form: Form,
        lights: &[Light],
        view: &View,
        costs: &CostTable,
        has_forms: bool,
    ) -> Self {
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
            candidates: Candidate::all(material, form, costs, has_forms),
            reference,
            probes,
            footprint_deg: view.footprint_deg,
            form,
            unit: costs.device.unit,
            own: (material.model(), material.bake.color.unwrap_or_default()),
        }
    }

    /// The candidate that a bake of the material by itself comes nearest to, with its error: the whole stack by its own model in its own colour, with the most
    /// lobes that bakes without limits have. `None` where that model is no candidate.
    pub(crate) fn by_itself(&mut self) -> Option<SceneCandidate> {
        let has_few = |c: &Candidate| c.lobes.is_none_or(|form| form.most() <= LOBES);
        let is_own = |c: &Candidate| (c.model, c.color) == self.own && c.left_out.is_empty() && has_few(c);
        let own = (0..self.candidates.len()).filter(|number| is_own(&self.candidates[*number]));
        let own = own.max_by_key(|number| self.candidates[*number].lobes)?;
        Some(self.judge(own, &SceneBudget::default()).0)
    }

    /// The cheapest candidate that holds [`MODEL_SHARE`] of a budget. If none holds, the choice is the most accurate candidate within `max_cost`, and
    /// the [`MaterialChoice`] says that it does not hold.
    ///
    /// `None` if every candidate costs more than `max_cost`.
    pub fn choose(&mut self, budget: &SceneBudget, max_cost: Option<f64>) -> Option<MaterialChoice> {
        let choices = Widths::ALL.into_iter().filter_map(|widths| {
            let tried = self.tried(budget, max_cost, 0.0, widths);
            let chosen = *tried.eligible()?.first()?;
            Some(self.chosen(tried, chosen))
        });
        let excess = |choice: &MaterialChoice| choice.budget.excess(&choice.candidate().error).max(1.0);
        choices.min_by(|a, b| {
            let cost = |choice: &MaterialChoice| choice.candidate().cost;
            b.holds().cmp(&a.holds()).then(excess(a).total_cmp(&excess(b))).then(cost(a).total_cmp(&cost(b)))
        })
    }

    /// Judges candidates, cheapest first, up to the first that holds; where neighbours differ, up to those that cannot be cheaper for a scene.
    pub(crate) fn tried(
        &mut self,
        budget: &SceneBudget,
        max_cost: Option<f64>,
        neighbours_differ: f64,
        widths: Widths,
    ) -> Tried {
        let budget = budget.scaled(MODEL_SHARE);
        // A material pays for every model of a scene: the dearest choice that can pay replaces all of them.
        let reach = 1.0 + neighbours_differ * ShadingModel::ALL.len() as f64;
        let mut judged: Vec<(SceneCandidate, f64)> = Vec::new();
        let mut most = f64::INFINITY;
        for number in
            (0..self.candidates.len()).filter(|number| widths.have(&self.candidates[*number])).collect::<Vec<_>>()
        {
            let cost = self.candidates[number].cost;
            if max_cost.is_some_and(|most| cost > most) || cost >= most {
                break;
            }
            let found = self.judge(number, &budget);
            let holds = found.0.verdict == Verdict::Holds;
            judged.push(found);
            if holds && neighbours_differ == 0.0 {
                break;
            }
            if holds && most.is_infinite() {
                most = reach * cost;
            }
        }
        Tried { budget, judged, neighbours_differ }
    }

    /// The choice of one of the candidates that were judged.
    pub(crate) fn chosen(&self, Tried { budget, judged, neighbours_differ }: Tried, chosen: usize) -> MaterialChoice {
        let cost = judged[chosen].0.cost;
        let cheaper = (0..judged.len()).filter(|&i| judged[i].0.cost < cost);
        // Among equal costs, the most accurate.
        let next_cheaper = cheaper.max_by(|&a, &b| {
            let by_cost = judged[a].0.cost.total_cmp(&judged[b].0.cost);
            by_cost.then(judged[b].1.total_cmp(&judged[a].1)).then(b.cmp(&a))
        });
        let tried: Vec<SceneCandidate> = judged.into_iter().map(|(candidate, _)| candidate).collect();
        let reason = reason(&tried, chosen, next_cheaper, &budget, self.unit, neighbours_differ);
        MaterialChoice {
            name: self.name.clone(),
            budget,
            chosen,
            next_cheaper,
            reason,
            disagreements: Vec::new(),
            tried,
            probes: self.probes.len() as u32,
            samples: self.reference.samples(),
            table_error: None,
        }
    }

    /// Sentences on orders that other devices turn round: of the chosen candidate and the next cheaper one, and of the chosen one and the next dearer one
    /// of another model.
    pub(crate) fn disagreements(&self, choice: &MaterialChoice, own: &CostTable, others: &[CostTable]) -> Vec<String> {
        let chosen = self.candidate(choice.candidate());
        let dearer = self.candidates.iter().find(|c| c.cost > chosen.cost && c.model != chosen.model);
        let cheaper = choice.next_cheaper.map(|i| self.candidate(&choice.tried[i]));
        let cost = |costs: &CostTable, candidate: &Candidate| {
            let shape = shape(&candidate.material.stack);
            costs.cost(candidate.model, self.form, &shape, candidate.lobes).map(|(cost, _)| cost)
        };
        let mut found = Vec::new();
        for other in [cheaper, dearer].into_iter().flatten() {
            let [cheap, dear] = if other.cost < chosen.cost { [other, chosen] } else { [chosen, other] };
            let turned: Vec<&str> = others
                .iter()
                .filter(|costs| cost(costs, cheap).zip(cost(costs, dear)).is_some_and(|(cheap, dear)| cheap > dear))
                .map(|costs| costs.device.name.as_str())
                .collect();
            if !turned.is_empty() {
                let [cheap, dear] = [cheap, dear].map(|c| label_of(c.model, c.lobes, c.color, &names(&c.left_out)));
                let (own, turned) = (&own.device.name, turned.join(", "));
                found.push(format!("{cheap} costs less than {dear} on {own}, and more on {turned}"));
            }
        }
        found
    }

    /// The candidate that was judged, of [`Self::candidates`].
    pub(crate) fn candidate(&self, judged: &SceneCandidate) -> &Candidate {
        let is_it = |candidate: &&Candidate| {
            (candidate.model, candidate.lobes, candidate.color) == (judged.model, judged.lobes, judged.color)
                && names(&candidate.left_out) == judged.left_out
        };
        self.candidates.iter().find(is_it).unwrap_or_else(|| unreachable!("candidates are judged"))
    }

    /// Errors of a candidate that was judged on the terms of tables, against exact terms, at the directions of the scene.
    pub fn table_error(
        &self,
        judged: &SceneCandidate,
        terms: &(impl ShaderTerms + Sync),
        with_delta_e: bool,
    ) -> SceneError {
        let candidate = self.candidate(judged);
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
                lobes: candidate.lobes,
                left_out: names(&candidate.left_out),
                cost: candidate.cost,
                cost_is_of_similar: candidate.cost_is_of_similar,
                error: largest(&misses, &self.probes),
                verdict,
            };
            return (judged, misses.iter().map(|miss| miss.excess(budget)).fold(0.0, f64::max));
        }
    }
}

/// A candidate in a few words: model, form of its rows, colour, parts that are left out.
pub fn label(candidate: &SceneCandidate) -> String {
    label_of(candidate.model, candidate.lobes, candidate.color, &candidate.left_out)
}

fn label_of(model: ShadingModel, lobes: Option<LobesForm>, color: ColorMode, left_out: &[String]) -> String {
    let lobes = lobes.map_or_else(String::new, |lobes| format!(" with {}", lobes.words()));
    let color = if color == ColorMode::Spectral { "" } else { " at three wavelengths" };
    let without = if left_out.is_empty() { String::new() } else { format!(" without {}", left_out.join(", ")) };
    format!("{}{lobes}{color}{without}", model.name())
}

fn names(left_out: &[LeaveOut]) -> Vec<String> {
    left_out.iter().map(|part| part.name()).collect()
}

/// A cost with its unit.
///
/// ```
/// use luthier_cost::CostUnit;
/// use luthier_scene::cost_text;
///
/// assert_eq!(cost_text(5.25, CostUnit::Picoseconds), "5.2 ps");
/// assert_eq!(cost_text(164.0, CostUnit::Cycles), "164 cycles");
/// ```
pub fn cost_text(cost: f64, unit: CostUnit) -> String {
    let digits = usize::from(unit == CostUnit::Picoseconds && cost < 1e3);
    format!("{cost:.digits$} {unit}")
}

fn reason(
    tried: &[SceneCandidate],
    chosen: usize,
    next_cheaper: Option<usize>,
    budget: &SceneBudget,
    unit: CostUnit,
    neighbours_differ: f64,
) -> String {
    let own = &tried[chosen];
    let has_cheaper_holder = tried[..chosen].iter().any(|other| other.verdict == Verdict::Holds);
    let for_scene = format!("the cheapest for a scene where a share of {neighbours_differ} of neighbours differs");
    let verdict = match own.verdict {
        Verdict::Holds if has_cheaper_holder => for_scene.as_str(),
        Verdict::Holds => "the cheapest that holds",
        Verdict::Undecided => {
            "none holds for certain; this comes nearest, and the noise of the reference leaves it open"
        }
        Verdict::Fails => "none holds; this comes nearest",
    };
    let place = own.error.at.filter(|_| own.verdict != Verdict::Holds).map_or_else(String::new, |at| format!("; {at}"));
    let mut text =
        format!("{} for {}: {verdict} (error {}{place})", label(own), cost_text(own.cost, unit), errors(own, budget));
    if let Some(cheaper) = next_cheaper.map(|i| &tried[i]) {
        let outcome = match cheaper.verdict {
            Verdict::Undecided => "could not be told apart from",
            Verdict::Holds => "alone holds, too, with",
            Verdict::Fails => "would have",
        };
        text.push_str(&format!(
            "; {} for {} {outcome} {}",
            label(cheaper),
            cost_text(cheaper.cost, unit),
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
