//! A ball of a baked material, rendered with Bevy into a PNG.
//!
//! `luthier-bevy BAKE SCENE PNG`: the folder of `luthier bake`, `scene.json`, the picture to write. `luthier-bevy BAKE SCENE PNG AGAIN PNG2`
//! then copies the folder AGAIN over the bake while the program runs, and writes the picture that follows.

use std::env;
use std::f32::consts::FRAC_PI_2;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use bevy::app::ScheduleRunnerPlugin;
use bevy::asset::{LoadState, UnapprovedPathMode};
use bevy::camera::{Exposure, RenderTarget};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::light::PointLight;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::ExitCondition;
use luthier_bevy::{LuthierBake, LuthierEnvironment, LuthierMaterial, LuthierPlugin, LuthierSettings};
use serde::Deserialize;

/// Frames drawn before the picture is taken: a material shows once its textures, buffer and shader are on the device.
const FRAMES: u32 = 8;

/// Where Bevy's exposure 1 / (1.2 * 2^ev100) is 1: -log2(1.2).
const UNEXPOSED_EV100: f32 = -0.263_034_4;

/// Frames until a bake that is written anew has to be there.
const PATIENCE: u32 = 2_000;

/// What `scene.json` says.
#[derive(Resource, Deserialize, Clone)]
struct Description {
    size: u32,
    material: String,
    /// A material for a floor below the ball.
    floor: Option<String>,
    fov_y_deg: f32,
    eye_distance: f32,
    background: [f32; 3],
    lights: Vec<Lamp>,
    #[serde(default)]
    slope_variance: f32,
    /// Distance at which fog hides half.
    fog: Option<f32>,
    /// Radiance of even light from all around.
    #[serde(default)]
    ambient: f32,
    /// Folder of `luthier environment --layout cube`.
    environment: Option<PathBuf>,
}

/// A lamp far away, or at a position, whose irradiance is that at the centre.
#[derive(Deserialize, Clone)]
struct Lamp {
    direction: Option<[f32; 3]>,
    position: Option<[f32; 3]>,
    /// Angle between the axis of a spot, which shines at the centre, and the edge of its light.
    cone_deg: Option<f32>,
    irradiance: [f32; 3],
    #[serde(default)]
    shadows: bool,
}

/// Pictures to take: the bake as it is, and with the files of another.
#[derive(Resource)]
struct Orders {
    bake: PathBuf,
    pictures: Vec<(Option<PathBuf>, PathBuf)>,
    /// The one at work, frames that it was shown, and frames altogether.
    current: usize,
    shown: u32,
    waited: u32,
}

/// What the camera renders into, and the bake.
#[derive(Resource)]
struct Stage {
    target: Handle<Image>,
    bake: Handle<LuthierBake>,
}

