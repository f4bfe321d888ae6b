//! Rows of families in the shader of `lobes` against the f64 formulas, on rows that no fit has made.

use std::collections::BTreeMap;

use glam::DVec3;
use luthier_layers::models::lobes::{
    Below, Critical, Family, FilmLight, Frame, Mix, Paint, Painted, Row, SlopeAxis, Slopes, ViewAxis, Wide,
};
use luthier_lut::{AtlasLayout, Axis, Image, TableKind, WeightBits, bilinear};
use luthier_manifest::{
    FamilyRecord, FileEntry, FunctionGroup, LayerKind, LayerRecord, LobesRecord, MapEntry, MapSlot, MaterialConstants,
    MaterialEntry, PaintedRecord, SlopesRecord, Tiles, VaryingFactor, VaryingRecord, material_buffer,
};
use luthier_optics::Rgb;
use luthier_optics::film_over_f0::FilmOverF0;
use luthier_optics::microfacet;
use luthier_optics::schlick::{F82, edge_dip};
use luthier_shader::MaterialSet;

use super::{in_all_languages, set, tables_with};
use crate::arithmetic::directions;
use crate::machine::{Machine, Value, vector};

/// Nodes over the coat and over the base.
pub(super) const NODES: [u32; 2] = [2, 3];

/// The tile before those of the family.
pub(super) const FIRST: u32 = 1;

/// Ranges of slope parameters of coat and base.
const RANGES: [[f64; 2]; 2] = [[0.01, 0.25], [0.04, 0.64]];

/// Slope parameters of the material, and its colours: F0 of the dielectric, and another one, albedo below it, optical depth of the coat's slab.
const ALPHAS: [f64; 2] = [0.3, 0.7];
const F0: Rgb = [0.04; 3];
const OTHER_F0: Rgb = [0.05, 0.3, 0.6];
const ALBEDO: Rgb = [0.7, 0.4, 0.2];
const DEPTH: Rgb = [0.1, 0.3, 0.6];

/// Rows whose every part changes with the view and with the tile. Without a coat, the first lobe has no light of the metal, as in bakes.
fn rows(family: Family) -> (AtlasLayout, Image) {
    rows_of(FIRST + NODES[0] * NODES[1], family.is_metallic, |_| family.is_coated())
}

/// Rows as [`rows`] has them, with or without a coat by the number of the tile.
pub(super) fn rows_of(tiles: u32, is_metallic: bool, is_coated: impl Fn(u32) -> bool) -> (AtlasLayout, Image) {
    let of_set = tables_with(&AtlasLayout { tiles, ..plain_layout() });
    let layout = of_set.into_iter().find(|table| table.kind == TableKind::Lobes).unwrap().layout;
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    for (tile, x) in (0..layout.tiles).flat_map(|tile| (0..width).map(move |x| (tile, x))) {
        let c = layout.x.node(((x % layout.row_size()).max(1) - 1).min(layout.x.size - 1));
        let (k, y) = (f64::from(tile) / 7.0, layout.origin(tile)[1]);
        let is_coated = is_coated(tile);
        let part: [f64; 4] = match x / layout.row_size() {
            // Light of several facets of the dielectric, and the slope of one facet, or energies of one visit.
            2 if is_metallic && !is_coated => [0.02 + 0.02 * k, 0.5, 0.2, 0.3 - 0.2 * c],
            2 if is_metallic => [0.2 + 0.1 * c, 0.3 + 0.1 * k, 0.25, 0.3 - 0.2 * c],
            2 => [0.2, 0.2 + 0.1 * c, 0.3 + 0.1 * k, 0.3 - 0.2 * c],
            3 => [0.02 + 0.02 * k, 0.15, 0.25, 0.3 + 0.2 * c],
            4 => [1.2 - 0.2 * c, 0.8, 0.9 + 0.2 * k, 0.7 + 0.1 * k],
            5 if !is_metallic => [0.94 - 0.02 * k, 0.9, 0.8 + 0.02 * c, 0.8],
            5 => [if is_coated { 0.94 - 0.02 * k } else { 0.01 + 0.02 * k }, 0.02 * c, 0.8 + 0.1 * k, 0.9 - 0.1 * c],
            6 if !is_metallic => [0.4 + 0.1 * k, 0.3 - 0.2 * k, 0.1 * c, 0.8],
            6 => [0.4 + 0.1 * k, 0.3 - 0.2 * k, 0.1 * c, 0.2 + 0.1 * k],
            7 if !is_metallic => [0.1, 0.2 - 0.1 * k, 0.2, 2.0 + 0.2 * c],
            // Lengths, or the squared sines at which facets are seen.
            7 => [1.4, 0.5 + 0.2 * c, if is_coated { 2.5 } else { 0.5 }, if is_coated { 3.0 + k } else { 0.1 * k }],
            8 if !is_metallic => [0.3, 0.2 + 0.1 * k, 0.25, 2.2 + 0.1 * k],
            // What an edge tint takes, or the squared sines at which light meets a film below a coat.
            8 => [0.15 + 0.1 * k, 0.05 + 0.03 * c, 0.2, 0.4],
            9 if !is_metallic => [1.5, 0.0, 0.0, 0.0],
            9 => [0.5 + 0.2 * c, 0.4, 0.3 + 0.1 * k, 1.5],
            // Shares over their estimates, or the light of a base of other materials.
            1 => [0.9 + 0.05 * k, 0.8 + 0.1 * c, 0.3 - 0.2 * k, 0.1],
            // Those of other materials, before the first.
            _ => [0.4 + 0.1 * k, 0.02, 0.3 - 0.2 * k, 0.1],
        };
        image.texel_mut(x, y).copy_from_slice(&part.map(|value| value as f32));
    }
    (layout, image)
}

