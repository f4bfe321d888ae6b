//! A package on a device: its textures and buffer, and the pipelines of the kernels.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use luthier_lut::TableKind;
use luthier_manifest::{Form, FunctionEntry, Interface, LayerRecord, Manifest, MapSlot};

use crate::bindings::{ShaderBindings, kernel_layout, material_words};
use crate::context::Context;
use crate::floor::Grounded;
use luthier_export::{Map, Package};

use crate::GpuError;
use crate::surroundings::Surroundings;

/// Value of a live number of a material: a factor, a colour or a direction, as a program writes it into a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiveValue {
    /// Number of the material.
    pub material: u32,
    /// Quantity.
    pub slot: MapSlot,
    /// Number of the layer from the top.
    pub layer: u32,
    /// One number and anything, RGB, or a vector.
    pub value: [f32; 3],
}

/// A bake on a device, ready to evaluate, to look up and to render.
#[derive(Debug)]
pub struct Scene {
    pub(crate) context: Context,
    pub(crate) manifest: Manifest,
    pub(crate) maps: Vec<Map>,
    /// Live numbers whose values are not those of the files.
    pub(crate) live: Vec<LiveValue>,
    form: Form,
    wgsl: String,
    /// The part of the shader that kernels call and fill.
    pub(crate) interface: Interface,
    pub(crate) bindings: ShaderBindings,
    /// Group 0 with the materials as baked.
    pub(crate) group: wgpu::BindGroup,
    kernels: wgpu::PipelineLayout,
    pub(crate) evaluate: wgpu::ComputePipeline,
    pub(crate) places: OnceLock<wgpu::ComputePipeline>,
    pub(crate) lookups: [OnceLock<wgpu::ComputePipeline>; TableKind::ALL.len()],
    /// Renderers of closed shapes, then of meshes; each first by blurred maps of the environment, then by directions.
    pub(crate) render: [[OnceLock<wgpu::ComputePipeline>; 2]; 2],
    /// Simulations of pairs, then of pictures; each first with one facet, then with walks.
    pub(crate) simulations: [OnceLock<wgpu::ComputePipeline>; 4],
    /// Kernels that are timed, by their text.
    timed: Arc<Mutex<BTreeMap<String, wgpu::ComputePipeline>>>,
    pub(crate) grounded: Mutex<Option<Grounded>>,
}