fn main() -> ExitCode {
    match start() {
        Ok(AppExit::Success) => ExitCode::SUCCESS,
        Ok(AppExit::Error(_)) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn start() -> Result<AppExit> {
    let arguments: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let (bake, scene, pictures) = match arguments.as_slice() {
        [bake, scene, picture] => (bake, scene, vec![(None, picture.clone())]),
        [bake, scene, picture, again, second] => {
            (bake, scene, vec![(None, picture.clone()), (Some(again.clone()), second.clone())])
        }
        _ => return Err("usage: luthier-bevy BAKE SCENE PNG [AGAIN PNG]".into()),
    };
    let bake = fs::canonicalize(bake)?;
    let description: Description = serde_json::from_str(&fs::read_to_string(scene)?)?;
    Ok(App::new()
        .add_plugins(
            DefaultPlugins
                .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
                .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
                .set(AssetPlugin {
                    file_path: bake.to_string_lossy().into_owned(),
                    watch_for_changes_override: Some(pictures.len() > 1),
                    unapproved_path_mode: UnapprovedPathMode::Allow,
                    ..default()
                }),
        )
        .add_plugins((ScheduleRunnerPlugin::run_loop(Duration::ZERO), LuthierPlugin))
        .insert_resource(GlobalAmbientLight { brightness: description.ambient, ..default() })
        .insert_resource(description)
        .insert_resource(Orders { bake, pictures, current: 0, shown: 0, waited: 0 })
        .add_systems(Startup, setup)
        .add_systems(Update, (furnish, prepare, take_pictures).chain())
        .run())
}

fn setup(scene: Res<Description>, server: Res<AssetServer>, mut commands: Commands, mut images: ResMut<Assets<Image>>) {
    // `preview` reads level 0 of maps.
    let plain = |settings: &mut LuthierSettings| settings.mipmaps = false;
    let bake = server.load_builder().with_settings(plain).load("manifest.json");
    for lamp in &scene.lights {
        spawn(&mut commands, lamp);
    }
    if let Some(folder) = &scene.environment {
        let [environment, irradiance] =
            ["environment-cube.ktx2", "irradiance-cube.ktx2"].map(|name| server.load(folder.join(name)));
        commands.insert_resource(LuthierEnvironment { environment, irradiance });
    }

    let target = images.add(Image::new_target_texture(scene.size, scene.size, TextureFormat::Rgba8UnormSrgb, None));
    let camera = commands.spawn((
        Camera3d::default(),
        Camera { clear_color: ClearColorConfig::Custom(color(scene.background)), ..default() },
        RenderTarget::Image(target.clone().into()),
        Projection::Perspective(PerspectiveProjection { fov: scene.fov_y_deg.to_radians(), ..default() }),
        Transform::from_xyz(0.0, 0.0, scene.eye_distance),
        // Radiance as it is: an exposure of 1, no tone curve, no noise.
        Exposure { ev100: UNEXPOSED_EV100 },
        Tonemapping::None,
        DebandDither::Disabled,
        Msaa::Off,
    ));
    let camera = camera.id();
    if let Some(distance) = scene.fog {
        let falloff = FogFalloff::Exponential { density: std::f32::consts::LN_2 / distance };
        commands.entity(camera).insert(DistanceFog { color: color(scene.background), falloff, ..default() });
    }
    commands.insert_resource(Stage { target, bake });
}

fn spawn(commands: &mut Commands, lamp: &Lamp) {
    let color = color(lamp.irradiance);
    let shadow_maps_enabled = lamp.shadows;
    let Some(position) = lamp.position.map(Vec3::from) else {
        let direction = lamp.direction.map_or(Vec3::Y, Vec3::from);
        let light = DirectionalLight { color, illuminance: 1.0, shadow_maps_enabled, ..default() };
        commands.spawn((light, Transform::default().looking_to(-direction, Vec3::Y)));
        return;
    };
    let intensity = 4.0 * std::f32::consts::PI * position.length_squared();
    // So far that Bevy does not fade the lamp.
    let range = 1e3;
    let place = Transform::from_translation(position).looking_at(Vec3::ZERO, Vec3::Y);
    if let Some(cone) = lamp.cone_deg {
        let angle = cone.to_radians();
        let light = SpotLight {
            color,
            intensity,
            range,
            shadow_maps_enabled,
            outer_angle: angle,
            inner_angle: 0.99 * angle,
            ..default()
        };
        commands.spawn((light, place));
    } else {
        commands.spawn((PointLight { color, intensity, range, shadow_maps_enabled, ..default() }, place));
    }
}

/// Sets up a ball, and a floor where the scene has one, once the bake is loaded.
fn furnish(
    mut is_done: Local<bool>,
    scene: Res<Description>,
    stage: Res<Stage>,
    bakes: Res<Assets<LuthierBake>>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
) -> Result {
    let Some(bake) = bakes.get(&stage.bake).filter(|_| !*is_done) else { return Ok(()) };
    *is_done = true;
    let material = |name: &str| {
        let material = bake.materials.get(name).ok_or_else(|| format!("the bake has no material {name}"))?;
        Ok::<_, BevyError>(MeshMaterial3d(material.clone()))
    };
    commands.spawn((Mesh3d(meshes.add(ball())), material(&scene.material)?));
    if let Some(floor) = &scene.floor {
        let plane = meshes.add(Plane3d::default().mesh().size(8.0, 8.0));
        commands.spawn((Mesh3d(plane), material(floor)?, Transform::from_xyz(0.0, -1.2, 0.0)));
    }
    Ok(())
}

/// Gives the materials, once they are loaded, the slope variance of the scene.
fn prepare(
    scene: Res<Description>,
    mut loaded: MessageReader<AssetEvent<LuthierMaterial>>,
    mut materials: ResMut<Assets<LuthierMaterial>>,
) {
    for event in loaded.read() {
        let (AssetEvent::Added { id } | AssetEvent::Modified { id }) = event else { continue };
        let is_other = |material: &LuthierMaterial| material.numbers.slope_variance != scene.slope_variance;
        if materials.get(*id).is_some_and(is_other)
            && let Some(mut material) = materials.get_mut(*id)
        {
            material.numbers.slope_variance = scene.slope_variance;
        }
    }
}

fn take_pictures(
    mut orders: ResMut<Orders>,
    stage: Res<Stage>,
    environment: Option<Res<LuthierEnvironment>>,
    server: Res<AssetServer>,
    mut came: MessageReader<AssetEvent<LuthierBake>>,
    mut commands: Commands,
    mut exit: MessageWriter<AppExit>,
) -> Result {
    orders.waited += 1;
    if let LoadState::Failed(error) = server.load_state(&stage.bake) {
        // A backtrace follows the first line.
        let error = error.to_string();
        eprintln!("error: {}", error.lines().next().unwrap_or_default());
        exit.write(AppExit::error());
        return Ok(());
    }
    if orders.waited > PATIENCE {
        eprintln!("error: the bake did not come");
        exit.write(AppExit::error());
        return Ok(());
    }
    let is_there = came.read().any(|event| matches!(event, AssetEvent::LoadedWithDependencies { .. }));
    let is_lit =
        environment.is_none_or(|around| server.is_loaded(&around.environment) && server.is_loaded(&around.irradiance));
    if is_there {
        orders.shown = 1;
    } else if orders.shown > 0 && is_lit {
        orders.shown += 1;
    }
    if orders.shown == FRAMES {
        commands.spawn(Screenshot::image(stage.target.clone())).observe(save);
    }
    Ok(())
}

fn save(captured: On<ScreenshotCaptured>, mut orders: ResMut<Orders>, mut exit: MessageWriter<AppExit>) -> Result {
    let Orders { bake, pictures, current, shown, waited } = &mut *orders;
    captured.image.clone().try_into_dynamic()?.to_rgb8().save(&pictures[*current].1)?;
    *current += 1;
    let Some((again, _)) = pictures.get(*current) else {
        exit.write(AppExit::Success);
        return Ok(());
    };
    if let Some(again) = again {
        copy(again, bake)?;
    }
    (*shown, *waited) = (0, 0);
    Ok(())
}

/// The files of a folder, over those of another; the manifest comes last.
fn copy(from: &Path, to: &Path) -> Result {
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type()?.is_dir() {
            fs::create_dir_all(&target)?;
            copy(&source, &target)?;
        } else if entry.file_name() != "manifest.json" {
            fs::copy(source, target)?;
        }
    }
    if from.join("manifest.json").exists() {
        fs::copy(from.join("manifest.json"), to.join("manifest.json"))?;
    }
    Ok(())
}

/// A ball whose texture coordinates begin at the top, behind: those of `luthier preview --shape sphere`.
fn ball() -> Mesh {
    const ACROSS: u32 = 128;
    const DOWN: u32 = 64;
    let (mut positions, mut coordinates, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for j in 0..=DOWN {
        for i in 0..=ACROSS {
            let (u, v) = (i as f32 / ACROSS as f32, j as f32 / DOWN as f32);
            let ((sin_u, cos_u), (sin_v, cos_v)) = ((4.0 * FRAC_PI_2 * u).sin_cos(), (2.0 * FRAC_PI_2 * v).sin_cos());
            positions.push([-cos_u * sin_v, cos_v, sin_u * sin_v]);
            coordinates.push([u + 0.25, v]);
            if i < ACROSS && j < DOWN {
                let [b, c] = [j, j + 1].map(|row| row * (ACROSS + 1) + i);
                indices.extend([b + 1, b, c + 1, b, c, c + 1]);
            }
        }
    }
    Mesh::new(bevy::mesh::PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, positions.clone())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, coordinates)
        .with_inserted_indices(bevy::mesh::Indices::U32(indices))
}

fn color([r, g, b]: [f32; 3]) -> Color {
    Color::linear_rgb(r, g, b)
}
