//! Errors of the runtime: packages, bindings, devices.

use luthier_environment::EnvironmentError;
use luthier_export::PackageError;
use luthier_lut::{TableKind, TexelFormat};
use luthier_manifest::Form;
use thiserror::Error;

/// Why a package cannot be loaded, bound or run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GpuError {
    /// The bake cannot be read, or its parts do not fit together.
    #[error(transparent)]
    Package(#[from] PackageError),
    /// A binding of the manifest that this version cannot make.
    #[error("the manifest binds `{name}` as `{resource}`, which this version does not know")]
    Binding {
        /// Name of the variable.
        name: String,
        /// Kind of resource.
        resource: String,
    },
    /// No adapter can run compute shaders.
    #[error(
        "no graphics driver found that runs compute shaders; a software one is enough: apt-get install mesa-vulkan-drivers libvulkan1 \
         (Debian, Ubuntu), dnf install mesa-vulkan-drivers vulkan-loader (Fedora), pacman -S vulkan-swrast (Arch), \
         apk add mesa-vulkan-swrast vulkan-loader (Alpine)"
    )]
    NoAdapter,
    /// Adapters, but none of that name.
    #[error("no adapter's name contains `{wanted}`; found: {found}")]
    NoSuchAdapter {
        /// Part of a name, as asked for.
        wanted: String,
        /// Names of the adapters at hand, comma-separated.
        found: String,
    },
    /// The adapter refuses to open.
    #[error("cannot open {adapter}: {source}")]
    Open {
        /// Name of the adapter.
        adapter: String,
        /// Error of the driver.
        source: wgpu::RequestDeviceError,
    },
    /// A texel format that the device lacks.
    #[error("the {} table is {format}, which this device does not have; bake it as rgba16float", kind.name())]
    NoSuchFormat {
        /// The table.
        kind: TableKind,
        /// Its format.
        format: TexelFormat,
    },
    /// A texture larger than the device takes.
    #[error("the {} table is {width} x {height} texels; this device takes {limit} along a side", kind.name())]
    TextureTooLarge {
        /// The table.
        kind: TableKind,
        /// Texels across.
        width: u32,
        /// Texels down.
        height: u32,
        /// Largest side.
        limit: u32,
    },
    /// The device or the shader compiler refuses.
    #[error("{what}: {message}")]
    Refused {
        /// Action that was refused.
        what: String,
        /// Message of the device.
        message: String,
    },
    /// The device ran out of memory.
    #[error("{what}: the device is out of memory")]
    OutOfMemory {
        /// Action that took the memory.
        what: String,
    },
    /// The device is gone: driver reset, removal.
    #[error("the device was lost: {0}")]
    Lost(String),
    /// No answer from the device in time.
    #[error("the device did not finish within {seconds} s")]
    Timeout {
        /// Time that it was given.
        seconds: u64,
    },
    /// A material number that the bake does not have.
    #[error("material {material} of {count}")]
    NoMaterial {
        /// Asked for, from 0.
        material: u32,
        /// Number of materials.
        count: usize,
    },
    /// A surface number that the bake does not have.
    #[error("no surface {surface}: the bake has {count}")]
    NoSurface {
        /// The number asked for.
        surface: u32,
        /// Surfaces of the bake.
        count: usize,
    },
    /// A table that the bake, or this form of the shader, does not have.
    #[error("no {} table in the `{form}` shader of this bake", kind.name())]
    NoTable {
        /// Asked for.
        kind: TableKind,
        /// Form of the shader.
        form: Form,
    },
    /// A tile that the table does not have.
    #[error("tile {tile} of {count} in the {} table", kind.name())]
    NoTile {
        /// The table.
        kind: TableKind,
        /// Asked for, from 0.
        tile: u32,
        /// Number of tiles.
        count: u32,
    },
    /// Blurred maps of the environment need the table look-ups.
    #[error("without samples of the environment only the `baked` shader can be rendered; this scene runs `{form}`")]
    Prefiltered {
        /// Form of the shader.
        form: Form,
    },
    /// Blurred maps of the environment need the reflectance of every interface.
    #[error(
        "without samples of the environment every interface needs a Fresnel tile, and materials of lobes the functions `environment`; \
         `{material}` lacks them: bake the kinds fresnel and fgd, or these functions, too, or sample the environment"
    )]
    NoReflectance {
        /// Name of the material.
        material: String,
    },
    /// A part of a material that the simulation does not support.
    #[error("`{material}`: the simulation takes no {what}")]
    NotSimulated {
        /// Name of the material.
        material: String,
        /// The part.
        what: &'static str,
    },
    /// A material that needs texture coordinates, because it varies or is anisotropic, on a mesh without them.
    #[error(
        "the mesh has no texture coordinates, and `{material}` needs them: {reason}. Export the mesh with UVs, or take another material"
    )]
    NoTextureCoordinates {
        /// Name of the material.
        material: String,
        /// Property that needs them.
        reason: &'static str,
    },
    /// Blurred maps of the environment ignore the textures of single layers.
    #[error("`{material}` has maps of single layers, which only samples of the environment show")]
    LayerMaps {
        /// Name of the material.
        material: String,
    },
    /// An environment that cannot be made.
    #[error("environment: {0}")]
    Environment(#[from] EnvironmentError),
    /// A setting of the renderer out of range.
    #[error("render setting {name} = {value}; {allowed}")]
    Setting {
        /// Name of the field.
        name: &'static str,
        /// Its value.
        value: String,
        /// Values that are allowed.
        allowed: &'static str,
    },
}

pub(crate) fn setting(name: &'static str, value: String, allowed: &'static str) -> GpuError {
    GpuError::Setting { name, value, allowed }
}

pub(crate) fn check_direction(name: &'static str, v: [f32; 3]) -> Result<(), GpuError> {
    let length_sq: f32 = v.iter().map(|x| x * x).sum();
    if length_sq.is_normal() { Ok(()) } else { Err(setting(name, format!("{v:?}"), "a finite direction, not zero")) }
}
