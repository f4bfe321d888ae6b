//! A ball of a baked material, rendered with Bevy into a PNG.
//!
//! `luthier-example-bevy BAKE SCENE PNG`: the folder of `luthier bake`, `scene.json`, the picture to write.

mod bake;

use std::env;
use std::f32::consts::FRAC_PI_2;
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use bevy::app::ScheduleRunnerPlugin;
use bevy::camera::{Exposure, RenderTarget};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::storage::ShaderBuffer;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::ExitCondition;
use serde_json::Value;

use bake::BakedMaterial;

/// Frames drawn before the picture is taken: a material shows once its textures, buffer and shader are on the device.
const FRAMES: u32 = 8;

/// Where Bevy's exposure 1 / (1.2 * 2^ev100) is 1: -log2(1.2).
const UNEXPOSED_EV100: f32 = -0.263_034_4;

/// What the command line says.
#[derive(Resource)]
struct Arguments {
    bake: PathBuf,
    scene: Value,
    picture: PathBuf,
}

/// What the camera renders into.
#[derive(Resource)]
struct Target(Handle<Image>);

fn main() -> Result<AppExit> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [bake, scene, picture] = arguments.as_slice() else {
        return Err("usage: luthier-example-bevy BAKE SCENE PNG".into());
    };
    let scene = serde_json::from_str(&fs::read_to_string(scene)?)?;
    let exit = App::new()
        .add_plugins(
            DefaultPlugins
                .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
                .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() }),
        )
        .add_plugins(ScheduleRunnerPlugin::run_loop(Duration::ZERO))
        .add_plugins(MaterialPlugin::<BakedMaterial>::default())
        .insert_resource(Arguments { bake: bake.into(), scene, picture: picture.into() })
        .add_systems(Startup, setup)
        .add_systems(Update, take_picture)
        .run();
    Ok(exit)
}

fn setup(
    arguments: Res<Arguments>,
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut shaders: ResMut<Assets<Shader>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<BakedMaterial>>,
) -> Result {
    let scene = &arguments.scene;
    let name = scene["material"].as_str().ok_or("a scene without a material")?;
    let material = BakedMaterial::open(&arguments.bake, name, &mut images, &mut buffers, &mut shaders)?;
    commands.spawn((
        // The poles of Bevy's ball are on its z axis.
        Mesh3d(meshes.add(Sphere::new(1.0).mesh().uv(128, 64))),
        Transform::from_rotation(Quat::from_rotation_x(-FRAC_PI_2)),
        MeshMaterial3d(materials.add(material)),
    ));

    for light in scene["lights"].as_array().ok_or("a scene without lights")? {
        let irradiance = triple(&light["irradiance"])?;
        commands.spawn((
            DirectionalLight {
                color: Color::linear_rgb(irradiance.x, irradiance.y, irradiance.z),
                illuminance: 1.0,
                ..default()
            },
            Transform::default().looking_to(-triple(&light["direction"])?, Vec3::Y),
        ));
    }

    let size = scene["size"].as_u64().ok_or("a scene without a size")? as u32;
    let target = images.add(Image::new_target_texture(size, size, TextureFormat::Rgba8UnormSrgb, None));
    let background = triple(&scene["background"])?;
    commands.spawn((
        Camera3d::default(),
        Camera {
            clear_color: ClearColorConfig::Custom(Color::linear_rgb(background.x, background.y, background.z)),
            ..default()
        },
        RenderTarget::Image(target.clone().into()),
        Projection::Perspective(PerspectiveProjection { fov: number(&scene["fov_y_deg"])?.to_radians(), ..default() }),
        Transform::from_xyz(0.0, 0.0, number(&scene["eye_distance"])?),
        // Radiance as it is: an exposure of 1, no tone curve, no noise.
        Exposure { ev100: UNEXPOSED_EV100 },
        Tonemapping::None,
        DebandDither::Disabled,
        Msaa::Off,
    ));
    commands.insert_resource(Target(target));
    Ok(())
}

fn take_picture(mut frame: Local<u32>, target: Res<Target>, mut commands: Commands) {
    *frame += 1;
    if *frame == FRAMES {
        commands.spawn(Screenshot::image(target.0.clone())).observe(save);
    }
}

fn save(captured: On<ScreenshotCaptured>, arguments: Res<Arguments>, mut exit: MessageWriter<AppExit>) -> Result {
    captured.image.clone().try_into_dynamic()?.to_rgb8().save(&arguments.picture)?;
    exit.write(AppExit::Success);
    Ok(())
}

fn number(value: &Value) -> Result<f32> {
    Ok(value.as_f64().ok_or_else(|| format!("{value} should be a number"))? as f32)
}

fn triple(value: &Value) -> Result<Vec3> {
    Ok(Vec3::new(number(&value[0])?, number(&value[1])?, number(&value[2])?))
}
