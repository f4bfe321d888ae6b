//! The place of a surface where a model is evaluated, from inputs and from the effects of the material file.

use luthier_bake::{MapSource, height_normals};
use luthier_layers::effects::flakes::Flakes;
use luthier_layers::effects::heterogeneous::Map;
use luthier_layers::effects::layer_sample::LayerSample;
use luthier_layers::effects::patina::Patina;
use luthier_layers::glam::{DVec2, DVec3};
use luthier_layers::models::lobes::Mix;
use luthier_layers::noise::voronoi::Voronoi;
use luthier_layers::twins::shaded::{Growth, Place, index_of_engine};
use luthier_lut::{Image, Picture, repeated};
use luthier_manifest::{MapSlot, ShadingModel};
use luthier_material::{Effects, FlakeSource, Glitter, Material, PictureRef, TexelUse, VariationSource};
use luthier_optics::Rgb;
use luthier_optics::schlick::{DIELECTRIC_F0, DIELECTRIC_INDEX, F82};
use luthier_optics::stack::Base;

use super::{Inputs, LayerMap, Refusal, live};
use crate::read_picture;

/// The place; `shows` are the effects that count.
pub(super) fn place(material: &Material, inputs: &Inputs, shows: &Effects) -> Result<Place, Refusal> {
    let uv = inputs.uv.unwrap_or(DVec2::ZERO);
    let (base_color, reradiation) = (inputs.base_color, material.reradiation());
    let mut place = Place { sample: inputs.sample(), base_color, reradiation, ..Place::NONE };
    if let Some(normal) = inputs.inner_normal {
        place.under.inner_normal = normal;
    }
    if let (Some(glitter), false) = (&shows.glitter, inputs.normal.is_some()) {
        place.sample.normal = particle(glitter, uv);
    }
    if let Some(flakes) = &shows.flakes {
        let (seed, count, spread) = match flakes.source {
            FlakeSource::Cells { seed, count, spread } => (seed, count, spread),
            FlakeSource::NormalMap(_) | FlakeSource::HeightMap { .. } => (0, 1, 0.0),
        };
        let (tiling, scale, fade_start) = (flakes.tiling, flakes.scale, flakes.fade_start);
        let all = Flakes { seed, count, tiling, spread, scale, fade_start };
        let flake = match &flakes.source {
            FlakeSource::Cells { .. } => all.flake(uv),
            FlakeSource::NormalMap(normals) => {
                let map = picture(material, normals, TexelUse::Normal)?;
                texel(&map.image(), moved(normals, uv * tiling))
            }
            FlakeSource::HeightMap { picture: heights, height } => {
                let map = picture(material, heights, TexelUse::Number)?;
                texel(&height_normals(&map.channel(0), *height), moved(heights, uv * tiling))
            }
        };
        place.under.flake_normal = all.tilted(flake, inputs.distance.unwrap_or(0.0));
    }
    if let Some(patina) = &shows.patina {
        let map = match (inputs.map, &patina.map) {
            (Some(map), _) => map,
            (None, VariationSource::Image(named)) => {
                filtered(&picture(material, named, TexelUse::Number)?.channel(0), moved(named, uv))
            }
            (None, &VariationSource::Noise { seed, frequency, octaves }) => {
                let noise = MapSource::Noise { seed, frequency, octaves }.texels();
                noise.map_or(0.5, |noise| filtered(&noise, uv))
            }
        };
        let extent = inputs.extent.unwrap_or(patina.extent);
        let (transition, base_alpha) = (patina.transition, patina.base_alpha);
        let grown = Patina { extent, transition, diffuse_albedo: 0.0, base_alpha, tarnish: 1.0 };
        let (diffuse_albedo, tarnish) = (patina.diffuse_albedo, patina.tarnish);
        place.patina = Some(Growth { amount: grown.amount(map), diffuse_albedo, base_alpha, tarnish });
    }
    Ok(place)
}

