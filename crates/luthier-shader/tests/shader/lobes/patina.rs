//! Rows of both ends of a patina, or of a coat with a weight, against the twin.

use std::collections::BTreeMap;

use glam::DVec3;
use luthier_layers::formulas::oren_nayar;
use luthier_layers::models::lobes::{Below, Critical, Frame, Row, ViewAxis, Wide};
use luthier_lut::{AtlasLayout, Image, TableKind, WeightBits, bilinear};
use luthier_manifest::{
    FlakesRecord, LayerKind, LayerRecord, MaterialEntry, PatinaRecord, VaryingFactor, material_buffer,
};
use luthier_optics::microfacet;
use luthier_optics::stack::Diffuse;
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::{rows, set, tables_with};
use crate::arithmetic::directions;
use crate::machine::{Machine, Value, vector};

/// Patina mixes the rows of two tiles, and the facets of its interface with those of the layer below it, or with a diffuse base: as much light of both
/// as there is surface. Rows of a bare base have its light in their remainder. Beside patina of chains, and where a place has no patina, all layers
/// are there. Oracles: the twin of rows, closed forms of D, Lambda and a rough base.
#[test]
fn patina_mixes_the_light_of_two_ends() {
    let (layout, image) = covered_rows();
    for (name, number) in [
        ("lobes-patina", 0),
        ("lobes-patina-base", 0),
        ("lobes-patina-mixed", 1),
        ("lobes-patina-mixed", 2),
        ("lobes-patina-chains", 0),
        ("lobes-patina-chains", 2),
    ] {
        let mut materials = set(name);
        for material in &mut materials {
            let patina = material.constants.patina.as_mut().map(|patina| &mut patina.bare);
            material.layers.iter_mut().chain(patina).for_each(|layer| layer.tiles[TableKind::Distribution] = None);
            let Some(record) = &mut material.constants.lobes else { continue };
            material.layers[0].tiles[TableKind::Lobes] = Some(1);
            record.integral = Wide::new(record.falloff, ViewAxis::new(2, Critical::default())).integral();
            let decays = bilinear(&image, layout.position(1, [0.0, 4.0]), WeightBits::Exact);
            record.inverse_tails = [decays[0], decays[2]];
        }
        let given = materials[number].clone();
        let record = given.constants.lobes.unwrap();
        let wide = Wide::new(record.falloff, ViewAxis::new(2, Critical::default()));
        let frame = Frame::new(record.index, wide);
        let bare = given.constants.patina.map(|patina| patina.bare);
        let text = emit(&MaterialSet::new(&materials, tables_with(&layout)), Form::Baked, Target::Wgsl).unwrap();
        let gray = Image { data: vec![GRAY; 36], ..Image::zeros(3, 3, 4) };
        let textures = [("luthier_fresnel", gray), ("luthier_lobes", image.clone())];
        let textures = BTreeMap::from(textures.map(|(name, image)| (name.to_owned(), image)));
        let machine = Machine::new(&text, &material_buffer(&materials), textures);
        let neutral = machine.call("luthier_place", Vec::new());
        for (patina, tile, cover) in [(-1.0, 1.0, 1.0), (1.0, 2.0, 1.0), (0.3, 2.7, 0.3), (0.0, 3.0, 0.0)] {
            let (tile, cover) = if bare.is_some() { (tile, cover) } else { (1.0, 1.0) };
            let mut place = neutral.clone();
            *place.members_mut().last_mut().unwrap() = Value::F(patina as f32);
            for (wi, wo) in directions(100) {
                let [light, eye] = [wi, wo].map(DVec3::from);
                if light.z <= 0.0 || eye.z <= 0.0 {
                    continue;
                }
                let low = (tile as u32).min(3);
                let read = |tile, part| bilinear(&image, layout.position(tile, [eye.z, part]), WeightBits::Exact);
                let mixed = |part: u32| {
                    let (a, b, t) = (read(low, part.into()), read(low + 1, part.into()), tile - f64::from(low));
                    [0, 1, 2, 3].map(|i: usize| a[i] + t * (b[i] - a[i]))
                };
                let mut row = Row::of_parts(&(0..6).map(mixed).collect::<Vec<_>>(), false);
                let facets = |layer: &LayerRecord| {
                    let half = (light + eye).normalize();
                    let sin_sq = half.x * half.x + half.y * half.y;
                    let d = microfacet::distribution(layer.distribution, layer.alpha, half.z, sin_sq);
                    let lambda = |w: DVec3| microfacet::lambda(layer.distribution, layer.alpha, w.z);
                    [f64::from(GRAY) * d / (4.0 * eye.z * (1.0 + lambda(light) + lambda(eye))); 3]
                };
                let first = facets(&given.layers[0]);
                let seen = bare.as_ref().map_or([0.0; 3], |bare| match bare.kind {
                    LayerKind::Diffuse => {
                        let of_base = read(3, 0.0);
                        (0..3).for_each(|c| row.wide[c] -= (1.0 - cover) * of_base[c]);
                        let base = Diffuse { albedo: bare.albedo, sigma: bare.sigma };
                        oren_nayar::brdf(base.albedo, base.sigma, light, eye).map(|f| f * light.z)
                    }
                    _ => facets(bare),
                });
                let below = Below::new(frame, row, eye).eval(light);
                let arguments = vec![
                    place.clone(),
                    Value::U(number as u32),
                    vector(&wi.map(|w| w as f32)),
                    vector(&wo.map(|w| w as f32)),
                ];
                let found = machine.call("luthier_eval_at", arguments).floats();
                for c in 0..3 {
                    let expected = cover * first[c] + (1.0 - cover) * seen[c] + below[c];
                    let error = (f64::from(found[c]) - expected).abs() / expected.abs().max(0.03);
                    assert!(error < 1e-3, "{name} {number} {patina} {wi:?} {wo:?}: {} {expected}", found[c]);
                }
            }
        }
    }
}

