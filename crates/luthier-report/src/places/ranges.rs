//! Random places of a material. Every varying quantity is drawn at once, within the range that the texels of its map have.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use luthier_layers::effects::flakes::Flakes;
use luthier_layers::effects::patina::Patina;
use luthier_lut::{Image, Picture, TableKind, repeated};
use luthier_manifest::{FlakesRecord, Form, LayerValues, LiveEntry, LiveRange, MapSlot, MaterialEntry, PlaceValues};
use luthier_optics::sampling::split_mix::{GOLDEN, SplitMix64, mix};
use luthier_optics::schlick::{DIELECTRIC_F0, schlick_average};

use crate::measure::references::shows_cover;
use crate::measure::subject::{FilmMap, FilmSource, Subject, SurfaceMap};

/// Quantities that vary over the surface of a material, with their ranges.
#[derive(Debug, Clone)]
pub struct Places {
    entry: MaterialEntry,
    ranges: Vec<(MapSlot, Option<u32>, [[f64; 2]; 3])>,
    /// Factors on the thickness of the film, and slopes of its lower boundary.
    film: Option<[[f64; 2]; 3]>,
}

/// Random numbers of a place. They depend on the seed and on the number of the place only.
fn numbers(seed: u64, place: u64) -> SplitMix64 {
    SplitMix64::new(mix(mix(seed) ^ place.wrapping_mul(GOLDEN)))
}

/// Largest tangent of a normal against the surface's own. Steeper normals of texels are turned up to it.
const STEEPEST: f64 = 3.0;

impl Places {
    /// Varying quantities of a material, by its number; `None` for a material that is the same everywhere. Maps that the model ignores are left out.
    pub fn of(subject: &Subject<'_>, material: usize) -> Option<Self> {
        let entry = subject.manifest.materials.get(material).filter(|entry| entry.varies())?;
        let shown: Vec<(u32, MapSlot)> = entry.shown_layer_maps(Form::Baked).collect();
        let maps = subject.maps.iter().filter(|map| map.material as usize == material);
        let ranges = maps.filter_map(|map| {
            let is_own = map.layer.is_some_and(|layer| map.slot.layer_feature(layer).is_some());
            let is_shown = !is_own || map.layer.is_some_and(|layer| shown.contains(&(layer, map.slot)));
            let stated = entry.maps.iter().find(|stated| (stated.slot, stated.layer) == (map.slot, map.layer));
            let factor = stated.and_then(|stated| stated.factor).unwrap_or([1.0; 3]);
            is_shown.then(|| {
                (map.slot, map.layer, [0, 1, 2].map(|c: usize| texels(&map.picture, c).map(|value| factor[c] * value)))
            })
        });
        let ranges = ranges.chain(entry.live.iter().map(|live| (live.slot, Some(live.layer), live_range(live))));
        let first = entry.layers.first().filter(|layer| layer.varies());
        // Below the first layer films vary over an F0 alone.
        let mut below = entry.layers.iter().filter(|layer| layer.varies() && layer.has_film_over_f0());
        let film = first.or_else(|| below.next()).map(|layer| {
            let texels = subject.textures.iter().find(|(kind, _)| *kind == TableKind::Thickness);
            let nominal = layer.film_thickness_max_nm / layer.film_thickness_nm;
            texels.map_or([[2.0 - nominal, nominal], [0.0; 2], [0.0; 2]], |(_, image)| {
                [channel(image, 0).map(|d| 2.0 * nominal * d), channel(image, 1), channel(image, 2)]
            })
        });
        Some(Self { entry: entry.clone(), ranges: ranges.collect(), film })
    }

    /// Quantities that vary, in words.
    pub fn quantities(&self) -> Vec<String> {
        let constants = &self.entry.constants;
        let maps = self.ranges.iter().map(|(slot, layer, _)| match layer {
            Some(layer) if *layer > 0 => format!("{} of layer {}", slot.name(), layer + 1),
            _ => slot.name().to_owned(),
        });
        let mut names: Vec<String> = maps.collect();
        names.extend(self.has_free_weight().then(|| MapSlot::Weight.name().to_owned()));
        let has_flake_map = self.ranges.iter().any(|(slot, ..)| *slot == MapSlot::FlakeNormal);
        names.extend(self.film.map(|_| "film".to_owned()));
        names.extend(constants.flakes.filter(|_| !has_flake_map).map(|_| "flakes".to_owned()));
        names.extend(constants.glitter.map(|_| "glitter".to_owned()));
        names
    }

