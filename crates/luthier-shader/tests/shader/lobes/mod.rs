//! The shader of `lobes` against its f64 twin, on rows that no fit has made.

mod curve;
mod families;
mod forms;
mod normals;
mod one_width;
mod patina;
mod short;
mod sides;
mod three_lobes;

use std::collections::BTreeMap;

use glam::DVec3;
use luthier_layers::models::lobes::{Axes, Below, Critical, Frame, Painted, Row, ViewAxis, Wide};
use luthier_lut::{AtlasLayout, Axis, Image, TableKind, WeightBits, bilinear};
use luthier_manifest::{
    AxesRecord, FunctionGroup, LobesRecord, MapSlot, MaterialConstants, MaterialEntry, PaintedRecord, VaryingFactor,
    VaryingRecord, material_buffer,
};
use luthier_optics::microfacet;
use luthier_optics::stack::Distribution;
use luthier_shader::{Form, MaterialSet, ShaderError, TableFace, Target, emit};

use self::patina::covered_rows;
use self::three_lobes::rows_of_three;
use crate::arithmetic::directions;
use crate::features::with_map;
use crate::machine::{Machine, Value, vector};
use crate::scenes::{sets, tables};

/// Rows that change with the view in every part.
fn rows() -> (AtlasLayout, Image) {
    let layout = tables().into_iter().find(|t| t.kind == TableKind::Lobes).unwrap().layout;
    let image = of_parts(&layout, |c| {
        [
            [0.3 * c, 0.2, 0.1, 0.0],
            [0.5, 0.4 + 0.1 * c, 0.3, 0.3 - 0.2 * c],
            [0.1, 0.2, 0.2 + 0.3 * c, -0.1],
            [8.0 + c, 12.0 - c, 0.5 + c, 0.7],
            [1.0, 0.9, 40.0, 0.8],
            [0.9, 0.8, 0.7, 0.0],
        ]
    });
    (layout, image)
}

/// One tile of rows whose parts are functions of the cosine, the first and the last node repeated.
fn of_parts<const N: usize>(layout: &AtlasLayout, parts_of: impl Fn(f64) -> [[f64; 4]; N]) -> Image {
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    let across = layout.row_size();
    for i in 0..across {
        let parts = parts_of(layout.x.node((i.max(1) - 1).min(layout.x.size - 1)));
        for (j, part) in (0..).zip(parts) {
            image.texel_mut(j * across + i, 0).copy_from_slice(&part.map(|value| value as f32));
        }
    }
    image
}

/// [`rows`] with the light of a base before them.
fn rows_over_base() -> (AtlasLayout, Image) {
    let (without, of_rows) = rows();
    let y = without.y.clone().map(|y| Axis { min: -2.0, size: 8, ..y });
    let layout = AtlasLayout { y, ..without };
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    let across = layout.row_size();
    for i in 0..across {
        let c = layout.x.node((i.max(1) - 1).min(layout.x.size - 1));
        for (j, part) in (0..).zip([[0.4, 0.3 - 0.1 * c, 0.2, 0.1], [0.25 * c, 0.16, 0.1, 0.3 + 0.2 * c]]) {
            image.texel_mut(j * across + i, 0).copy_from_slice(&part.map(|value| value as f32));
        }
        for j in 2..8 {
            let part = of_rows.texel((j - 2) * across + i, 0).to_vec();
            image.texel_mut(j * across + i, 0).copy_from_slice(&part);
        }
    }
    (layout, image)
}

pub(crate) fn set(name: &str) -> Vec<MaterialEntry> {
    sets().into_iter().find(|(known, _)| *known == name).unwrap().1
}

/// The WGSL of a set, whose shader exists in every language.
fn in_all_languages(set: &MaterialSet<'_>) -> String {
    for target in Target::ALL.into_iter().filter(|target| *target != Target::SpirV) {
        emit(set, Form::Baked, target).unwrap_or_else(|error| panic!("{}: {error}", target.name()));
    }
    emit(set, Form::Baked, Target::Wgsl).unwrap()
}

/// A shader of materials whose first facets are black, with rows of lobes.
fn lit_from_below(text: &str, materials: &[MaterialEntry], rows: &Image) -> Machine {
    let black = Image::zeros(3, 3, 3);
    let textures =
        [("luthier_fresnel", black.clone()), ("luthier_distribution", black), ("luthier_lobes", rows.clone())];
    Machine::new(text, &material_buffer(materials), textures.map(|(name, image)| (name.to_owned(), image)).into())
}

