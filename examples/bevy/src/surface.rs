//! The maps of materials: lines of shader that fill a `LuthierPlace` from their texels, and the numbers that say which texel is which.
//!
//! The lines are the same for all materials of a bake: a texel goes to the quantity whose number, its kind, is among the numbers of the
//! material. So a bake has one program.

use bevy::math::{Mat3, Vec3, Vec4};
use luthier_manifest::{Interface, Manifest, MapEntry, MapSlot, MaterialEntry};

use crate::loader::LuthierError;
use crate::material::{MAPS, Numbers};

/// The maps that models of a bake show.
pub struct Surface {
    /// Slots and layers, by kind from 1 up, and the line of each.
    kinds: Vec<((MapSlot, Option<u32>), String)>,
    /// Maps that a material has at most.
    pub width: usize,
    /// Statements before the maps, and behind them. They read `material`, `uv` and `distance`, from the eye.
    pub before: String,
    pub after: String,
}

impl Surface {
    /// The maps of a manifest, as a shader with this interface and text shows them.
    pub fn new(manifest: &Manifest, interface: &Interface, text: &str) -> Result<Self, LuthierError> {
        let shader = Known { interface, layers: layers(text) };
        let mut kinds = Vec::<((MapSlot, Option<u32>), String)>::new();
        for map in manifest.materials.iter().flat_map(|material| &material.maps) {
            let kind = (map.slot, map.layer);
            if kinds.iter().all(|(known, _)| *known != kind)
                && let Some(line) = line(&shader, map)
            {
                kinds.push((kind, line));
            }
        }
        let mut before = String::new();
        if shader.calls("luthier_film_place") {
            before += "luthier_here = luthier_film_place(luthier_here, material, uv);\n";
        }
        if shader.calls("luthier_flake_normal") {
            before += "luthier_here.flake_normal = luthier_flake_normal(material, uv, distance);\n";
        }
        let mut after = String::new();
        if shader.calls("luthier_metallic_place") {
            after += "if base.w >= 0.0 { luthier_here = luthier_metallic_place(luthier_here, material, base.xyz, base.w); }\n";
        }
        if shader.calls("luthier_glitter_normal") {
            after += "let glitter = luthier_glitter_normal(material, uv);\nif glitter.z < 1.0 { luthier_here.normal = glitter; }\n";
        }
        let mut surface = Self { kinds, width: 0, before, after };
        for material in &manifest.materials {
            let width = surface.maps_of(material).len();
            if width > MAPS {
                return Err(LuthierError::Maps { name: material.name.clone(), maps: width });
            }
            surface.width = surface.width.max(width);
        }
        Ok(surface)
    }

    /// What the texel `t` of a `kind` says of the place.
    pub fn texel(&self) -> String {
        let lines = self.kinds.iter().zip(1..);
        lines.map(|((_, line), kind)| format!("if kind == {kind}u {{ {line} }}\n")).collect()
    }

    /// The kind of the normals of flakes; a number that no map has, where there are none.
    pub fn cells(&self) -> usize {
        let place = self.kinds.iter().position(|((slot, _), _)| *slot == MapSlot::FlakeNormal);
        place.unwrap_or(self.kinds.len()) + 1
    }

    /// The maps of a material that its model shows, in the order in which they fill the place.
    pub fn maps_of<'a>(&self, material: &'a MaterialEntry) -> Vec<&'a MapEntry> {
        let mut maps: Vec<_> = material.maps.iter().filter(|map| self.kind(map) > 0).collect();
        // An F0 may depend on the weight of the coat above.
        maps.sort_by_key(|map| map.slot == MapSlot::F0);
        maps
    }

    /// The numbers of a material.
    pub fn numbers(&self, material: &MaterialEntry, number: u32) -> Numbers {
        let maps = self.maps_of(material);
        let has_base = maps.iter().any(|map| matches!(map.slot, MapSlot::BaseColor | MapSlot::Metallic));
        let base = if has_base { uncoloured(material) } else { Vec4::new(0.0, 0.0, 0.0, -1.0) };
        let mut numbers = Numbers { material: number, base, ..Numbers::default() };
        for (i, map) in maps.into_iter().enumerate() {
            numbers.kinds[i / 4][i % 4] = self.kind(map);
            numbers.rows[i] = rows(material, map);
            numbers.factors[i] = vector(map.factor.unwrap_or([1.0; 3])).extend(1.0);
        }
        numbers
    }

    fn kind(&self, map: &MapEntry) -> u32 {
        let place = self.kinds.iter().position(|(kind, _)| *kind == (map.slot, map.layer));
        place.map_or(0, |place| place as u32 + 1)
    }
}

/// Names in a shader.
struct Known<'a> {
    interface: &'a Interface,
    /// Layers with places of their own.
    layers: u32,
}

