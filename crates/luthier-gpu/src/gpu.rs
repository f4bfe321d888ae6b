//! Choice of an adapter, and the device on it.

use luthier_manifest::Form;
use wgpu::{DeviceType, DownlevelFlags};

use crate::context::Context;
use luthier_export::Package;

use crate::{GpuError, Scene};

/// Factor on the work of one submission on a discrete GPU. There a submission of the size for other adapters takes milliseconds, so that waiting
/// for each would cost more than the work.
const DISCRETE_BATCH: u32 = 16;

/// An open device. Without a GPU, a software driver serves: [`Gpu::open_named`] takes `llvmpipe`.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) context: Context,
    info: wgpu::AdapterInfo,
}

impl Gpu {
    /// Opens the best adapter that runs compute shaders: a discrete GPU before an integrated one before a virtual one
    /// before a software driver; between equals, the first that the system lists.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] says what to install; [`GpuError::Open`] when the driver refuses.
    pub fn open() -> Result<Self, GpuError> {
        Self::choose(None)
    }

    /// Opens the best adapter whose name or driver contains `part`, in any case: `llvmpipe`, `nvidia`.
    ///
    /// # Errors
    /// As [`Gpu::open`], and [`GpuError::NoSuchAdapter`].
    pub fn open_named(part: &str) -> Result<Self, GpuError> {
        Self::choose(Some(part))
    }

    fn choose(part: Option<&str>) -> Result<Self, GpuError> {
        let wanted = part.unwrap_or_default().to_lowercase();
        let mut found = Vec::new();
        // OpenGL comes last: it is the weaker interface to the same adapters.
        for backends in [wgpu::Backends::PRIMARY, wgpu::Backends::SECONDARY] {
            let mut adapters = adapters(backends);
            found.extend(adapters.iter().map(|a| label(&a.get_info())));
            adapters.retain(|a| label(&a.get_info()).to_lowercase().contains(&wanted));
            if let Some(best) = adapters.into_iter().min_by_key(|a| preference(a.get_info().device_type)) {
                return Self::request(&best);
            }
        }
        match part {
            Some(part) if !found.is_empty() => {
                Err(GpuError::NoSuchAdapter { wanted: part.to_owned(), found: found.join(", ") })
            }
            _ => Err(GpuError::NoAdapter),
        }
    }

    fn request(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("luthier"),
            required_features: adapter.features()
                & (wgpu::Features::TIMESTAMP_QUERY
                    | wgpu::Features::TEXTURE_FORMAT_16BIT_NORM
                    | wgpu::Features::TEXTURE_COMPRESSION_BC),
            required_limits: adapter.limits(),
            ..Default::default()
        });
        let (device, queue) =
            pollster::block_on(request).map_err(|source| GpuError::Open { adapter: label(&info), source })?;
        let batch = if info.device_type == DeviceType::DiscreteGpu { DISCRETE_BATCH } else { 1 };
        Ok(Self { context: Context::new(device, queue, batch), info })
    }

    /// Name of the adapter, as its driver gives it.
    pub fn adapter_name(&self) -> String {
        self.info.name.clone()
    }

    /// Driver and its version; empty if the system does not tell.
    pub fn driver(&self) -> String {
        format!("{} {}", self.info.driver, self.info.driver_info).trim().to_owned()
    }

    /// Graphics interface in use: `vulkan`, `metal`, `dx12`, `gl`.
    pub fn backend(&self) -> String {
        self.info.backend.to_string()
    }

    /// Whether the adapter runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == DeviceType::Cpu
    }

    /// Uploads the tables and materials and compiles the shader of a form.
    ///
    /// # Errors
    /// When the bake has no such shader, a table is too large, or the device refuses the shader or its bindings.
    pub fn scene(&self, package: &Package, form: Form) -> Result<Scene, GpuError> {
        Scene::new(self.context.clone(), package, form)
    }
}

/// The adapters that run compute shaders.
fn adapters(backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    // No debug layers of the driver: wgpu validates by itself, alike in every build profile.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.retain(|a| a.get_downlevel_capabilities().flags.contains(DownlevelFlags::COMPUTE_SHADERS));
    adapters
}

fn label(info: &wgpu::AdapterInfo) -> String {
    format!("{} ({}, {})", info.name, info.driver, info.backend)
}

/// Smaller is better.
fn preference(device_type: DeviceType) -> u32 {
    match device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}
