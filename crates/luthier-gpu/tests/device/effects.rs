//! Flakes, patina, glitter and maps on the device, against their f64 twins and closed forms.

use glam::{DVec2, DVec3};
use luthier_gpu::{Package, RenderSettings, Scene, Shader};
use luthier_layers::effects::flakes::Flakes;
use luthier_layers::effects::heterogeneous::Map;
use luthier_layers::models::elek::Elek;
use luthier_layers::noise::voronoi::Voronoi;
use luthier_layers::terms::Terms;
use luthier_lut::Image;
use luthier_manifest::{
    CoatRecord, FileEntry, FlakesRecord, GlitterRecord, LayerRecord, MapEntry, MapSlot, MaterialConstants,
    PatinaRecord, PlaceValues,
};
use luthier_shader::{Form, MaterialSet, Target};

use crate::adapter::gpu;
use crate::bake_by_hand::{artefacts, conductor, dielectric, diffuse, manifest};
use crate::record_terms::{RecordTerms, model_layers};
use crate::render::{check, dark, dot, sun};

/// Sines, cosines and logarithms of devices are less precise than those of hosts: WGSL allows 2^-11 for a sine.
const NORMAL_TOLERANCE: f64 = 1e-3;

/// Tolerance of f cos_theta_i over the brightest of the lobe: a normal off by [`NORMAL_TOLERANCE`] under a lobe 0.3 wide.
const EVAL_TOLERANCE: f64 = 1e-2;

const FLAKES: FlakesRecord =
    FlakesRecord { seed: 0x1234_5678, count: 32, tiling: 4.0, spread: 0.3, scale: 1.0, fade_start: 2.0 };
const GLITTER: GlitterRecord = GlitterRecord { seed: u32::MAX, frequency: 15.0, filled: 0.4, tilt: 0.4 };

fn effects() -> MaterialConstants {
    let patina = PatinaRecord {
        extent: 0.5,
        transition: 0.5,
        diffuse_albedo: [0.3, 0.5, 0.2],
        base_alpha: None,
        tarnish: [1.0; 3],
        bare: conductor(0.3, [0.2, 0.9, 1.4], [3.9, 2.4, 1.9]),
    };
    MaterialConstants {
        flakes: Some(FLAKES),
        patina: Some(patina),
        glitter: Some(GLITTER),
        ..MaterialConstants::default()
    }
}

fn coated() -> Vec<LayerRecord> {
    let coat = LayerRecord { optical_depth: [0.1, 0.3, 0.6], ..dielectric(0.3, 1.5) };
    vec![coat, conductor(0.3, [0.12, 0.35, 0.97], [2.32, 1.6, 1.25])]
}

/// A scene whose `luthier_eval` is `body`, over the emitted functions: `material`, `wi` and `wo` are its arguments.
fn scene_with(body: &str) -> Option<Scene> {
    let gpu = gpu()?;
    let mut made = artefacts(Form::Full, vec![coated()], &[]);
    made.manifest.materials[0].constants = effects();
    let set = MaterialSet::from_manifest(&made.manifest);
    let wgsl = luthier_shader::emit(&set, Form::Full, Target::Wgsl).unwrap();
    let wgsl = wgsl.replace("fn luthier_eval(", "fn emitted_eval(")
        + &format!("\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n");
    let shaders = vec![Shader::wgsl(Form::Full, wgsl)];
    let made = Package::from_parts(made.manifest, Vec::new(), shaders).unwrap();
    Some(gpu.scene(&made, Form::Full).unwrap())
}

fn flakes() -> Flakes {
    let FlakesRecord { seed, count, tiling, spread, scale, fade_start } = FLAKES;
    Flakes { seed, count, tiling, spread, scale, fade_start }
}

/// Points of the unit square (R2 sequence) as f32 holds them, off the edges of the flakes' cells.
fn places() -> Vec<DVec2> {
    let cells = FLAKES.tiling * f64::from(FLAKES.count);
    let inside = |x: f64| (0.01..0.99).contains(&(x * cells).fract());
    (0..4000u32)
        .map(|i| DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(i))
        .map(|p| p.fract().as_vec2().as_dvec2())
        .filter(|p| inside(p.x) && inside(p.y))
        .collect()
}

