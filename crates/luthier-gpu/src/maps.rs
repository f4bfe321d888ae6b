//! Maps that vary a surface, for the renderer.

use luthier_lut::Image;
use luthier_manifest::{LiveEntry, MapSlot, MaterialEntry};

use crate::context::word;
use crate::{GpuError, LiveValue, Map, Scene};

/// `vec4` words per material before its maps: see `ShadingMaps` in `shading.wgsl`.
pub(crate) const MAP_WORDS: usize = 10;

/// Texels of a map that a picture is made with: 2048 x 2048 take 64 MiB of the buffer.
const TEXELS_MAX: u64 = 1 << 22;

/// Texels of all maps of a picture: 96 MiB of the 128 MiB that every adapter binds. Surroundings and a mesh take the rest.
const TEXELS_OF_ALL_MAX: u64 = 3 << 21;

/// Words of each layer that has maps of its own, behind those.
const OWN_WORDS: usize = 10;

impl Scene {
    /// The texel of a live number: of its value, or of the number of the file where a place does not have that by itself.
    fn live_texel(&self, material: usize, live: &LiveEntry) -> Option<[f32; 3]> {
        let is_own = |value: &&LiveValue| {
            (value.material as usize, value.slot, value.layer) == (material, live.slot, live.layer)
        };
        if let Some(value) = self.live.iter().find(is_own) {
            return Some(texel_of(value));
        }
        let is_color = matches!(live.slot, MapSlot::BaseColor | MapSlot::Metallic);
        let value = |c: usize| live.default[c.min(live.default.len() - 1)] as f32;
        is_color.then(|| [0, 1, 2].map(value))
    }

    /// How often each map of a scene is halved for a picture of some materials: maps have at most [`TEXELS_MAX`], and all together [`TEXELS_OF_ALL_MAX`], of which
    /// the largest give way. Normals of flakes are never averaged: texels are different flakes.
    pub(crate) fn halvings(&self, materials: &[u32]) -> Vec<u32> {
        let texels = self.maps.iter().map(|map| {
            let [width, height] = map.picture.size().map(u64::from);
            let is_seen = materials.contains(&map.material);
            (if is_seen { width * height } else { 0 }, map.slot != MapSlot::FlakeNormal)
        });
        fitting(texels.collect())
    }