impl Known<'_> {
    fn calls(&self, name: &str) -> bool {
        self.interface.functions.iter().any(|function| function.name == name)
    }

    fn has(&self, structure: &str, member: &str) -> bool {
        let known = self.interface.structures.iter().find(|known| known.name == structure);
        known.is_some_and(|known| known.members.iter().any(|known| known == member))
    }

    fn place(&self, member: &str, line: &str) -> Option<String> {
        self.has("LuthierPlace", member).then(|| line.to_owned())
    }

    fn layer(&self, layer: u32, member: &str, line: &str) -> Option<String> {
        let fills = layer < self.layers && self.has("LuthierLayerPlace", member);
        fills.then(|| format!("luthier_here.layers[{layer}].{line}"))
    }
}

/// The line of a map: the table in docs/manifest.md. None where no model of the bake shows the quantity.
fn line(shader: &Known, map: &MapEntry) -> Option<String> {
    let layer = map.layer.unwrap_or(0);
    match map.slot {
        MapSlot::Normal => Some("luthier_here.normal = luthier_unit_normal(t);".into()),
        MapSlot::Roughness => Some("luthier_here.alpha_factor = t.x * t.x;".into()),
        MapSlot::Thickness if layer == 0 => Some("luthier_here.slab_factor = t.x;".into()),
        MapSlot::Thickness => shader.layer(layer, "slab_factor", "slab_factor = t.x;"),
        MapSlot::Absorption => shader.layer(layer, "absorption_factors", "absorption_factors = t;"),
        MapSlot::Weight => shader.place("weight_factor", "luthier_here.weight_factor = t.x;"),
        MapSlot::Patina => shader.place("patina", "luthier_here.patina = luthier_patina_amount(material, t.x);"),
        MapSlot::FlakeNormal => shader.place(
            "flake_normal",
            "luthier_here.flake_normal = luthier_flake_tilt(material, 2.0 * t - 1.0, distance);",
        ),
        MapSlot::Bumps => shader.layer(layer, "normal", "normal = luthier_unit_normal(t);"),
        MapSlot::Alpha => shader.layer(layer, "alpha_factors", "alpha_factors *= t.x;"),
        MapSlot::AlphaX => shader.layer(layer, "alpha_factors", "alpha_factors.x *= t.x;"),
        MapSlot::AlphaY => shader.layer(layer, "alpha_factors", "alpha_factors.y *= t.x;"),
        MapSlot::Tangent => shader.layer(layer, "tangent", "tangent = luthier_tangent(t.xy);"),
        MapSlot::Albedo => shader.place("base_color", "luthier_here.base_color = t;"),
        MapSlot::Lean => shader.place(
            "inner_normal",
            "luthier_here.inner_normal = luthier_lean(luthier_unit_normal(t), luthier_here.inner_normal);",
        ),
        MapSlot::F0 => shader
            .calls("luthier_f0_place")
            .then(|| "luthier_here = luthier_f0_place(luthier_here, material, t);".into()),
        // They take effect together, in the end.
        MapSlot::BaseColor => shader.calls("luthier_metallic_place").then(|| "base = vec4(t, base.w);".into()),
        MapSlot::Metallic => shader.calls("luthier_metallic_place").then(|| "base.w = t.x;".into()),
    }
}

/// Layers with places of their own: `array<LuthierLayerPlace, 2>`.
fn layers(text: &str) -> u32 {
    let count = text.split_once("array<LuthierLayerPlace, ").and_then(|(_, rest)| rest.split_once('>'));
    count.and_then(|(count, _)| count.trim_end_matches('u').parse().ok()).unwrap_or(0)
}

/// The matrix that makes texture coordinates of (u, v, 1).
fn rows(material: &MaterialEntry, map: &MapEntry) -> Mat3 {
    let [u, v] = map.transform.unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let flakes = material.constants.flakes.as_ref().filter(|_| map.slot == MapSlot::FlakeNormal);
    let tiling = flakes.map_or(1.0, |flakes| flakes.tiling);
    let row = |row: [f64; 3]| vector([row[0] * tiling, row[1] * tiling, row[2]]);
    Mat3::from_cols(row(u), row(v), Vec3::Z).transpose()
}

/// Colour and metal of a surface with a map of the other alone.
fn uncoloured(material: &MaterialEntry) -> Vec4 {
    let metallic = if material.layers.iter().any(|layer| layer.is_metal) { 1.0 } else { 0.0 };
    if let Some(brightening) = &material.constants.brightening {
        return vector(brightening.base_color).extend(metallic);
    }
    let [.., above, base] = material.layers.as_slice() else { return Vec4::new(0.0, 0.0, 0.0, metallic) };
    // Without metal, what the interface lets through decides the albedo of the base.
    let passed = 0.96 * 20.0 / 21.0 / (above.eta * above.eta);
    vector(base.albedo.map(|albedo| albedo * passed / (1.0 - albedo * (1.0 - passed)))).extend(metallic)
}

fn vector(numbers: [f64; 3]) -> Vec3 {
    Vec3::from(numbers.map(|number| number as f32))
}