fn pairs(places: &[DVec2]) -> Vec<([f32; 3], [f32; 3])> {
    places.iter().map(|p| ([p.x as f32, p.y as f32, 1.5], [0.0, 0.0, 1.0])).collect()
}

fn worst(found: &[[f32; 3]], expected: impl Iterator<Item = DVec3>) -> f64 {
    let apart = |(f, e): (&[f32; 3], DVec3)| (DVec3::from(f.map(f64::from)) - e).length();
    found.iter().zip(expected).map(apart).fold(0.0, f64::max)
}

#[test]
fn flakes_on_the_device_are_those_of_f64() {
    let Some(scene) = scene_with("return luthier_flake_normal(material, wi.xy, 2.0 * wi.z);") else { return };
    let places = places();
    let found = scene.evaluate(0, &pairs(&places)).unwrap();
    let error = worst(&found, places.iter().map(|&uv| flakes().normal(uv, 3.0)));
    eprintln!("flake normals: {error:.1e}");
    assert!(error < NORMAL_TOLERANCE && places.len() > 3000, "{error}");
}

/// Integers are exact everywhere, and so are the numbers that are made of them.
#[test]
fn the_hash_on_the_device_is_that_of_f64() {
    let body = "let cell = luthier_voronoi(77u, 40.0 * wi.xy - 20.0);
                return vec3<f32>(luthier_unit(cell, 2u), luthier_unit(cell, 3u), luthier_unit(cell, 7u));";
    let Some(scene) = scene_with(body) else { return };
    let map = Voronoi { seed: 77, frequency: 1.0 };
    let places = places();
    let found = scene.evaluate(0, &pairs(&places)).unwrap();
    let mut compared = 0;
    for (uv, found) in places.iter().zip(found) {
        let p = 40.0 * *uv - 20.0;
        let cell = map.cell(p);
        let near = |d: DVec2| map.cell(p + 1e-4 * d) == cell;
        if [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].into_iter().all(near) {
            compared += 1;
            assert_eq!(found, [0, 1, 5].map(|i| cell.number(i) as f32), "{p}");
        }
    }
    assert!(compared > 3000, "{compared}");
}

#[test]
fn glitter_on_the_device_is_that_of_f64() {
    let Some(scene) = scene_with("return luthier_glitter_normal(material, wi.xy);") else { return };
    let cells = Voronoi { seed: GLITTER.seed, frequency: GLITTER.frequency };
    let map = Map::Glitter {
        cells,
        stacks: vec![0],
        filled: GLITTER.filled,
        tilt: GLITTER.tilt,
        under: Box::new(Map::Uniform(0)),
    };
    let far = |uv: &DVec2| {
        let near = |d: DVec2| cells.cell(*uv + 1e-5 * d) == cells.cell(*uv);
        [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].into_iter().all(near)
    };
    let places: Vec<DVec2> = places().into_iter().filter(far).collect();
    let found = scene.evaluate(0, &pairs(&places)).unwrap();
    let error = worst(&found, places.iter().map(|&uv| map.pick(uv).normal));
    eprintln!("glitter normals: {error:.1e}");
    assert!(error < NORMAL_TOLERANCE && places.len() > 3000, "{error}");
}