/// Light from below of the first material, in two steps: light and eye, and what they give.
fn assert_light(machine: &Machine, directions: [[f64; 3]; 2], expected: [f64; 3], name: &str) {
    assert_light_of(0, machine, directions, expected, name);
}

/// [`assert_light`] for a material by number.
fn assert_light_of(number: u32, machine: &Machine, [wi, wo]: [[f64; 3]; 2], expected: [f64; 3], name: &str) {
    let prepared = machine.call("luthier_prepare_lobes", vec![Value::U(number), vector(&wo.map(|w| w as f32))]);
    let found = machine.call("luthier_light_lobes", vec![prepared, vector(&wi.map(|w| w as f32))]).floats();
    for (found, expected) in found.iter().zip(expected) {
        let error = (f64::from(*found) - expected).abs() / expected.abs().max(0.03);
        assert!(error < 1e-4, "{name} {wi:?} {wo:?}: {found} {expected}");
    }
}

/// The light below as the twin has it, and as the function of the shader has it.
#[test]
fn light_from_below_is_that_of_the_twin() {
    let (layout, image) = rows();
    for (name, cot_sq, width) in [("lobes", 0.0, 0.0), ("lobes-inward", 0.0, 0.0), ("lobes-inward", 1.25, 0.02)] {
        let mut materials = set(name);
        let lobes = LobesRecord {
            index: 1.4,
            falloff: [0.6, 0.3],
            integral: 1.0,
            critical_cot_sq: cot_sq,
            critical_width: width,
            critical_plain_share: 0.25,
            lobes: 2,
            inverse_tails: [1.0, 40.0],
            rise: None,
            short: None,
            reflectance: None,
            varying: None,
            axes: None,
            painted: None,
            error: None,
        };
        let axis = ViewAxis::new(2, Critical { cot_sq, width, plain_share: 0.25 });
        let wide = Wide::new(lobes.falloff, axis);
        materials[0].constants.lobes = Some(LobesRecord { integral: wide.integral(), ..lobes });
        let set = MaterialSet::new(&materials, tables());
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        let machine = lit_from_below(&text, &materials, &image);
        let mut brightest = 0.0_f64;
        for (wi, wo) in directions(300) {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            let part = |part: u32| {
                let at = layout.position(0, [axis.cosine(eye.z), f64::from(part)]);
                bilinear(&image, at, WeightBits::Exact)
            };
            let row = Row::of_parts(&(0..6).map(part).collect::<Vec<_>>(), false);
            let expected = Below::new(Frame::new(1.4f32.into(), wide), row, eye).eval(light);
            assert_light(&machine, [wi, wo], expected, name);
            brightest = expected.into_iter().fold(brightest, f64::max);
        }
        assert!(brightest > 1.0, "{name}: {brightest}");
    }
}

