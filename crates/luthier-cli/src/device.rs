//! The graphics adapter as the judge sees it.

use luthier_gpu::{Gpu, GpuError, Package, Scene};
use luthier_report::{Device, Form};

use crate::failure::{Failure, Outcome};

/// Both shaders of a bake, ready to run.
pub(crate) struct Shaders {
    name: String,
    baked: Scene,
    full: Scene,
}

impl Shaders {
    pub(crate) fn new(gpu: &Gpu, package: &Package) -> Outcome<Self> {
        let scene = |form| gpu.scene(package, form).map_err(device);
        let name = format!("{} ({}, {})", gpu.adapter_name(), gpu.backend(), gpu.driver());
        Ok(Self { name, baked: scene(Form::Baked)?, full: scene(Form::Full)? })
    }
}

impl Shaders {
    /// The pipelines of a form.
    pub(crate) fn scene(&self, form: Form) -> &Scene {
        match form {
            Form::Baked => &self.baked,
            Form::Full => &self.full,
        }
    }
}

impl Device for Shaders {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn evaluate(&self, form: Form, material: u32, pairs: &[luthier_report::Pair]) -> Result<Vec<[f32; 3]>, String> {
        self.scene(form).evaluate(material, pairs).map_err(|source| source.to_string())
    }
}

/// Opens an adapter: the best there is, or the one whose name contains a text.
pub(crate) fn open(name: Option<&str>) -> Outcome<Gpu> {
    name.map_or_else(Gpu::open, Gpu::open_named).map_err(device)
}

/// An error of the runtime: what is wrong with the bake is not the adapter's fault.
pub(crate) fn device(source: GpuError) -> Failure {
    match source {
        GpuError::Package(source) => source.into(),
        GpuError::NoReflectance { .. } | GpuError::Binding { .. } => Failure::Input(source.into()),
        _ => Failure::Device(source.into()),
    }
}
