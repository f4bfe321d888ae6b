//! Kinds of places, with the statements for the shader and the place of its twin.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use luthier::surface_map;
use luthier_layers::effects::flakes::Flakes;
use luthier_layers::effects::heterogeneous::Map;
use luthier_layers::effects::layer_sample::LayerSample;
use luthier_layers::effects::patina::Patina;
use luthier_layers::noise::voronoi::Voronoi;
use luthier_layers::twins::shaded::{Growth, Place};
use luthier_manifest::ShadingModel::{self, Belcour, Elek, GranierHeidrich, Microfacet, WeidlichWilkie, Yamaguchi};
use luthier_manifest::{CellsRecord, ParticlesRecord, SurfaceEntry, SwitchBy, SwitchRecord};
use luthier_material::{FlakeSource, Material, parse};
use luthier_optics::Rgb;

use super::at_three_wavelengths;

/// Kind of variation over a surface, and the models that show it.
pub(super) struct Case {
    /// In words.
    pub(super) name: &'static str,
    /// The field of a place, the key of a file, or the function.
    pub(super) key: &'static str,
    pub(super) models: &'static [ShadingModel],
    /// The layers and effects of each material.
    files: &'static [&'static str],
    spot: fn(&[Material], usize) -> Spot,
    /// The surface of a case of several materials.
    surface: Option<fn() -> SurfaceEntry>,
}

/// One place: the statements that make it on the device, and its twin.
pub(super) struct Spot {
    /// Statements that may set `place` and `material`.
    pub(super) make: String,
    /// The material's number.
    pub(super) material: usize,
    pub(super) place: Place,
    /// Colour of the light, for fluorescent bases.
    pub(super) light: Option<Rgb>,
}

const COATED: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\nthickness_um = 20\nabsorption_per_um = [0.01, 0.02, 0.05]\n\
    [[layer]]\ntype = \"conductor\"\nior = { n = [0.2, 0.92, 1.1], k = [3.9, 2.5, 2.4], wavelengths_nm = [645, 525, 445] }\nalpha = 0.25\n";