/// The layout of rows of a family beside rows of two lobes with the light of a base.
fn plain_layout() -> AtlasLayout {
    let layout = crate::scenes::tables().into_iter().find(|table| table.kind == TableKind::Lobes).unwrap().layout;
    let y = layout.y.clone().map(|y| Axis { min: -2.0, max: 7.0, size: 10, ..y });
    AtlasLayout { y, ..layout }
}

/// Share of the light of a diffuse base that layers send back to it, and its steepness over the roots of both slope parameters.
const SENT_BACK: [f64; 3] = [0.5, -0.1, 0.05];

/// The axes of a family.
pub(super) fn family(interface: usize, is_metallic: bool, nodes: [u32; 2]) -> Family {
    let [coat, base] = [0, 1].map(|i: usize| {
        let [least, most] = RANGES[i];
        SlopeAxis { least: if nodes[i] > 1 { least } else { most }, most, nodes: nodes[i] as usize }
    });
    let coat = if interface > 0 { coat } else { SlopeAxis { least: 0.0, most: 0.0, nodes: 1 } };
    let [least, by_coat, by_base] = SENT_BACK;
    let by_coat = if coat.nodes > 1 { by_coat } else { 0.0 };
    let sent_back = if is_metallic { [least, by_coat, by_base] } else { [0.0; 3] };
    let (is_tinted, has_lengths, has_tail) = (false, false, false);
    Family { coat, base, interface, is_metallic, is_tinted, has_lengths, has_tail, sent_back }
}

/// 1 over the tail of the lobes of a family.
fn inverse_tail(family: Family) -> f64 {
    if family.has_tail { 4.0 } else { 1.0 }
}

