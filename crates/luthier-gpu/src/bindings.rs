//! Group 0, as the manifest lists it.

use luthier_lut::{TableKind, TexelFormat};
use luthier_manifest::{BindingEntry, Interface, material_buffer};
use wgpu::{BindGroupLayoutEntry, BindingType, ShaderStages};

use crate::context::Context;
use crate::surroundings::Surroundings;
use luthier_export::{Package, PackageError};

use crate::GpuError;

/// A resource that a shader binds.
#[derive(Debug)]
enum Resource {
    Table(wgpu::TextureView, TexelFormat),
    /// A table whose texels have steps.
    Steps(wgpu::Buffer),
    Sampler(wgpu::Sampler),
    Materials,
    /// The levels of an environment.
    Environment,
    /// The irradiance of an environment.
    Irradiance,
}

/// The resources of group 0 and their layout. The material buffer is given per bind group.
#[derive(Debug)]
pub(crate) struct ShaderBindings {
    resources: Vec<(u32, Resource)>,
    pub(crate) layout: wgpu::BindGroupLayout,
}

impl ShaderBindings {
    /// Whether the shader reads an environment.
    pub(crate) fn has_surroundings(&self) -> bool {
        self.resources.iter().any(|(_, resource)| matches!(resource, Resource::Environment))
    }

    /// Uploads the tables that the shader reads.
    pub(crate) fn new(context: &Context, package: &Package, interface: &Interface) -> Result<Self, GpuError> {
        let mut resources = Vec::new();
        // A shader binds only the tables that it reads: the full form binds none.
        for entry in package.manifest.bindings.iter().filter(|entry| interface.binds(&entry.name)) {
            resources.push((entry.binding, resource(context, package, entry)?));
        }
        let entries: Vec<_> = resources.iter().map(|(binding, r)| layout_entry(*binding, r)).collect();
        let layout = context.guarded("bindings of the manifest", || {
            context.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("luthier"),
                entries: &entries,
            })
        })?;
        Ok(Self { resources, layout })
    }

    /// Group 0 with these words as the material buffer, in these surroundings.
    pub(crate) fn group(
        &self,
        context: &Context,
        materials: &[[f32; 4]],
        surroundings: &Surroundings,
    ) -> Result<wgpu::BindGroup, GpuError> {
        context.guarded("material buffer", || {
            let buffer = context.upload("luthier_materials", bytemuck::cast_slice(materials));
            let entries: Vec<_> = self
                .resources
                .iter()
                .map(|(binding, resource)| wgpu::BindGroupEntry {
                    binding: *binding,
                    resource: match resource {
                        Resource::Table(view, _) => wgpu::BindingResource::TextureView(view),
                        Resource::Steps(texels) => texels.as_entire_binding(),
                        Resource::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
                        Resource::Materials => buffer.as_entire_binding(),
                        Resource::Environment => wgpu::BindingResource::TextureView(&surroundings.environment),
                        Resource::Irradiance => wgpu::BindingResource::TextureView(&surroundings.irradiance),
                    },
                })
                .collect();
            context.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("luthier"),
                layout: &self.layout,
                entries: &entries,
            })
        })
    }
}

/// The material buffer of a bake.
pub(crate) fn material_words(package: &Package) -> Vec<[f32; 4]> {
    material_buffer(&package.manifest.materials)
}

fn resource(context: &Context, package: &Package, entry: &BindingEntry) -> Result<Resource, GpuError> {
    let found = match (entry.resource.as_str(), entry.name.as_str()) {
        (BindingEntry::BUFFER, _) => Some(Resource::Materials),
        ("sampler", name) => {
            let sampler = context.guarded("sampler", || {
                context.device.create_sampler(&wgpu::SamplerDescriptor {
                    label: Some(name),
                    mag_filter: wgpu::FilterMode::Linear,
                    min_filter: wgpu::FilterMode::Linear,
                    mipmap_filter: wgpu::MipmapFilterMode::Linear,
                    ..Default::default()
                })
            })?;
            Some(Resource::Sampler(sampler))
        }
        ("texture_2d<f32>" | BindingEntry::STEPS, name) => {
            let kind = TableKind::ALL.into_iter().find(|kind| name.strip_prefix("luthier_") == Some(kind.name()));
            let is_meant =
                |kind| package.table(kind).is_none_or(|texels| texels.format.has_steps() == entry.is_buffer());
            kind.filter(|kind| is_meant(*kind)).map(|kind| table(context, package, kind)).transpose()?
        }
        ("texture_cube<f32>", "luthier_environment_map") => Some(Resource::Environment),
        ("texture_cube<f32>", "luthier_irradiance_map") => Some(Resource::Irradiance),
        _ => None,
    };
    found.ok_or_else(|| GpuError::Binding { name: entry.name.clone(), resource: entry.resource.clone() })
}

fn table(context: &Context, package: &Package, kind: TableKind) -> Result<Resource, GpuError> {
    let texels = package.table(kind).ok_or(PackageError::MissingTexels { kind })?;
    if texels.format.has_steps() {
        return Ok(Resource::Steps(context.guarded(kind.name(), || context.upload(kind.name(), &texels.bytes))?));
    }
    let (width, height) = (texels.width, texels.height);
    let limit = context.device.limits().max_texture_dimension_2d;
    if width > limit || height > limit {
        return Err(GpuError::TextureTooLarge { kind, width, height, limit });
    }
    let format = texture_format(texels.format);
    if !context.device.features().contains(format.required_features()) {
        return Err(GpuError::NoSuchFormat { kind, format: texels.format });
    }
    let view = context.guarded(kind.name(), || {
        let texture = context.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(kind.name()),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        context.upload_texels(&texture, &texels.bytes, texels.format.row_bytes(width));
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    })?;
    Ok(Resource::Table(view, texels.format))
}

fn layout_entry(binding: u32, resource: &Resource) -> BindGroupLayoutEntry {
    let ty = match resource {
        Resource::Table(_, format) => BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: format.is_filterable() },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        Resource::Sampler(_) => BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        Resource::Materials | Resource::Steps(_) => storage(true),
        Resource::Environment | Resource::Irradiance => BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::Cube,
            multisampled: false,
        },
    };
    BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None }
}

/// Layout of group 1: `kernel_inputs` and `kernel_outputs`.
pub(crate) fn kernel_layout(context: &Context) -> Result<wgpu::BindGroupLayout, GpuError> {
    let entries = [(0, true), (1, false)].map(|(binding, read_only)| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE,
        ty: storage(read_only),
        count: None,
    });
    context.guarded("kernel bindings", || {
        context
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("kernel"), entries: &entries })
    })
}

fn storage(read_only: bool) -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

fn texture_format(format: TexelFormat) -> wgpu::TextureFormat {
    match format {
        TexelFormat::Rg16Float => wgpu::TextureFormat::Rg16Float,
        TexelFormat::R16Float => wgpu::TextureFormat::R16Float,
        TexelFormat::R32Float => wgpu::TextureFormat::R32Float,
        TexelFormat::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        TexelFormat::Rgb10a2Unorm => wgpu::TextureFormat::Rgb10a2Unorm,
        TexelFormat::Rg11b10Ufloat => wgpu::TextureFormat::Rg11b10Ufloat,
        TexelFormat::Rgba16Unorm => wgpu::TextureFormat::Rgba16Unorm,
        TexelFormat::Bc6hRgbUfloat => wgpu::TextureFormat::Bc6hRgbUfloat,
        TexelFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        TexelFormat::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        TexelFormat::Rgba16FloatSteps => wgpu::TextureFormat::Rgba32Uint,
    }
}
