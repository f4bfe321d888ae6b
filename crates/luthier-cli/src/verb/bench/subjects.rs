//! Shaders to time, on the device.

use luthier::Bake;
use luthier_export::{Package, Shader};
use luthier_gpu::{Gpu, Scene};
use luthier_lut::TableKind;
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_shader::{Form, MaterialSet, Target};
use luthier_terminal::{Failure, Outcome};

use crate::cli::BenchOptions;
use crate::materials::{is_shaded_by, shade_by};
use crate::store::store;

/// One shader on the device.
pub(super) struct Subject {
    pub(super) model: ShadingModel,
    pub(super) form: Form,
    pub(super) closed: bool,
    pub(super) scene: Scene,
}

/// The forms of every model of a material, Phong's model first where it has the material's facets: ratios are to it.
pub(super) fn subjects(gpu: &Gpu, material: &Material, options: &BenchOptions) -> Outcome<Vec<Subject>> {
    let mut models = vec![ShadingModel::Phong];
    models.extend(
        crate::materials::models(&options.model, options.no_fit)
            .into_iter()
            .filter(|&model| model != ShadingModel::Phong),
    );
    let mut subjects = Vec::new();
    for model in models.into_iter().filter(|&model| is_shaded_by(material, model, &options.model)) {
        let mut shaded = material.clone();
        shade_by(&mut shaded, model, options.fresnel)?;
        let mut package = Bake::lit().package(std::slice::from_ref(&shaded), store()?)?;
        let reads_d = model.reads_some(TableKind::Distribution);
        let styles = [(Form::Full, true), (Form::Baked, !reads_d), (Form::Baked, true)];
        // A shader without a table of D is the same in both styles.
        let distinct = if reads_d { 3 } else { 2 };
        for (form, closed) in styles.into_iter().take(distinct).filter(|(form, _)| model.has(*form)) {
            if form == Form::Baked && closed && reads_d {
                package = with_closed(package)?;
            }
            let scene = gpu.scene(&package, form)?;
            subjects.push(Subject { model, form, closed, scene });
        }
    }
    Ok(subjects)
}

/// The bake with the shader `baked` that has D in closed form.
fn with_closed(mut package: Package) -> Outcome<Package> {
    let set = MaterialSet::from_manifest(&package.manifest).with_closed_distribution();
    let wgsl = luthier_shader::emit(&set, Form::Baked, Target::Wgsl).map_err(Failure::input)?;
    package.shaders = vec![Shader::wgsl(Form::Baked, wgsl)];
    Ok(package)
}