/// A material of a family: a coat over a base with an F0 over a diffuse one; without the coat where the base is the first interface.
pub(super) fn material(family: Family) -> MaterialEntry {
    let given = set("lobes").swap_remove(0);
    let Family { coat, base, interface, is_metallic, is_tinted, has_lengths, has_tail, sent_back } = family;
    let axis = |SlopeAxis { least, most, nodes }| SlopesRecord { least, most, nodes: nodes as u32 };
    let record = FamilyRecord {
        coat: (interface > 0).then(|| axis(coat)),
        base: axis(base),
        interface: interface as u32,
        is_metallic,
        is_tinted,
        has_tail,
        sent_back,
        has_lengths,
    };
    let first = LayerRecord {
        alpha: ALPHAS[0],
        alpha_xy: [ALPHAS[0]; 2],
        optical_depth: DEPTH,
        tiles: given.layers[0].tiles.with([(TableKind::Lobes, Some(FIRST)), (TableKind::Distribution, None)]),
        ..given.layers[0].clone()
    };
    let second = LayerRecord {
        kind: LayerKind::Dielectric,
        alpha: ALPHAS[1],
        alpha_xy: [ALPHAS[1]; 2],
        eta: INDEX,
        f0: Some(F0),
        metal_f82_tint: is_tinted.then_some(TINT),
        ior_n: F0,
        ior_k: [-1.0; 3],
        tiles: if interface == 0 { first.tiles } else { Tiles::default() },
        ..LayerRecord::default()
    };
    let last = LayerRecord { kind: LayerKind::Diffuse, albedo: ALBEDO, ..LayerRecord::default() };
    let layers = if interface > 0 { vec![first, second, last] } else { vec![second, last] };
    let falloff = [0.6, 0.3];
    let lobes = LobesRecord {
        index: 1.4,
        falloff,
        integral: 0.8,
        critical_cot_sq: 0.0,
        critical_width: 0.0,
        critical_plain_share: 0.0,
        lobes: 2,
        inverse_tails: [inverse_tail(family); 2],
        rise: None,
        short: None,
        reflectance: None,
        varying: Some(VaryingRecord {
            factor: VaryingFactor::Family,
            tiles: family.nodes() as u32,
            least_spread: 1.0,
            factors: None,
            family: Some(record),
        }),
        axes: None,
        // By hand: 2 / 42 and 2 / 12.
        painted: Some(PaintedRecord { albedo: ALBEDO, moments: Some([1.0 / 21.0, 1.0 / 6.0]) }),
        error: None,
    };
    let map = |slot, layer| MapEntry {
        slot,
        layer: Some(layer),
        source: String::new(),
        file: FileEntry::default(),
        width: 1,
        height: 1,
        factor: None,
        srgb: false,
        transform: None,
    };
    let mut maps = vec![map(MapSlot::Alpha, interface as u32)];
    if interface > 0 {
        maps.push(map(MapSlot::Alpha, 0));
    }
    if is_metallic {
        maps.push(map(MapSlot::Metallic, interface as u32));
    } else {
        maps.push(map(MapSlot::Albedo, interface as u32 + 1));
    }
    let constants = MaterialConstants { lobes: Some(lobes), ..MaterialConstants::default() };
    MaterialEntry { layers, constants, maps, ..given }
}

/// A material with other slope parameters along tangents, turned, and with maps of these and of directions.
fn brushed(mut given: MaterialEntry) -> MaterialEntry {
    let count = given.layers.len() - 1;
    for (number, layer) in given.layers[..count].iter_mut().enumerate() {
        layer.alpha_xy = BRUSHED.map(|factor| layer.alpha * factor);
        layer.rotation = TURNS[number];
        let map = MapEntry { layer: Some(number as u32), ..given.maps[0].clone() };
        given.maps.extend([MapSlot::AlphaX, MapSlot::Tangent].map(|slot| MapEntry { slot, ..map.clone() }));
    }
    given
}

/// A material whose base has a film, below a coat or not.
fn filmed(mut given: MaterialEntry, family: Family) -> MaterialEntry {
    let base = &mut given.layers[family.interface];
    (base.film_ior_n, base.film_thickness_waves) = ([FILM_IOR; 3], FILM_WAVES);
    (base.film_thickness_nm, base.film_thickness_max_nm) = (400.0, 500.0);
    base.tiles[TableKind::Phase] = Some(0);
    if !family.is_coated() {
        base.tiles[TableKind::Fresnel] = None;
    }
    given
}

/// The film of the tests: its index, its thickness in waves, and the interference of every echo of it.
const FILM_IOR: f64 = 0.9;
const FILM_WAVES: Rgb = [0.5, 0.7, 0.9];
const ECHOES: Rgb = [0.6, -0.4, 1.1];

/// Reflectance of the film over an F0 where it is this many times as thick.
fn of_film(f0: Rgb, factor: f64, cos_theta: f64, spread: f64) -> Rgb {
    let film = FilmOverF0 { ior: FILM_IOR, waves: FILM_WAVES.map(|waves| 2.0 * FILM_IOR * waves * factor) };
    film.reflectance(f0, cos_theta, spread, |_| ECHOES)
}

