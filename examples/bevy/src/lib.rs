//! Materials that luthier baked, for Bevy: [`LuthierPlugin`] loads a bake's `manifest.json`, and each of its materials is a [`LuthierMaterial`].
//!
//! ```no_run
//! use bevy::prelude::*;
//! use luthier_bevy::{LuthierMaterial, LuthierPlugin};
//!
//! fn setup(server: Res<AssetServer>, mut meshes: ResMut<Assets<Mesh>>, mut commands: Commands) {
//!     let paint: Handle<LuthierMaterial> = server.load("bake/manifest.json#car-paint");
//!     commands.spawn((Mesh3d(meshes.add(Sphere::default())), MeshMaterial3d(paint)));
//! }
//!
//! App::new().add_plugins((DefaultPlugins, LuthierPlugin)).add_systems(Startup, setup).run();
//! ```

mod loader;
mod material;
mod shader;
mod surface;

use bevy::app::{App, Plugin};
use bevy::asset::AssetApp;
use bevy::pbr::MaterialPlugin;

pub use loader::{LuthierBake, LuthierError, LuthierLoader, LuthierSettings};
pub use material::{LuthierEnvironment, LuthierMaterial, Numbers};

/// Loads bakes of luthier and draws their materials.
///
/// A bake is the asset [`LuthierBake`] at the path of its `manifest.json`; the label `#NAME` is one of its materials. Where Bevy watches
/// files, a bake that is written anew is shown at once.
#[derive(Debug, Clone, Copy, Default)]
pub struct LuthierPlugin;

impl Plugin for LuthierPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(MaterialPlugin::<LuthierMaterial>::default())
            .init_asset::<LuthierBake>()
            .init_asset_loader::<LuthierLoader>()
            .add_systems(bevy::app::PreUpdate, material::light_from_all_around);
    }
}