    /// The words of a material's maps, then their texels. `first` is the number of the first word, and maps are halved so often.
    pub(crate) fn map_words(
        &self,
        material: usize,
        entry: &MaterialEntry,
        first: usize,
        halvings: &[u32],
    ) -> Vec<[u32; 4]> {
        let mut headers = self.no_map_words();
        let mut texels = Vec::new();
        let behind = first + headers.len();
        for (map, &halvings) in self.maps.iter().zip(halvings).filter(|(map, _)| map.material as usize == material) {
            let own = map.layer.filter(|&layer| map.slot.is_of_layer_place(layer));
            let number = match own {
                None => slot_word(map.slot),
                Some(layer) => MAP_WORDS + OWN_WORDS * layer as usize + own_word(map.slot),
            };
            // Layers that the model does not read have no words. If several maps vary the whole surface, the topmost counts.
            let Some(header) = headers.get_mut(number).filter(|header| header[1] == 0) else { continue };
            let stated = entry.maps.iter().find(|stated| (stated.slot, stated.layer) == (map.slot, map.layer));
            // A map with a transform of its own has its rows as two words before the texels.
            let transform = stated.and_then(|stated| stated.transform);
            let at = (behind + texels.len()) as u32;
            texels.extend(
                transform
                    .map(|rows| rows.map(|[u, v, one]| [u, v, one, 0.0].map(|v| (v as f32).to_bits())))
                    .into_iter()
                    .flatten(),
            );
            let image = shrunk(map, halvings);
            let [width, height] = image.size();
            *header = [(behind + texels.len()) as u32, width, height, transform.map_or(0, |_| at)];
            let factor = stated.and_then(|stated| stated.factor).unwrap_or([1.0; 3]).map(|factor| factor as f32);
            // A live number takes the place of that of the file. Of directions, those of the map hold.
            let is_direction = matches!(map.slot, MapSlot::Normal | MapSlot::Bumps | MapSlot::Tangent | MapSlot::Lean);
            let live = entry.live.iter().find(|live| (live.slot, Some(live.layer)) == (map.slot, map.layer));
            let live = live.filter(|_| !is_direction).and_then(|live| self.live_texel(material, live));
            let [r, g, b] = live.unwrap_or(factor);
            texels.extend(image.texels().map(|t| [r * t[0], g * t[1], b * t[2], t[3]].map(f32::to_bits)));
        }
        for live in &entry.live {
            let number = if live.slot.is_of_layer_place(live.layer) {
                MAP_WORDS + OWN_WORDS * live.layer as usize + own_word(live.slot)
            } else {
                slot_word(live.slot)
            };
            let header = headers.get_mut(number).filter(|header| header[1] == 0);
            if let (Some(header), Some([r, g, b])) = (header, self.live_texel(material, live)) {
                *header = [(behind + texels.len()) as u32, 1, 1, 0];
                texels.push([r, g, b, 1.0].map(f32::to_bits));
            }
        }
        // A map of the F0 of a conductor says that the surface is a metal everywhere.
        if let Some(layer) = entry.layers.iter().position(|layer| layer.is_metal) {
            let number = MAP_WORDS + OWN_WORDS * layer + own_word(MapSlot::Metallic);
            if let Some(header) = headers.get_mut(number).filter(|header| header[1] == 0) {
                *header = [(behind + texels.len()) as u32, 1, 1, 0];
                texels.push([1.0_f32; 4].map(f32::to_bits));
            }
        }
        // A map of metal alone leaves the base colour to the file, where the albedo of the base is that of a brighter one.
        let metals = self.maps.iter().find(|map| map.material as usize == material && map.slot == MapSlot::Metallic);
        if let (Some(base), Some(layer)) = (entry.constants.brightening, metals.and_then(|map| map.layer)) {
            let number = MAP_WORDS + OWN_WORDS * layer as usize + own_word(MapSlot::BaseColor);
            if let Some(header) = headers.get_mut(number).filter(|header| header[1] == 0) {
                *header = [(behind + texels.len()) as u32, 1, 1, 0];
                texels.push(word(base.base_color.map(|color| color as f32), 1.0).map(f32::to_bits));
            }
        }
        if let Some(patina) = &entry.constants.patina {
            let [albedo, tarnish] = [patina.diffuse_albedo, patina.tarnish].map(|rgb| rgb.map(|v| v as f32));
            headers[5] = word(albedo, patina.base_alpha.unwrap_or(-1.0) as f32).map(f32::to_bits);
            headers[6] = word(tarnish, 0.0).map(f32::to_bits);
        } else if entry.constants.coat.is_some() {
            headers[5] = word([0.0; 3], -1.0).map(f32::to_bits);
            // Without a film all layers are there, of which the first has another record.
            headers[6] = word([1.0; 3], f32::from(u8::from(entry.weighs_film_of_path()))).map(f32::to_bits);
        }
        headers.extend(texels);
        headers
    }

    /// The words of a material without maps.
    pub(crate) fn no_map_words(&self) -> Vec<[u32; 4]> {
        vec![[0; 4]; MAP_WORDS + OWN_WORDS * self.layer_places()]
    }

    /// Number of layers that have a place of their own in the shader.
    pub(crate) fn layer_places(&self) -> usize {
        // Materials whose models lack this form are not in its shader.
        let shaded = self.manifest.materials.iter().filter(|entry| entry.model.has(self.form()));
        let shown = shaded.flat_map(|entry| entry.shown_layer_maps(self.form()));
        let shown = shown.filter(|(layer, slot)| slot.is_of_layer_place(*layer));
        shown.map(|(layer, _)| layer as usize + 1).max().unwrap_or(0)
    }

    /// Whether a material has maps of single layers, of its albedo or of a lean. The blurred environment does not show these.
    ///
    /// # Errors
    /// [`GpuError::NoMaterial`](crate::GpuError::NoMaterial).
    pub fn has_layer_maps(&self, material: u32) -> Result<bool, GpuError> {
        self.layers(material)?;
        Ok(self.manifest.materials[material as usize].shown_layer_maps(self.form()).next().is_some())
    }