/// A material whose dielectric has another F0, with or without a map of it.
fn with_f0(mut given: MaterialEntry, has_map: bool) -> MaterialEntry {
    let interface = given.layers.len() - 2;
    (given.layers[interface].f0, given.layers[interface].ior_n) = (Some(OTHER_F0), OTHER_F0);
    if has_map {
        given.maps.push(MapEntry { slot: MapSlot::F0, layer: Some(interface as u32), ..given.maps[0].clone() });
    }
    given
}

/// Index of the dielectric over that above.
const INDEX: f64 = 1.5;

/// Edge tint of a metal.
const TINT: [f64; 3] = [0.2, 0.6, 0.9];

/// Slope parameters along tangent and bitangent, over their mean, and the angles of the tangents of coat and base.
const BRUSHED: [f64; 2] = [1.6, 0.4];
const TURNS: [f64; 2] = [0.4, 2.0];

/// The row of a family at places among its nodes, read as the formulas say.
fn row(layout: &AtlasLayout, image: &Image, family: Family, alphas: [f64; 2], cos_theta: f64) -> Row {
    let [coat, base] = family.places(alphas);
    let part = |part: i32| {
        let read = |i: usize, j: usize| {
            let tile = FIRST as usize + i.min(family.coat.nodes - 1) * family.base.nodes + j.min(family.base.nodes - 1);
            bilinear(image, layout.position(tile as u32, [cos_theta, f64::from(part)]), WeightBits::Exact)
        };
        let mix = |a: [f64; 4], b: [f64; 4], t: f64| [0, 1, 2, 3].map(|c: usize| a[c] + t * (b[c] - a[c]));
        let (i, j) = (coat as usize, base as usize);
        let [low, high] = [i, i + 1].map(|i| mix(read(i, j), read(i, j + 1), base.fract()));
        mix(low, high, coat.fract())
    };
    let first = family.first_part();
    family.of_parts(first, &(first..8).map(part).collect::<Vec<_>>(), 1.0 / inverse_tail(family))
}

/// Light of facets that reflect all of it, once.
fn facets(light: DVec3, eye: DVec3, alpha: f64) -> f64 {
    let (distribution, half) = (LayerRecord::default().distribution, (light + eye).normalize());
    let d = microfacet::distribution(distribution, alpha, half.z, half.x * half.x + half.y * half.y);
    let lambda = |w: DVec3| microfacet::lambda(distribution, alpha, w.z);
    d / (4.0 * eye.z * (1.0 + lambda(light) + lambda(eye)))
}

