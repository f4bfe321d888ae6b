//! Balls of metal in a uniform environment, drawn by Bevy without a window.

use std::error::Error;

use bevy::app::PluginsState;
use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, RenderTarget, ScalingMode};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::image::{CompressedImageFormats, ImageSampler, ImageType};
use bevy::light::GlobalAmbientLight;
use bevy::pbr::DfgLut;
use bevy::prelude::*;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::render::{RenderApp, RenderPlugin};
use bevy::tasks::tick_global_task_pools_on_main_thread;
use bevy::window::ExitCondition;

use crate::expected::Light;

/// Reflectance of the metal at normal incidence, by channel.
pub const F0: [f32; 3] = [1.0, 0.5, 0.25];
/// Roughness of each ball, from the upper left.
pub const ROUGHNESSES: [f32; 8] = [0.1, 0.15, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0];

const COLUMNS: usize = 4;
const ROWS: usize = ROUGHNESSES.len() / COLUMNS;
/// Pixels across a ball.
const DIAMETER: usize = 128;
/// Frames after which a change has reached the picture: textures and shaders are on the device.
const FRAMES: usize = 8;
/// Where Bevy's exposure 1 / (1.2 * 2^ev100) is 1: -log2(1.2).
const UNEXPOSED_EV100: f32 = -0.263_034_4;

/// Index of a pixel, of its ball, and the cosine between the eye and the normal there.
pub fn pixels() -> impl Iterator<Item = (usize, usize, f64)> {
    (0..COLUMNS * DIAMETER * ROWS * DIAMETER).filter_map(|pixel| {
        let place = [pixel % (COLUMNS * DIAMETER), pixel / (COLUMNS * DIAMETER)];
        let [x, y] = place.map(|place| ((place % DIAMETER) as f64 + 0.5) / DIAMETER as f64 * 2.0 - 1.0);
        let cos_sq = 1.0 - x * x - y * y;
        (cos_sq > 0.0).then(|| (pixel, place[1] / DIAMETER * COLUMNS + place[0] / DIAMETER, cos_sq.sqrt()))
    })
}

/// The bytes last read back.
#[derive(Resource, Default)]
struct Bytes(Vec<u8>);

/// The environment, which the camera carries.
#[derive(Resource)]
struct Surroundings {
    camera: Entity,
    white: EnvironmentMapLight,
    black: EnvironmentMapLight,
}

/// The program that draws.
pub struct Scene {
    app: App,
}

impl Scene {
    /// Starts Bevy.
    pub fn new() -> Self {
        let mut app = App::new();
        app.add_plugins(
            DefaultPlugins
                .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
                .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() }),
        )
        .insert_resource(GlobalAmbientLight::NONE)
        .init_resource::<Bytes>()
        .add_systems(Startup, setup);
        while app.plugins_state() == PluginsState::Adding {
            tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        app.update();
        Self { app }
    }

    /// Gives Bevy another table.
    pub fn replace_table(&mut self, file: &[u8]) -> Result<(), Box<dyn Error>> {
        // As Bevy decodes its own.
        let image = Image::from_buffer(
            file,
            ImageType::Extension("ktx2"),
            CompressedImageFormats::NONE,
            false,
            ImageSampler::linear(),
            RenderAssetUsages::RENDER_WORLD,
        )?;
        let texture = self.app.world_mut().resource_mut::<Assets<Image>>().add(image);
        // A view without its table is not drawn.
        self.frames();
        let render_app = self.app.get_sub_app_mut(RenderApp).ok_or("Bevy draws nothing here")?;
        render_app.world_mut().insert_resource(DfgLut { texture });
        Ok(())
    }

    /// The pixels, from the upper left.
    pub fn picture(&mut self, light: Light) -> Vec<[f32; 4]> {
        let world = self.app.world_mut();
        let Surroundings { camera, white, black } = world.resource();
        let (camera, specular_map) = (*camera, white.specular_map.clone());
        let diffuse_map = match light {
            Light::Reflected => black.diffuse_map.clone(),
            Light::All => white.diffuse_map.clone(),
        };
        world.entity_mut(camera).insert(EnvironmentMapLight { diffuse_map, specular_map, intensity: 1.0, ..default() });
        self.frames();
        self.app.world_mut().resource_mut::<Bytes>().0.clear();
        while self.app.world().resource::<Bytes>().0.is_empty() {
            self.app.update();
        }
        let bytes = &self.app.world().resource::<Bytes>().0;
        let float = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        bytes.chunks_exact(16).map(|pixel| [0, 4, 8, 12].map(|at| float(&pixel[at..]))).collect()
    }

    fn frames(&mut self) {
        (0..FRAMES).for_each(|_| self.app.update());
    }
}

fn setup(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let ball = meshes.add(Sphere::new(1.0).mesh().uv(512, 256));
    for (index, perceptual_roughness) in ROUGHNESSES.into_iter().enumerate() {
        let at = [index % COLUMNS, index / COLUMNS].map(|place| 2.0 * place as f32 + 1.0);
        commands.spawn((
            Mesh3d(ball.clone()),
            Transform::from_xyz(at[0] - COLUMNS as f32, ROWS as f32 - at[1], 0.0),
            MeshMaterial3d(materials.add(StandardMaterial {
                base_color: Color::linear_rgb(F0[0], F0[1], F0[2]),
                metallic: 1.0,
                perceptual_roughness,
                ..default()
            })),
        ));
    }

    let [width, height] = [COLUMNS, ROWS].map(|balls| (balls * DIAMETER) as u32);
    // The camera draws in the format of its target.
    let mut target = Image::new_target_texture(width, height, TextureFormat::Rgba32Float, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let target = images.add(target);
    let camera = commands.spawn((
        Camera3d::default(),
        RenderTarget::Image(target.clone().into()),
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::Fixed { width: 2.0 * COLUMNS as f32, height: 2.0 * ROWS as f32 },
            ..OrthographicProjection::default_3d()
        }),
        Transform::from_xyz(0.0, 0.0, 10.0),
        // Radiance as it is: an exposure of 1, no tone curve, no noise.
        Exposure { ev100: UNEXPOSED_EV100 },
        Tonemapping::None,
        DebandDither::Disabled,
        Msaa::Off,
    ));
    let camera = camera.id();
    let white = EnvironmentMapLight::solid_color(&mut images, Color::WHITE);
    let black = EnvironmentMapLight::solid_color(&mut images, Color::BLACK);
    commands.insert_resource(Surroundings { camera, white, black });
    commands.spawn(Readback::texture(target)).observe(|read: On<ReadbackComplete>, mut bytes: ResMut<Bytes>| {
        bytes.0.clone_from(&read.data);
    });
}
