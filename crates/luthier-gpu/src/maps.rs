//! Maps that vary a surface, for the renderer.

use luthier_manifest::{MapSlot, MaterialEntry};

use crate::Scene;

/// `vec4` words per material before its maps: see `ShadingMaps` in `shading.wgsl`.
pub(crate) const MAP_WORDS: usize = 7;

impl Scene {
    /// The words of a material's maps, then their texels. `first` is where they begin.
    pub(crate) fn map_words(&self, material: usize, entry: &MaterialEntry, first: usize) -> Vec<[u32; 4]> {
        let mut headers = [[0; 4]; MAP_WORDS];
        let mut texels = Vec::new();
        for map in self.maps.iter().filter(|map| map.material as usize == material) {
            let header = &mut headers[slot_word(map.slot)];
            // One place has one normal, one factor on all slope parameters and one on the first slab: the topmost map counts.
            if header[1] > 0 || (map.slot == MapSlot::Thickness && map.layer != Some(0)) {
                continue;
            }
            *header = [(first + MAP_WORDS + texels.len()) as u32, map.image.width, map.image.height, 0];
            texels.extend(map.image.texels().map(|t| [t[0], t[1], t[2], t[3]].map(f32::to_bits)));
        }
        if let Some(patina) = &entry.constants.patina {
            let bits = |[r, g, b]: [f64; 3], w: f64| [r, g, b, w].map(|v| (v as f32).to_bits());
            headers[5] = bits(patina.diffuse_albedo, patina.base_alpha.unwrap_or(-1.0));
            headers[6] = bits(patina.tarnish, 0.0);
        }
        let mut words = headers.to_vec();
        words.extend(texels);
        words
    }

    /// `ShadingSurface`, what the emitted shader takes for a place, and the functions that fill, read and use it.
    pub(crate) fn surface_functions(&self) -> String {
        // What fluorescent bases send out is no factor times the light.
        let takes_light = self.has("fn luthier_eval_lit(");
        if !self.has("struct LuthierPlace") {
            let lit = match takes_light {
                true => "luthier_eval_lit(material, wi, wo, light)",
                false => "luthier_eval(material, wi, wo) * light",
            };
            return include_str!("wgsl/surface_even.wgsl").replace("$lit", lit);
        }
        let lit = match takes_light {
            true => "luthier_eval_lit_at(surface, material, wi, wo, light)",
            false => "luthier_eval_at(surface, material, wi, wo) * light",
        };
        let lines = [
            (self.has("fn luthier_film_place("), "surface = luthier_film_place(surface, material, maps.uv);"),
            (
                self.has("inner_normal: vec3"),
                "surface.inner_normal = normalize(surface.inner_normal \
                 + vec3<f32>(kernel_inputs.film_tilt, 0.0) * surface.inner_normal.z);",
            ),
            (
                self.has("fn luthier_flake_normal("),
                "surface.flake_normal = luthier_flake_normal(material, maps.uv, distance);\n    \
                 if maps.has_flakes {\n        \
                     surface.flake_normal = luthier_flake_tilt(material, maps.flake, distance);\n    \
                 }",
            ),
            (self.has("fn luthier_patina_amount("), "surface.patina = luthier_patina_amount(material, maps.patina);"),
            (
                self.has("fn luthier_glitter_normal("),
                "let glitter = luthier_glitter_normal(material, maps.uv);\n    \
                 surface.normal = select(surface.normal, glitter, glitter.z < 1.0);",
            ),
        ];
        let fill: Vec<&str> = lines.iter().filter(|(has, _)| *has).map(|(_, line)| *line).collect();
        let below = if self.has("flake_normal: vec3") { "surface.flake_normal" } else { "vec3<f32>(0.0, 0.0, 1.0)" };
        let patina = if self.has("patina: f32,") { "surface.patina" } else { "-1.0" };
        include_str!("wgsl/surface.wgsl")
            .replace("$fill", &fill.join("\n    "))
            .replace("$lit", lit)
            .replace("$below", below)
            .replace("$patina", patina)
    }
}

fn slot_word(slot: MapSlot) -> usize {
    match slot {
        MapSlot::Normal => 0,
        MapSlot::Roughness => 1,
        MapSlot::Thickness => 2,
        MapSlot::Patina => 3,
        MapSlot::FlakeNormal => 4,
    }
}
