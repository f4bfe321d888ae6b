//! Parts of a shape: each shows a material, or a surface of several.

use crate::{GpuError, Scene};

/// A material or a surface of a bake, by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// One material everywhere.
    Material(u32),
    /// A surface: the shader picks a material at each place.
    Surface(u32),
}

impl Shown {
    /// The word of a part in `shading.wgsl`: number of the material, or of the surface, and which of the two.
    pub(crate) fn word(self) -> [u32; 4] {
        match self {
            Self::Material(material) => [material, 0, 0, 0],
            Self::Surface(surface) => [surface, 1, 0, 0],
        }
    }
}

impl Scene {
    /// Numbers of the materials that parts show, each once.
    ///
    /// # Errors
    /// [`GpuError::NoMaterial`], [`GpuError::NoSurface`].
    pub fn materials_of(&self, parts: &[Shown]) -> Result<Vec<u32>, GpuError> {
        let mut materials = Vec::new();
        for part in parts {
            match *part {
                Shown::Material(material) => {
                    self.layers(material)?;
                    materials.push(material);
                }
                Shown::Surface(surface) => {
                    let all = &self.manifest.surfaces;
                    let entry = all.get(surface as usize);
                    let entry = entry.ok_or(GpuError::NoSurface { surface, count: all.len() })?;
                    materials.extend(entry.materials());
                }
            }
        }
        materials.sort_unstable();
        materials.dedup();
        Ok(materials)
    }

    /// WGSL of `shading_pick`: the material and the normal of a part at a place.
    pub(crate) fn pick_function(&self) -> &'static str {
        if self.interface.calls("luthier_pick") {
            "fn shading_pick(part: vec4<u32>, uv: vec2<f32>) -> ShadingPick {\n    \
                 if part.y == 1u {\n        \
                     let pick = luthier_pick(part.x, uv);\n        \
                     return ShadingPick(pick.material, pick.normal);\n    \
                 }\n    \
                 return ShadingPick(part.x, vec3<f32>(0.0, 0.0, 1.0));\n}\n"
        } else {
            "fn shading_pick(part: vec4<u32>, uv: vec2<f32>) -> ShadingPick {\n    \
                 return ShadingPick(part.x, vec3<f32>(0.0, 0.0, 1.0));\n}\n"
        }
    }
}