/// A factor of the place mixes the rows of two tiles, and widens lobes; tiles beyond those of the material are another's.
#[test]
fn rows_over_a_factor_are_those_of_the_twin() {
    let (one, _) = rows();
    let layout = AtlasLayout { tiles: 5, ..one };
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    for tile in 0..5 {
        let [_, y] = layout.origin(tile);
        for x in 0..width {
            let (part, k) = (x / layout.row_size(), f64::from(tile));
            let texel = match part {
                // Shapes and strengths of the first lobe; the second has no light.
                1 => [0.5 + 0.1 * k, 0.4, 0.3 * k, 0.2 + 0.05 * k],
                2 => [6.0 + k, 9.0 - k, 2.0 + k, 0.9],
                4 => [1.0, 1.0, 1.0, 1.0],
                _ => [0.1 * k, 0.2, 0.3, 0.0],
            };
            image.texel_mut(x, y).copy_from_slice(&texel.map(|value| value as f32));
        }
    }
    let film = Some([1.2, 0.2]);
    for (factor, member, first, factors, tint) in [
        (VaryingFactor::AlphaFactor, 0, 1, None, None),
        (VaryingFactor::SlabFactor, 1, 0, None, None),
        (VaryingFactor::SlabFactor, 1, 0, None, Some([0.81, 0.25, 0.49])),
        (VaryingFactor::FilmFactor, 2, 1, film, None),
    ] {
        let mut material = set("lobes-place")[0].clone();
        if tint.is_some() {
            material = with_map(material, MapSlot::Absorption, 0);
        }
        material.layers[0].tiles[TableKind::Lobes] = Some(first);
        let record = material.constants.lobes.as_mut().unwrap();
        let wide = Wide::new(record.falloff, ViewAxis::new(2, Critical::default()));
        record.integral = wide.integral();
        record.varying = Some(VaryingRecord { factor, tiles: 4, least_spread: 0.1, factors, family: None });
        let frame = Frame::new(record.index, wide);
        let materials = [material];
        let text = emit(&MaterialSet::new(&materials, tables_with(&layout)), Form::Baked, Target::Wgsl).unwrap();
        let machine = lit_from_below(&text, &materials, &image);
        let neutral = machine.call("luthier_place", Vec::new());
        // By hand: roots 1, .7, .41, 0; of four tiles, the last on slopes is that of 1/4. Films are at equal distances from 1.2 to .2.
        for (scale, over_alpha, over_slab, over_film) in [
            (1.0, 0.0, 0.0, 0.6),
            (0.49, 1.2, 0.9, 2.13),
            (0.1681, 2.36, 1.77, 3.0),
            (0.0025, 3.0, 2.85, 3.0),
            (0.0, 3.0, 3.0, 3.0),
        ] {
            let mut place = neutral.clone();
            place.members_mut()[1 + member] = Value::F(scale as f32);
            if let Some(tint) = tint {
                let layers = place.members_mut().last_mut().unwrap();
                layers.members_mut()[0].members_mut()[0] = vector(&tint.map(|factor: f64| factor as f32));
            }
            let (over, spread) = match member {
                0 => (over_alpha, f64::max(scale, 0.1)),
                1 => (over_slab, 1.0),
                _ => (over_film, 1.0),
            };
            // Each channel has a tile of its own, and shapes are those of their mean.
            let own_tiles = tint.map(|tint| tint.map(|tint: f64| 3.0 * (1.0 - (tint * scale).sqrt())));
            let tile = f64::from(first) + own_tiles.map_or(over, |tiles| tiles.iter().sum::<f64>() / 3.0);
            for (wi, wo) in directions(60) {
                let [light, eye] = [wi, wo].map(DVec3::from);
                if light.z <= 0.0 || eye.z <= 0.0 {
                    continue;
                }
                let row_at = |tile: f64| {
                    let low = (tile as u32).min(3);
                    let part = |part: u32| {
                        let read =
                            |tile| bilinear(&image, layout.position(tile, [eye.z, f64::from(part)]), WeightBits::Exact);
                        let (a, b, t) = (read(low), read(low + 1), tile - f64::from(low));
                        [0, 1, 2, 3].map(|i: usize| a[i] + t * (b[i] - a[i]))
                    };
                    Row::of_parts(&(0..6).map(part).collect::<Vec<_>>(), false)
                };
                let mut row = row_at(tile).spread(spread);
                for (c, own) in own_tiles.into_iter().flatten().map(row_at).enumerate() {
                    row.wide[c] = own.wide[c];
                    row.lobes.iter_mut().zip(&own.lobes).for_each(|(lobe, own)| lobe.strength[c] = own.strength[c]);
                }
                let expected = Below::new(frame, row, eye).eval(light);
                let arguments = vec![place.clone(), Value::U(0), vector(&wo.map(|w| w as f32))];
                let prepared = machine.call("luthier_prepare_lobes", arguments);
                let found = machine.call("luthier_light_lobes", vec![prepared, vector(&wi.map(|w| w as f32))]).floats();
                for (found, expected) in found.iter().zip(expected) {
                    let error = (f64::from(*found) - expected).abs() / expected.abs().max(0.03);
                    assert!(error < 3e-4, "{factor:?} {scale} {wi:?} {wo:?}: {found} {expected}");
                }
            }
        }
    }
}

