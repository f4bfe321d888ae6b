//! A ball of a baked material, rendered with wgpu into a PNG.
//!
//! `luthier-example-wgpu BAKE SCENE PNG [ENVIRONMENT]`: the folder of `luthier bake`, `scene.json`, the picture to write; for a bake with
//! `--functions environment` the folder of `luthier environment`. `-` in place of a folder is the bake of `build.rs`, which is part of the program.

mod bake;
mod materials;
mod scene;

use std::env;
use std::fs::File;
use std::path::Path;

use anyhow::{Result, bail};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

use bake::Bake;
use materials::Materials;
use scene::{Scene, ball};

/// The bake of `build.rs`.
mod materials_of_build {
    include!(concat!(env!("OUT_DIR"), "/materials.rs"));
}

/// Written with the sRGB transfer function, read back as it is.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

fn main() -> Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [folder, scene, picture, surroundings @ ..] = arguments.as_slice() else {
        bail!("usage: luthier-example-wgpu BAKE SCENE PNG [ENVIRONMENT]");
    };
    let surroundings = surroundings.first().map(Path::new);
    let bake = match folder.as_str() {
        "-" => Bake::built_in(materials_of_build::FILES)?,
        folder => Bake::open(Path::new(folder))?,
    };
    let scene = Scene::open(Path::new(scene))?;
    let material = bake.material(&scene.material)?;

    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let info = adapter.get_info();
    eprintln!("{} ({}), material {material}: {}", info.name, info.backend, scene.material);
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    let materials = Materials::upload(&device, &queue, &bake, surroundings)?;
    let pixels = render(&device, &queue, &shader(&bake, surroundings.is_some())?, &materials, &scene, material)?;

    let mut encoder = png::Encoder::new(File::create(picture)?, scene.size, scene.size);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}

/// The text of the bake, and that of the program, with or without surroundings.
fn shader(bake: &Bake, has_surroundings: bool) -> Result<String> {
    let surroundings =
        if has_surroundings { include_str!("surroundings.wgsl") } else { include_str!("no_surroundings.wgsl") };
    Ok([&bake.wgsl()?, surroundings, include_str!("ball.wgsl")].join("\n"))
}

/// Renders the ball; RGBA, row by row from the top.
fn render(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    shader: &str,
    materials: &Materials,
    scene: &Scene,
    material: u32,
) -> Result<Vec<u8>> {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("ball"),
        source: wgpu::ShaderSource::Wgsl(shader.into()),
    });
    let scene_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("scene"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("ball"),
        bind_group_layouts: &[Some(&materials.layout), Some(&scene_layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("ball"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("ball_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<[f32; 3]>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("ball_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    });

    let (points, corners) = ball();
    let buffer = |label, contents: &[u8], usage| {
        device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage })
    };
    let point_buffer = buffer("points", bytemuck::cast_slice(&points), wgpu::BufferUsages::VERTEX);
    let corner_buffer = buffer("corners", bytemuck::cast_slice(&corners), wgpu::BufferUsages::INDEX);
    let uniforms = buffer("scene", &scene.uniforms(material), wgpu::BufferUsages::UNIFORM);
    let scene_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("scene"),
        layout: &scene_layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
    });

    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width: scene.size, height: scene.size, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let [red, green, blue] = scene.background.map(f64::from);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ball"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: red, g: green, b: blue, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &materials.group, &[]);
        pass.set_bind_group(1, &scene_group, &[]);
        pass.set_vertex_buffer(0, point_buffer.slice(..));
        pass.set_index_buffer(corner_buffer.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(0..corners.len() as u32, 0, 0..1);
    }
    read_back(device, queue, encoder, &target)
}

/// Submits what is encoded and waits for the texels of `target`.
fn read_back(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    target: &wgpu::Texture,
) -> Result<Vec<u8>> {
    let size = target.size();
    let row = 4 * size.width;
    let stride = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pixels"),
        size: u64::from(stride) * u64::from(size.height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None },
        },
        size,
    );
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let mapped = buffer.get_mapped_range(..)?;
    Ok(mapped.chunks(stride as usize).flat_map(|line| line[..row as usize].to_vec()).collect())
}