    /// Whether a program sets the weight of a coat, which has no map.
    fn has_free_weight(&self) -> bool {
        shows_cover(&self.entry)
            && self.entry.constants.coat.is_some()
            && !self.ranges.iter().any(|(slot, ..)| *slot == MapSlot::Weight)
    }

    /// The n-th random place of a seed.
    pub fn place(&self, seed: u64, n: u64) -> PlaceValues {
        let mut numbers = numbers(seed, n);
        let (mut place, lean) = self.mapped(|_, _, range| Some(range.map(|range| numbers.between(range))));
        let constants = &self.entry.constants;
        if let Some(coat) = constants.coat.as_ref().filter(|_| self.has_free_weight()) {
            // Up to the weight 1.
            place.weight_factor = numbers.between([0.0, 1.0 / coat.weight.max(0.1)]) as f32;
        }
        if let Some([factor, x, y]) = self.film.map(|film| film.map(|range| numbers.between(range))) {
            place.film_factor = factor as f32;
            place.inner_normal = DVec3::new(x, y, 1.0).normalize().as_vec3().to_array();
        }
        if lean != UP {
            // Slopes add up.
            let [film, own] = [place.inner_normal, lean].map(|n| n.map(f64::from));
            let [x, y] = [0, 1].map(|i: usize| film[i] / film[2] + own[i] / own[2]);
            place.inner_normal = DVec3::new(x, y, 1.0).normalize().as_vec3().to_array();
        }
        let has_flake_map = self.ranges.iter().any(|(slot, ..)| *slot == MapSlot::FlakeNormal);
        if let Some(flakes) = constants.flakes.filter(|_| !has_flake_map) {
            // Twice the spread covers nineteen of twenty flakes.
            let (angle, phi) = (2.0 * flakes.spread * numbers.unit(), TAU * numbers.unit());
            let (sin, cos) = libm::sincos(angle.min(1.5));
            let (sin_phi, cos_phi) = libm::sincos(phi);
            place.flake_normal = tilted(&flakes, DVec3::new(sin * cos_phi, sin * sin_phi, cos));
        }
        if let Some(glitter) = constants.glitter {
            let (lack, phi) = (numbers.unit() * (1.0 - libm::cos(glitter.tilt)), TAU * numbers.unit());
            let across = (lack * (2.0 - lack)).sqrt();
            let (sin, cos) = libm::sincos(phi);
            if numbers.unit() < 0.5 {
                place.normal = DVec3::new(across * cos, across * sin, 1.0 - lack).as_vec3().to_array();
            }
        }
        place
    }

    /// The place at texture coordinates: texels of the maps, bilinear and repeated, and the film of a picture. Normals, flakes, particles and leans are left
    /// out, because they turn the frame: see [`Self::normal_at`].
    pub fn at(&self, subject: &Subject<'_>, material: usize, uv: [f64; 2]) -> PlaceValues {
        let (mut place, _) = self.mapped(|slot, layer, _| {
            if matches!(slot, MapSlot::Normal | MapSlot::Bumps | MapSlot::FlakeNormal | MapSlot::Lean) {
                return None;
            }
            self.texel(subject, material, slot, layer, uv)
        });
        let film = subject.films.iter().find(|film| film.material as usize == material);
        let layer = film.and_then(|film| self.entry.layers.get(film.layer as usize));
        if let (Some(FilmMap { source: FilmSource::Image(image), .. }), Some(layer)) = (film, layer) {
            let [thick, ..] = filtered([image.width, image.height], uv, |x, y| [image.texel(x, y)[0]; 4]);
            let most = layer.film_thickness_max_nm / layer.film_thickness_nm;
            place.film_factor = (2.0 - most + 2.0 * (most - 1.0) * thick) as f32;
        }
        place
    }

    /// The normal that the map of the whole surface has at texture coordinates, in the frame of the surface.
    pub fn normal_at(&self, subject: &Subject<'_>, material: usize, uv: [f64; 2]) -> DVec3 {
        let maps = self.ranges.iter().filter(|(slot, ..)| *slot == MapSlot::Normal);
        let texel = maps.map(|(slot, layer, _)| self.texel(subject, material, *slot, *layer, uv)).next().flatten();
        texel.map_or(DVec3::Z, |[x, y, _]| DVec3::from(normal([x, y]).map(f64::from)))
    }

