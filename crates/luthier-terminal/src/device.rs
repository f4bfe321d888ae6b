//! The graphics adapter as the judge sees it.

use luthier_export::sha256;
use luthier_gpu::{Gpu, Map, Package, PlaceValues, Scene};
use luthier_report::{Device, Form, Pair, SurfaceMap};
use serde_json::{Value, json};

use crate::Outcome;

/// The shaders of a bake, ready to run.
#[derive(Debug)]
pub struct Shaders {
    name: String,
    /// The adapter, and a hash of the texts of the shaders.
    identity: String,
    /// Whether the adapter is a program on the CPU.
    is_software: bool,
    baked: Scene,
    /// None where the package has no such shader.
    full: Option<Scene>,
}

impl Shaders {
    /// The shaders of a package on an adapter.
    ///
    /// # Errors
    /// Errors of the adapter.
    pub fn new(gpu: &Gpu, package: &Package) -> Outcome<Self> {
        let has_full = package.shaders.iter().any(|shader| shader.form == Form::Full);
        let full = has_full.then(|| gpu.scene(package, Form::Full)).transpose()?;
        let texts: Vec<u8> = package.shaders.iter().flat_map(|shader| shader.bytes.iter().copied()).collect();
        let identity = format!("{} {}", adapter_label(gpu), sha256(&texts));
        let baked = gpu.scene(package, Form::Baked)?;
        Ok(Self { name: adapter_label(gpu), identity, is_software: gpu.is_software(), baked, full })
    }

    /// Whether the adapter is a program on the CPU.
    pub fn is_software(&self) -> bool {
        self.is_software
    }

    /// The pipelines of a form, if the bake has it.
    pub fn scene(&self, form: Form) -> Option<&Scene> {
        match form {
            Form::Baked => Some(&self.baked),
            Form::Full => self.full.as_ref(),
        }
    }
}

impl Device for Shaders {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn identity(&self) -> String {
        self.identity.clone()
    }

    fn has(&self, form: Form) -> bool {
        self.scene(form).is_some()
    }

    fn evaluate(&self, form: Form, material: u32, pairs: &[Pair]) -> Result<Vec<[f32; 3]>, String> {
        let scene = self.scene(form).ok_or_else(|| format!("the bake has no `{form}` shader"))?;
        scene.evaluate(material, pairs).map_err(|source| source.to_string())
    }

    fn evaluate_at(&self, form: Form, material: u32, spots: &[(PlaceValues, Pair)]) -> Result<Vec<[f32; 3]>, String> {
        let scene = self.scene(form).ok_or_else(|| format!("the bake has no `{form}` shader"))?;
        let spots: Vec<_> = spots.iter().map(|(place, (wi, wo))| (place.clone(), *wi, *wo)).collect();
        scene.evaluate_at(material, &spots).map_err(|source| source.to_string())
    }
}

/// The maps of a package, for the judge.
pub fn surface_maps(package: &Package) -> Vec<SurfaceMap> {
    let maps = package.maps.iter().map(|Map { material, slot, layer, picture, .. }| SurfaceMap {
        material: *material,
        slot: *slot,
        layer: *layer,
        picture: picture.clone(),
    });
    maps.collect()
}

/// Name, interface and driver of an adapter, as pages have them.
pub fn adapter_label(gpu: &Gpu) -> String {
    format!("{} ({}, {})", gpu.adapter_name(), gpu.backend(), gpu.driver())
}

/// The adapter of measurements in JSON. `software` is true for a program on the CPU, which filters textures in software.
pub fn adapter_json(gpu: &Gpu) -> Value {
    json!({
        "name": gpu.adapter_name(),
        "driver": gpu.driver(),
        "backend": gpu.backend(),
        "software": gpu.is_software(),
    })
}

/// Starts the process again without Mesa's layer that sorts devices, if that layer would complain on standard error. The layer asks for a Wayland
/// display, and libwayland prints a message if there is none. Pictures need no display, and adapters are chosen by their kind, so the layer is not
/// needed. Returns if there would be no message, or if the program's own file is not found. Call it before anything is read or written.
pub fn without_display() {
    #[cfg(target_os = "linux")]
    {
        use std::os::unix::process::CommandExt;

        let value = std::env::var_os;
        let has_display = value("XDG_RUNTIME_DIR").is_some_and(|folder| std::path::Path::new(&folder).is_absolute());
        // A user who asks the layer for a device keeps the layer.
        let is_settled = ["NODEVICE_SELECT", "MESA_VK_DEVICE_SELECT"].into_iter().any(|name| value(name).is_some());
        if has_display || is_settled {
            return;
        }
        let mut words = std::env::args_os();
        if let (Ok(program), Some(name)) = (std::env::current_exe(), words.next()) {
            // Returns only where it fails.
            let _ = std::process::Command::new(program).arg0(name).args(words).env("NODEVICE_SELECT", "1").exec();
        }
    }
}

/// Opens an adapter: the best there is, or the one whose name contains a text.
///
/// # Errors
/// [`Failure::Device`](crate::Failure::Device).
pub fn open(name: Option<&str>) -> Outcome<Gpu> {
    Ok(name.map_or_else(Gpu::open, Gpu::open_named)?)
}