/// Rows over the azimuth, which change with it in every part.
fn turned_rows() -> (AtlasLayout, Image) {
    let (one, _) = rows();
    let layout = AtlasLayout { tiles: 9, ..one };
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    for tile in 0..9 {
        let ([_, y], k) = (layout.origin(tile), f64::from(tile));
        for x in 0..width {
            let texel = match x / layout.row_size() {
                0 => [0.1, 0.2 + 0.02 * k, 0.3, 2.0 - 0.5 * k],
                1 => [0.5 + 0.1 * k, 0.4, 0.3, 0.02 + 0.005 * k],
                2 => [0.2, 0.1 * k, 0.3, -0.1],
                3 => [6.0 + k, 15.0 - k, 0.7, 0.9],
                4 => [2.0, 0.9, 40.0, 0.8],
                _ => [2.0, 2.0, 2.0, 0.3 - 0.1 * k],
            };
            image.texel_mut(x, y).copy_from_slice(&texel.map(|value| value as f32));
        }
    }
    (layout, image)
}

/// Tables whose lobes have a layout.
pub(crate) fn tables_with(layout: &AtlasLayout) -> Vec<TableFace> {
    let face = |table: TableFace| match table.kind {
        TableKind::Lobes => TableFace { layout: layout.clone(), ..table },
        _ => table,
    };
    tables().into_iter().map(face).collect()
}

/// Rows over the azimuth, with lobes in axes: of stacks that are their own mirror image and others; where normals vary in a pixel; and beside
/// a material whose lobes are in the plane of the eye.
#[test]
fn lobes_in_axes_are_those_of_the_twin() {
    let (layout, image) = turned_rows();
    for (name, number, is_mirrored, variance) in [
        ("lobes-axes", 0, true, 0.0),
        ("lobes-axes", 0, false, 0.0),
        ("lobes-axes", 0, true, 0.02),
        ("lobes-axes-mixed", 1, false, 0.0),
        ("lobes-axes-mixed", 0, false, 0.0),
    ] {
        let mut materials = set(name);
        let first = 1;
        for material in &mut materials {
            material.layers[0].tiles[TableKind::Lobes] = Some(first);
            let Some(record) = &mut material.constants.lobes else { continue };
            let wide = Wide::new(record.falloff, ViewAxis::new(2, Critical::default()));
            (record.index, record.integral) = (1.5, wide.integral());
            record.axes = record.axes.map(|axes| AxesRecord { is_mirrored, ..axes });
            // Materials with one tile take the decays of its rows from their record.
            let decays = bilinear(&image, layout.position(first, [0.0, 4.0]), WeightBits::Exact);
            record.inverse_tails = [decays[0], decays[2]];
        }
        let record = materials[number].constants.lobes.unwrap();
        let axes = record.axes.map(|AxesRecord { turn, is_mirrored, .. }| Axes { turn, is_mirrored });
        let wide = Wide::new(record.falloff, ViewAxis::new(2, Critical::default()));
        let frame = Frame { axes, ..Frame::new(record.index, wide) };
        let groups = if variance > 0.0 { &[FunctionGroup::Surface][..] } else { &[] };
        let set = MaterialSet {
            functions: groups.iter().copied().collect(),
            ..MaterialSet::new(&materials, tables_with(&layout))
        };
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        let machine = lit_from_below(&text, &materials, &image);
        let place = (variance > 0.0).then(|| {
            let mut place = machine.call("luthier_place", Vec::new());
            place.members_mut()[4] = Value::F(variance as f32);
            place
        });
        let mut brightest = 0.0_f64;
        for (wi, wo) in directions(300) {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            let row = |tile: usize| {
                let at = |part| layout.position(first + tile as u32, [eye.z, f64::from(part)]);
                Row::of_parts(
                    &(0..6).map(|part| bilinear(&image, at(part), WeightBits::Exact)).collect::<Vec<_>>(),
                    false,
                )
            };
            let row = axes.map_or_else(|| row(0), |axes| axes.row(eye, row));
            let expected = Below::new(frame, row, eye).widened(eye, variance).eval(light);
            let arguments = [Value::U(number as u32), vector(&wo.map(|w| w as f32))];
            let prepared = machine.call("luthier_prepare_lobes", place.iter().cloned().chain(arguments).collect());
            let found = machine.call("luthier_light_lobes", vec![prepared, vector(&wi.map(|w| w as f32))]).floats();
            for (found, expected) in found.iter().zip(expected) {
                let error = (f64::from(*found) - expected).abs() / expected.abs().max(0.03);
                assert!(error < 4e-4, "{name} {number} {is_mirrored} {wi:?} {wo:?}: {found} {expected}");
                brightest = brightest.max(expected);
            }
        }
        assert!(brightest > 1.0, "{name}: {brightest}");
    }
}