    /// The texel of a map at texture coordinates, times the number of the file.
    fn texel(
        &self,
        subject: &Subject<'_>,
        material: usize,
        slot: MapSlot,
        layer: Option<u32>,
        uv: [f64; 2],
    ) -> Option<[f64; 3]> {
        let is_it = |map: &&SurfaceMap| map.material as usize == material && (map.slot, map.layer) == (slot, layer);
        let map = subject.maps.iter().find(is_it)?;
        let stated = self.entry.maps.iter().find(|stated| (stated.slot, stated.layer) == (slot, layer));
        let factor = stated.and_then(|stated| stated.factor).unwrap_or([1.0; 3]);
        let rows = stated.and_then(|stated| stated.transform);
        let uv = rows.map_or(uv, |rows| rows.map(|[u, v, one]| u * uv[0] + v * uv[1] + one));
        let texel = filtered(map.picture.size(), uv, |x, y| map.picture.texel(x, y));
        Some([0, 1, 2].map(|c: usize| factor[c] * texel[c]))
    }

    /// The values that maps vary, and the lean of the base; `texel` is asked for the texel of each map.
    fn mapped(
        &self,
        mut texel: impl FnMut(MapSlot, Option<u32>, &[[f64; 2]; 3]) -> Option<[f64; 3]>,
    ) -> (PlaceValues, [f32; 3]) {
        let mut place = PlaceValues::NONE;
        let constants = &self.entry.constants;
        let (mut color, mut metal, mut lean) = (None, None, UP);
        let is_metal = self.entry.layers.iter().any(|layer| layer.is_metal);
        for (slot, layer, range) in &self.ranges {
            let Some(drawn) = texel(*slot, *layer, range) else { continue };
            let [r, g, _] = drawn.map(|value| value as f32);
            let rgb = drawn.map(|value| value as f32);
            match slot {
                MapSlot::Normal => place.normal = normal([drawn[0], drawn[1]]),
                MapSlot::Roughness => place.alpha_factor *= r * r,
                MapSlot::Thickness if layer.is_none_or(|layer| layer == 0) => place.slab_factor *= r,
                MapSlot::Weight => place.weight_factor *= r,
                MapSlot::Patina => {
                    let shape = constants.patina.as_ref();
                    place.patina = shape.map(|p| {
                        let (extent, transition, base_alpha) = (p.extent, p.transition, p.base_alpha);
                        Patina { extent, transition, diffuse_albedo: 0.0, base_alpha, tarnish: 1.0 }.amount(drawn[0])
                            as f32
                    });
                }
                MapSlot::FlakeNormal => {
                    let flake = normal([drawn[0], drawn[1]]).map(f64::from);
                    place.flake_normal = constants.flakes.map_or(UP, |flakes| tilted(&flakes, DVec3::from(flake)));
                }
                MapSlot::Albedo => place.base_color = Some(rgb),
                MapSlot::BaseColor => color = Some(rgb),
                MapSlot::Metallic => metal = Some(r),
                MapSlot::F0 => place.f0 = Some(rgb),
                MapSlot::Lean => lean = normal([drawn[0], drawn[1]]),
                MapSlot::Bumps
                | MapSlot::Alpha
                | MapSlot::AlphaX
                | MapSlot::AlphaY
                | MapSlot::Tangent
                | MapSlot::Absorption
                | MapSlot::Thickness => {
                    let own = of_layer(&mut place, layer.unwrap_or(0) as usize);
                    match slot {
                        MapSlot::Bumps => own.normal = normal([drawn[0], drawn[1]]),
                        MapSlot::Alpha => own.alpha_factors = own.alpha_factors.map(|factor| factor * r),
                        MapSlot::AlphaX => own.alpha_factors[0] *= r,
                        MapSlot::AlphaY => own.alpha_factors[1] *= r,
                        MapSlot::Tangent => own.tangent = [r, g],
                        MapSlot::Absorption => own.absorption_factors = rgb,
                        _ => own.slab_factor = r,
                    }
                }
            }
        }
        if color.is_some() || metal.is_some() {
            place.metallic =
                Some((color.unwrap_or_else(|| self.base_color()), metal.unwrap_or(if is_metal { 1.0 } else { 0.0 })));
        }
        (place, lean)
    }

    /// Base colour of a metallic-roughness surface without a map of it. Such a surface is no metal; the colour follows from its albedo, unless a
    /// coat leaves it undarkened.
    fn base_color(&self) -> [f32; 3] {
        if let Some(base) = self.entry.constants.brightening {
            return base.base_color.map(|color| color as f32);
        }
        let layers = &self.entry.layers;
        let eta = layers.len().checked_sub(2).map_or(1.0, |interface| layers[interface].eta);
        let passed = (1.0 - schlick_average(DIELECTRIC_F0)) / (eta * eta);
        let albedo = layers.last().map_or([0.0; 3], |layer| layer.albedo);
        albedo.map(|albedo| (albedo * passed / (1.0 - albedo * (1.0 - passed))) as f32)
    }
}