/// The share of the surface that the first layer covers at the place, if it is a coat with a weight.
pub(super) fn weight(material: &Material, inputs: &Inputs) -> Result<Option<f64>, Refusal> {
    let Some(weight) = material.weight() else { return Ok(None) };
    let texel = match inputs.weight_map(material) {
        Some(named) => {
            let image = picture(material, named, TexelUse::Number)?.channel(0);
            filtered(&image, moved(named, inputs.uv.unwrap_or(DVec2::ZERO)))
        }
        None => 1.0,
    };
    let factor = inputs.weight_factor.unwrap_or(1.0) * live::weight_factor(&inputs.live);
    Ok(Some((weight * texel * factor).clamp(0.0, 1.0)))
}

/// Gives the place the values of layer textures: those of `maps`, which include the albedo of the base.
pub(super) fn add_layers(
    place: &mut Place,
    material: &Material,
    model: Option<ShadingModel>,
    inputs: &Inputs,
    maps: &[LayerMap],
) -> Result<(), Refusal> {
    let uv = inputs.uv.unwrap_or(DVec2::ZERO);
    let count = maps.iter().map(|map| map.layer + 1).max().unwrap_or(0);
    let mut layers = vec![LayerSample::NONE; count];
    let mut metallic: Option<(usize, Rgb, Rgb, f64)> = None;
    let mut own_f0: Option<(usize, Rgb)> = None;
    for map in maps {
        let own = &mut layers[map.layer];
        let image = picture(material, &map.picture, map.texels)?.image();
        let uv = moved(&map.picture, uv);
        let texel = |channel| filtered_channel(&image, uv, channel);
        match map.slot {
            MapSlot::Bumps => {
                let [x, y, z] = [0, 1, 2].map(|c| 2.0 * texel(c) - 1.0);
                own.normal = DVec3::new(x, y, z.max(1e-3)).normalize();
            }
            MapSlot::Lean => {
                // Slopes add up with those of an option.
                let [x, y, z] = [0, 1, 2].map(|c| 2.0 * texel(c) - 1.0);
                let slopes = [place.under.inner_normal, DVec3::new(x, y, z.max(1e-3))].map(|n| n.truncate() / n.z);
                place.under.inner_normal = (slopes[0] + slopes[1]).extend(1.0).normalize();
            }
            MapSlot::Alpha => own.alpha_factors = own.alpha_factors.map(|factor| factor * texel(0)),
            MapSlot::AlphaX => own.alpha_factors[0] *= texel(0),
            MapSlot::AlphaY => own.alpha_factors[1] *= texel(0),
            MapSlot::Tangent => own.tangent = LayerSample::tangent_of([texel(0), texel(1)]),
            MapSlot::Thickness => own.slab_factor = texel(0),
            MapSlot::Absorption => own.absorption_factors = [0, 1, 2].map(texel),
            MapSlot::Albedo => {
                let Base::Diffuse(diffuse) = &material.stack.layers[map.layer].base else { continue };
                let here = [0, 1, 2].map(|c: usize| diffuse.albedo[c] * texel(c));
                place.base_color = place.base_color.or(Some(here));
            }
            MapSlot::F0 if material.layers[map.layer].metallic.is_none_or(|surface| !surface.is_metal) => {
                let Base::Dielectric { ior, .. } = &material.stack.layers[map.layer].base else { continue };
                own_f0 = ior.f0().map(|f0| (map.layer, [0, 1, 2].map(|c: usize| f0[c] * texel(c))));
            }
            MapSlot::BaseColor | MapSlot::Metallic | MapSlot::F0 => {
                let Some(surface) = material.layers[map.layer].metallic else { continue };
                let (_, _, color, metal) =
                    metallic.get_or_insert((map.layer, surface.f82_tint, surface.base_color, surface.metallic));
                match map.slot {
                    MapSlot::BaseColor | MapSlot::F0 => (0..3).for_each(|c| color[c] *= texel(c)),
                    _ => *metal *= texel(0),
                }
            }
            MapSlot::Normal | MapSlot::Roughness | MapSlot::Weight | MapSlot::Patina | MapSlot::FlakeNormal => {}
        }
    }
    place.layers = layers;
    live::set(place, &mut metallic, material, model, &inputs.live)?;
    if let Some((layer, f0)) = own_f0 {
        place.layers[layer].f0 = Some(f0.map(|f0| F82 { f0, tint: 1.0 }));
    }
    if let Some((layer, tint, color, metal)) = metallic {
        let of_file = material.layers[layer].metallic.map_or([DIELECTRIC_F0; 3], |surface| surface.dielectric);
        let dielectric = own_f0.map_or(of_file, |(_, f0)| f0);
        let mix = match material.brightening() {
            Some(below) => {
                let weight = weight(material, inputs)?.unwrap_or(1.0);
                Mix {
                    metal: below.metal(color, weight),
                    tint,
                    dielectric,
                    matt: below.matt(color, weight),
                    metallic: metal,
                }
            }
            None => Mix { metal: color, tint, dielectric, matt: color, metallic: metal },
        };
        let (curves, albedo) = mix.surface(model.map_or(DIELECTRIC_INDEX, index_of_engine));
        if place.layers.len() <= layer {
            place.layers.resize(layer + 1, LayerSample::NONE);
        }
        place.layers[layer].f0 = Some(curves);
        place.metal = Some(mix);
        place.base_color = place.base_color.or(Some(albedo));
    }
    Ok(())
}