/// The normal of flakes shifts lobes, the variance of normals widens them, and the colour of a base has its light, as in the twin, whose own oracles
/// are a walk, a mean and paths (`luthier-layers/src/models/lobes/tests`).
#[test]
fn values_of_a_place_change_lobes_as_in_the_twin() {
    let surface = [FunctionGroup::Surface];
    for (name, groups, variance, is_lambertian) in
        [("lobes-flakes", &[][..], 0.0, false), ("lobes", &surface, 0.02, false), ("lobes", &surface, 0.0, true)]
    {
        let has_base = !groups.is_empty();
        let (layout, image) = if has_base { rows_over_base() } else { rows() };
        let given = set(name).swap_remove(0);
        let record = given.constants.lobes.unwrap();
        let frame = Frame {
            base: has_base.then_some(Painted { albedo: [0.3, 0.5, 0.7], is_lambertian }),
            ..Frame::new(record.index, Wide::new(record.falloff, ViewAxis::new(2, Critical::default())))
        };
        let painted = frame.base.map(|Painted { albedo, is_lambertian }| PaintedRecord {
            albedo,
            // By hand: 2 / 42 and 2 / 12.
            moments: is_lambertian.then_some([1.0 / 21.0, 1.0 / 6.0]),
        });
        let lobes = Some(LobesRecord { integral: frame.wide.integral(), painted, ..record });
        let materials =
            [MaterialEntry { constants: MaterialConstants { lobes, ..given.constants.clone() }, ..given.clone() }];
        let tables = tables_with(&layout);
        let set = MaterialSet { functions: groups.iter().copied().collect(), ..MaterialSet::new(&materials, tables) };
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        let machine = lit_from_below(&text, &materials, &image);
        let neutral = machine.call("luthier_place", Vec::new());
        let mut moved = 0.0_f64;
        for (k, (wi, wo)) in directions(300).enumerate() {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            let normal = DVec3::new(0.3, -0.2, 1.0 + 0.1 * k as f64).normalize().as_vec3();
            let mut place = neutral.clone();
            // After the normal and three factors.
            let color = [0.0, 0.6, 1.0].map(|x: f64| (x + 0.01 * k as f64) % 1.0);
            if has_base {
                place.members_mut()[4] = Value::F(variance as f32);
                place.members_mut()[5] = vector(&color.map(|x| x as f32));
            }
            *place.members_mut().last_mut().unwrap() = vector(&normal.to_array());
            let part = |part: i32| bilinear(&image, layout.position(0, [eye.z, f64::from(part)]), WeightBits::Exact);
            let parts: Vec<_> = (if has_base { -2 } else { 0 }..6).map(part).collect();
            let below = Below::new(frame, Row::of_parts(&parts, has_base), eye);
            let straight = below.eval(light);
            let there = below.widened(eye, variance).tilted(normal.as_dvec3(), given.layers[0].eta).over_base(color);
            let there = there.eval(light);
            let arguments = vec![place, Value::U(0), vector(&wo.map(|w| w as f32))];
            let prepared = machine.call("luthier_prepare_lobes", arguments);
            let found = machine.call("luthier_light_lobes", vec![prepared, vector(&wi.map(|w| w as f32))]).floats();
            for c in 0..3 {
                let error = (f64::from(found[c]) - there[c]).abs() / there[c].abs().max(0.03);
                assert!(error < 3e-4, "{name} {wi:?} {wo:?} {normal}: {found:?} {there:?}");
                moved = moved.max((there[c] - straight[c]).abs());
            }
        }
        assert!(moved > 0.1, "{name}: {moved}");
    }
}

