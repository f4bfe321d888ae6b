//! Bakes of scenes: a model for each material, and only the code and the tables that these models need.

use luthier::{Bake, Error, Shading};
use luthier_bake::{BakeError, Options, Store};
use luthier_export::{Package, PackageError, sha256};
use luthier_lut::{FormatSet, RowLayout, TexelFormat};
use luthier_manifest::{
    Budget, Functions, MaterialChoice, Names, SceneBudget, SceneCandidate, SceneChoice, SceneError, ShadingModel,
    Target,
};
use luthier_material::{Material, Scene};
use luthier_report::{ReportError, Subject, TableTerms, Weights};
use thiserror::Error;

use crate::choice::Widths;
use crate::divergence::cheapest;
use crate::{CostTable, DeviceCost, Form, Judge, Shaded, TABLE_SHARE, cost_text, label, scene_cost};

/// Limits on the absolute error of tables to try, loosest first.
const TABLE_LEVELS: [f64; 6] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5];

/// Size of an ordinary reflectance. It turns the tightest relative limit of a scene into an absolute one, at which the search for tables begins.
const REFLECTANCE: f64 = 0.2;

/// A search for the models and tables of a scene. Each step keeps its results for the next.
pub struct Director<'a> {
    scene: &'a Scene,
    materials: &'a [Material],
    targets: Vec<Target>,
    functions: Functions,
    names: Names,
    store: &'a dyn Store,
    costs: CostTable,
    /// Whether the target has the format of rows of lobes, and whether models may be fitted.
    has_rows: bool,
    has_fits: bool,
    baked: Option<Vec<Judge>>,
    full: Option<Vec<Judge>>,
}

/// A bake of a scene.
#[derive(Debug, Clone)]
pub struct Made {
    /// The models, with the reasons for them.
    pub choice: SceneChoice,
    /// The tables and shaders that these models need.
    pub package: Package,
}

impl Made {
    /// Bytes of all texels.
    pub fn bytes(&self) -> u64 {
        self.package.texel_bytes()
    }

    /// Cost of all materials together, in the unit of the choice's device.
    pub fn cost(&self) -> f64 {
        self.choice.cost
    }

    /// The largest error of a model, relative.
    pub fn max_rel(&self) -> f64 {
        self.choice.materials.iter().map(|choice| choice.candidate().error.max_rel).fold(0.0, f64::max)
    }

    /// The largest error of tables, relative.
    pub fn table_max_rel(&self) -> f64 {
        self.choice.materials.iter().filter_map(|c| c.table_error).map(|error| error.max_rel).fold(0.0, f64::max)
    }
}

/// Materials of a scene by models that no budget chose.
#[derive(Debug, Clone)]
pub struct Unchosen {
    /// Model and error of each.
    pub materials: Vec<SceneCandidate>,
    /// Cost of all together, in the unit of the director's device.
    pub cost: f64,
}

impl Unchosen {
    /// The largest error, relative.
    pub fn max_rel(&self) -> f64 {
        self.materials.iter().map(|material| material.error.max_rel).fold(0.0, f64::max)
    }
}

