//! Materials of one shader whose rows have different forms.

use glam::DVec3;
use luthier_layers::models::lobes::{Below, Critical, Frame, Lobe, Row, ViewAxis, Wide};
use luthier_lut::{AtlasLayout, Axis, Image, TableKind, WeightBits, bilinear};
use luthier_manifest::{FunctionGroup, LobesRecord, MaterialEntry, ShortRecord};
use luthier_optics::stack::Distribution;
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::short::{REFLECTANCE, first_interface};
use super::{assert_light_of, in_all_languages, lit_from_below, set, tables_with};
use crate::arithmetic::directions;
use crate::machine::{Value, vector};
use crate::scenes::tables;

const INDEX: f64 = 1.4;
const FALLOFF: [f64; 2] = [0.6, 0.3];
const RISE: f64 = -0.4;
const INVERSE_TAILS: [f64; 2] = [3.0, 40.0];
const SHARPNESS: [f64; 3] = [8.0, -2.0, 1.5];
const CRITICAL: Critical = Critical { cot_sq: 1.25, width: 0.02, plain_share: 0.25 };

/// Form of the rows of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Own {
    None,
    Short,
    OneWidth {
        is_curved: bool,
    },
    /// So many lobes of two widths, with a critical angle of the view or without.
    Plain(usize, bool),
}

impl Own {
    fn lobes(self) -> usize {
        match self {
            Self::None => 0,
            Self::Short | Self::OneWidth { .. } => 1,
            Self::Plain(lobes, _) => lobes,
        }
    }

    fn is_curved(self) -> bool {
        matches!(self, Self::Short | Self::OneWidth { is_curved: true })
    }

    fn axis(self) -> ViewAxis {
        ViewAxis::new(2, if matches!(self, Self::Plain(_, true)) { CRITICAL } else { Critical::default() })
    }

    /// A material of this form, whose rows are in a tile.
    fn material(self, number: u32) -> MaterialEntry {
        let has_critical = matches!(self, Self::Plain(_, true));
        let mut material = set(if has_critical { "lobes-inward" } else { "lobes" })[0].clone();
        let given = material.constants.lobes.unwrap();
        let Critical { cot_sq, width, plain_share } = self.axis().critical();
        let record = LobesRecord {
            index: INDEX,
            falloff: FALLOFF,
            integral: Wide::new(FALLOFF, self.axis()).integral(),
            critical_cot_sq: cot_sq,
            critical_width: width,
            critical_plain_share: plain_share,
            lobes: self.lobes() as u32,
            inverse_tails: INVERSE_TAILS,
            reflectance: self.is_curved().then_some(REFLECTANCE),
            ..given
        };
        material.constants.lobes = Some(match self {
            Self::Short => LobesRecord {
                falloff: [0.0; 2],
                integral: 1.0,
                rise: Some(RISE),
                short: Some(ShortRecord { sharpness: SHARPNESS }),
                ..record
            },
            Self::OneWidth { .. } => LobesRecord { rise: Some(RISE), ..record },
            Self::None | Self::Plain(..) => record,
        });
        material.name = format!("material-{number}");
        for layer in &mut material.layers {
            layer.tiles[TableKind::Distribution] = None;
            layer.distribution = Distribution::Ggx;
        }
        material.layers[0].tiles[TableKind::Lobes] = Some(number);
        material
    }

    /// The lobes at a view by the parts of its row, written out by hand.
    fn expected_lobes(self, parts: &[[f64; 4]], eye: DVec3) -> Vec<Lobe> {
        let of = |[r, g, b, shift]: [f64; 4], sharpness: [f64; 2], inverse_tail: f64, share: f64| {
            let (strength, tail) = ([r, g, b], 1.0 / inverse_tail);
            Lobe { strength, share, shift, sharpness: sharpness.map(|x| x * inverse_tail.sqrt()), shear: 0.0, tail }
        };
        let sin_sq = eye.x * eye.x + eye.y * eye.y;
        let two = |along: f64| [along, along * (1.0 + RISE * sin_sq)];
        match self {
            Self::None => Vec::new(),
            Self::Short => {
                let along = SHARPNESS[0] + SHARPNESS[1] * sin_sq + SHARPNESS[2] * sin_sq * sin_sq;
                vec![of(parts[1], two(along), 1.0, 0.7)]
            }
            Self::OneWidth { .. } => vec![of(parts[1], two(parts[0][3]), INVERSE_TAILS[0], 0.7)],
            Self::Plain(1, _) if parts.len() == 4 => {
                let [x, y, inverse_tail, share] = parts[2];
                vec![of(parts[1], [x, y], inverse_tail, share)]
            }
            Self::Plain(lobes, _) => {
                let [x, y, z, w] = parts[3];
                let both = [of(parts[1], [x, y], INVERSE_TAILS[0], 0.7), of(parts[2], [z, w], INVERSE_TAILS[1], 0.8)];
                both.into_iter().take(lobes).collect()
            }
        }
    }
}

