//! Shaders to time, on the device.

use luthier::{Bake, Options};
use luthier_cost::StaticCounts;
use luthier_export::{GENERATOR, Package, Shader};
use luthier_gpu::{Gpu, Scene};
use luthier_lut::{RowLayout, TableKind};
use luthier_manifest::{FunctionGroup, Manifest, ShadingModel};
use luthier_material::Material;
use luthier_shader::{CoatNumbers, Form, MaterialSet, Target, Yardstick};
use luthier_terminal::{Failure, Outcome};

use crate::cli::BenchOptions;
use crate::materials::{is_shaded_by, shade_by};
use crate::store::store;
use crate::verb::bench_fit;

/// One shader on the device.
pub(super) struct Subject {
    pub(super) shader: Timed,
    pub(super) form: Form,
    pub(super) closed: bool,
    /// Layout of rows of lobes, of a model that has them.
    pub(super) layout: Option<RowLayout>,
    /// Counts of its text for each number of lights; none where no fit is asked for.
    pub(super) counts: Vec<StaticCounts>,
    pub(super) scene: Scene,
}

/// Model or yardstick that a shader evaluates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Timed {
    Model(ShadingModel),
    Yardstick(Yardstick),
}

/// A bake whose shaders prepare a view once for all lights.
pub(super) fn bake<'a>() -> Bake<'a> {
    Bake { functions: [FunctionGroup::Light].into_iter().collect(), ..Bake::wgsl(&[]) }
}

/// The forms of every model of a material, and the yardsticks after the first. That is Phong's where it has the material's facets: ratios are to it.
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
        for layout in layouts(model, options) {
            let bake = bake();
            let bake = Bake { options: Options { layout, ..bake.options }, ..bake };
            let mut package = bake.package(std::slice::from_ref(&shaded), store()?)?;
            let reads_d = model.reads_some(TableKind::Distribution);
            let styles = [(Form::Full, true), (Form::Baked, !reads_d), (Form::Baked, true)];
            // A shader without a table of D is the same in both styles.
            let distinct = if reads_d { 3 } else { 2 };
            for (form, closed) in styles.into_iter().take(distinct).filter(|(form, _)| model.has(*form)) {
                if form == Form::Baked && closed && reads_d {
                    package = with_closed(package)?;
                }
                let scene = gpu.scene(&package, form)?;
                let counts = counts(&package, form, options)?;
                subjects.push(Subject { shader: Timed::Model(model), form, closed, layout, counts, scene });
            }
            if !subjects.iter().any(|subject: &Subject| matches!(subject.shader, Timed::Yardstick(_))) {
                for yardstick in Yardstick::ALL {
                    subjects.push(of_yardstick(gpu, yardstick, &package.manifest, options)?);
                }
            }
        }
    }
    Ok(subjects)
}

/// The layouts of rows to time: of a model with rows of lobes the one asked for, or all.
fn layouts(model: ShadingModel, options: &BenchOptions) -> Vec<Option<RowLayout>> {
    match (model.is_fitted(), options.layout) {
        (false, _) => vec![None],
        (true, Some(layout)) => vec![Some(layout)],
        (true, None) => RowLayout::ALL.map(Some).to_vec(),
    }
}

/// Counts of a shader for each number of lights that is timed, where a fit is asked for.
fn counts(package: &Package, form: Form, options: &BenchOptions) -> Outcome<Vec<StaticCounts>> {
    let lights = options.lights.iter().filter(|_| options.fit.is_some());
    lights.map(|&lights| bench_fit::counts(package, form, lights)).collect()
}

/// A yardstick with the numbers of the first material of a bake.
fn of_yardstick(gpu: &Gpu, yardstick: Yardstick, baked: &Manifest, options: &BenchOptions) -> Outcome<Subject> {
    let form = Form::Full;
    let entry = baked.materials[0].clone();
    let words = CoatNumbers::of(&entry).words();
    let manifest =
        Manifest { bindings: vec![Yardstick::binding()], ..Manifest::new(GENERATOR, vec![entry], Vec::new()) };
    let shaders = vec![Shader::wgsl(form, yardstick.wgsl())];
    let package = Package::from_parts(manifest, Vec::new(), shaders).map_err(Failure::input)?;
    let scene = gpu.scene(&package, form)?.with_words(&words)?;
    Ok(Subject {
        shader: Timed::Yardstick(yardstick),
        form,
        closed: true,
        layout: None,
        counts: counts(&package, form, options)?,
        scene,
    })
}

/// The bake with the shader `baked` that has D in closed form.
fn with_closed(mut package: Package) -> Outcome<Package> {
    let set = MaterialSet::from_manifest(&package.manifest).with_closed_distribution();
    let wgsl = luthier_shader::emit(&set, Form::Baked, Target::Wgsl).map_err(Failure::input)?;
    package.shaders = vec![Shader::wgsl(Form::Baked, wgsl)];
    Ok(package)
}
