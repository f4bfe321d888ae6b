//! Effects become records and maps.

use luthier_bake::{MapSource, MaterialMap};
use luthier_lut::TableKind;
use luthier_manifest::{LayerKind, MapSlot, MaterialConstants};

use crate::materials::{SMALL, bake_all, conductor, dielectric, material};

const PATINA: &str = "[effects.patina]\nextent = 0.4\ntransition = 0.2\nbase_alpha = 0.5\n\
                      map = { noise = { seed = 4, frequency = 3, octaves = 2 } }\n";

fn coated() -> String {
    dielectric("1.5", 0.2) + &conductor("{ n = 0.3, k = 3.0 }", 0.1)
}

/// The bare layer is that of a material without the first.
#[test]
fn patina_brings_the_layer_below_as_it_is_in_air() {
    let grown = material("grown", &(coated() + PATINA), SMALL);
    let metal = material("metal", &conductor("{ n = 0.3, k = 3.0 }", 0.1), SMALL);
    let bake = bake_all(&[grown, metal]);
    let patina = bake.materials[0].constants.patina.as_ref().unwrap();
    // The set shares their tiles too.
    assert_eq!(patina.bare, bake.materials[1].records[0]);
    assert_eq!(patina.bare.kind, LayerKind::Conductor);
    assert!((patina.bare.ior_n[0] - 1.5 * bake.materials[0].records[1].ior_n[0]).abs() < 1e-12);
}

/// The bare layer is that of a material without the first, also where that bends light as the medium above says. A weight of 1 is no weight, in every byte.
#[test]
fn a_weight_brings_the_layer_below_as_it_is_in_air() {
    let engine = "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.6, 0.3, 0.1]\nroughness = 0.5\n";
    let metal = conductor("{ n = 0.3, k = 3.0 }", 0.1);
    for (below, model) in [(metal.as_str(), "elek"), (engine, "elek"), (engine, "lobes")] {
        let settings = format!("[bake]\nmodel = \"{model}\"\n{SMALL}");
        let coated = |weight: &str| material("coated", &(dielectric("1.5", 0.2) + weight + below), &settings);
        let bake = bake_all(&[coated("weight = 0.4\n"), material("below", below, &settings)]);
        let [coated_constants, alone] = [&bake.materials[0].constants, &bake.materials[1].constants];
        let coat = coated_constants.coat.as_ref().unwrap();
        // The set shares their tiles too, but for lobes: those of all layers have both ends.
        let mut below_alone = bake.materials[1].records[0].clone();
        below_alone.tiles[TableKind::Lobes] = None;
        assert_eq!((coat.weight, &coat.bare), (0.4, &below_alone));
        assert!(coated_constants.patina.is_none() && alone.coat.is_none());
        let [one, plain] = ["weight = 1\n", ""].map(|weight| bake_all(&[coated(weight)]));
        assert!(one == plain && one.materials[0].constants.coat.is_none());
    }
    let mapped = dielectric("1.5", 0.2) + "maps = { weight = \"w.png\" }\n" + &conductor("{ n = 0.3, k = 3.0 }", 0.1);
    let bake = bake_all(&[material("mapped", &mapped, SMALL)]);
    assert_eq!(bake.materials[0].constants.coat.as_ref().unwrap().weight, 1.0);
    let maps: Vec<_> = bake.materials[0].maps.iter().map(|map| (map.slot, map.layer, map.factor)).collect();
    assert_eq!(maps, [(MapSlot::Weight, Some(0), None)]);
}

#[test]
fn noise_becomes_a_map_that_fills_its_range_and_repeats() {
    let bake = bake_all(&[material("grown", &(coated() + PATINA), SMALL)]);
    let source = MapSource::Noise { seed: 4, frequency: 3.0, octaves: 2 };
    assert_eq!(
        bake.materials[0].maps,
        [MaterialMap { slot: MapSlot::Patina, layer: None, source: source.clone(), factor: None }]
    );
    let image = source.texels().unwrap();
    let (low, high) = image.data.iter().fold((1f32, 0f32), |(l, h), &v| (l.min(v), h.max(v)));
    assert!(low < 0.01 && high > 0.99, "{low} {high}");
    // A step across the edge is no larger than steps inside.
    let step = |i: u32, k: u32, j: u32| (image.texel(i, j)[0] - image.texel(k, j)[0]).abs();
    let last = image.width - 1;
    let across = (0..image.height).map(|j| step(last, 0, j)).fold(0.0, f32::max);
    let inside = (0..image.height).flat_map(|j| (0..last).map(move |i| (i, j))).map(|(i, j)| step(i, i + 1, j));
    assert!(across <= inside.fold(0.0, f32::max) && across > 0.0, "{across}");
}

#[test]
fn maps_are_listed_by_layer_and_slot() {
    let maps = "maps = { normal = \"n.png\", roughness = \"r.png\", thickness = \"t.png\" }\n";
    let flakes = "[effects.flakes]\nnormal_map = \"f.png\"\ntiling = 7\nfade_start = 3\n\
                  [effects.glitter]\nfrequency = 30\nfilled = 0.2\ntilt_deg = 10\n";
    let layers = dielectric("1.5", 0.2) + maps + &conductor("{ n = 0.3, k = 3.0 }", 0.1) + flakes;
    let material = material("mapped", &layers, SMALL);
    assert_eq!(material.files, ["f.png", "n.png", "r.png", "t.png"]);
    let bake = bake_all(&[material]);
    let found: Vec<_> = bake.materials[0].maps.iter().map(|m| (m.slot, m.layer, m.source.label())).collect();
    let expected = [
        (MapSlot::Normal, Some(0), "n.png"),
        (MapSlot::Roughness, Some(0), "r.png"),
        (MapSlot::Thickness, Some(0), "t.png"),
        (MapSlot::FlakeNormal, None, "f.png"),
    ];
    assert_eq!(found, expected.map(|(slot, layer, path)| (slot, layer, path.to_owned())));
    let MaterialConstants { flakes, glitter, .. } = &bake.materials[0].constants;
    let flakes = flakes.unwrap();
    assert_eq!((flakes.count, flakes.tiling, flakes.fade_start), (0, 7.0, 3.0));
    let glitter = glitter.unwrap();
    assert!((glitter.frequency, glitter.filled) == (30.0, 0.2) && (glitter.tilt - 10f64.to_radians()).abs() < 1e-15);
}
