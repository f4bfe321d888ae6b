//! Shaders of engines to compare costs with: coats as games draw them.

use luthier_manifest::{BindingEntry, LayerKind, LayerRecord, LowerReflectance, MaterialEntry};

luthier_lut::named! {
    /// A shader that engines draw a coat by. It has the functions `luthier_eval`, `luthier_prepare` and `luthier_light` of a bake's shader, and reads
    /// [`CoatNumbers`] from the material buffer.
    ///
    /// Simplifications: isotropic, no textures, no maps of normals, and no table that compensates for energy.
    ///
    /// ```
    /// use luthier_shader::{Yardstick, validate};
    ///
    /// let text = Yardstick::GltfClearcoat.wgsl();
    /// assert!(text.contains("fn luthier_light(") && validate(&text).is_ok());
    /// ```
    pub enum Yardstick("yardstick") {
        /// The metallic-roughness surface without a coat: glTF 2.0, Appendix B, in its simplified form (B.3.5): GGX, Schlick's reflectance
        /// at the half vector, and Lambert's base with the rest. The masking is Smith's, height-correlated, as in Khronos' sample viewer; the
        /// appendix prints the separable form.
        Gltf = "gltf",
        /// The surface of `gltf` below a coat: glTF's extension `KHR_materials_clearcoat`, section "Layering". The coat has GGX, the masking above and
        /// Schlick's reflectance of index 1.5 at the cosine of the eye, by which coat and surface are mixed.
        GltfClearcoat = "gltf-clearcoat",
        /// Filament's clear coat: `surface_shading_model_standard.fs`, `surface_brdf.fs` and `common_material.fs` at the highest quality. The masking
        /// of the coat is Kelemen's (2001), its reflectance is at the half vector, the surface is at least as rough as the coat
        /// and its F0 is that below index 1.5. Lambert's base keeps its whole albedo, as there.
        FilamentClearcoat = "filament-clearcoat",
    }
}

impl Yardstick {
    /// WGSL: functions only, group 0 for [`Self::binding`].
    pub fn wgsl(self) -> String {
        let surface = match self {
            Self::Gltf => include_str!("wgsl/yardstick/gltf.wgsl"),
            Self::GltfClearcoat => include_str!("wgsl/yardstick/gltf_clearcoat.wgsl"),
            Self::FilamentClearcoat => include_str!("wgsl/yardstick/filament_clearcoat.wgsl"),
        };
        [include_str!("wgsl/yardstick/record.wgsl"), surface, include_str!("wgsl/yardstick/eval.wgsl")].join("\n")
    }

    /// The one resource: the material buffer, with [`CoatNumbers::words`] for each material.
    pub fn binding() -> BindingEntry {
        BindingEntry { binding: 6, name: "luthier_materials".to_owned(), resource: "buffer".to_owned() }
    }
}

/// Numbers that yardsticks read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoatNumbers {
    /// Reflectance of the surface below the coat at normal incidence, in air, RGB.
    pub f0: [f64; 3],
    /// Slope parameter of that surface.
    pub alpha: f64,
    /// Albedo of its diffuse base, RGB.
    pub diffuse: [f64; 3],
    /// Slope parameter of the coat.
    pub coat_alpha: f64,
}

/// F0 of index 1.5, the default of glTF and Filament.
const F0: f64 = 0.04;

impl CoatNumbers {
    /// The numbers that an artist would give the stack of a bake. The coat is the first interface. The surface is the lowest interface: its
    /// slope parameter, its reflectance in air without films at the wavelengths of the record, and its diffuse base. A diffuse base directly below the
    /// coat has no interface of its own: its surface has the slope parameter of the coat, and the reflectance of index 1.5.
    ///
    /// ```
    /// use luthier_manifest::{LayerKind, LayerRecord, MaterialEntry};
    /// use luthier_shader::CoatNumbers;
    ///
    /// let coat = LayerRecord { alpha: 0.1, eta: 1.5, ior_n: [1.5; 3], ..LayerRecord::default() };
    /// // Relative to the coat; in air it is 3.
    /// let mirror = LayerRecord { kind: LayerKind::Conductor, alpha: 0.3, ior_n: [2.0; 3], ..LayerRecord::default() };
    /// let entry = MaterialEntry { layers: vec![coat, mirror], ..MaterialEntry::default() };
    /// let numbers = CoatNumbers::of(&entry);
    /// assert_eq!((numbers.coat_alpha, numbers.alpha, numbers.f0, numbers.diffuse), (0.1, 0.3, [0.25; 3], [0.0; 3]));
    /// ```
    pub fn of(material: &MaterialEntry) -> Self {
        let interfaces: Vec<&LayerRecord> =
            material.layers.iter().take_while(|layer| layer.kind != LayerKind::Diffuse).collect();
        let diffuse = material.layers.get(interfaces.len()).map(|layer| layer.albedo);
        let f0 = match interfaces.as_slice() {
            [] => [F0; 3],
            [_] if diffuse.is_some() => [F0; 3],
            [above @ .., lowest] => in_air(lowest, above.iter().map(|layer| layer.eta).product()),
        };
        let [coat_alpha, alpha] =
            [interfaces.first(), interfaces.last()].map(|layer| layer.map_or(1.0, |layer| layer.alpha));
        Self { f0, alpha, diffuse: diffuse.unwrap_or_default(), coat_alpha }
    }

    /// The record: F0 RGB and slope parameter of the surface; diffuse albedo RGB over pi, and slope parameter of the coat.
    pub fn words(&self) -> [[f32; 4]; 2] {
        let [r, g, b] = self.f0;
        let [dr, dg, db] = self.diffuse.map(|albedo| albedo * std::f64::consts::FRAC_1_PI);
        [[r, g, b, self.alpha], [dr, dg, db, self.coat_alpha]].map(|word| word.map(|value| value as f32))
    }
}

/// Reflectance of an interface at normal incidence if air lay above it, from its index relative to one of index `above`.
fn in_air(layer: &LayerRecord, above: f64) -> [f64; 3] {
    let above = if layer.lower_reflectance == LowerReflectance::InAir { 1.0 } else { above };
    layer.f0.unwrap_or_else(|| {
        [0, 1, 2].map(|c| {
            let (n, k) = (above * layer.ior_n[c], above * layer.ior_k[c]);
            ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
        })
    })
}