/// The tilted evaluation, the place taken from the direction that comes first.
#[test]
fn flakes_tilt_the_layers_below_on_the_device() {
    let body = "var place = luthier_place();
                place.flake_normal = luthier_flake_normal(material, wi.xy + 1.0, 3.0);
                return luthier_eval_at(place, material, wi, wo);";
    let Some(scene) = scene_with(body) else { return };
    let directions: Vec<(DVec3, DVec3)> = places()
        .windows(2)
        .map(|p| [p[0], p[1]].map(|p| DVec3::new(1.4 * p.x - 0.7, 1.4 * p.y - 0.7, 0.0)))
        .map(|[a, b]| [a, b].map(|v| DVec3::new(v.x, v.y, (1.0 - v.length_squared()).max(0.01).sqrt()).normalize()))
        .map(|[a, b]| [a, b].map(|v| v.as_vec3().as_dvec3()).into())
        .collect();
    let cells = FLAKES.tiling * f64::from(FLAKES.count);
    // Twice the margin: the sum is rounded.
    let inside = |x: f64| (0.02..0.98).contains(&((x + 1.0) * cells).fract());
    let directions: Vec<_> = directions.into_iter().filter(|(wi, _)| inside(wi.x) && inside(wi.y)).collect();
    let pairs: Vec<_> = directions.iter().map(|(wi, wo)| (wi.as_vec3().to_array(), wo.as_vec3().to_array())).collect();
    let records = coated();
    let (layers, terms) = (model_layers(&records), RecordTerms(&records));
    let (mut error, mut changed) = (0.0f64, 0);
    for ((wi, wo), found) in directions.iter().zip(scene.evaluate(0, &pairs).unwrap()) {
        let normal = flakes().normal(DVec2::new(wi.x, wi.y) + 1.0, 3.0);
        let expected = Elek::default().eval_below(&layers, &terms, *wi, *wo, normal);
        let plain = Elek::default().eval_with(&layers, &terms, *wi, *wo);
        for c in 0..3 {
            error = error.max((f64::from(found[c]) - expected[c]).abs() / expected[c].max(0.05));
        }
        changed += usize::from((plain[0] - expected[0]).abs() > 0.05 * plain[0]);
    }
    eprintln!("tilted by flakes: {error:.1e}");
    assert!(error < EVAL_TOLERANCE, "{error}");
    assert!(changed > 1000, "{changed}");
}

/// Half of the patina's value is that of the layers and its diffuse term, half that of the bare base.
#[test]
fn patina_blends_two_stacks_on_the_device() {
    let body = "var place = luthier_place();
                place.patina = luthier_patina_amount(material, wi.z - 0.5);
                return luthier_eval_at(place, material, vec3<f32>(0.6, 0.0, 0.8), wo);";
    let Some(scene) = scene_with(body) else { return };
    let wi = DVec3::new(0.6, 0.0, 0.8);
    let wo = DVec3::new(-0.36, 0.48, 0.8);
    let maps: Vec<f64> = (0..=16).map(|i| f64::from(i) / 16.0).collect();
    let pairs: Vec<_> = maps.iter().map(|&m| ([0.0, 0.0, (m + 0.5) as f32], wo.as_vec3().to_array())).collect();
    let grown = coated();
    let bare = vec![effects().patina.unwrap().bare];
    let eval =
        |records: &[LayerRecord]| Elek::default().eval_with(&model_layers(records), &RecordTerms(records), wi, wo);
    let (grown_value, bare_value) = (eval(&grown), eval(&bare));
    let cos_theta_d = 0.5 * (wi + wo).length();
    let passed = 1.0 - RecordTerms(&grown).fresnel(0, cos_theta_d)[0];
    for (map, found) in maps.iter().zip(scene.evaluate(0, &pairs).unwrap()) {
        let amount = (0.5 + (0.5 - map)).clamp(0.0, 1.0);
        for (c, albedo) in [0.3, 0.5, 0.2].into_iter().enumerate() {
            let layered = grown_value[c] + passed * albedo * wi.z / std::f64::consts::PI;
            let expected = amount * layered + (1.0 - amount) * bare_value[c];
            assert!((f64::from(found[c]) - expected).abs() < 1e-4 * expected, "{map}: {found:?} {expected}");
        }
    }
}

