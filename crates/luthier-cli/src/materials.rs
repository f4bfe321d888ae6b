//! Materials and surfaces that a command works on.

use std::path::PathBuf;

use luthier_export::{
    Source, SurfaceSource, gather, of_energy, of_function, of_model, of_parts, read_all, refuse, refuse_surfaces,
};
use luthier_manifest::{Form, FunctionGroup, Reflectance, ShadingModel, SurfaceEntry};
use luthier_material::{Diagnostic, Material, Severity};
use luthier_optics::stack::{Base, Layer};
use luthier_terminal::{Broken, Failure, Outcome, complain, print_diagnostics, valid};

use crate::cli::Shading;

impl Shading {
    /// The model by which the command line has a material shaded in some forms, unless that is the material's own. The form `full` computes all
    /// terms, so that it takes a model that is not fitted.
    fn model_of(&self, material: &Material, forms: &[Form]) -> Option<ShadingModel> {
        let is_closed = self.no_fit || forms.contains(&Form::Full);
        self.model.or_else(|| is_closed.then(|| material.model_without_fit()))
    }

    /// The model by which a material is shaded.
    pub(crate) fn model(&self, material: &Material) -> ShadingModel {
        self.model_of(material, &[]).unwrap_or_else(|| material.model())
    }

    /// Doubts about a material in some forms, and refusals.
    pub(crate) fn doubts(&self, material: &Material, forms: &[Form]) -> Vec<Diagnostic> {
        let model = self.model_of(material, forms);
        let chosen = self.fresnel.map(|_| {
            let mut chosen = material.clone();
            chosen.bake.reflectance = self.fresnel;
            chosen
        });
        let mut doubts = of_model(chosen.as_ref().unwrap_or(material), model);
        if self.no_fit && model.is_some_and(ShadingModel::is_fitted) {
            let message = "the model `lobes` is fitted to a simulation, and `--no-fit` makes none";
            let hint = "leave out `--no-fit`, or write `--model elek` in its place".to_owned();
            doubts.push(material.diagnostic(Severity::Error, "bake.model", message, Some(hint)));
        }
        doubts
    }

    /// Doubts about a material, those about its energy too, which take some hundredths of a second.
    pub(crate) fn doubts_and_energy(&self, material: &Material, forms: &[Form]) -> Vec<Diagnostic> {
        let mut doubts = self.doubts(material, forms);
        if !doubts.iter().any(Diagnostic::is_error) {
            doubts.extend(of_energy(material, self.model_of(material, forms)));
        }
        doubts
    }
}

/// The materials that can be baked, shaded by the model that the command line asks for; or, when anything is refused, its diagnostics
/// and a failure.
pub(crate) fn bakeable(
    mut sources: Vec<Source>,
    shading: &Shading,
    forms: &[Form],
    quiet: bool,
) -> Outcome<Vec<Material>> {
    refuse(&mut sources, |material| shading.doubts(material, forms));
    Ok(shaded(valid(sources, quiet)?, shading, forms))
}

/// The materials and surfaces of files that can be baked, or a failure, as `bakeable` has it; the materials of surfaces are among them.
pub(crate) fn bakeable_with_surfaces(
    files: &[PathBuf],
    shading: &Shading,
    forms: &[Form],
    quiet: bool,
) -> Outcome<(Vec<Material>, Vec<SurfaceEntry>)> {
    let mut found = gather(files)?;
    let mut sources = read_all(&found.materials)?;
    refuse(&mut sources, |material| shading.doubts(material, forms));
    refuse_surfaces(&mut found.surfaces, &sources);
    let surfaces = valid_surfaces(&found.surfaces)?;
    Ok((shaded(valid(sources, quiet)?, shading, forms), surfaces))
}

/// The surfaces of all files; or, when any is invalid, its diagnostics and a failure.
pub(crate) fn valid_surfaces(surfaces: &[SurfaceSource]) -> Outcome<Vec<SurfaceEntry>> {
    let mut diagnostics = Vec::new();
    for source in surfaces {
        let errors = source.parsed.as_ref().err().into_iter().flatten();
        print_diagnostics(errors.clone(), &source.text);
        diagnostics.extend(errors.cloned());
    }
    if diagnostics.is_empty() {
        return Ok(surfaces.iter().filter_map(SurfaceSource::entry).collect());
    }
    let broken = surfaces.iter().filter(|source| source.parsed.is_err()).count();
    let sentence = format!("{broken} of {} surface files cannot be used; nothing was written", surfaces.len());
    Err(Failure::input(Broken { sentence, diagnostics }))
}

/// The materials, shaded by the model that the command line asks for, with its tables.
pub(crate) fn shaded(mut materials: Vec<Material>, shading: &Shading, forms: &[Form]) -> Vec<Material> {
    for material in &mut materials {
        material.bake.model = shading.model_of(material, forms).or(material.bake.model);
        material.bake.reflectance = shading.fresnel.or(material.bake.reflectance);
        material.bake.tables.extend(&shading.tables);
    }
    materials
}

/// Refuses functions of the environment where no shader has them.
pub(crate) fn refuse_environment(functions: &[FunctionGroup], is_shown: bool) -> Outcome {
    if is_shown || !functions.contains(&FunctionGroup::Environment) {
        return Ok(());
    }
    Err(Failure::Usage(anyhow::anyhow!(
        "`--functions environment` is for interfaces of the model `lobes` in the form `baked`, and there is none: leave it out, or write \
         `--model lobes`"
    )))
}

/// Whether the form `baked` of a material shows the environment.
pub(crate) fn shows_environment(material: &Material) -> bool {
    let is_interface = |layer: &Layer| !matches!(layer.base, Base::Diffuse(_));
    material.model().is_fitted() && material.stack.layers.iter().any(is_interface)
}

/// Has a material shaded by one of several models that are compared: each with the parts that it has, of the file or the command line.
pub(crate) fn shade_by(material: &mut Material, model: ShadingModel, fresnel: Option<Reflectance>) -> Outcome {
    material.bake.reflectance = fresnel.or(material.bake.reflectance);
    material.shade_by(model);
    match of_parts(material, None).into_iter().find(Diagnostic::is_error) {
        Some(error) => Err(Failure::Input(anyhow::anyhow!("{}: {}", error.label, error.message))),
        None => Ok(()),
    }
}

/// The models that are asked for, or all; without a fit, all but `lobes`.
#[cfg(any(feature = "cost", feature = "gpu"))]
pub(crate) fn models(asked: &[ShadingModel], no_fit: bool) -> Vec<ShadingModel> {
    let all = || ShadingModel::ALL.into_iter().filter(|model| !no_fit || !model.is_fitted()).collect();
    if asked.is_empty() { all() } else { asked.to_vec() }
}

/// Whether a material can be shaded by a model. Where no model is asked for, one that has not its distribution of slopes is left out, and that is said.
pub(crate) fn is_shaded_by(material: &Material, model: ShadingModel, asked: &[ShadingModel]) -> bool {
    let lack = of_function(material, model.name()).filter(|_| !asked.contains(&model));
    if let Some(lack) = &lack {
        complain(&format!("warning: {} is left out of {}: {}", material.name, model.name(), lack.message));
    }
    lack.is_none()
}