/// Oracle: the closed forms of D and Lambda.
#[test]
fn the_first_facet_has_smith_s_masking() {
    let all = |width, height, value| Image {
        data: vec![value; (width * height * 4) as usize],
        ..Image::zeros(width, height, 4)
    };
    for distribution in [Distribution::Beckmann, Distribution::Ggx] {
        for alpha in [0.02, 0.3, 1.0] {
            let mut materials = set("lobes");
            let coat = &mut materials[0].layers[0];
            (coat.distribution, coat.alpha, coat.alpha_xy) = (distribution, alpha, [alpha; 2]);
            coat.tiles[TableKind::Distribution] = None;
            let set = MaterialSet::new(&materials, tables());
            let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
            let [width, height] = rows().0.size();
            let textures = [("luthier_fresnel", all(3, 3, 1.0)), ("luthier_lobes", all(width, height, 0.0))];
            let textures = BTreeMap::from(textures.map(|(name, image)| (name.to_owned(), image)));
            let machine = Machine::new(&text, &material_buffer(&materials), textures);
            for (wi, wo) in directions(200) {
                let [light, eye] = [wi, wo].map(DVec3::from);
                if light.z <= 0.0 || eye.z <= 0.0 {
                    continue;
                }
                let arguments = vec![Value::U(0), vector(&wi.map(|w| w as f32)), vector(&wo.map(|w| w as f32))];
                let found = f64::from(machine.call("luthier_eval", arguments).floats()[1]);
                let half = (light + eye).normalize();
                let d = microfacet::distribution(distribution, alpha, half.z, half.x * half.x + half.y * half.y);
                let lambda = |w: DVec3| microfacet::lambda(distribution, alpha, w.z);
                let expected = d / (4.0 * eye.z * (1.0 + lambda(light) + lambda(eye)));
                // Masking by two numbers that are within 2e-6, and f32 at the foot of narrow lobes.
                let error = (found - expected).abs() / expected.max(1e-3);
                assert!(error < 2e-5, "{distribution:?} {alpha} {wi:?} {wo:?}: {found} {expected}");
            }
        }
    }
}

#[test]
fn lobes_have_no_form_without_tables() {
    let materials = set("lobes-mixed");
    let set = MaterialSet::new(&materials, tables());
    let refusal = emit(&set, Form::Full, Target::Wgsl).unwrap_err();
    assert!(matches!(&refusal, ShaderError::NoForm { material, form: Form::Full, .. } if material == "brushed"));
    assert!(refusal.to_string().contains("ask for the `baked` form"), "{refusal}");
}

/// Rows without lobes have no code for any; rows of one have none for a second.
#[test]
fn sets_pay_for_the_lobes_that_rows_have() {
    let materials = set("lobes");
    for (parts, present, absent) in
        [(2, "", "slope_density"), (4, "first_shape", "second_shape"), (6, "second_shape", "$")]
    {
        let mut tables = tables();
        for table in tables.iter_mut().filter(|table| table.kind == TableKind::Lobes) {
            let y = table.layout.y.as_mut().unwrap();
            (y.size, y.max) = (parts, f64::from(parts - 1));
        }
        let text = emit(&MaterialSet::new(&materials, tables), Form::Baked, Target::Wgsl).unwrap();
        assert!(text.contains(present) && !text.contains(absent), "{parts}: {text}");
    }
}