    /// The functions that fill the places of layers, and the lines that call them.
    fn layer_functions(&self) -> (String, Vec<String>) {
        let count = self.layer_places();
        if count == 0 {
            return Default::default();
        }
        let lines = [
            (
                self.interface.fills("LuthierLayerPlace", "normal"),
                "let bumps = shading_own(material, layer, 0u);\n    if bumps.y > 0u {\n        \
                 let n = 2.0 * shading_bilinear(bumps, uv).xyz - 1.0;\n        \
                 own.normal = normalize(vec3<f32>(n.xy, max(n.z, 1e-3)));\n    }",
            ),
            (
                self.interface.fills("LuthierLayerPlace", "alpha_factors"),
                "own.alpha_factors = shading_own_factor(material, layer, 1u, uv)\n        * \
                 vec2<f32>(shading_own_factor(material, layer, 2u, uv), shading_own_factor(material, layer, 3u, uv));",
            ),
            (
                self.interface.fills("LuthierLayerPlace", "tangent"),
                "let tangent = shading_own(material, layer, 4u);\n    if tangent.y > 0u {\n        \
                 own.tangent = luthier_tangent(shading_bilinear(tangent, uv).xy);\n    }",
            ),
            (
                self.interface.fills("LuthierLayerPlace", "slab_factor"),
                "own.slab_factor = shading_own_factor(material, layer, 5u, uv);",
            ),
            (
                self.interface.fills("LuthierLayerPlace", "absorption_factors"),
                "let absorption = shading_own(material, layer, 8u);\n    if absorption.y > 0u {\n        \
                 own.absorption_factors = shading_bilinear(absorption, uv).xyz;\n    }",
            ),
        ];
        let fill: Vec<&str> = lines.iter().filter(|(has, _)| *has).map(|(_, line)| *line).collect();
        let functions = include_str!("wgsl/surface_layers.wgsl")
            .replace("$words", &format!("{MAP_WORDS}u"))
            .replace("$own", &format!("{OWN_WORDS}u"))
            .replace("$fill", &fill.join("\n    "));
        let calls = (0..count).map(|i| format!("surface.layers[{i}] = shading_layer_place(material, {i}u, maps.uv);"));
        let mut calls: Vec<String> = calls.collect();
        if self.interface.calls("luthier_metallic_place") {
            calls.push("surface = shading_metallic(surface, material, maps.uv);".to_owned());
            let own_f0 = if self.interface.calls("luthier_f0_place") {
                "let f0s = shading_own(material, count - 2u, 9u);\n    if f0s.y > 0u {\n        \
                 place = luthier_f0_place(place, material, shading_bilinear(f0s, uv).xyz);\n    }"
            } else {
                ""
            };
            let metallic = include_str!("wgsl/surface_metallic.wgsl").replace("$own_f0", own_f0);
            return (functions + &metallic, calls);
        }
        (functions, calls)
    }

    /// WGSL of `ShadingSurface` (the place, as the emitted shader takes it) and of the functions that fill, read and use it.
    pub(crate) fn surface_functions(&self) -> String {
        // A fluorescent base moves light between channels, so its value is no factor per channel times the light.
        let takes_light = self.interface.calls("luthier_eval_lit");
        if !self.has_places() {
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
            (self.interface.calls("luthier_film_place"), "surface = luthier_film_place(surface, material, maps.uv);"),
            (
                self.interface.fills("LuthierPlace", "inner_normal"),
                "surface.inner_normal = normalize(surface.inner_normal \
                 + vec3<f32>(kernel_inputs.film_tilt, 0.0) * surface.inner_normal.z);",
            ),
            (
                self.interface.calls("luthier_flake_normal"),
                "surface.flake_normal = luthier_flake_normal(material, maps.uv, distance);\n    \
                 if maps.has_flakes {\n        \
                     surface.flake_normal = luthier_flake_tilt(material, maps.flake, distance);\n    \
                 }",
            ),
            (
                self.interface.calls("luthier_patina_amount"),
                "surface.patina = luthier_patina_amount(material, maps.patina);",
            ),
            (
                self.interface.calls("luthier_glitter_normal"),
                "let glitter = luthier_glitter_normal(material, maps.uv);\n    \
                 surface.normal = select(surface.normal, glitter, glitter.z < 1.0);",
            ),
        ];
        let (layers, calls) = self.layer_functions();
        let mut fill: Vec<&str> = lines.iter().filter(|(has, _)| *has).map(|(_, line)| *line).collect();
        // Before those of metal: a weight decides how bright a base is below the coat.
        let has_weight = self.interface.fills("LuthierPlace", "weight_factor");
        if has_weight {
            fill.push(
                "let weight = shading_map_header(material, 9u);\n    if weight.y > 0u {\n        \
                 surface.weight_factor = shading_bilinear(weight, maps.uv).x;\n    }",
            );
        }
        fill.extend(calls.iter().map(String::as_str));
        if self.interface.fills("LuthierPlace", "base_color") {
            fill.push(
                "let albedo = shading_map_header(material, 7u);\n    if albedo.y > 0u {\n        \
                 surface.base_color = shading_bilinear(albedo, maps.uv).xyz;\n    }",
            );
        }
        if self.interface.fills("LuthierPlace", "inner_normal") {
            // Slopes add up.
            fill.push(
                "let lean = shading_map_header(material, 8u);\n    if lean.y > 0u {\n        \
                 let n = 2.0 * shading_bilinear(lean, maps.uv).xyz - 1.0;\n        \
                 let own = vec3<f32>(n.xy, max(n.z, 1e-3));\n        let film = surface.inner_normal;\n        \
                 surface.inner_normal = normalize(vec3<f32>(film.xy * own.z + own.xy * film.z, film.z * own.z));\n    }",
            );
        }
        let below = if self.interface.fills("LuthierPlace", "flake_normal") {
            "surface.flake_normal"
        } else {
            "vec3<f32>(0.0, 0.0, 1.0)"
        };
        let patina = match self.interface.fills("LuthierPlace", "patina") {
            _ if self.manifest.materials.iter().any(MaterialEntry::is_covered_by_amount) => {
                "luthier_cover(surface, material)"
            }
            true => "surface.patina",
            false => "-1.0",
        };
        let functions = include_str!("wgsl/surface.wgsl")
            .replace("$fill", &fill.join("\n    "))
            .replace("$lit", lit)
            .replace("$below", below)
            .replace("$patina", patina);
        functions + &layers
    }
}