/// Flakes of a patina turn the lobes of the layers that it covers, and not the lobe of a bare interface, which is the second. Over a bare base both lobes
/// are those of the patina.
#[test]
fn flakes_turn_the_lobes_that_patina_covers() {
    let (layout, image) = covered_rows();
    for name in ["lobes-patina", "lobes-patina-base"] {
        let mut materials = set(name);
        let material = &mut materials[0];
        let is_base = material.constants.bare().is_some_and(|bare| bare.kind == LayerKind::Diffuse);
        let MaterialEntry { layers, constants, .. } = material;
        layers.iter_mut().chain(constants.bare_mut()).for_each(|layer| layer.tiles[TableKind::Distribution] = None);
        layers[0].tiles[TableKind::Lobes] = Some(1);
        constants.flakes =
            Some(FlakesRecord { seed: 1, count: 9, tiling: 1.0, spread: 0.1, scale: 1.0, fade_start: 1.0 });
        let record = constants.lobes.unwrap();
        let wide = Wide::new(record.falloff, ViewAxis::new(2, Critical::default()));
        let frame = Frame::new(record.index, wide);
        let index = layers[0].eta;
        let text = emit(&MaterialSet::new(&materials, tables_with(&layout)), Form::Baked, Target::Wgsl).unwrap();
        let number = |structure: &str, name: &str| {
            let members = text.split(&format!("struct {structure} {{\n")).nth(1).unwrap().lines();
            let members = members.take_while(|line| *line != "}").map(str::trim).filter(|line| !line.starts_with("//"));
            members.map(|line| line.split_once(": ").unwrap().0).position(|member| member == name).unwrap()
        };
        // Facets of the first interface and of the bare layer reflect nothing.
        let black = Image::zeros(3, 3, 4);
        let textures = [("luthier_fresnel", black), ("luthier_lobes", image.clone())];
        let textures = BTreeMap::from(textures.map(|(name, image)| (name.to_owned(), image)));
        let machine = Machine::new(&text, &material_buffer(&materials), textures);
        let normal = DVec3::new(0.1, -0.06, 1.0).normalize();
        let mut place = machine.call("luthier_place", Vec::new());
        place.members_mut()[number("LuthierPlace", "flake_normal")] = vector(&normal.to_array().map(|x| x as f32));
        place.members_mut()[number("LuthierPlace", "patina")] = Value::F(0.3);
        let mut brightest = 0.0_f64;
        for (wi, wo) in directions(200) {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            let read =
                |tile, part: u32| bilinear(&image, layout.position(tile, [eye.z, part.into()]), WeightBits::Exact);
            let mixed = |part: u32| {
                let (grown, bare) = (read(2, part), read(3, part));
                [0, 1, 2, 3].map(|i: usize| grown[i] + 0.7 * (bare[i] - grown[i]))
            };
            let row = Row::of_parts(&(0..6).map(mixed).collect::<Vec<_>>(), false);
            let [mut first, mut second] = [0; 2].map(|_| row.clone());
            first.lobes[1].strength = [0.0; 3];
            second.lobes[0].strength = [0.0; 3];
            (first.wide, second.wide) = ([0.0; 3], [0.0; 3]);
            let [first, second] = [first, second].map(|row| Below::new(frame, row, eye));
            let second = if is_base { second.tilted(normal, index) } else { second };
            let expected = [first.tilted(normal, index).eval(light), second.eval(light)];
            let arguments = [Value::U(0), vector(&wo.map(|w| w as f32))];
            let mut prepared =
                machine.call("luthier_prepare_lobes", [place.clone()].into_iter().chain(arguments).collect());
            let lit = |prepared: &Value| {
                machine.call("luthier_light_lobes", vec![prepared.clone(), vector(&wi.map(|w| w as f32))]).floats()
            };
            let all = lit(&prepared);
            for name in ["first_strength", "second_strength"] {
                prepared.members_mut()[number("LuthierPreparedLobes", name)] = vector(&[0.0; 3]);
            }
            let rest = lit(&prepared);
            for c in 0..3 {
                let expected = expected[0][c] + expected[1][c];
                let found = f64::from(all[c]) - f64::from(rest[c]);
                let error = (found - expected).abs() / expected.abs().max(0.03);
                assert!(error < 1e-3, "{name} {wi:?} {wo:?}: {found} {expected}");
                brightest = brightest.max(expected);
            }
        }
        assert!(brightest > 0.3, "{name}: {brightest}");
    }
}

