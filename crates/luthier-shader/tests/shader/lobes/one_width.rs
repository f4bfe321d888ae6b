//! Rows with one lobe of one width.

use glam::DVec3;
use luthier_layers::models::lobes::{Below, Critical, Frame, Lobe, Row, ViewAxis, Wide};
use luthier_lut::{AtlasLayout, Axis, TableKind, WeightBits, bilinear};
use luthier_manifest::{FunctionGroup, LobesRecord};
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::{assert_light, lit_from_below, of_parts, set};
use crate::arithmetic::directions;
use crate::machine::{Value, vector};
use crate::scenes::tables;

const RISE: f64 = -0.4;
const INVERSE_TAIL: f64 = 3.0;

/// Oracle: a lobe whose two widths are written out by hand, and whose frame knows nothing of rows with one.
#[test]
fn one_width_gives_the_other() {
    let mut tables = tables();
    let face = tables.iter_mut().find(|table| table.kind == TableKind::Lobes).unwrap();
    let y = face.layout.y.clone().map(|y| Axis { max: 2.0, size: 3, ..y });
    let layout = AtlasLayout { y, ..face.layout.clone() };
    face.layout = layout.clone();
    let image = of_parts(&layout, |c| {
        [[0.3 * c, 0.2, 0.1, 8.0 + c], [0.5, 0.4 + 0.1 * c, 0.3, 0.3 - 0.2 * c], [0.9, 0.8, 0.7, 0.6]]
    });
    let mut materials = set("lobes");
    let axis = ViewAxis::new(2, Critical::default());
    let wide = Wide::new([0.6, 0.3], axis);
    let record = materials[0].constants.lobes.unwrap();
    materials[0].constants.lobes = Some(LobesRecord {
        index: 1.4,
        falloff: [0.6, 0.3],
        integral: wide.integral(),
        lobes: 1,
        inverse_tails: [INVERSE_TAIL, 0.0],
        rise: Some(RISE),
        ..record
    });
    let mut set = MaterialSet::new(&materials, tables);
    let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
    // Light of a view takes two parts. The third is read by none of these functions.
    assert!(!text.contains("cos_theta, 2.0)"), "{text}");
    let machine = lit_from_below(&text, &materials, &image);
    set.functions = [FunctionGroup::Sample, FunctionGroup::Albedo].into_iter().collect();
    let drawing = lit_from_below(&emit(&set, Form::Baked, Target::Wgsl).unwrap(), &materials, &image);
    let mut brightest = 0.0_f64;
    for (wi, wo) in directions(300) {
        let [light, eye] = [wi, wo].map(DVec3::from);
        if light.z <= 0.0 || eye.z <= 0.0 {
            continue;
        }
        let part = |part: u32| bilinear(&image, layout.position(0, [eye.z, f64::from(part)]), WeightBits::Exact);
        let [r, g, b, x] = part(0);
        let [red, green, blue, shift] = part(1);
        let sin_sq = eye.x * eye.x + eye.y * eye.y;
        let along = x * INVERSE_TAIL.sqrt();
        let lobe = Lobe {
            strength: [red, green, blue],
            share: 0.6,
            shift,
            sharpness: [along, along * (1.0 + RISE * sin_sq)],
            shear: 0.0,
            tail: 1.0 / INVERSE_TAIL,
        };
        let row = Row { albedo_dir: [0.9, 0.8, 0.7], lobes: vec![lobe], wide: [r, g, b], base: None };
        let frame = Frame::new(1.4f32.into(), wide);
        let expected = Below::new(frame, row, eye).eval(light);
        assert_light(&machine, [wi, wo], expected, "one width");
        brightest = expected.into_iter().fold(brightest, f64::max);
        // The albedo and the energy of the lobe are in the third part, with its share in A.
        let prepared = drawing.call("luthier_prepare_lobes", vec![Value::U(0), vector(&wo.map(|w| w as f32))]);
        let albedo = drawing.call("luthier_albedo_lobes", vec![prepared.clone()]).floats();
        let below = drawing.call("luthier_lobe_below", vec![prepared, Value::U(0)]);
        let given = albedo.iter().zip([0.9, 0.8, 0.7]);
        for (found, expected) in
            given.chain(below.members()[0].floats().iter().zip([red, green, blue].map(|x| 0.6 * x)))
        {
            assert!((f64::from(*found) - expected).abs() < 1e-5, "{wo:?}: {found} {expected}");
        }
    }
    assert!(brightest > 1.0, "{brightest}");
}