/// Range of texels that stand for a live number: of slopes and factors its range, up to twice the number of the file where nothing bounds it, of normals
/// leans of a tenth, of tangents all.
fn live_range(live: &LiveEntry) -> [[f64; 2]; 3] {
    match (live.slot, live.range) {
        (MapSlot::Tangent, _) => [[0.0, 1.0]; 3],
        (MapSlot::Roughness, _) => [[0.2, 1.0]; 3],
        (_, Some(LiveRange { least, most })) => [[least, most.unwrap_or(2.0)]; 3],
        (_, None) => [[0.45, 0.55], [0.45, 0.55], [1.0, 1.0]],
    }
}

const UP: [f32; 3] = [0.0, 0.0, 1.0];

/// Least and greatest value of a channel of an image; those of the first channel, if the image lacks it.
fn channel(image: &Image, channel: usize) -> [f64; 2] {
    let channel = if channel < image.channels as usize { channel } else { 0 };
    let values = image.texels().map(|texel| f64::from(texel[channel]));
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

/// Smallest and largest value of a channel of a picture.
fn texels(picture: &Picture, channel: usize) -> [f64; 2] {
    let values = picture.texels().map(|texel| f64::from(texel[channel]));
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

/// A texel of a map of a size that repeats, bilinear, with the centres of texels at (i + 1/2) / size.
fn filtered([width, height]: [u32; 2], uv: [f64; 2], texel: impl Fn(u32, u32) -> [f32; 4]) -> [f64; 4] {
    let [(columns, s), (rows, t)] = [repeated(uv[0], width), repeated(uv[1], height)];
    let line = |y: u32| {
        let [a, b] = columns.map(|x| texel(x, y).map(f64::from));
        [0, 1, 2, 3].map(|c: usize| a[c] + (b[c] - a[c]) * s)
    };
    let [top, bottom] = rows.map(line);
    [0, 1, 2, 3].map(|c: usize| top[c] + (bottom[c] - top[c]) * t)
}

/// The unit normal of two numbers of a texel of a normal map, turned up to [`STEEPEST`] if it is steeper or impossible.
fn normal(texel: [f64; 2]) -> [f32; 3] {
    let across = DVec2::from(texel.map(|value| 2.0 * value - 1.0));
    let longest = STEEPEST / (1.0 + STEEPEST * STEEPEST).sqrt();
    let across = across.clamp_length_max(longest);
    DVec3::new(across.x, across.y, (1.0 - across.length_squared()).sqrt()).as_vec3().to_array()
}

/// `LuthierPlace::flake_normal` of a flake beside the eye.
fn tilted(record: &FlakesRecord, flake: DVec3) -> [f32; 3] {
    let &FlakesRecord { seed, count, tiling, spread, scale, fade_start } = record;
    Flakes { seed, count: count.max(1), tiling, spread, scale, fade_start }.tilted(flake, 0.0).as_vec3().to_array()
}

fn of_layer(place: &mut PlaceValues, layer: usize) -> &mut LayerValues {
    if place.layers.len() <= layer {
        place.layers.resize(layer + 1, LayerValues::NONE);
    }
    &mut place.layers[layer]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_uniform_and_depend_on_their_place_alone() {
        let drawn = |n: u64| {
            let mut numbers = numbers(3, n);
            [numbers.unit(), numbers.unit()]
        };
        assert_eq!(drawn(7), drawn(7));
        let all: Vec<[f64; 2]> = (0..40_000).map(drawn).collect();
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
        // Standard errors: 1/sqrt(12 n) and 1/(12 sqrt n).
        assert!((mean(&|x| x[0]) - 0.5).abs() < 4.0 * 0.001_45 && (mean(&|x| x[1]) - 0.5).abs() < 4.0 * 0.001_45);
        assert!(mean(&|x| (x[0] - 0.5) * (x[1] - 0.5)).abs() < 4.0 * 0.000_42);
    }

    #[test]
    fn normals_are_unit_and_never_flat() {
        for texel in [[0.5, 0.5], [1.0, 1.0], [0.0, 0.3]] {
            let n = DVec3::from(normal(texel).map(f64::from));
            assert!((n.length() - 1.0).abs() < 1e-6 && n.z > 0.3, "{texel:?} {n}");
        }
        assert_eq!(normal([0.5, 0.5]), UP);
    }
}