impl Scene {
    pub(crate) fn new(context: Context, package: &Package, form: Form) -> Result<Self, GpuError> {
        let package = &*package.in_own_names();
        let shader = package.shader(form)?;
        let (wgsl, interface) = (shader.text(), shader.interface.clone());
        let bindings = ShaderBindings::new(&context, package, &interface)?;
        let group = bindings.group(&context, &material_words(package), &Surroundings::black(&context)?)?;
        let kernel_group = kernel_layout(&context)?;
        let kernels = context.guarded("pipeline layout", || {
            context.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("luthier kernel"),
                bind_group_layouts: &[Some(&bindings.layout), Some(&kernel_group)],
                immediate_size: 0,
            })
        })?;
        let evaluate = compile(&context, &kernels, form, wgsl, include_str!("wgsl/evaluate.wgsl"))?;
        Ok(Self {
            context,
            manifest: package.manifest.clone(),
            maps: package.maps.clone(),
            live: Vec::new(),
            form,
            wgsl: wgsl.to_owned(),
            interface,
            bindings,
            group,
            kernels,
            evaluate,
            places: OnceLock::new(),
            lookups: Default::default(),
            render: Default::default(),
            simulations: Default::default(),
            timed: Arc::default(),
            grounded: Mutex::default(),
        })
    }

    /// A scene with the materials, tables and maps of another package, without compiling. `None` if the shader of that package differs.
    ///
    /// # Errors
    /// [`PackageError::NoShader`](crate::PackageError::NoShader), and as [`Gpu::scene`](crate::Gpu::scene) for the tables.
    pub fn rebound(&self, package: &Package) -> Result<Option<Self>, GpuError> {
        let package = &*package.in_own_names();
        if package.wgsl(self.form)? != self.wgsl {
            return Ok(None);
        }
        // Layouts with the same entries are the same to the device, so the pipelines take the new groups.
        let bindings = ShaderBindings::new(&self.context, package, &self.interface)?;
        let group = bindings.group(&self.context, &material_words(package), &Surroundings::black(&self.context)?)?;
        Ok(Some(Self {
            context: self.context.clone(),
            manifest: package.manifest.clone(),
            maps: package.maps.clone(),
            live: Vec::new(),
            form: self.form,
            wgsl: self.wgsl.clone(),
            interface: self.interface.clone(),
            bindings,
            group,
            kernels: self.kernels.clone(),
            evaluate: self.evaluate.clone(),
            places: self.places.clone(),
            lookups: self.lookups.clone(),
            render: self.render.clone(),
            simulations: self.simulations.clone(),
            timed: Arc::clone(&self.timed),
            grounded: Mutex::default(),
        }))
    }

    /// The scene with these words in place of the material buffer, for a shader with records of its own.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn with_words(self, words: &[[f32; 4]]) -> Result<Self, GpuError> {
        let group = self.bindings.group(&self.context, words, &Surroundings::black(&self.context)?)?;
        Ok(Self { group, ..self })
    }

    /// Takes values of live numbers ([`LiveEntry`](luthier_manifest::LiveEntry)) in place of those taken before: pictures show them without a bake.
    pub fn set_live(&mut self, values: &[LiveValue]) {
        self.live = values.to_vec();
    }

    /// Form of the shader that runs here: `baked` or `full`.
    pub fn form(&self) -> Form {
        self.form
    }

    /// The layers of a material.
    pub(crate) fn layers(&self, material: u32) -> Result<&[LayerRecord], GpuError> {
        let materials = &self.manifest.materials;
        let entry = materials.get(material as usize);
        entry.map(|m| m.layers.as_slice()).ok_or(GpuError::NoMaterial { material, count: materials.len() })
    }

    /// Whether the shader reads a table.
    pub(crate) fn reads(&self, kind: TableKind) -> bool {
        self.look_up(kind).is_some()
    }

    /// The function that looks a table up.
    pub(crate) fn look_up(&self, kind: TableKind) -> Option<&FunctionEntry> {
        self.interface.function(&format!("luthier_lookup_{}", kind.name()))
    }

    /// The pipeline of a kernel.
    pub(crate) fn compile(&self, kernel: &str) -> Result<wgpu::ComputePipeline, GpuError> {
        compile(&self.context, &self.kernels, self.form, &self.wgsl, kernel)
    }

    /// The pipeline of a kernel that is timed, compiled at its first use.
    pub(crate) fn timed(&self, kernel: &str) -> Result<wgpu::ComputePipeline, GpuError> {
        let mut timed = self.timed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = timed.get(kernel) {
            return Ok(pipeline.clone());
        }
        let pipeline = self.compile(kernel)?;
        timed.insert(kernel.to_owned(), pipeline.clone());
        Ok(pipeline)
    }

    /// The pipeline in `cell`, compiled at its first use.
    pub(crate) fn pipeline<'a>(
        &self,
        cell: &'a OnceLock<wgpu::ComputePipeline>,
        kernel: &str,
    ) -> Result<&'a wgpu::ComputePipeline, GpuError> {
        match cell.get() {
            Some(pipeline) => Ok(pipeline),
            None => {
                let pipeline = self.compile(kernel)?;
                Ok(cell.get_or_init(|| pipeline))
            }
        }
    }
}

/// Compiles the shader with a kernel appended. Every kernel has one entry point.
fn compile(
    context: &Context,
    layout: &wgpu::PipelineLayout,
    form: Form,
    wgsl: &str,
    kernel: &str,
) -> Result<wgpu::ComputePipeline, GpuError> {
    let what = format!("the `{form}` shader");
    let module = context.guarded(&what, || {
        context.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(form.name()),
            source: wgpu::ShaderSource::Wgsl(format!("{wgsl}\n{kernel}").into()),
        })
    })?;
    context.guarded(&what, || {
        context.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(form.name()),
            layout: Some(layout),
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    })
}