/// Light and albedo of places, whatever varies: slope parameters of both axes, colours, metal, thickness, and the variance of normals.
#[test]
fn rows_of_a_family_are_those_of_the_formulas() {
    let surface = [FunctionGroup::Surface, FunctionGroup::Albedo, FunctionGroup::Sample];
    let plain = set("lobes-place").swap_remove(0);
    for (number, (family, groups, others)) in [
        (family(1, true, NODES), &surface[1..], vec![]),
        (family(1, true, NODES), &surface[..], vec![plain.clone()]),
        (family(1, false, NODES), &surface[..], vec![]),
        (family(1, true, [1, 3]), &surface[1..], vec![]),
        (family(1, true, [2, 1]), &surface[1..], vec![material(family(1, false, NODES))]),
        (family(0, true, [1, 3]), &surface[1..], vec![]),
        (family(0, true, [1, 3]), &surface[1..], vec![plain.clone(), material(family(1, true, NODES))]),
        (family(1, true, NODES).tinted(true), &surface[1..], vec![]),
        (family(0, true, [1, 3]).tinted(true), &surface[1..], vec![material(family(1, true, NODES))]),
        (Family { has_tail: true, ..family(1, true, NODES) }, &surface[1..], vec![]),
        (Family { has_tail: true, ..family(1, false, NODES) }, &surface[1..], vec![material(family(1, true, NODES))]),
        // From here on slope parameters differ along tangents.
        (family(1, true, NODES), &surface[1..], vec![]),
        (family(1, false, NODES), &surface[..], vec![plain.clone(), material(family(1, false, NODES))]),
        (family(0, false, [1, 3]), &surface[1..], vec![]),
        // And here a film lies on the base.
        (family(0, true, [1, 3]), &surface[1..], vec![]),
        (family(0, true, [1, 3]), &surface[1..], vec![plain.clone(), material(family(0, true, [1, 3]))]),
        // Or on one below a coat.
        (family(1, true, NODES), &surface[1..], vec![]),
        (
            family(1, true, NODES),
            &surface[1..],
            vec![plain.clone(), filmed(material(family(0, true, [1, 3])), family(0, true, [1, 3]))],
        ),
        // From here on the dielectric has another F0, by the file, and then at each place.
        (family(0, true, [1, 3]), &surface[1..], vec![]),
        (family(1, true, NODES), &surface[1..], vec![material(family(0, true, [1, 3]))]),
        (
            family(0, true, [1, 3]).tinted(true),
            &surface[1..],
            vec![filmed(material(family(0, true, [1, 3])), family(0, true, [1, 3]))],
        ),
        (family(1, true, NODES), &surface[1..], vec![plain.clone()]),
        // And a base that keeps its colours lies below a slab that varies.
        (family(1, false, NODES).below_varied_slab(true), &surface[..], vec![plain.clone()]),
        (family(1, false, NODES).below_varied_slab(true), &surface[1..], vec![material(family(1, true, NODES))]),
        // And coats have the one slope parameter of their layer, which shaders then take from there.
        (family(1, true, [1, 3]), &surface[1..], vec![]),
        (family(1, false, [1, 3]), &surface[..], vec![plain.clone()]),
        (family(1, true, [1, 3]), &surface[1..], vec![material(family(0, true, [1, 3]))]),
    ]
    .into_iter()
    .enumerate()
    {
        let (is_brushed, is_filmed, is_other) =
            ((11..14).contains(&number), (14..18).contains(&number), (18..22).contains(&number));
        let nominal = if is_other { OTHER_F0 } else { F0 };
        let first = match (is_brushed, is_filmed) {
            (true, _) => brushed(material(family)),
            (_, true) => filmed(material(family), family),
            _ if is_other => with_f0(material(family), number >= 18),
            _ => material(family),
        };
        let mut materials: Vec<MaterialEntry> = [first].into_iter().chain(others).collect();
        for (number, material) in materials.iter_mut().enumerate() {
            material.name = format!("m{number}");
        }
        if number >= 24 {
            materials[0].layers[0].alpha = family.coat.most;
        }
        let (layout, image) = rows(family);
        let tables = tables_with(&layout);
        let set = MaterialSet { functions: groups.iter().copied().collect(), ..MaterialSet::new(&materials, tables) };
        let text = in_all_languages(&set);
        // A first interface that is a coat is black. Without one it has the nominal F0 at all angles, and so that of the place.
        let mut reflected = Image::zeros(3, 3, 4);
        let has_facets = !family.is_coated() && family.is_metallic;
        if has_facets {
            reflected.data = [nominal[0], nominal[1], nominal[2], 0.0].map(|x| x as f32).repeat(9);
        }
        let of_phase = tables_with(&layout).into_iter().find(|table| table.kind == TableKind::Phase).unwrap();
        let [width, height] = of_phase.layout.size();
        let mut echoes = Image::zeros(width, height, 4);
        echoes.data = [ECHOES[0], ECHOES[1], ECHOES[2], 0.0].map(|x| x as f32).repeat((width * height) as usize);
        let textures = [
            ("luthier_fresnel", reflected.clone()),
            ("luthier_distribution", reflected),
            ("luthier_lobes", image.clone()),
            ("luthier_phase", echoes),
        ];
        let textures = BTreeMap::from(textures.map(|(name, image)| (name.to_owned(), image)));
        if number >= 24 {
            assert!(!text.contains("coat_axis"), "{text}");
        }
        let machine = Machine::new(&text, &material_buffer(&materials), textures);
        let neutral = machine.call("luthier_place", Vec::new());
        let member = |name: &str| {
            let place = text.split("struct LuthierPlace {").nth(1).unwrap();
            let names = place.lines().filter_map(|line| line.trim().strip_suffix(',')?.split_once(": "));
            names.map(|(name, _)| name).position(|known| known == name)
        };
        let own_member = |name: &str| {
            let place = text.split("struct LuthierLayerPlace {").nth(1).unwrap();
            let names = place.lines().filter_map(|line| line.trim().strip_suffix(',')?.split_once(": "));
            names.map(|(name, _)| name).position(|known| known == name)
        };
        let axis = ViewAxis::new(2, Critical::default());
        let mut frame = Frame {
            base: Some(Painted { albedo: ALBEDO, is_lambertian: true }),
            ..Frame::new(1.4, Wide::new([0.6, 0.3], axis))
        };
        let mut brightest = 0.0_f64;
        for (k, (wi, wo)) in directions(160).enumerate() {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            // Below the ranges, in them, at a node and above them.
            let share = |step: f64| (0.003 + k as f64 * step).fract() as f32;
            let (own, factor, slab) =
                ([share(0.37).max(1e-3), share(0.61).max(1e-3)], 1.0 - 0.5 * share(0.29), share(0.43));
            let (color, metal) = ([share(0.17), share(0.23), share(0.31)], share(0.71));
            let mut place = neutral.clone();
            let mut depth = DEPTH.map(|depth| depth * f64::from(slab));
            let mut variance = 0.0;
            let members = place.members_mut();
            members[member("alpha_factor").unwrap()] = Value::F(factor);
            members[member("slab_factor").unwrap()] = Value::F(slab);
            let thickness = 0.6 + 0.7 * share(0.19);
            if is_filmed {
                members[member("film_factor").unwrap()] = Value::F(thickness);
            }
            if let Some(number) = member("slope_variance") {
                variance = f64::from(0.02 * share(0.13));
                members[number] = Value::F(variance as f32);
            }
            let layers = members[member("layers").unwrap()].members_mut();
            let interfaces = if family.is_coated() { vec![(0, own[0]), (1, own[1])] } else { vec![(0, own[1])] };
            for &(number, factor) in &interfaces {
                let factors = if is_brushed { [factor * factor, 1.0] } else { [factor; 2] };
                layers[number].members_mut()[own_member("alpha_factors").unwrap()] = vector(&factors);
            }
            let turn = 6.0 * share(0.53);
            if let Some(member) = own_member("tangent") {
                let vector = vector(&[turn.cos(), turn.sin()]);
                layers.iter_mut().for_each(|own| own.members_mut()[member] = vector.clone());
            }
            let wide = color.map(f64::from);
            let tint = if family.is_tinted { TINT } else { [1.0; 3] };
            let mut dielectric = nominal;
            if is_other && number >= 18 {
                let f0 = [share(0.41), 0.9 * share(0.47), 0.0];
                dielectric = f0.map(f64::from);
                place = machine.call("luthier_f0_place", vec![place, Value::U(0), vector(&f0)]);
            }
            let mix = Mix { metal: wide, tint, dielectric, matt: wide, metallic: metal.into() };
            if family.is_metallic {
                let arguments = vec![place, Value::U(0), vector(&color), Value::F(metal)];
                place = machine.call("luthier_metallic_place", arguments);
            } else {
                place.members_mut()[member("base_color").unwrap()] = vector(&color);
            }
            let mut alphas = [0, 1].map(|i: usize| ALPHAS[i] * f64::from(own[i]) * f64::from(factor));
            if !family.is_coated() {
                (alphas[0], depth) = (0.0, [0.0; 3]);
            }
            if is_brushed {
                let slopes = [0, 1].map(|i: usize| {
                    let (along, angle) =
                        (ALPHAS[i] * f64::from(factor), TURNS[i.min(family.interface)] + f64::from(turn));
                    let own = f64::from(own[i]);
                    Slopes {
                        along: [along * BRUSHED[0] * own * own, along * BRUSHED[1]],
                        turn: [libm::cos(angle), libm::sin(angle)],
                    }
                });
                alphas = slopes.map(Slopes::mean);
                frame.stretch = family.stretch(slopes);
            }
            let row = row(&layout, &image, family, alphas, eye.z);
            let plain = Paint {
                metal: [0.0; 3],
                tint: [1.0; 3],
                metallic: 0.0,
                dielectric,
                index: INDEX,
                albedo: wide,
                depth,
                film_factor: 1.0,
            };
            let paint = if family.is_metallic { plain.mixed(mix) } else { plain };
            let film_factor = f64::from(thickness);
            let film = is_filmed.then(|| {
                FilmLight::new(family, &row, FILM_IOR, |cos_theta, spread| {
                    [paint.metal, [0.04; 3]].map(|f0| of_film(f0, film_factor, cos_theta, spread))
                })
            });
            let here = family.row_in(&row, alphas, (&frame, eye.z), &paint, film.as_ref());
            let below = Below::new(frame, here, eye).widened(eye, variance);
            let facets = if !has_facets { 0.0 } else { facets(light, eye, alphas[1].clamp(0.001, 1.0)) };
            let expected = below.eval(light);
            let cos_theta_d = eye.dot((light + eye).normalize());
            let expected = [0, 1, 2].map(|c: usize| {
                let kept = mix.metallic * F82 { f0: wide[c], tint: tint[c] }.dip() * edge_dip(cos_theta_d);
                let plain = (dielectric[c] + mix.metallic * (wide[c] - dielectric[c]) - kept).max(0.0);
                let of_film = |f0: Rgb| of_film(f0, film_factor, cos_theta_d.min(1.0), 0.0)[c];
                let filmed = || mix.metallic * of_film(wide) + (1.0 - mix.metallic) * of_film([0.04; 3]);
                expected[c] + facets * if is_filmed { filmed() } else { plain }
            });
            let arguments = vec![place, Value::U(0), vector(&wo.map(|w| w as f32))];
            let prepared = machine.call("luthier_prepare_lobes", arguments);
            let found =
                machine.call("luthier_light_lobes", vec![prepared.clone(), vector(&wi.map(|w| w as f32))]).floats();
            let stated = machine.call("luthier_albedo_lobes", vec![prepared]).floats();
            for c in 0..3 {
                // A film reflects more than an F0 of 0.04, of facets whose light far from the mirror direction has few digits.
                let floor = if is_filmed { 0.1 } else { 0.03 };
                let error = (f64::from(found[c]) - expected[c]).abs() / expected[c].abs().max(floor);
                // Widths of brushed lobes differ by up to 160 times: their matrices are nearly singular in single precision.
                let limit = if is_brushed { 1e-3 } else { 3e-4 };
                assert!(error < limit, "{family:?} {k} {wi:?} {wo:?}: {found:?} {expected:?}");
                let error = (f64::from(stated[c]) - below.row().albedo_dir[c]).abs();
                assert!(error < 2e-5, "{family:?} {k} {wo:?}: {stated:?} {:?}", below.row().albedo_dir);
                assert!(stated[c] <= 1.000_01 || !family.is_metallic, "{stated:?}");
                brightest = brightest.max(expected[c]);
            }
        }
        assert!(brightest > 0.1, "{brightest}");
    }
}