/// Light is linear in the share that a coat covers, from that of the layers below it to that of all layers: the ends of rows over a patina that is nothing
/// but a layer, of the same rows. Beside a patina, too.
#[test]
fn a_weight_mixes_the_light_of_two_ends() {
    let (layout, image) = covered_rows();
    let machine = |mut materials: Vec<MaterialEntry>| {
        for material in &mut materials {
            let MaterialEntry { layers, constants, .. } = material;
            layers.iter_mut().chain(constants.bare_mut()).for_each(|layer| layer.tiles[TableKind::Distribution] = None);
            if constants.lobes.is_some() {
                layers[0].tiles[TableKind::Lobes] = Some(2);
            }
        }
        let text = emit(&MaterialSet::new(&materials, tables_with(&layout)), Form::Baked, Target::Wgsl).unwrap();
        let gray = Image { data: vec![GRAY; 36], ..Image::zeros(3, 3, 4) };
        let textures = [("luthier_fresnel", gray), ("luthier_lobes", image.clone())];
        let textures = BTreeMap::from(textures.map(|(name, image)| (name.to_owned(), image)));
        Machine::new(&text, &material_buffer(&materials), textures)
    };
    let mut grown = set("lobes-weight");
    let coat = grown[0].constants.coat.take().unwrap();
    grown[0].constants.patina = Some(PatinaRecord {
        extent: 0.5,
        transition: 0.5,
        diffuse_albedo: [0.0; 3],
        base_alpha: None,
        tarnish: [1.0; 3],
        bare: coat.bare,
    });
    if let Some(varying) = grown[0].constants.lobes.as_mut().and_then(|lobes| lobes.varying.as_mut()) {
        varying.factor = VaryingFactor::Patina;
    }
    let grown = machine(grown);
    for name in ["lobes-weight", "lobes-weight-mixed"] {
        let weighed = machine(set(name));
        for (wi, wo) in directions(100) {
            let at = |machine: &Machine, value: f32| {
                let mut place = machine.call("luthier_place", Vec::new());
                *place.members_mut().last_mut().unwrap() = Value::F(value);
                let arguments = vec![place, Value::U(0), vector(&wi.map(|w| w as f32)), vector(&wo.map(|w| w as f32))];
                machine.call("luthier_eval_at", arguments).floats()
            };
            let [all, below] = [1.0, 0.0].map(|amount| at(&grown, amount));
            for factor in [0.0, 0.3, 1.0, 4.0_f32] {
                let (found, share) = (at(&weighed, factor), (0.6 * factor).min(1.0));
                for c in 0..3 {
                    let expected = share * all[c] + (1.0 - share) * below[c];
                    let error = (found[c] - expected).abs() / expected.abs().max(0.03);
                    assert!(error < 1e-4, "{name} {factor} {wi:?} {wo:?}: {} {expected}", found[c]);
                }
            }
        }
    }
}

/// Reflectance of all interfaces, for all channels.
const GRAY: f32 = 0.1;

/// Rows of a patina after another's tile: all layers, grown, and bare; shapes of the last two are alike.
pub(super) fn covered_rows() -> (AtlasLayout, Image) {
    let layout = AtlasLayout { tiles: 5, ..rows().0 };
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    for tile in 0..5 {
        let ([_, y], k) = (layout.origin(tile), f64::from(tile));
        let end = k.min(2.0);
        for x in 0..width {
            let texel = match x / layout.row_size() {
                0 => [0.2 + 0.1 * k, 0.3, 0.5 - 0.1 * k, 0.0],
                1 => [1.2 - 0.4 * k, 0.4, 0.3 * k, 0.2 + 0.05 * end],
                2 => [0.1 * k, 0.2, 0.3, -0.1],
                3 => [6.0 + end, 9.0 - end, 0.7, 0.9],
                4 => [2.0 + end, 0.9, 40.0, 0.8],
                _ => [2.0, 2.0, 2.0, if tile == 3 { 0.1 } else { 0.0 }],
            };
            image.texel_mut(x, y).copy_from_slice(&texel.map(|value| value as f32));
        }
    }
    (layout, image)
}