/// A coat covers a share of the place: its weight where nothing is said of the place, and that times a factor, 1 at most.
#[test]
fn weights_blend_two_stacks_on_the_device() {
    let Some(gpu) = gpu() else { return };
    let bare = effects().patina.unwrap().bare;
    let mut made = artefacts(Form::Full, vec![coated()], &[]);
    let coat = CoatRecord { weight: 0.6, bare: bare.clone(), side: None };
    made.manifest.materials[0].constants = MaterialConstants { coat: Some(coat), ..MaterialConstants::default() };
    let set = MaterialSet::from_manifest(&made.manifest);
    let wgsl = luthier_shader::emit(&set, Form::Full, Target::Wgsl).unwrap();
    let made = Package::from_parts(made.manifest, Vec::new(), vec![Shader::wgsl(Form::Full, wgsl)]).unwrap();
    let scene = gpu.scene(&made, Form::Full).unwrap();
    let (wi, wo) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.36, 0.48, 0.8));
    let eval =
        |records: &[LayerRecord]| Elek::default().eval_with(&model_layers(records), &RecordTerms(records), wi, wo);
    let (all, below) = (eval(&coated()), eval(&[bare]));
    let pair = (wi.as_vec3().to_array(), wo.as_vec3().to_array());
    let factors = [0.0_f32, 0.25, 1.0, 1.5, 4.0];
    let spots = factors.map(|weight_factor| (PlaceValues { weight_factor, ..PlaceValues::NONE }, pair.0, pair.1));
    let mut found = scene.evaluate_at(0, &spots).unwrap();
    found.extend(scene.evaluate(0, &[pair]).unwrap());
    let shares = factors.map(|factor| (0.6 * f64::from(factor)).min(1.0)).into_iter().chain([0.6]);
    for (found, share) in found.iter().zip(shares) {
        for c in 0..3 {
            let expected = share * all[c] + (1.0 - share) * below[c];
            assert!((f64::from(found[c]) - expected).abs() < 1e-4 * expected, "{share}: {found:?} {expected}");
        }
    }
}

/// A ball of chalk whose normal map is one tilted texel.
#[test]
fn normal_maps_tilt_the_surface_in_pictures() {
    let Some(gpu) = gpu() else { return };
    let tilted = DVec3::new(0.3, -0.2, 0.9).normalize();
    let mut manifest = manifest(vec![vec![diffuse([0.5; 3], 0.0)]], &[]);
    manifest.materials[0].maps.push(MapEntry {
        slot: MapSlot::Normal,
        layer: Some(0),
        source: "by hand".to_owned(),
        file: FileEntry::default(),
        width: 1,
        height: 1,
        factor: None,
        srgb: false,
        transform: None,
    });
    let set = MaterialSet::from_manifest(&manifest);
    let wgsl = luthier_shader::emit(&set, Form::Baked, Target::Wgsl).unwrap();
    manifest.bindings = luthier_shader::bindings(&set, Form::Baked);
    let shaders = vec![Shader::wgsl(Form::Baked, wgsl)];
    let mut artefacts = Package::from_parts(manifest, Vec::new(), shaders).unwrap();
    let texel = (0.5 * tilted + 0.5).as_vec3();
    let image = Image { width: 1, height: 1, channels: 4, data: vec![texel.x, texel.y, texel.z, 1.0] };
    artefacts.maps.push(luthier_gpu::Map {
        material: 0,
        slot: MapSlot::Normal,
        layer: Some(0),
        picture: image.into(),
        png: Vec::new(),
    });
    let scene = gpu.scene(&artefacts, Form::Baked).unwrap();
    let settings = RenderSettings { lights: sun([3.0, 4.0, 12.0], [1.0; 3]), ..dark() };
    check(&scene.render(&[0], &settings).unwrap(), 2e-5, |n, wo| {
        let light = DVec3::new(3.0, 4.0, 12.0) / 13.0;
        let normal = DVec3::from(n);
        let tangent = DVec3::new(n[2], 0.0, -n[0]).normalize();
        let here = tilted.x * tangent + tilted.y * normal.cross(tangent) + tilted.z * normal;
        let seen = dot(n, light.to_array()) > 0.0 && here.dot(DVec3::from(wo)) > 0.0;
        [if seen { 0.5 * here.dot(light).max(0.0) / std::f64::consts::PI } else { 0.0 }; 3]
    });
}
