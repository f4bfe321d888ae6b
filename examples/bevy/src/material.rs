//! The material: what a bake's shader binds, and the shader that Bevy draws with.

use bevy::asset::{Asset, Assets, Handle};
use bevy::ecs::change_detection::DetectChanges;
use bevy::ecs::message::MessageReader;
use bevy::ecs::resource::Resource;
use bevy::ecs::system::{Res, ResMut};
use bevy::image::Image;
use bevy::math::{Mat3, UVec4, Vec4};
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{Material, MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::AssetEvent;
use bevy::reflect::TypePath;
use bevy::render::render_resource::{AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::Shader;

/// Maps that a material has at most.
pub(crate) const MAPS: usize = 8;

/// A material of a bake. The numbers of its tables are those of every bake (docs/bindings.md); a table that no material needs stays out
/// of the shader, and `None` binds Bevy's white texel in its place.
#[derive(Asset, TypePath, AsBindGroup, Debug, Clone)]
#[bind_group_data(Program)]
pub struct LuthierMaterial {
    /// Shader of the bake, the same for all its materials.
    pub shader: Handle<Shader>,
    #[texture(0)]
    #[sampler(5)]
    pub(crate) fresnel: Option<Handle<Image>>,
    #[texture(1)]
    pub(crate) distribution: Option<Handle<Image>>,
    #[texture(2)]
    pub(crate) fgd: Option<Handle<Image>>,
    #[texture(3)]
    pub(crate) phase: Option<Handle<Image>>,
    #[texture(4)]
    pub(crate) thickness: Option<Handle<Image>>,
    #[texture(7)]
    pub(crate) film: Option<Handle<Image>>,
    #[texture(8)]
    pub(crate) escape: Option<Handle<Image>>,
    #[texture(9)]
    pub(crate) lobes: Option<Handle<Image>>,
    #[storage(6, read_only)]
    pub(crate) materials: Handle<ShaderBuffer>,
    #[texture(13, dimension = "cube")]
    #[sampler(15)]
    pub(crate) environment: Option<Handle<Image>>,
    #[texture(14, dimension = "cube")]
    pub(crate) irradiance: Option<Handle<Image>>,
    /// Numbers of the material. Bindings from 16 up are those of this crate.
    #[uniform(16)]
    pub numbers: Numbers,
    #[texture(17)]
    #[sampler(25)]
    pub(crate) map_0: Option<Handle<Image>>,
    #[texture(18)]
    pub(crate) map_1: Option<Handle<Image>>,
    #[texture(19)]
    pub(crate) map_2: Option<Handle<Image>>,
    #[texture(20)]
    pub(crate) map_3: Option<Handle<Image>>,
    #[texture(21)]
    pub(crate) map_4: Option<Handle<Image>>,
    #[texture(22)]
    pub(crate) map_5: Option<Handle<Image>>,
    #[texture(23)]
    pub(crate) map_6: Option<Handle<Image>>,
    #[texture(24)]
    pub(crate) map_7: Option<Handle<Image>>,
}

/// Numbers of one material.
#[derive(ShaderType, Debug, Clone, Default)]
pub struct Numbers {
    /// Number of the material in the bake.
    pub material: u32,
    /// Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does.
    pub slope_variance: f32,
    /// Whether there is light from all around.
    pub(crate) has_environment: u32,
    /// Colour and metal of a surface with a map of one of them; a negative metal is none.
    pub(crate) base: Vec4,
    /// Kinds of the maps, 0 for none: `crate::surface`.
    pub(crate) kinds: [UVec4; MAPS / 4],
    /// Matrices that make the texture coordinates of the maps of (u, v, 1).
    pub(crate) rows: [Mat3; MAPS],
    /// Factors on texels.
    pub(crate) factors: [Vec4; MAPS],
}

/// The shader of a material, by which Bevy chooses a pipeline.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Program(Handle<Shader>);

impl From<&LuthierMaterial> for Program {
    fn from(material: &LuthierMaterial) -> Self {
        Self(material.shader.clone())
    }
}

impl Material for LuthierMaterial {
    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        // Prepasses and shadows have no colours, and keep the shader of Bevy.
        let is_main = descriptor.label.as_ref().is_none_or(|label| !label.contains("prepass"));
        if let Some(fragment) = descriptor.fragment.as_mut().filter(|_| is_main) {
            fragment.shader = key.bind_group_data.0;
        }
        Ok(())
    }
}

/// Light from all around, of `luthier environment --layout cube`, for all materials. It needs bakes with `--functions surface,environment`.
#[derive(Resource, Debug, Clone, Default)]
pub struct LuthierEnvironment {
    /// `environment-cube.ktx2`, blurred levels of the surroundings.
    pub environment: Handle<Image>,
    /// `irradiance-cube.ktx2`.
    pub irradiance: Handle<Image>,
}

/// Gives the light from all around to new materials, and to all where it changed.
pub(crate) fn light_from_all_around(
    environment: Option<Res<LuthierEnvironment>>,
    mut loaded: MessageReader<AssetEvent<LuthierMaterial>>,
    mut materials: ResMut<Assets<LuthierMaterial>>,
) {
    let came = loaded.read().any(|event| matches!(event, AssetEvent::Added { .. } | AssetEvent::Modified { .. }));
    let Some(environment) = environment.filter(|environment| came || environment.is_changed()) else { return };
    let new = Some(environment.environment.clone());
    let old = materials.iter().filter(|(_, material)| material.environment != new).map(|(id, _)| id);
    for id in old.collect::<Vec<_>>() {
        let Some(mut material) = materials.get_mut(id) else { continue };
        material.environment.clone_from(&new);
        material.irradiance = Some(environment.irradiance.clone());
        material.numbers.has_environment = 1;
    }
}
