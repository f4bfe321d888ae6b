//! Group 0 of the shader, bound as the manifest says.

use std::path::Path;

use anyhow::{Context, Result, bail};
use wgpu::util::{BufferInitDescriptor, DeviceExt, TextureDataOrder};

use crate::bake::{Bake, Binding, Texels, cube};

/// The tables, the sampler and the material buffer on a device.
pub struct Materials {
    pub layout: wgpu::BindGroupLayout,
    pub group: wgpu::BindGroup,
}

enum Resource {
    Table(wgpu::TextureView),
    Cube(wgpu::TextureView),
    Sampler(wgpu::Sampler),
    Buffer(wgpu::Buffer),
}

impl Materials {
    /// `surroundings` is a folder of `luthier environment`, for a bake with `--functions environment`.
    pub fn upload(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        bake: &Bake,
        surroundings: Option<&Path>,
    ) -> Result<Self> {
        let mut resources = Vec::new();
        for binding in bake.bindings()? {
            resources.push((binding.number, upload(device, queue, bake, surroundings, &binding)?));
        }
        let layout_entries: Vec<_> =
            resources.iter().map(|(number, resource)| layout_entry(*number, resource)).collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("luthier"),
            entries: &layout_entries,
        });
        let entries: Vec<_> = resources.iter().map(|(number, resource)| group_entry(*number, resource)).collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("luthier"),
            layout: &layout,
            entries: &entries,
        });
        Ok(Self { layout, group })
    }
}

fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    bake: &Bake,
    surroundings: Option<&Path>,
    binding: &Binding,
) -> Result<Resource> {
    match binding.resource.as_str() {
        "texture_2d<f32>" => {
            let kind = binding.name.strip_prefix("luthier_").context("a table without its prefix")?;
            Ok(Resource::Table(upload_texture(device, queue, kind, &bake.table(kind)?)?))
        }
        "texture_cube<f32>" => {
            let folder =
                surroundings.context("this bake shows surroundings: name a folder of `luthier environment`")?;
            let content = binding.name.strip_prefix("luthier_").and_then(|name| name.strip_suffix("_map"));
            let texels = cube(folder, content.context("a map without its suffix")?)?;
            Ok(Resource::Cube(upload_texture(device, queue, &binding.name, &texels)?))
        }
        // Clamped to the edge, which is the default. Tables have one level.
        "sampler" => Ok(Resource::Sampler(device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some(&binding.name),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        }))),
        "buffer<vec4<u32>>" => {
            let kind = binding.name.strip_prefix("luthier_").context("a table without its prefix")?;
            Ok(Resource::Buffer(device.create_buffer_init(&BufferInitDescriptor {
                label: Some(&binding.name),
                contents: &bake.table(kind)?.bytes,
                usage: wgpu::BufferUsages::STORAGE,
            })))
        }
        "buffer" => Ok(Resource::Buffer(device.create_buffer_init(&BufferInitDescriptor {
            label: Some(&binding.name),
            contents: &bake.material_buffer()?,
            usage: wgpu::BufferUsages::STORAGE,
        }))),
        other => bail!("a binding of unknown kind `{other}`"),
    }
}

fn upload_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    texels: &Texels,
) -> Result<wgpu::TextureView> {
    let format = match texels.format.as_str() {
        "r16float" => wgpu::TextureFormat::R16Float,
        "rg16float" => wgpu::TextureFormat::Rg16Float,
        "rgba16float" => wgpu::TextureFormat::Rgba16Float,
        "rgba8unorm" => wgpu::TextureFormat::Rgba8Unorm,
        "rgb10a2unorm" => wgpu::TextureFormat::Rgb10a2Unorm,
        "rg11b10ufloat" => wgpu::TextureFormat::Rg11b10Ufloat,
        // Floats of 32 bits are not filtered, and the others need a feature of the device. A bake has them only where it is asked for them.
        other => bail!("this program does not upload `{other}`"),
    };
    let descriptor = wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: texels.width, height: texels.height, depth_or_array_layers: texels.faces },
        mip_level_count: texels.levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texture = device.create_texture_with_data(queue, &descriptor, TextureDataOrder::MipMajor, &texels.bytes);
    let dimension = (texels.faces == 6).then_some(wgpu::TextureViewDimension::Cube);
    Ok(texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() }))
}

fn layout_entry(binding: u32, resource: &Resource) -> wgpu::BindGroupLayoutEntry {
    let texture = |view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension,
        multisampled: false,
    };
    let ty = match resource {
        Resource::Table(_) => texture(wgpu::TextureViewDimension::D2),
        Resource::Cube(_) => texture(wgpu::TextureViewDimension::Cube),
        Resource::Sampler(_) => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        Resource::Buffer(_) => wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
    };
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None }
}

fn group_entry(binding: u32, resource: &Resource) -> wgpu::BindGroupEntry<'_> {
    let resource = match resource {
        Resource::Table(view) | Resource::Cube(view) => wgpu::BindingResource::TextureView(view),
        Resource::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        Resource::Buffer(buffer) => buffer.as_entire_binding(),
    };
    wgpu::BindGroupEntry { binding, resource }
}