/// Rows of one tile for each material, which differ in every part.
fn image_of(layout: &AtlasLayout, forms: &[Own]) -> Image {
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    let (across, parts) = (layout.row_size(), layout.y.as_ref().unwrap().size);
    for (tile, form) in (0..).zip(forms) {
        let ([x, y], k) = (layout.origin(tile), f64::from(tile));
        for i in 0..across {
            let c = layout.x.node((i.max(1) - 1).min(layout.x.size - 1));
            for part in 0..parts {
                let texel = match part {
                    // A short lobe has no remainder; the number beside it is of one width.
                    0 if *form == Own::Short => [9.0; 4],
                    0 => [
                        0.3 * c,
                        0.2 + 0.02 * k,
                        0.1,
                        if matches!(form, Own::OneWidth { .. }) { 7.0 + c + k } else { 0.0 },
                    ],
                    1 => [0.5, 0.4 + 0.1 * c, 0.3 + 0.1 * k, 0.3 - 0.2 * c],
                    2 if parts == 4 => [8.0 + c, 6.0 + k, INVERSE_TAILS[0], 0.7],
                    2 => [0.1, 0.2, 0.2 + 0.3 * c, -0.1],
                    3 if parts == 6 => [8.0 + c, 12.0 - c, 0.5 + c, 0.7],
                    4 => [INVERSE_TAILS[0], 0.7, INVERSE_TAILS[1], 0.8],
                    _ => [0.9, 0.8 - 0.1 * k, 0.7, 0.0],
                };
                let texel = texel.map(|value: f64| value as f32);
                image.texel_mut(x + part * across + i, y).copy_from_slice(&texel);
            }
        }
    }
    image
}