/// How often each of some pictures is halved, of their texels and whether they may be.
fn fitting(mut texels: Vec<(u64, bool)>) -> Vec<u32> {
    let mut halvings = vec![0; texels.len()];
    loop {
        let can = (0..texels.len()).filter(|&i| texels[i].1 && texels[i].0 > 1);
        let Some(largest) = can.max_by_key(|&i| texels[i].0) else { return halvings };
        let all: u64 = texels.iter().map(|(texels, _)| texels).sum();
        if texels[largest].0 <= TEXELS_MAX && all <= TEXELS_OF_ALL_MAX {
            return halvings;
        }
        texels[largest].0 = texels[largest].0.div_ceil(4);
        halvings[largest] += 1;
    }
}

/// The texel that gives a place this value.
fn texel_of(live: &LiveValue) -> [f32; 3] {
    let [x, y, z] = live.value;
    match live.slot {
        MapSlot::Normal | MapSlot::Bumps | MapSlot::Lean | MapSlot::FlakeNormal => {
            [x, y, z].map(|component| 0.5 + 0.5 * component)
        }
        MapSlot::Tangent => {
            let length_sq = (x * x + y * y).max(f32::MIN_POSITIVE);
            [0.5 + 0.5 * (x * x - y * y) / length_sq, 0.5 + x * y / length_sq, 0.0]
        }
        MapSlot::Roughness => [x.max(0.0).sqrt(); 3],
        MapSlot::Absorption | MapSlot::Albedo | MapSlot::BaseColor | MapSlot::F0 => [x, y, z],
        _ => [x; 3],
    }
}

/// The texels of a map, RGBA, averaged down to half its sides so often.
fn shrunk(map: &Map, halvings: u32) -> Image {
    (0..halvings).fold(map.picture.image(), |image, _| image.halved())
}

fn slot_word(slot: MapSlot) -> usize {
    match slot {
        MapSlot::Normal => 0,
        MapSlot::Roughness => 1,
        MapSlot::Thickness => 2,
        MapSlot::Patina => 3,
        MapSlot::FlakeNormal => 4,
        MapSlot::Albedo => 7,
        MapSlot::Lean => 8,
        MapSlot::Weight => 9,
        // No whole surface has these.
        MapSlot::Bumps
        | MapSlot::Alpha
        | MapSlot::AlphaX
        | MapSlot::AlphaY
        | MapSlot::Tangent
        | MapSlot::Absorption
        | MapSlot::BaseColor
        | MapSlot::Metallic
        | MapSlot::F0 => usize::MAX,
    }
}

/// The word of a map of one layer among its words.
fn own_word(slot: MapSlot) -> usize {
    match slot {
        MapSlot::Bumps => 0,
        MapSlot::Alpha => 1,
        MapSlot::AlphaX => 2,
        MapSlot::AlphaY => 3,
        MapSlot::Tangent => 4,
        MapSlot::BaseColor => 6,
        MapSlot::Metallic => 7,
        MapSlot::Absorption => 8,
        MapSlot::F0 => 9,
        _ => 5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sides of pictures; those of flakes stay.
    #[test]
    fn the_largest_maps_give_way() {
        let of = |sides: &[u64]| fitting(sides.iter().map(|side| (side * side, true)).collect());
        assert_eq!(of(&[2048, 512, 512]), [0, 0, 0]);
        assert_eq!(of(&[4096]), [1]);
        // Two of 2048 are 8.4 million texels.
        assert_eq!(of(&[2048, 2048]).iter().sum::<u32>(), 1);
        let many = of(&[1024; 20]);
        let left: u64 = many.iter().map(|halvings| (1 << 20) >> (2 * halvings)).sum();
        assert!(left <= TEXELS_OF_ALL_MAX && many.iter().all(|halvings| *halvings <= 1), "{many:?}");
        assert_eq!(fitting(vec![(1 << 24, false), (1 << 20, true)])[0], 0);
        assert!(of(&[]).is_empty());
    }
}