/// An anisotropic base stretches lobes, where no map turns it and the first interface is isotropic.
#[test]
fn an_anisotropic_base_alone_stretches_lobes() {
    let family = family(1, false, NODES);
    let (layout, _) = rows(family);
    let mut given = material(family);
    let text = |given: &MaterialEntry| {
        let materials = std::slice::from_ref(given);
        in_all_languages(&MaterialSet::new(materials, tables_with(&layout)))
    };
    assert!(!text(&given).contains("luthier_family_stretched"));
    given.layers[1].alpha_xy = [0.9, 0.3];
    assert!(text(&given).contains("luthier_family_stretched"));
}

/// Below a coat the F0 of a place is in no facets: a layer's place still has its member, where maps of colours and metal are all maps. WGSL has no empty
/// structures, which the emitter did not come to an end with.
#[test]
fn colours_below_a_coat_are_a_place_of_their_own() {
    let family = family(1, true, NODES);
    let (layout, _) = rows(family);
    let mut given = material(family);
    let text = |given: &MaterialEntry| {
        let materials = std::slice::from_ref(given);
        in_all_languages(&MaterialSet::new(materials, tables_with(&layout)))
    };
    given.maps.retain(|map| map.slot == MapSlot::Metallic);
    let below = text(&given);
    assert!(below.contains("fn luthier_metallic_place") && !below.contains("layer.passing = own.passing"), "{below}");
    let first = self::family(0, true, NODES);
    let mut bare = material(first);
    bare.maps.retain(|map| map.slot == MapSlot::Metallic);
    assert!(text(&bare).contains("layer.passing = own.passing"));
}

