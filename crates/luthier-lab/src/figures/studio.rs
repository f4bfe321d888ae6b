//! A studio for pictures: one adapter, one light, one size.

use std::cell::{Cell, OnceCell};
use std::io::ErrorKind;
use std::sync::Arc;

use luthier::{Bake, MemoryStore};
use luthier_export::Package;
use luthier_gpu::{Environment, Gpu, Mesh, RenderSettings, Shape, SimulationSettings, model};
use luthier_layers::model::Estimate;
use luthier_layers::registry;
use luthier_lut::Image;
use luthier_manifest::{ColorMode, Form, ShadingModel};
use luthier_material::{Effects, Material, parse};
use luthier_report::{BallPicture, DistantLight, render_ball, render_ball_of};
use luthier_terminal::{Failure, Outcome, adapter_label, open};

use super::numbers::light::{even_sky, one_light};
use crate::cli::FiguresOptions;

/// Directions of the environment per lobe and sample: with four samples to a pixel, 128 per lobe.
const ENVIRONMENT_SAMPLES: u32 = 32;

/// A key from the upper left, and a dimmer light from behind on the right. No paper states its lights.
pub(crate) const LIGHTS: [DistantLight; 2] = [
    DistantLight { direction: [-0.45, 0.7, 0.6], irradiance: [1.75, 1.7, 1.62] },
    DistantLight { direction: [0.9, 0.1, -0.2], irradiance: [1.0, 1.1, 1.25] },
];

pub(crate) struct Studio {
    /// Side of each single picture, of the figure that is made.
    pub(crate) size: u32,
    samples: u32,
    paths: u32,
    adapter: Option<String>,
    gpu: OnceCell<Gpu>,
    /// Whether the figure that is made has used the adapter.
    has_used_gpu: Cell<bool>,
    environment: OnceCell<Arc<Environment>>,
    mesh: OnceCell<Arc<Mesh>>,
}

impl Studio {
    pub(crate) fn new(options: &FiguresOptions) -> Self {
        let FiguresOptions { samples, paths, adapter, .. } = options;
        let (gpu, environment, mesh) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        let adapter = adapter.name.clone();
        Self {
            size: 0,
            samples: *samples,
            paths: *paths,
            adapter,
            gpu,
            has_used_gpu: Cell::new(false),
            environment,
            mesh,
        }
    }

    /// Begins another figure, whose pictures have `size` pixels a side.
    pub(crate) fn begin(&mut self, size: u32) {
        self.size = size;
        self.has_used_gpu.set(false);
    }

    /// The adapter, opened when the first figure needs it.
    pub(crate) fn gpu(&self) -> Outcome<&Gpu> {
        self.has_used_gpu.set(true);
        if self.gpu.get().is_none() {
            let _ = self.gpu.set(open(self.adapter.as_deref())?);
        }
        self.gpu.get().ok_or_else(|| Failure::Device(anyhow::anyhow!("no graphics adapter")))
    }

    /// Name of the adapter, if the figure that is made needed one.
    pub(crate) fn adapter_name(&self) -> Option<String> {
        self.gpu.get().filter(|_| self.has_used_gpu.get()).map(adapter_label)
    }

    /// The studio of `luthier preview`, its environment through the shader.
    pub(crate) fn settings(&self, shape: Shape) -> Outcome<RenderSettings> {
        let mut settings = RenderSettings::new(shape)?;
        settings.environment = self.environment.get_or_init(|| settings.environment.clone()).clone();
        settings.size = self.size;
        settings.samples = self.samples;
        settings.environment_samples = ENVIRONMENT_SAMPLES;
        Ok(settings)
    }

    /// The studio with the model on its floor, twice as large as other pictures. Its environment is blurred beforehand.
    pub(crate) fn stage(&self) -> Outcome<RenderSettings> {
        let mesh = self.mesh.get_or_init(|| Arc::new(model::mesh())).clone();
        let settings = self.settings(Shape::Sphere)?;
        Ok(RenderSettings {
            shape: Shape::Mesh,
            camera: Shape::Mesh.camera(),
            mesh: Some(mesh),
            size: 2 * self.size,
            samples: self.samples.max(3),
            environment_samples: 0,
            ..settings
        })
    }

    /// Renders each material of a bake on the stage, linear. `adjust` may change the settings of the n-th.
    pub(crate) fn staged(&self, package: &Package, adjust: impl Fn(usize, &mut RenderSettings)) -> Outcome<Vec<Image>> {
        self.each(package, Form::Baked, &self.stage()?, adjust)
    }

    /// Bakes materials and renders each, linear. `adjust` may change the settings of the n-th.
    pub(crate) fn pictures(
        &self,
        materials: &[Material],
        form: Form,
        shape: Shape,
        adjust: impl Fn(usize, &mut RenderSettings),
    ) -> Outcome<Vec<Image>> {
        self.rendered(&Bake::lit().package(materials, &MemoryStore::default())?, form, shape, adjust)
    }