/// Failure to bake a scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneFailure {
    /// No models and tables hold the budget of the scene.
    #[error("no choice of models and tables holds the budget of the scene. {reasons}{hint}")]
    Unheld {
        /// A line for each form that was tried.
        reasons: String,
        /// Advice to the user, possibly empty.
        hint: &'static str,
    },
    /// The chosen models cannot be baked.
    #[error(transparent)]
    Export(#[from] Error),
    /// Texels that cannot be read back.
    #[error(transparent)]
    Package(#[from] PackageError),
    /// Tables that the judge refuses.
    #[error(transparent)]
    Report(#[from] ReportError),
}

/// Reason to reject a form.
enum Refusal {
    /// No model holds the budget.
    Model(String),
    /// Tables are too large, too coarse or of the wrong format. The form without tables may still do.
    Tables(String),
}

impl<'a> Director<'a> {
    /// A search for the materials of a scene. `targets` are the languages of the shaders; their form is chosen with the models. Results in the store
    /// are not computed again.
    pub fn new(scene: &'a Scene, materials: &'a [Material], targets: Vec<Target>, store: &'a dyn Store) -> Self {
        // Rows of lobes exist in one format only: without it, `lobes` is no candidate.
        let has_rows = scene.target.formats.is_none_or(|formats| formats.has(TexelFormat::Rgba16Float));
        let costs = default_costs(scene);
        Self {
            scene,
            materials,
            targets,
            functions: Functions::default(),
            names: Names::default(),
            store,
            costs: rows_of(scene, if has_rows { costs } else { costs.without(ShadingModel::Lobes) }),
            has_rows,
            has_fits: true,
            baked: None,
            full: None,
        }
    }

    /// Takes the costs of a device in place of those that the scene names.
    #[must_use]
    pub fn with_costs(self, device: DeviceCost) -> Self {
        let costs = rows_of(self.scene, CostTable::of(device));
        let has_lobes = self.has_rows && self.has_fits;
        Self { costs: if has_lobes { costs } else { costs.without(ShadingModel::Lobes) }, ..self }
    }

    /// The device whose costs count.
    pub fn device(&self) -> &DeviceCost {
        &self.costs.device
    }

    /// Excludes models that are fitted to a simulation of the stack.
    #[must_use]
    pub fn without_fits(self) -> Self {
        Self { costs: self.costs.without(ShadingModel::Lobes), has_fits: false, ..self }
    }

    /// Adds groups of functions to the shaders.
    #[must_use]
    pub fn with_functions(self, functions: Functions) -> Self {
        Self { functions, ..self }
    }

    /// Takes names for the shaders and places for their resources.
    #[must_use]
    pub fn with_names(self, names: Names) -> Self {
        Self { names, ..self }
    }

    /// Chooses and bakes. `max_rel`, if given, replaces the limits on the relative error. The form `baked` is tried first, and `full` if tables do not
    /// fit the target. With `allow_miss`, the nearest candidates are taken if none holds.
    pub fn step(&mut self, max_rel: Option<f64>, allow_miss: bool) -> Result<Made, SceneFailure> {
        let budgets: Vec<SceneBudget> = self.scene.materials.iter().map(|m| self.budget(&m.budget, max_rel)).collect();
        let mut reasons = Vec::new();
        for form in [Form::Baked, Form::Full] {
            match self.attempt(form, &budgets, allow_miss)? {
                Ok(made) => return Ok(made),
                Err(Refusal::Tables(reason)) => reasons.push(format!("{}: {reason}", form.name())),
                Err(Refusal::Model(reason)) => {
                    reasons.push(format!("{}: {reason}", form.name()));
                    break;
                }
            }
        }
        let hint =
            if allow_miss { "" } else { "\nloosen the budget, or take the nearest candidates with --allow-miss" };
        Err(SceneFailure::Unheld { reasons: reasons.join("\n"), hint })
    }

    /// The materials by their own models, which no budget chose: a bake without a scene comes near to it. `None` before a step of the form `baked`, and where
    /// a model is no candidate.
    pub fn without_choice(&mut self) -> Option<Unchosen> {
        let materials: Vec<SceneCandidate> =
            self.baked.as_mut()?.iter_mut().map(Judge::by_itself).collect::<Option<_>>()?;
        let shaded: Vec<Shaded> =
            materials.iter().map(|&SceneCandidate { model, cost, .. }| Shaded { model, cost }).collect();
        Some(Unchosen { cost: scene_cost(&shaded, self.scene.neighbours_differ), materials })
    }

    /// The limits of a material.
    fn budget(&self, own: &SceneBudget, max_rel: Option<f64>) -> SceneBudget {
        let given = SceneBudget { max_rel, ..SceneBudget::default() };
        given.or(own).or(&self.scene.budget)
    }

    fn attempt(
        &mut self,
        form: Form,
        budgets: &[SceneBudget],
        allow_miss: bool,
    ) -> Result<Result<Made, Refusal>, SceneFailure> {
        let judges = match form {
            Form::Baked => &mut self.baked,
            Form::Full => &mut self.full,
        };
        let (scene, costs) = (self.scene, &self.costs);
        let judges = judges.get_or_insert_with(|| {
            let materials = self.materials.iter();
            // Materials that limit the errors of their rows have a search of their own.
            let has_forms = !self.materials.iter().any(|material| material.budget.limits_lobes());
            materials.map(|material| Judge::new(material, form, &scene.lights, &scene.view, costs, has_forms)).collect()
        });
        let mut picked: Option<Picked> = None;
        let mut refusal = None;
        for widths in Widths::ALL {
            match pick(judges, self.materials, budgets, scene, costs, widths) {
                Ok(found) if picked.as_ref().is_none_or(|best| found.is_before(best)) => picked = Some(found),
                Ok(_) => {}
                Err(reason) => refusal = Some(reason),
            }
        }
        let Some(Picked { mut choices, cost, misses, .. }) = picked else {
            return Ok(Err(Refusal::Model(refusal.unwrap_or_default())));
        };
        if !misses.is_empty() && !allow_miss {
            return Ok(Err(Refusal::Model(format!("no model holds the budget\n{}", misses.join("\n")))));
        }
        let materials: Vec<Material> = judges
            .iter()
            .zip(&choices)
            .map(|(judge, choice)| judge.candidate(choice.candidate()).material.clone())
            .collect();
        // No refusals by domain: the judges have measured the error of each model.
        let (targets, functions) = (self.targets.clone(), self.functions.clone());
        let bake = Bake {
            targets,
            shading: Shading { forms: vec![form], ..Shading::default() },
            functions,
            names: self.names.clone(),
            refuses: false,
            ..Bake::default()
        };
        let package = match form {
            Form::Full => bake.package(&materials, self.store)?,
            Form::Baked => {
                let formats = scene.target.formats.unwrap_or(FormatSet::CORE);
                let layout = scene.target.max_bytes.map(|_| RowLayout::Filtered);
                let bake = Bake { options: Options { formats, layout, ..bake.options }, ..bake };
                match tables(&materials, &bake, self.store, judges, &mut choices, budgets, allow_miss)? {
                    Ok(package) => package,
                    Err(reason) => return Ok(Err(Refusal::Tables(reason))),
                }
            }
        };
        let choice = SceneChoice {
            scene: scene.name.clone(),
            source: scene.source.clone(),
            source_hash: sha256(scene.text.as_bytes()),
            form,
            device: Some(self.costs.manifest_device()),
            neighbours_differ: scene.neighbours_differ,
            cost,
            materials: choices,
        };
        let mut made = Made { choice, package };
        made.package.manifest.choice = Some(made.choice.clone());
        Ok(match unfit(scene, &made) {
            Some(reason) => Err(Refusal::Tables(reason)),
            None => Ok(made),
        })
    }
}

/// A choice for every material.
struct Picked {
    choices: Vec<MaterialChoice>,
    /// Cost of all together.
    cost: f64,
    /// A line for each that misses its budget.
    misses: Vec<String>,
    /// The largest ratio of an error to a limit, of those that miss.
    excess: f64,
}

impl Picked {
    /// Whether it misses fewer budgets, or by less; or costs less.
    fn is_before(&self, other: &Self) -> bool {
        let order = self.misses.len().cmp(&other.misses.len());
        order.then(self.excess.total_cmp(&other.excess)).then(self.cost.total_cmp(&other.cost)).is_lt()
    }
}

/// Chooses for every material, of candidates whose rows one set may have together.
///
/// # Errors
/// In words, where a material has no candidate within the largest cost.
fn pick(
    judges: &mut [Judge],
    materials: &[Material],
    budgets: &[SceneBudget],
    scene: &Scene,
    costs: &CostTable,
    widths: Widths,
) -> Result<Picked, String> {
    let share = scene.neighbours_differ;
    let mut all_tried = Vec::new();
    for (judge, (budget, material)) in judges.iter_mut().zip(budgets.iter().zip(materials)) {
        let tried = judge.tried(budget, scene.target.max_cost, share, widths);
        let Some(eligible) = tried.eligible() else {
            let unit = costs.device.unit;
            let least = judge.candidates().first().map_or(0.0, |candidate| candidate.cost);
            let [least, most] = [least, scene.target.max_cost.unwrap_or_default()].map(|cost| cost_text(cost, unit));
            let name = &costs.device.name;
            return Err(format!("{}: the cheapest model takes {least} on {name}, more than {most}", material.name));
        };
        all_tried.push((tried, eligible));
    }
    let shaded = all_tried.iter().map(|(tried, eligible)| eligible.iter().map(|&i| tried.shaded(i)).collect());
    let shaded: Vec<Vec<Shaded>> = shaded.collect();
    // Alone, each material takes its cheapest.
    let places = if share == 0.0 { None } else { cheapest(&shaded, share) };
    let places = places.unwrap_or_else(|| vec![0; shaded.len()]);
    let taken: Vec<Shaded> = shaded.iter().zip(&places).map(|(of_one, &place)| of_one[place]).collect();
    let names = DeviceCost::names().filter(|name| *name != costs.device.name);
    let others: Vec<CostTable> = names.filter_map(CostTable::on).collect();
    let mut picked = Picked { choices: Vec::new(), cost: scene_cost(&taken, share), misses: Vec::new(), excess: 0.0 };
    for ((judge, (tried, eligible)), place) in judges.iter().zip(all_tried).zip(places) {
        let mut choice = judge.chosen(tried, eligible[place]);
        choice.disagreements = judge.disagreements(&choice, costs, &others);
        if !choice.holds() {
            picked.misses.push(format!("{}: {}", choice.name, choice.reason));
            picked.excess = picked.excess.max(choice.budget.excess(&choice.candidate().error));
        }
        picked.choices.push(choice);
    }
    Ok(picked)
}

/// The costs that a scene asks for. A limit on cost without a device is one of cycles on RDNA2.
fn default_costs(scene: &Scene) -> CostTable {
    let named = scene.target.device.as_deref().or(scene.target.max_cost.map(|_| "rdna2"));
    named.and_then(CostTable::on).unwrap_or_else(CostTable::shipped)
}

/// The costs with the rows that a scene's target has room for. Steps double the bytes of rows.
fn rows_of(scene: &Scene, costs: CostTable) -> CostTable {
    let has_steps = scene.target.max_bytes.is_none()
        && scene.target.formats.is_none_or(|formats| formats.has(RowLayout::Steps.format()));
    if has_steps { costs } else { costs.filtered() }
}

/// Reason why tables do not fit the target: too many bytes, or a format that it lacks.
fn unfit(scene: &Scene, made: &Made) -> Option<String> {
    let bytes = made.bytes();
    if let Some(most) = scene.target.max_bytes.filter(|most| bytes > *most) {
        return Some(format!("tables take {bytes} bytes, more than {most}"));
    }
    let formats = scene.target.formats?;
    let foreign = made.package.manifest.tables.iter().find(|table| !formats.has(table.format))?;
    Some(format!("the {} table is {}, which the target does not have", foreign.kind.name(), foreign.format.name()))
}

/// The loosest tables whose errors, under the light of the scene, stay inside [`TABLE_SHARE`] of the budgets.
fn tables(
    materials: &[Material],
    bake: &Bake<'_>,
    store: &dyn Store,
    judges: &[Judge],
    choices: &mut [MaterialChoice],
    budgets: &[SceneBudget],
    allow_miss: bool,
) -> Result<Result<Package, String>, SceneFailure> {
    let limits: Vec<SceneBudget> = budgets.iter().map(|budget| budget.scaled(TABLE_SHARE)).collect();
    let tightest = limits.iter().filter_map(|limit| limit.max_rel).fold(f64::INFINITY, f64::min);
    let levels = TABLE_LEVELS.into_iter().filter(|level| *level <= REFLECTANCE * tightest);
    // The default tables, which have no budget, come last.
    let mut levels: Vec<Option<f64>> = levels.map(Some).chain([None]).collect();
    levels.reverse();
    let mut nearest = String::new();
    while let Some(level) = levels.pop() {
        let budget = Budget { max_abs: level, ..Budget::default() };
        let bake = Bake { options: Options { budget, ..bake.options }, ..bake.clone() };
        let package = match bake.package(materials, store) {
            // A budget that no table holds rules out tighter ones.
            Err(Error::Bake(BakeError::Budget { .. })) if level.is_some() => {
                levels = vec![None];
                continue;
            }
            package => package?,
        };
        let errors = table_errors(&package, materials, judges, choices, budgets)?;
        choices.iter_mut().zip(&errors).for_each(|(choice, error)| choice.table_error = Some(*error));
        let worst = (0..errors.len())
            .map(|i| (i, limits[i].excess(&errors[i])))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, excess)| *excess > 1.0);
        let Some((number, excess)) = worst else { return Ok(Ok(package)) };
        if levels.is_empty() && allow_miss {
            return Ok(Ok(package));
        }
        nearest = format!(
            "the tables for {} ({}) have {excess:.2} times the error that the budget leaves to tables",
            choices[number].name,
            label(choices[number].candidate())
        );
    }
    Ok(Err(nearest))
}

/// Errors of the tables of every material at the directions of the scene.
fn table_errors(
    package: &Package,
    materials: &[Material],
    judges: &[Judge],
    choices: &[MaterialChoice],
    budgets: &[SceneBudget],
) -> Result<Vec<SceneError>, SceneFailure> {
    let (manifest, textures) = (&package.manifest, package.textures()?);
    let stacks = materials.iter().map(|material| material.reflecting_stack().into_owned()).collect();
    let subject = Subject { manifest, textures, stacks, maps: Vec::new(), films: Vec::new() };
    let errors = (0..materials.len()).map(|number| {
        let terms = TableTerms::new(&subject, number, Weights::EightBit)?;
        Ok(judges[number].table_error(choices[number].candidate(), &terms, budgets[number].delta_e.is_some()))
    });
    errors.collect()
}