/// Oracle: lobes and first interfaces written out by hand, in frames that know nothing of forms. Sets of GGX alone, whose facets are black but where a polynomial is their reflectance, with
/// one lobe at most and with two; each with the functions of a surface, too, whose lobes may be tilted.
#[test]
fn materials_of_one_shader_have_forms_of_their_own() {
    for (most, has_surface) in [(1, false), (2, false), (1, true), (2, true)] {
        let plain = [Own::Plain(1, false), Own::Plain(1, true), Own::Plain(2, false), Own::Plain(2, true)];
        let shaped = [Own::None, Own::Short, Own::OneWidth { is_curved: false }, Own::OneWidth { is_curved: true }];
        let forms: Vec<Own> = shaped.into_iter().chain(plain).filter(|form| form.lobes() <= most).collect();
        let materials: Vec<MaterialEntry> = (0..).zip(&forms).map(|(number, form)| form.material(number)).collect();
        let given = tables().into_iter().find(|table| table.kind == TableKind::Lobes).unwrap().layout;
        let last = 1 + 2 * most as u32;
        let y = given.y.clone().map(|y| Axis { max: f64::from(last), size: last + 1, ..y });
        let layout = AtlasLayout { y, tiles: forms.len() as u32, ..given };
        let image = image_of(&layout, &forms);
        let mut set = MaterialSet::new(&materials, tables_with(&layout));
        if has_surface {
            set.functions = [FunctionGroup::Surface].into_iter().collect();
        } else {
            set.functions = [FunctionGroup::Light, FunctionGroup::Albedo, FunctionGroup::Sample].into_iter().collect();
        }
        let text = in_all_languages(&set);
        let machine = lit_from_below(&text, &materials, &image);
        let mut brightest = vec![[0.0_f64; 2]; forms.len()];
        for (wi, wo) in directions(100) {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            for (number, form) in (0..).zip(&forms) {
                let axis = form.axis();
                let part = |part: u32| {
                    let at = layout.position(number, [axis.cosine(eye.z), f64::from(part)]);
                    bilinear(&image, at, WeightBits::Exact)
                };
                let parts: Vec<[f64; 4]> = (0..=last).map(part).collect();
                let lobes = form.expected_lobes(&parts, eye);
                let [r, g, b, _] = if *form == Own::Short { [0.0; 4] } else { parts[0] };
                let row = Row { albedo_dir: [0.0; 3], lobes: lobes.clone(), wide: [r, g, b], base: None };
                let wide = Wide::new(if *form == Own::Short { [0.0; 2] } else { FALLOFF }, axis);
                let below = Below::new(Frame::new(f64::from(INDEX as f32), wide), row, eye).eval(light);
                let alpha = materials[number as usize].layers[0].alpha;
                let first = if form.is_curved() { first_interface(alpha, light, eye) } else { 0.0 };
                let expected = below.map(|below| below + first);
                let name = format!("{form:?} of {most} lobes, surface {has_surface}");
                if has_surface {
                    let place = machine.call("luthier_place", Vec::new());
                    let arguments = vec![place, Value::U(number), vector(&wo.map(|w| w as f32))];
                    let prepared = machine.call("luthier_prepare_lobes", arguments);
                    let light = vector(&wi.map(|w| w as f32));
                    let found = machine.call("luthier_light_lobes", vec![prepared, light]).floats();
                    for (found, expected) in found.iter().zip(expected) {
                        let error = (f64::from(*found) - expected).abs() / expected.abs().max(0.03);
                        assert!(error < 3e-4, "{name} {wi:?} {wo:?}: {found} {expected}");
                    }
                } else {
                    assert_light_of(number, &machine, [wi, wo], expected, &name);
                    let prepared =
                        machine.call("luthier_prepare_lobes", vec![Value::U(number), vector(&wo.map(|w| w as f32))]);
                    let albedo = machine.call("luthier_albedo_lobes", vec![prepared.clone()]).floats();
                    assert!((f64::from(albedo[1]) - parts[last as usize][1]).abs() < 1e-5, "{name}: {albedo:?}");
                    if let Some(lobe) = lobes.first() {
                        let energy = machine.call("luthier_lobe_below", vec![prepared, Value::U(0)]);
                        let energy = energy.members()[0].floats();
                        let expected = lobe.strength[2] * lobe.share;
                        assert!((f64::from(energy[2]) - expected).abs() < 1e-5, "{name}: {energy:?} {expected}");
                    }
                }
                let [below_most, first_most] = &mut brightest[number as usize];
                *below_most = below.into_iter().fold(*below_most, f64::max);
                *first_most = first_most.max(first);
            }
        }
        for (form, [below, first]) in forms.iter().zip(brightest) {
            assert!(below > 0.05 && (first > 0.1) == form.is_curved(), "{form:?}: {below} {first}");
        }
    }
}

/// Materials of one form have no branches by form, and a set of several has.
#[test]
fn a_set_of_one_form_has_no_branches_by_form() {
    let emitted = |forms: &[Own], parts: [u32; 2]| {
        let materials: Vec<MaterialEntry> = (0..).zip(forms).map(|(number, form)| form.material(number)).collect();
        let given = tables().into_iter().find(|table| table.kind == TableKind::Lobes).unwrap().layout;
        let [min, max] = parts;
        let y = given.y.clone().map(|y| Axis { min: f64::from(min), max: f64::from(max), size: max - min + 1, ..y });
        let layout = AtlasLayout { y, tiles: forms.len() as u32, ..given };
        let set = MaterialSet::new(&materials, tables_with(&layout));
        emit(&set, Form::Baked, Target::Wgsl).unwrap()
    };
    let [narrow, curved] = [false, true].map(|is_curved| Own::OneWidth { is_curved });
    for (forms, parts) in [
        (&[Own::Short; 2][..], [1, 2]),
        (&[narrow; 2], [0, 2]),
        (&[curved; 2], [0, 2]),
        (&[Own::Plain(1, false), Own::Plain(1, true)], [0, 3]),
    ] {
        let text = emitted(forms, parts);
        assert!(!text.contains("LUTHIER_SHORT") && !text.contains("LUTHIER_ONE_WIDTH"), "{forms:?}");
        assert!(!text.contains("LUTHIER_CURVED"), "{forms:?}");
    }
    let text = emitted(&[narrow, curved], [0, 2]);
    assert!(text.contains("LUTHIER_CURVED") && !text.contains("LUTHIER_ONE_WIDTH"), "{text}");
    let text = emitted(&[Own::Short, Own::Plain(1, false)], [0, 3]);
    assert!(["LUTHIER_SHORT", "LUTHIER_ONE_WIDTH", "LUTHIER_CURVED"].iter().all(|mark| text.contains(mark)), "{text}");
}