    /// Renders each material of a bake, linear.
    pub(crate) fn rendered(
        &self,
        package: &Package,
        form: Form,
        shape: Shape,
        adjust: impl Fn(usize, &mut RenderSettings),
    ) -> Outcome<Vec<Image>> {
        self.each(package, form, &self.settings(shape)?, adjust)
    }

    /// Renders each material of a bake, linear, with `settings` that `adjust` may change.
    fn each(
        &self,
        package: &Package,
        form: Form,
        settings: &RenderSettings,
        adjust: impl Fn(usize, &mut RenderSettings),
    ) -> Outcome<Vec<Image>> {
        let scene = self.gpu()?.scene(package, form)?;
        let images = (0..package.manifest.materials.len()).map(|n| {
            let mut settings = settings.clone();
            adjust(n, &mut settings);
            Ok(scene.render(&[n as u32], &settings)?)
        });
        images.collect()
    }

    /// Bakes a material and renders it, linear.
    pub(crate) fn picture(&self, material: Material, form: Form, shape: Shape) -> Outcome<Image> {
        Ok(self.pictures(&[material], form, shape, |_, _| {})?.swap_remove(0))
    }

    /// Bakes materials and renders each under one light from a direction, linear.
    pub(crate) fn lit(&self, materials: &[Material], form: Form, shape: Shape, from: [f32; 3]) -> Outcome<Vec<Image>> {
        let dark = even_sky(0.0)?;
        self.pictures(materials, form, shape, |_, settings| one_light(settings, &dark, from))
    }

    /// A ball by a model in f64, under two lights and nothing else.
    pub(crate) fn ball(&self, material: &Material, model: &str) -> Outcome<Image> {
        self.ball_of_size(material, model, self.size)
    }

    /// The ball of [`Studio::ball`], of `size` pixels a side.
    pub(crate) fn ball_of_size(&self, material: &Material, model: &str, size: u32) -> Outcome<Image> {
        let model = registry::model(model).ok_or_else(|| Failure::Input(anyhow::anyhow!("no model `{model}`")))?;
        let wavelengths_nm = material.bake.wavelengths_nm();
        Ok(render_ball(model.as_ref(), &material.stack, wavelengths_nm, &LIGHTS, size).image)
    }

    /// The ball of [`Studio::ball`] by the simulation on the device, of the stack alone.
    pub(crate) fn simulated(&self, material: &Material) -> Outcome<BallPicture> {
        self.simulated_of_size(material, self.size)
    }

    /// The ball of [`Studio::simulated`], of `size` pixels a side.
    pub(crate) fn simulated_of_size(&self, material: &Material, size: u32) -> Outcome<BallPicture> {
        // Models play no part: no table is baked.
        let mut plain = material.clone();
        plain.shade_by(ShadingModel::Phong);
        plain.effects = Effects::default();
        plain.bake.tables.clear();
        plain.bake.color = Some(ColorMode::ThreeWavelengths);
        let package = Bake::lit().package(std::slice::from_ref(&plain), &MemoryStore::default())?;
        let scene = self.gpu()?.scene(&package, Form::Baked)?;
        render_ball_of(&LIGHTS, size, |pairs| {
            let pairs: Vec<_> =
                pairs.iter().map(|(wi, wo)| (wi.as_vec3().to_array(), wo.as_vec3().to_array())).collect();
            let values = scene.simulate(0, &pairs, self.paths, &SimulationSettings::default())?;
            Ok(values.into_iter().map(|v| [0, 1, 2].map(|c: usize| Estimate::known(v.mean[c], v.std_err[c]))).collect())
        })
    }
}

/// The material of a text.
pub(crate) fn material(label: &str, text: &str) -> Outcome<Material> {
    let parsed = parse(label, text, &|_| Err(ErrorKind::NotFound.into()));
    Ok(parsed
        .map_err(|errors| {
            let messages: Vec<String> = errors.into_iter().map(|e| e.render(text)).collect();
            Failure::Input(anyhow::anyhow!(messages.join("\n")))
        })?
        .material)
}

/// A material of some layers by a model, its colours at three wavelengths.
pub(crate) fn layered(name: &str, layers: &str, model: ShadingModel) -> Outcome<Material> {
    let text = format!("schema = 1\nname = \"{name}\"\n{layers}[bake]\ncolor = \"three-wavelengths\"\n");
    Ok(shaded(&material(name, &text)?, name, model))
}

/// A material that finds its maps in the lab's folder `maps/`.
pub(crate) fn mapped(material: Material) -> Material {
    Material { source: crate::maps::source(), ..material }
}

/// A material under another name and model.
pub(crate) fn shaded(material: &Material, name: &str, model: ShadingModel) -> Material {
    let mut shaded = material.clone();
    shaded.name = name.to_owned();
    shaded.bake.model = Some(model);
    shaded
}