/// The normal of the particle of a glittering surface.
fn particle(&Glitter { seed, frequency, filled, tilt }: &Glitter, uv: DVec2) -> DVec3 {
    let cells = Voronoi { seed, frequency };
    Map::Glitter { cells, stacks: vec![0], filled, tilt, under: Box::new(Map::Uniform(0)) }.pick(uv).normal
}

fn picture(material: &Material, named: &PictureRef, texels: TexelUse) -> Result<Picture, Refusal> {
    read_picture(&material.source, named, texels)
        .map_err(|reason| Refusal::File(format!("{}: {}: {reason}", material.source, named.path)))
}

/// Texture coordinates of a picture.
fn moved(named: &PictureRef, uv: DVec2) -> DVec2 {
    let Some(transform) = named.transform else { return uv };
    DVec2::from(transform.matrix().map(|[u, v, one]| u * uv.x + v * uv.y + one))
}

/// The texel of a map of normals that repeats, unfiltered.
fn texel(map: &Image, uv: DVec2) -> DVec3 {
    let [column, row] = [(uv.x, map.width), (uv.y, map.height)]
        .map(|(x, size)| (((x - x.floor()) * f64::from(size)) as u32).min(size - 1));
    let texel = map.texel(column, row);
    DVec3::from([0, 1, 2].map(|c| 2.0 * f64::from(texel[c]) - 1.0))
}

/// The first channel of a map that repeats, filtered as samplers do; centres of texels are at (i + 1/2) / size.
fn filtered(map: &Image, uv: DVec2) -> f64 {
    filtered_channel(map, uv, 0)
}

/// A channel of a map that repeats, filtered as samplers do; centres of texels are at (i + 1/2) / size.
fn filtered_channel(map: &Image, uv: DVec2, channel: usize) -> f64 {
    let [(columns, s), (rows, t)] = [(uv.x, map.width), (uv.y, map.height)].map(|(at, size)| repeated(at, size));
    let [top, bottom] = rows.map(|y| {
        let [a, b] = columns.map(|x| f64::from(map.texel(x, y)[channel]));
        a + (b - a) * s
    });
    top + (bottom - top) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_repeat_and_are_filtered() {
        let mut map = Image::zeros(4, 2, 1);
        map.data = vec![0.0, 1.0, 0.5, 0.25, 1.0, 1.0, 1.0, 1.0];
        let centre = |i: f64, j: f64| DVec2::new((i + 0.5) / 4.0, (j + 0.5) / 2.0);
        assert_eq!(filtered(&map, centre(1.0, 0.0)), 1.0);
        assert_eq!(filtered(&map, centre(2.0, 0.0) + DVec2::new(3.0, -2.0)), 0.5);
        assert_eq!(filtered(&map, centre(1.5, 0.0)), 0.75);
        // Across the edge: the last column and the first.
        assert_eq!(filtered(&map, DVec2::new(0.0, 0.25)), 0.125);
        assert_eq!(filtered(&map, centre(0.0, 0.5)), 0.5);
    }
}
