//! The levels of an environment as textures.

use luthier_environment::{Environment, Layout, Level};
use luthier_lut::{Image, TexelFormat};

use crate::GpuError;
use crate::context::Context;

/// The cubes that shaders read an environment from.
#[derive(Debug)]
pub(crate) struct Surroundings {
    pub(crate) environment: wgpu::TextureView,
    pub(crate) irradiance: wgpu::TextureView,
}

impl Surroundings {
    pub(crate) fn new(context: &Context, environment: &Environment) -> Result<Self, GpuError> {
        let irradiance = Level { width: 0.0, images: environment.irradiance_level(Layout::Cube) };
        Ok(Self {
            environment: cube(context, "luthier_environment_map", environment.cube_levels())?,
            irradiance: cube(context, "luthier_irradiance_map", &[irradiance])?,
        })
    }

    /// Black cubes, for shaders that show lights alone.
    pub(crate) fn black(context: &Context) -> Result<Self, GpuError> {
        let black = [Level { width: 0.0, images: vec![Image::zeros(1, 1, 3); 6] }];
        Ok(Self { environment: cube(context, "black", &black)?, irradiance: cube(context, "black", &black)? })
    }
}

fn cube(context: &Context, label: &str, levels: &[Level]) -> Result<wgpu::TextureView, GpuError> {
    let size = levels[0].images[0].width;
    context.guarded(label, || {
        let texture = context.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 6 },
            mip_level_count: levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for (level, images) in (0..).zip(levels.iter().map(|level| &level.images)) {
            for (face, image) in (0..).zip(images) {
                context.upload_face(&texture, level, face, &TexelFormat::Rgba16Float.encode(&opaque(image)));
            }
        }
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::Cube),
            ..wgpu::TextureViewDescriptor::default()
        })
    })
}

/// RGB with a fourth channel of 1, clamped to 65504: the largest half float.
fn opaque(image: &Image) -> Image {
    let data = image.texels().flat_map(|t| [t[0], t[1], t[2], 1.0].map(|v| v.min(65504.0))).collect();
    Image { channels: 4, data, ..*image }
}
