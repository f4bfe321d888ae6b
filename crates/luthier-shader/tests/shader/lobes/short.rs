//! Rows with one short lobe.

use glam::DVec3;
use luthier_layers::models::lobes::{Below, Critical, Frame, Lobe, Row, ViewAxis, Wide};
use luthier_lut::{AtlasLayout, Axis, TableKind, WeightBits, bilinear};
use luthier_manifest::{FunctionGroup, LobesRecord, ShortRecord};
use luthier_optics::microfacet;
use luthier_optics::stack::Distribution;
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::{assert_light, lit_from_below, of_parts, set};
use crate::arithmetic::directions;
use crate::machine::{Value, vector};
use crate::scenes::tables;

const SHARPNESS: [f64; 3] = [8.0, -2.0, 1.5];
const RISE: f64 = -0.4;
pub(super) const REFLECTANCE: [f64; 3] = [0.04, 0.2, 0.3];
const INDEX: f64 = 1.4;

/// Oracle: a lobe whose widths are written out by hand, in a frame that knows nothing of short lobes, and beside it a first interface by other formulas. That is black
/// where its distribution comes from a table, and else GGX, alone and in a set with Beckmann's.
#[test]
fn a_short_lobe_has_the_widths_of_the_view() {
    let mut tables = tables();
    let face = tables.iter_mut().find(|table| table.kind == TableKind::Lobes).unwrap();
    let y = face.layout.y.clone().map(|y| Axis { min: 1.0, max: 2.0, size: 2, ..y });
    let layout = AtlasLayout { y, ..face.layout.clone() };
    face.layout = layout.clone();
    let image = of_parts(&layout, |c| [[0.5, 0.4 + 0.1 * c, 0.3, 0.3 - 0.2 * c], [0.9, 0.8, 0.7, 0.6]]);
    for (is_closed, has_beckmann) in [(false, true), (true, true), (true, false)] {
        let mut materials = set("lobes");
        let record = materials[0].constants.lobes.unwrap();
        materials[0].constants.lobes = Some(LobesRecord {
            index: INDEX,
            falloff: [0.0; 2],
            integral: 1.0,
            lobes: 1,
            inverse_tails: [1.0, 0.0],
            rise: Some(RISE),
            short: Some(ShortRecord { sharpness: SHARPNESS }),
            reflectance: Some(REFLECTANCE),
            ..record
        });
        for layer in materials.iter_mut().flat_map(|material| &mut material.layers) {
            if is_closed {
                layer.tiles[TableKind::Distribution] = None;
            }
            if !has_beckmann {
                layer.distribution = Distribution::Ggx;
            }
        }
        materials[0].layers[0].distribution = Distribution::Ggx;
        let coat = materials[0].layers[0].clone();
        let mut set = MaterialSet::new(&materials, tables.clone());
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        // Light of a view takes one part.
        assert!(!text.contains("cos_theta, 0.0)") && !text.contains("cos_theta, 2.0)"), "{text}");
        let machine = lit_from_below(&text, &materials, &image);
        set.functions = [FunctionGroup::Sample, FunctionGroup::Albedo].into_iter().collect();
        let drawing = lit_from_below(&emit(&set, Form::Baked, Target::Wgsl).unwrap(), &materials, &image);
        let mut brightest = [0.0_f64; 2];
        for (wi, wo) in directions(300) {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            let part = |part: u32| bilinear(&image, layout.position(0, [eye.z, f64::from(part)]), WeightBits::Exact);
            let [red, green, blue, shift] = part(1);
            let sin_sq = eye.x * eye.x + eye.y * eye.y;
            let along = SHARPNESS[0] + SHARPNESS[1] * sin_sq + SHARPNESS[2] * sin_sq * sin_sq;
            let lobe = Lobe {
                strength: [red, green, blue],
                share: 0.6,
                shift,
                sharpness: [along, along * (1.0 + RISE * sin_sq)],
                shear: 0.0,
                tail: 1.0,
            };
            let row = Row { albedo_dir: [0.9, 0.8, 0.7], lobes: vec![lobe], wide: [0.0; 3], base: None };
            let wide = Wide::new([0.0; 2], ViewAxis::new(2, Critical::default()));
            let frame = Frame::new(f64::from(INDEX as f32), wide);
            let below = Below::new(frame, row, eye).eval(light);
            let first = if is_closed { first_interface(coat.alpha, light, eye) } else { 0.0 };
            assert_light(&machine, [wi, wo], below.map(|below| below + first), "short");
            brightest = [brightest[0].max(below[0]), brightest[1].max(first)];
            // The albedo and the energy of the lobe are in the second part, with its share in A.
            let prepared = drawing.call("luthier_prepare_lobes", vec![Value::U(0), vector(&wo.map(|w| w as f32))]);
            let albedo = drawing.call("luthier_albedo_lobes", vec![prepared.clone()]).floats();
            let lobe = drawing.call("luthier_lobe_below", vec![prepared, Value::U(0)]);
            let energy = lobe.members()[0].floats();
            let expected = [0.9, 0.8, 0.7, 0.6 * red, 0.6 * green, 0.6 * blue];
            for (found, expected) in albedo.into_iter().chain(energy).zip(expected) {
                assert!((f64::from(found) - expected).abs() < 1e-5, "{wo:?}: {found} {expected}");
            }
        }
        assert!(brightest[0] > 1.0 && (brightest[1] > 0.1) == is_closed, "{brightest:?}");
    }
}

/// The first interface: D G F / (4 cos), Smith's masking by tangents.
pub(super) fn first_interface(alpha: f64, light: DVec3, eye: DVec3) -> f64 {
    let half = (light + eye).normalize();
    let d = microfacet::distribution(Distribution::Ggx, alpha, half.z, half.x * half.x + half.y * half.y);
    let lambda = |w: DVec3| {
        let tan = alpha * (w.x * w.x + w.y * w.y).sqrt() / w.z;
        0.5 * ((1.0 + tan * tan).sqrt() - 1.0)
    };
    let u = libm::pow(1.0 - half.dot(eye), 3.0);
    let [f, p, q] = REFLECTANCE;
    let reflected = f + p * u + q * u * u + (1.0 - f - p - q) * u * u * u;
    d * reflected / (1.0 + lambda(light) + lambda(eye)) / (4.0 * eye.z)
}
