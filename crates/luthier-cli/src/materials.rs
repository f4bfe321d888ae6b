//! Materials and surfaces that a command works on.

use luthier::refusals::{misses, of_function, of_parts};
use luthier::{Files, Source, Sources, SurfaceSource, refuse, source_hash};
use luthier_manifest::{Form, FunctionGroup, Manifest, MaterialEntry, Reflectance, ShadingModel, SurfaceEntry};
use luthier_material::{Diagnostic, Material};
use luthier_optics::stack::Base;
use luthier_terminal::{Broken, Failure, Outcome, complain, print_diagnostics, valid};

use crate::cli::Shading;

impl Shading {
    /// These options, restricted to shaders of some forms; empty for all forms.
    pub(crate) fn in_forms(&self, forms: &[Form]) -> luthier::Shading {
        let Self { model, no_fit, fresnel: reflectance, tables } = self.clone();
        luthier::Shading { model, no_fit, reflectance, tables, forms: forms.to_vec() }
    }
}

/// The materials, shaded as the command line asks for. If any cannot be baked, its diagnostics are printed and the result is a failure.
pub(crate) fn bakeable(mut sources: Vec<Source>, shading: &luthier::Shading, quiet: bool) -> Outcome<Vec<Material>> {
    refuse(&mut sources, |material| shading.doubts(material));
    Ok(shading.shaded(valid(sources, quiet)?))
}

/// The materials and surfaces of files, or a failure as of `bakeable`. Materials that only surfaces name are included.
pub(crate) fn bakeable_with_surfaces(
    files: Files,
    shading: &luthier::Shading,
    quiet: bool,
) -> Outcome<(Vec<Material>, Vec<SurfaceEntry>)> {
    let mut sources = Sources::of(files.without_scenes());
    sources.refuse(shading);
    let surfaces = valid_surfaces(&sources.surfaces)?;
    Ok((shading.shaded(valid(sources.materials, quiet)?), surfaces))
}

/// The surfaces of all files. If any is invalid, its diagnostics are printed and the result is a failure.
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

/// Warnings for layers of a bake whose tiles miss their aim. They are printed unless `quiet`.
pub(crate) fn tell_misses(manifest: &Manifest, materials: &[Material], quiet: bool) -> Vec<Diagnostic> {
    let warnings = misses(manifest, materials);
    for warning in warnings.iter().filter(|_| !quiet) {
        let material = materials.iter().find(|material| material.source == warning.label);
        print_diagnostics([warning], material.map_or("", |material| &material.text));
    }
    warnings
}

/// Refuses functions of the environment where no shader has them.
pub(crate) fn refuse_environment(functions: &[FunctionGroup], is_shown: bool) -> Outcome {
    if is_shown || functions.iter().all(|group| group.environment_reads().is_none()) {
        return Ok(());
    }
    Err(Failure::Usage(anyhow::anyhow!(
        "`--functions environment` is for materials with an interface, of the model `lobes` in the form `baked`, and there is none: leave it out"
    )))
}

/// True where one of some forms of a material shows a blurred environment; no form stands for all.
pub(crate) fn shows_environment(material: &Material, forms: &[Form]) -> bool {
    let has_form = forms.is_empty() || material.model().facts().forms.iter().any(|form| forms.contains(form));
    has_form && material.stack.layers.first().is_some_and(|layer| !matches!(layer.base, Base::Diffuse(_)))
}

/// Makes a model shade a material for a comparison of models. The model keeps the chosen parts that it has, from the file or the command line.
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
    match asked {
        [] => ShadingModel::ALL.into_iter().filter(|model| !no_fit || !model.is_fitted()).collect(),
        _ => asked.to_vec(),
    }
}

/// True where a model can shade a material. If no model was asked for, a model without the material's slope distribution is left out with a warning.
pub(crate) fn is_shaded_by(material: &Material, model: ShadingModel, asked: &[ShadingModel]) -> bool {
    let lack = of_function(material, model.name()).filter(|_| !asked.contains(&model));
    if let Some(lack) = &lack {
        complain(&format!("warning: {} is left out of {}: {}", material.name, model.name(), lack.message));
    }
    lack.is_none()
}

/// Gives a material the model and the parts of its entry in a manifest. Returns true if the entry was made from this material.
pub(crate) fn is_baked_as(material: &mut Material, entry: &MaterialEntry) -> Outcome<bool> {
    let (masking, reflectance) = entry.parts();
    material.bake.model = Some(entry.model);
    material.bake.masking = Some(masking).filter(|masking| entry.model.takes_masking(*masking));
    material.bake.reflectance = Some(reflectance);
    Ok(source_hash(material)? == entry.source_hash)
}
