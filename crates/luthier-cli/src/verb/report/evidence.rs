//! Evidence that a report shows in addition to the judgement: searches for single materials, models against paths, costs, stability, choices.

use std::path::Path;

use luthier::{Store, outline};
use luthier_bake::{Function, Options, kept};
use luthier_export::{GENERATOR, sha256};
use luthier_manifest::{Form, LobesForm, Manifest, ShadingModel};
use luthier_material::Material;
use luthier_report::stability::Stability;
use luthier_report::{
    AgainstReference, Costs, ModelSettings, ModelSubject, ReferencePaths, Report, ShapeCost, StabilitySummary,
    judge_shading_models,
};
use luthier_scene::CostTable;
use luthier_terminal::{Failure, Outcome};
use rayon::prelude::*;
use serde_json::json;

use crate::cli::ReportOptions;
use crate::input;
use crate::store::store;

/// First family of random numbers of the paths.
const SEED: u64 = 1;

/// The errors of models. Raise the revision when models, paths or measurements give other errors than before.
const REFERENCE: Function = Function { kind: "reference", revision: 2 };

/// Contents of the files that the command line names.
pub(super) struct Given {
    costs: Option<Costs>,
    pub(super) stability: Option<Stability>,
    /// Names and descriptions of the files, for the provenance.
    pub(super) files: Vec<(String, String)>,
}

/// Reads the files.
pub(super) fn given(options: &ReportOptions) -> Outcome<Given> {
    let mut out = Given { costs: None, stability: None, files: Vec::new() };
    if let Some(path) = &options.cost {
        let text = read(path, "costs", &mut out.files)?;
        out.costs = Some(serde_json::from_str(&text).map_err(|source| unusable(path, "luthier cost", source.into()))?);
    } else {
        let driver = CostTable::rdna2().device.driver;
        out.files.push(("costs".to_owned(), format!("shaders for layers of the same kinds; {driver}")));
    }
    if let Some(path) = &options.stability {
        let text = read(path, "stability", &mut out.files)?;
        let suite = Stability::from_json(&text);
        out.stability = Some(suite.map_err(|source| unusable(path, "luthier-lab stability", source.into()))?);
    }
    Ok(out)
}

fn read(path: &Path, what: &str, names: &mut Vec<(String, String)>) -> Outcome<String> {
    let text = input::named_text(path)?;
    names.push((what.to_owned(), format!("{}, SHA-256 {}", path.display(), sha256(text.as_bytes()))));
    Ok(text)
}

fn unusable(path: &Path, command: &str, source: anyhow::Error) -> Failure {
    Failure::Input(source.context(format!("{} is not what `{command} --json` prints", path.display())))
}

/// Puts it all into the report.
pub(super) fn add(
    report: &mut Report,
    given: &Given,
    options: &ReportOptions,
    manifest: &Manifest,
    materials: &[Material],
) -> Outcome {
    if let Some(costs) = &given.costs {
        let mut costs = costs.clone();
        costs.rows.retain(|row| !row.constant && report.materials.iter().any(|m| m.name == row.material));
        report.costs = Some(costs);
    }
    let costs = CostTable::rdna2().reading(manifest);
    for ((judged, material), entry) in report.materials.iter_mut().zip(materials).zip(&manifest.materials) {
        let lobes = entry.constants.lobes.as_ref().and_then(LobesForm::of);
        judged.shape_cost = shape_cost(&costs, judged.model, material, lobes);
    }
    report.stability = given.stability.as_ref().map(StabilitySummary::of);
    // Fixed sizes were not searched for, so a search has nothing to add.
    if !manifest.searches.is_empty() && manifest.generator == GENERATOR {
        let (options, store) = (Options { fits: false, ..Options::default() }, store()?);
        let alone: Vec<_> = materials
            .par_iter()
            .map(|material| outline(std::slice::from_ref(material), &options, store))
            .collect::<Result<_, _>>()?;
        for (material, outline) in report.materials.iter_mut().zip(alone) {
            material.alone = outline.searches;
        }
    }
    choices(report, manifest);
    if let Some(samples) = options.reference {
        let settings = ModelSettings { samples, seed: SEED };
        let subjects = materials.iter().zip(&manifest.materials).map(|(material, entry)| ModelSubject {
            name: entry.name.clone(),
            stack: material.stack.clone(),
            wavelengths_nm: entry.wavelengths_nm,
        });
        let (subjects, store): (Vec<ModelSubject>, _) = (subjects.collect(), store()?);
        let judged: Vec<_> = subjects.par_iter().map(|subject| against_reference(subject, settings, store)).collect();
        for (material, judged) in report.materials.iter_mut().zip(judged) {
            material.against_reference = judged;
        }
        report.reference = Some(ReferencePaths { paths: samples.get(), seed: SEED });
    }
    Ok(())
}

/// The errors of all models of a material; from the store if an earlier report has them.
fn against_reference(subject: &ModelSubject, settings: ModelSettings, store: &dyn Store) -> Vec<AgainstReference> {
    let ModelSubject { stack, wavelengths_nm, .. } = subject;
    let inputs = json!({
        "stack": stack,
        "wavelengths_nm": wavelengths_nm,
        "paths": settings.samples,
        "seed": settings.seed,
    });
    kept(REFERENCE, &inputs, store, || judge_shading_models(subject, settings))
}

/// Cost of the shader of a material, from the table that scenes choose by.
fn shape_cost(
    costs: &CostTable,
    model: ShadingModel,
    material: &Material,
    lobes: Option<LobesForm>,
) -> Option<ShapeCost> {
    let shape = luthier_scene::shape(&material.stack);
    let (baked, is_of_similar) = costs.cost(model, Form::Baked, &shape, lobes)?;
    let full = costs.cost(model, Form::Full, &shape, None).map(|(cycles, _)| cycles as u32);
    Some(ShapeCost { baked: baked as u32, full, is_of_similar })
}

/// Adds the manifest's reasons for the choice of each model, which a bake of a scene has.
fn choices(report: &mut Report, manifest: &Manifest) {
    let Some(choice) = &manifest.choice else { return };
    for (material, choice) in report.materials.iter_mut().zip(&choice.materials) {
        let shipped = choice.tried.get(choice.chosen);
        let next = choice.next_cheaper.and_then(|place| choice.tried.get(place));
        material.choice =
            Some(json!({"why": choice.reason, "budget": choice.budget, "shipped": shipped, "next_cheaper": next}));
    }
}