const PAINTED: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.15\nthickness_um = 20\nabsorption_per_um = [0.01, 0.02, 0.05]\n\
    [[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0.2]\nsigma = 0.3\n";
const LACQUERED: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.15\nthickness_um = 20\nabsorption_per_um = [0.01, 0.02, 0.05]\n\
    [[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0.2]\n";
const FILMED: &str = "[[layer]]\ntype = \"thin-film\"\nior = 2.3\n\
    thickness_nm = { min = 60, max = 240, extent_um = 20000, map = { noise = { seed = 3, frequency = 4, octaves = 3 } } }\n\
    [[layer]]\ntype = \"conductor\"\nior = { n = 2.5, k = 3.1 }\nalpha = 0.2\n";
const BUBBLE: &str = "[[layer]]\ntype = \"thin-film\"\nior = 1.4\n\
    thickness_nm = { min = 200, max = 600, extent_um = 20000, map = { noise = { seed = 3, frequency = 4, octaves = 3 } } }\n\
    [[layer]]\ntype = \"dielectric\"\nior = 1.6\nalpha = 0.2\n\
    [[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0.2]\n";
const GREEN: &str = "[effects.patina]\nextent = 0.45\ntransition = 0.65\nmap = { noise = { seed = 4, frequency = 3, octaves = 5 } }\n\
    diffuse_albedo = [0.25, 0.55, 0.42]\nbase_alpha = 0.45\ntarnish = [0.8, 0.45, 0.25]\n";
const FLAKES: &str =
    "[effects.flakes]\ncells = { seed = 5, count = 64, spread_deg = 12 }\ntiling = 40\nscale = 0.8\nfade_start = 2\n";
const GLITTER: &str = "[effects.glitter]\nseed = 9\nfrequency = 60\nfilled = 0.5\ntilt_deg = 20\n";
const DYED: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n[[layer]]\ntype = \"diffuse\"\nreradiation = \"dye.csv\"\n";
const DYE: &str = include_str!("../../maps/dye.csv");

/// Maps of the metal alone, to follow [`COATED`].
const OF_THE_METAL: &str = "maps = { bumps = \"bumps.png\", alpha = \"thickness.png\" }\n";
const CROSSED: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha_x = 0.08\nalpha_y = 0.3\nmaps = { tangent = \"circles.png\" }\n\
    [[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.4 }\nalpha_x = 0.35\nalpha_y = 0.12\nmaps = { tangent = \"rays.png\", alpha_x = \"thickness.png\" }\n";

const PATH: &[ShadingModel] = &[Elek, WeidlichWilkie];

/// Models of layers of their own roughness and thickness.
const LAYERED: &[ShadingModel] = &[Elek, WeidlichWilkie, Belcour, Yamaguchi];

/// Models whose roughness a map scales.
const ROUGH: &[ShadingModel] = &[Elek, WeidlichWilkie, Microfacet, Belcour, Yamaguchi];

const MAPPED: &[ShadingModel] = &[Elek, WeidlichWilkie, GranierHeidrich, Microfacet, Belcour, Yamaguchi];

/// All kinds.
pub(super) fn all() -> Vec<Case> {
    vec![
        case("normal map", "place.normal", MAPPED, &[COATED], normal),
        case("roughness map", "place.alpha_factor", ROUGH, &[COATED], roughness),
        case("thickness map of a slab", "place.slab_factor", LAYERED, &[LACQUERED], slab),
        case("thickness map of a film", "place.film_factor", &[Elek, WeidlichWilkie, Microfacet], &[FILMED], film),
        case("thickness map of a film, and its lean", "place.inner_normal", &[GranierHeidrich], &[BUBBLE], lean),
        case("map of the base's colour", "place.base_color", PATH, &[PAINTED], color),
        case("colour of the base under a film", "place.base_color", &[GranierHeidrich], &[BUBBLE], color),
        case("bumps of one interface", "place.layers[1].normal", PATH, &[COATED, OF_THE_METAL], bumps),
        case(
            "slope parameters of one interface",
            "place.layers[1].alpha_factors",
            LAYERED,
            &[COATED, OF_THE_METAL],
            slopes,
        ),
        case(
            "tangents, and slope parameters along them",
            "place.layers[i].tangent, .alpha_factors",
            &[WeidlichWilkie, Yamaguchi],
            &[CROSSED],
            tangents,
        ),
        case("flakes", "luthier_flake_normal", PATH, &[COATED, FLAKES], flakes),
        case("flakes as a normal map", "luthier_flake_tilt", PATH, &[COATED, FLAKES], flake_map),
        case("patina", "luthier_patina_amount", PATH, &[COATED, GREEN], patina),
        case("glitter", "luthier_glitter_normal", &[Elek, WeidlichWilkie, Microfacet], &[COATED, GLITTER], glitter),
        Case {
            surface: Some(grains),
            ..case("surface of several materials", "luthier_pick", MAPPED, &[], |_, n| pick(&grains(), n))
        },
        Case {
            surface: Some(switched),
            ..case("surface with switches", "luthier_perlin", MAPPED, &[], |_, n| pick(&switched(), n))
        },
        case("fluorescent base", "luthier_eval_lit_at", PATH, &[DYED], dyed),
    ]
}

/// A case without a surface of several materials.
fn case(
    name: &'static str,
    key: &'static str,
    models: &'static [ShadingModel],
    files: &'static [&'static str],
    spot: fn(&[Material], usize) -> Spot,
) -> Case {
    Case { name, key, models, files, spot, surface: None }
}

impl Case {
    /// The materials of the case, shaded by a model.
    pub(super) fn materials(&self, model: ShadingModel) -> Vec<Material> {
        let texts: Vec<String> = if self.surface.is_some() {
            vec![COATED.to_owned(), LACQUERED.to_owned()]
        } else {
            vec![self.files.concat()]
        };
        let materials = texts.iter().enumerate().map(|(n, text)| {
            let text = format!("schema = 1\nname = \"m{n}\"\n{text}");
            let parsed = parse("m.toml", &text, &|_| Ok(DYE.to_owned()));
            let mut material = parsed.unwrap_or_else(|errors| panic!("{}", errors[0].render(&text))).material;
            material.source = crate::maps::source();
            at_three_wavelengths(&mut material, model);
            material
        });
        materials.collect()
    }

    /// The surfaces of the bake.
    pub(super) fn surfaces(&self) -> Vec<SurfaceEntry> {
        self.surface.iter().map(|surface| surface()).collect()
    }

    /// The n-th place.
    pub(super) fn spot(&self, materials: &[Material], n: usize) -> Spot {
        (self.spot)(materials, n)
    }
}

/// A place where nothing varies.
pub(super) fn plain(materials: &[Material]) -> Spot {
    let light = materials[0].reradiation().map(|_| LIGHT);
    // The shader's base is fluorescent at a place without textures, too.
    Spot { light, ..at(String::new(), Place::NONE) }
}

fn at(make: String, place: Place) -> Spot {
    Spot { make, material: 0, place, light: None }
}

/// The n-th number in 0..1 of a sequence that fills evenly, as f32 holds it.
fn part(n: usize, step: f64) -> f64 {
    f64::from(((n + 1) as f64 * step).fract() as f32)
}

const STEPS: [f64; 3] = [0.754_877_666, 0.569_840_291, 0.819_172_513];

/// A normal up to 25 degrees off, unit to single precision, and its text.
fn leaning(n: usize) -> (DVec3, String) {
    let (theta, phi) = (0.44 * part(n, STEPS[0]), TAU * part(n, STEPS[1]));
    let exact = DVec3::new(libm::sin(theta) * libm::cos(phi), libm::sin(theta) * libm::sin(phi), libm::cos(theta));
    let [x, y, z] = exact.as_vec3().to_array();
    (DVec3::from([x, y, z].map(f64::from)), format!("vec3<f32>({x:?}, {y:?}, {z:?})"))
}

/// A texture coordinate, and its text.
fn coordinate(n: usize) -> (DVec2, String) {
    let [u, v] = [STEPS[0], STEPS[1]].map(|step| part(n, step));
    (DVec2::new(u, v), format!("vec2<f32>({:?}, {:?})", u as f32, v as f32))
}

fn factor(n: usize, from: f64, to: f64) -> f64 {
    f64::from((from + (to - from) * part(n, STEPS[2])) as f32)
}

fn normal(_: &[Material], n: usize) -> Spot {
    let (normal, text) = leaning(n);
    let mut place = Place::NONE;
    place.sample.normal = normal;
    at(format!("place.normal = {text};"), place)
}

fn roughness(_: &[Material], n: usize) -> Spot {
    let mut place = Place::NONE;
    place.sample.alpha_factor = factor(n, 0.2, 2.5);
    at(format!("place.alpha_factor = {:?};", place.sample.alpha_factor as f32), place)
}

fn slab(_: &[Material], n: usize) -> Spot {
    let mut place = Place::NONE;
    place.sample.slab_factor = factor(n, 0.0, 3.0);
    at(format!("place.slab_factor = {:?};", place.sample.slab_factor as f32), place)
}

fn film(_: &[Material], n: usize) -> Spot {
    let mut place = Place::NONE;
    place.sample.film_factor = factor(n, 0.4, 1.6);
    at(format!("place.film_factor = {:?};", place.sample.film_factor as f32), place)
}

fn lean(_: &[Material], n: usize) -> Spot {
    let (normal, text) = leaning(n);
    let mut place = Place::NONE;
    place.sample.film_factor = factor(n, 0.5, 1.5);
    place.under.inner_normal = normal;
    at(format!("place.film_factor = {:?}; place.inner_normal = {text};", place.sample.film_factor as f32), place)
}

fn color(_: &[Material], n: usize) -> Spot {
    let color = STEPS.map(|step| part(n, step));
    let [r, g, b] = color.map(|c| c as f32);
    let place = Place { base_color: Some(color), ..Place::NONE };
    at(format!("place.base_color = vec3<f32>({r:?}, {g:?}, {b:?});"), place)
}

/// A place whose two layers have textures of their own.
fn layered(upper: LayerSample, lower: LayerSample) -> Place {
    Place { layers: vec![upper, lower], ..Place::NONE }
}

fn bumps(_: &[Material], n: usize) -> Spot {
    let (normal, text) = leaning(n);
    let place = layered(LayerSample::NONE, LayerSample { normal, ..LayerSample::NONE });
    at(format!("place.layers[1].normal = {text};"), place)
}

/// The factor of a map of both slope parameters.
fn slopes(_: &[Material], n: usize) -> Spot {
    let factor = factor(n, 0.4, 2.4);
    let place = layered(LayerSample::NONE, LayerSample { alpha_factors: [factor; 2], ..LayerSample::NONE });
    at(format!("place.layers[1].alpha_factors = vec2<f32>({:?});", factor as f32), place)
}

fn tangents(_: &[Material], n: usize) -> Spot {
    // Any texels will do: the directions are their halved angles.
    let texels = [[0, 1], [1, 2]].map(|[a, b]: [usize; 2]| [part(n, STEPS[a]), part(n, STEPS[b])]);
    let alpha_factors = [factor(n, 0.4, 2.4), factor(n, 1.5, 0.5)];
    let own = texels.map(|texel| LayerSample { tangent: LayerSample::tangent_of(texel), ..LayerSample::NONE });
    let tangents = texels.into_iter().enumerate().map(|(i, [x, y])| {
        format!("place.layers[{i}].tangent = luthier_tangent(vec2<f32>({:?}, {:?})); ", x as f32, y as f32)
    });
    let make: String = tangents.collect();
    let [x, y] = alpha_factors.map(|factor| factor as f32);
    let make = format!("{make}place.layers[1].alpha_factors = vec2<f32>({x:?}, {y:?});");
    at(make, layered(own[0], LayerSample { alpha_factors, ..own[1] }))
}

fn all_flakes(material: &Material) -> Flakes {
    let flakes = material.effects.flakes.as_ref().expect("the file has flakes");
    let FlakeSource::Cells { seed, count, spread } = flakes.source else { unreachable!("the file has cells") };
    Flakes { seed, count, tiling: flakes.tiling, spread, scale: flakes.scale, fade_start: flakes.fade_start }
}

fn flakes(materials: &[Material], n: usize) -> Spot {
    let flakes = all_flakes(&materials[0]);
    let cells = flakes.tiling * f64::from(flakes.count);
    // In the middle of a cell, because single precision may miss its edges.
    let uv = (coordinate(n).0 * cells).floor() + 0.5;
    let uv = (uv / cells).as_vec2();
    let distance = factor(n, 0.0, 5.0);
    let mut place = Place::NONE;
    place.under.flake_normal = flakes.normal(uv.as_dvec2(), distance);
    let make = format!(
        "place.flake_normal = luthier_flake_normal(material, vec2<f32>({:?}, {:?}), {:?});",
        uv.x, uv.y, distance as f32
    );
    at(make, place)
}

fn flake_map(materials: &[Material], n: usize) -> Spot {
    let (flake, text) = leaning(n);
    let distance = factor(n, 0.0, 5.0);
    let mut place = Place::NONE;
    place.under.flake_normal = all_flakes(&materials[0]).tilted(flake, distance);
    at(format!("place.flake_normal = luthier_flake_tilt(material, {text}, {:?});", distance as f32), place)
}

fn patina(materials: &[Material], n: usize) -> Spot {
    let patina = materials[0].effects.patina.as_ref().expect("the file has patina");
    let value = part(n, STEPS[0]);
    let (extent, transition, base_alpha) = (patina.extent, patina.transition, patina.base_alpha);
    let grown = Patina { extent, transition, diffuse_albedo: 0.0, base_alpha, tarnish: 1.0 };
    let (diffuse_albedo, tarnish) = (patina.diffuse_albedo, patina.tarnish);
    let growth = Growth { amount: grown.amount(value), diffuse_albedo, base_alpha, tarnish };
    let make = format!("place.patina = luthier_patina_amount(material, {:?});", value as f32);
    at(make, Place { patina: Some(growth), ..Place::NONE })
}

fn glitter(materials: &[Material], n: usize) -> Spot {
    let glitter = materials[0].effects.glitter.as_ref().expect("the file glitters");
    let (uv, text) = coordinate(n);
    let cells = Voronoi { seed: glitter.seed, frequency: glitter.frequency };
    let under = Box::new(Map::Uniform(0));
    let map = Map::Glitter { cells, stacks: vec![0], filled: glitter.filled, tilt: glitter.tilt, under };
    let mut place = Place::NONE;
    place.sample.normal = map.pick(uv).normal;
    at(format!("place.normal = luthier_glitter_normal(material, {text});"), place)
}

fn cells(seed: u32, frequency: f64, materials: &[u32]) -> CellsRecord {
    CellsRecord { seed, frequency, materials: materials.to_vec() }
}

/// Grains of two materials, and particles of the first on top.
fn grains() -> SurfaceEntry {
    SurfaceEntry {
        name: "s".to_owned(),
        source: "s.toml".to_owned(),
        source_hash: String::new(),
        cells: cells(11, 8.0, &[0, 1]),
        switches: Vec::new(),
        glitter: Some(ParticlesRecord { cells: cells(12, 70.0, &[0]), filled: 0.4, tilt: 0.4 }),
    }
}

/// One material, and the other where noise or larger cells say so.
fn switched() -> SurfaceEntry {
    let noise = SwitchBy::Noise { seed: 13, frequency: 6.0, octaves: 4, between: [-0.05, 0.1] };
    let tiles = SwitchBy::Tiles { seed: 14, frequency: 10.0, share: 0.4 };
    SurfaceEntry {
        cells: cells(11, 8.0, &[0]),
        switches: [noise, tiles].map(|by| SwitchRecord { by, cells: cells(11, 8.0, &[1]) }).to_vec(),
        glitter: None,
        ..grains()
    }
}

fn pick(surface: &SurfaceEntry, n: usize) -> Spot {
    let (uv, text) = coordinate(n);
    let found = surface_map(surface).pick(uv);
    let mut place = Place::NONE;
    place.sample.normal = found.normal;
    let make = format!("let pick = luthier_pick(0u, {text}); place.normal = pick.normal; material = pick.material;");
    Spot { material: found.stack, ..at(make, place) }
}

/// A light of a colour; one of equal energy at a place where nothing varies.
const LIGHT: Rgb = [0.9, 0.5, 0.25];

fn dyed(materials: &[Material], n: usize) -> Spot {
    let (normal, text) = leaning(n);
    let mut place = Place { reradiation: materials[0].reradiation(), ..Place::NONE };
    place.sample.normal = normal;
    Spot { light: Some(LIGHT), ..at(format!("place.normal = {text};"), place) }
}