/// Drawn directions at places of a family: the mean of their weights is the integral of the light by a midpoint rule, and densities sum to at most 1.
#[test]
fn directions_of_a_family_are_drawn_as_their_density_says() {
    let family = family(1, true, NODES);
    let (layout, image) = rows(family);
    let materials = [material(family)];
    let functions = [FunctionGroup::Sample, FunctionGroup::Albedo].into_iter().collect();
    let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables_with(&layout)) };
    let text = in_all_languages(&set);
    let black = Image::zeros(3, 3, 3);
    let textures = [("luthier_fresnel", black.clone()), ("luthier_distribution", black), ("luthier_lobes", image)];
    let textures = BTreeMap::from(textures.map(|(name, image)| (name.to_owned(), image)));
    let machine = Machine::new(&text, &material_buffer(&materials), textures);
    let neutral = machine.call("luthier_place", Vec::new());
    for (color, metal, theta) in [([0.9, 0.6, 0.2], 1.0, 0.3_f64), ([0.8, 0.3, 0.1], 0.0, 0.9), ([0.9; 3], 0.5, 1.2)] {
        let arguments = vec![neutral.clone(), Value::U(0), vector(&color), Value::F(metal)];
        let place = machine.call("luthier_metallic_place", arguments);
        let wo = [theta.sin() * 0.8, theta.sin() * 0.6, theta.cos()].map(|w| w as f32);
        let prepared = machine.call("luthier_prepare_at", vec![place, Value::U(0), vector(&wo)]);
        drawn_as_the_density_says(&machine, &prepared, &format!("{color:?} {metal} {theta}"));
    }
}