/// Directions that were drawn fall into each bin of the hemisphere as often as the density says, and mean weights are the energy of what the
/// material reflects. Oracle: quadrature over the bins, by the midpoint rule.
#[test]
fn directions_are_drawn_as_their_density_says() {
    const DRAWN: u32 = 8192;
    const RINGS: usize = 6;
    const SECTORS: usize = 6;
    for (name, coat, axes, (layout, image)) in [
        ("lobes", [0.3; 2], None, rows()),
        ("lobes", [0.3; 2], None, rows_of_three()),
        ("lobes-inward", [0.2; 2], None, rows()),
        ("lobes-axes", [0.1, 0.4], Some(AxesRecord { turn: [0.6, 0.8], is_mirrored: false, tiles: 8 }), turned_rows()),
        ("lobes-patina", [0.3; 2], None, covered_rows()),
        ("lobes-patina-base", [0.3; 2], None, covered_rows()),
        ("lobes-weight", [0.3; 2], None, covered_rows()),
    ] {
        let mut materials = set(name);
        let varying = materials[0].constants.lobes.unwrap().varying;
        let lobes = LobesRecord {
            index: 1.4,
            falloff: [0.6, 0.3],
            integral: 0.8,
            critical_cot_sq: 0.0,
            critical_width: 0.0,
            critical_plain_share: 0.0,
            lobes: if layout.y.as_ref().unwrap().max == 7.0 { 3 } else { 2 },
            inverse_tails: [1.0, 40.0],
            rise: None,
            short: None,
            reflectance: None,
            varying,
            axes,
            painted: None,
            error: None,
        };
        materials[0].constants.lobes = Some(lobes);
        if let Some(bare) = materials[0].constants.bare_mut() {
            bare.tiles[TableKind::Distribution] = None;
        }
        if name == "lobes-weight" {
            // The last two of those rows.
            materials[0].layers[0].tiles[TableKind::Lobes] = Some(2);
        }
        let first = &mut materials[0].layers[0];
        (first.alpha, first.alpha_xy) = (libm::sqrt(coat[0] * coat[1]), coat);
        first.tiles[TableKind::Distribution] = None;
        let functions = [FunctionGroup::Sample].into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables_with(&layout)) };
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        let gray = Image { data: vec![0.1; 36], ..Image::zeros(3, 3, 4) };
        let textures = [("luthier_fresnel", gray), ("luthier_lobes", image.clone())];
        let machine =
            Machine::new(&text, &material_buffer(&materials), BTreeMap::from(textures.map(|(n, i)| (n.to_owned(), i))));
        for theta in [0.0, 0.7, 1.3_f64] {
            let wo = [theta.sin() * 0.8, theta.sin() * 0.6, theta.cos()].map(|w| w as f32);
            let prepared = match varying {
                None => machine.call("luthier_prepare", vec![Value::U(0), vector(&wo)]),
                Some(_) => {
                    let mut place = machine.call("luthier_place", vec![]);
                    *place.members_mut().last_mut().unwrap() = Value::F(0.4);
                    machine.call("luthier_prepare_at", vec![place, Value::U(0), vector(&wo)])
                }
            };
            let call =
                |function: &str, arguments: &[f32]| machine.call(function, vec![prepared.clone(), vector(arguments)]);
            let mut counts = [0.0; RINGS * SECTORS];
            let bin = |x: f64, y: f64, z: f64| {
                let ring = ((1.0 - z) * RINGS as f64) as usize;
                let turn = libm::atan2(y, x) / std::f64::consts::TAU;
                ring.min(RINGS - 1) * SECTORS + (((turn + 1.0) % 1.0) * SECTORS as f64) as usize % SECTORS
            };
            let (mut lost, mut weights, mut greatest) = (0.0, 0.0, 0.0_f64);
            for i in 0..DRAWN {
                // Roberts 2018: multiples of the powers of the root of x^4 = x + 1.
                let u = [0.819_172_5, 0.671_043_6, 0.549_700_5]
                    .map(|step: f64| ((f64::from(i) + 0.5) * step).fract() as f32);
                let drawn = call("luthier_sample", &u);
                let members = drawn.members();
                let (wi, pdf) = (members[0].floats(), members[1].floats()[0]);
                let weight = members[2].floats();
                if pdf == 0.0 {
                    lost += 1.0 / f64::from(DRAWN);
                    continue;
                }
                counts[bin(wi[0].into(), wi[1].into(), wi[2].into())] += 1.0 / f64::from(DRAWN);
                weights += f64::from(weight[1]) / f64::from(DRAWN);
                greatest = greatest.max(weight.iter().map(|&w| f64::from(w)).sum::<f64>() / 3.0);
            }
            let mut expected = [0.0; RINGS * SECTORS];
            let mut energy = 0.0;
            let side = [96, 96];
            for (i, j) in (0..side[0]).flat_map(|i| (0..side[1]).map(move |j| (i, j))) {
                let z = (f64::from(i) + 0.5) / f64::from(side[0]);
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(side[1]));
                let across = (1.0 - z * z).sqrt();
                let wi = [across * cos, across * sin, z];
                let area = std::f64::consts::TAU / f64::from(side[0] * side[1]);
                let at = wi.map(|w| w as f32);
                expected[bin(wi[0], wi[1], wi[2])] += area * f64::from(call("luthier_pdf", &at).floats()[0]);
                energy += area * f64::from(call("luthier_light", &at).floats()[1]);
            }
            for (i, (found, expected)) in counts.iter().zip(expected).enumerate() {
                assert!((found - expected).abs() < 0.006, "{name} {theta} bin {i}: {found} {expected}");
            }
            let above: f64 = expected.iter().sum();
            assert!((above + lost - 1.0).abs() < 0.01, "{name} {theta}: {above} {lost}");
            assert!((weights / energy - 1.0).abs() < 0.02, "{name} {theta}: {weights} {energy}");
            eprintln!(
                "{name} {theta}: lost {lost:.3}, greatest weight {:.2} of energy and share",
                greatest * above / energy
            );
        }
    }
}