/// Directions drawn of a prepared material. Oracle: the mean of their weights is the integral of the light by a midpoint rule, and densities sum to at most 1.
pub(super) fn drawn_as_the_density_says(machine: &Machine, prepared: &Value, words: &str) {
    const DRAWN: u32 = 16384;
    let call = |name: &str, arguments: &[f32]| machine.call(name, vec![prepared.clone(), vector(arguments)]);
    let mut mean = [0.0; 3];
    for i in 0..DRAWN {
        // Roberts 2018: multiples of the powers of the root of x^4 = x + 1.
        let u = [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|s: f64| ((f64::from(i) + 0.5) * s).fract() as f32);
        let drawn = call("luthier_sample", &u);
        let weight = drawn.members()[2].floats();
        if drawn.members()[1].floats()[0] > 0.0 {
            (0..3).for_each(|c| mean[c] += f64::from(weight[c]) / f64::from(DRAWN));
        }
    }
    let (rings, sectors) = (160, 160);
    let (mut whole, mut density) = ([0.0; 3], 0.0);
    for (i, j) in (0..rings).flat_map(|i| (0..sectors).map(move |j| (i, j))) {
        let (z, phi) = ((f64::from(i) + 0.5) / f64::from(rings), (f64::from(j) + 0.5) / f64::from(sectors));
        let (sin, angle) = ((1.0 - z * z).sqrt(), std::f64::consts::TAU * phi);
        let wi = [sin * angle.cos(), sin * angle.sin(), z].map(|w| w as f32);
        let solid_angle = std::f64::consts::TAU / f64::from(rings * sectors);
        let light = call("luthier_light", &wi).floats();
        (0..3).for_each(|c| whole[c] += f64::from(light[c]) * solid_angle);
        density += f64::from(call("luthier_pdf", &wi).floats()[0]) * solid_angle;
    }
    for c in 0..3 {
        assert!((mean[c] - whole[c]).abs() < 0.01, "{words}: {mean:?} {whole:?}");
    }
    assert!(density < 1.01, "{words}: {density}");
}
