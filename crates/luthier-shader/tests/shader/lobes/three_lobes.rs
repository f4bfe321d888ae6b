//! Rows with a third lobe behind the albedo.

use glam::DVec3;
use luthier_layers::models::lobes::{Below, Critical, Frame, Lobe, Row, ViewAxis, Wide};
use luthier_lut::{AtlasLayout, Axis, Image, WeightBits, bilinear};
use luthier_manifest::{FunctionGroup, LobesRecord};
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::{assert_light, lit_from_below, rows, set, tables_with};
use crate::arithmetic::directions;
use crate::machine::{Value, vector};

/// 1 over the tail of the third lobe.
const INVERSE_TAIL: f64 = 3.0;

/// [`rows`] with a third lobe.
pub(super) fn rows_of_three() -> (AtlasLayout, Image) {
    let (two, of_two) = rows();
    let layout = AtlasLayout { y: two.y.clone().map(|y| Axis { max: 7.0, size: 8, ..y }), ..two };
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    let across = layout.row_size();
    for i in 0..across {
        for part in 0..6 {
            let texel = of_two.texel(part * across + i, 0).to_vec();
            image.texel_mut(part * across + i, 0).copy_from_slice(&texel);
        }
        let c = layout.x.node((i.max(1) - 1).min(layout.x.size - 1));
        for (part, texel) in (6..).zip([[0.2 + 0.1 * c, 0.3, 0.05, 0.2 * c], [3.0 - c, 4.0 + c, INVERSE_TAIL, 0.6]]) {
            image.texel_mut(part * across + i, 0).copy_from_slice(&texel.map(|value| value as f32));
        }
    }
    (layout, image)
}

/// Oracle: a third lobe whose numbers are written out by hand, beside the two that other tests compare; and beside a material with two lobes in the table.
#[test]
fn a_third_lobe_comes_after_the_albedo() {
    let (layout, image) = rows_of_three();
    let axis = ViewAxis::new(2, Critical::default());
    let wide = Wide::new([0.6, 0.3], axis);
    let frame = Frame::new(1.4f32.into(), wide);
    let mut two = set("lobes")[0].clone();
    let record = two.constants.lobes.unwrap();
    let record = LobesRecord {
        index: 1.4,
        falloff: [0.6, 0.3],
        integral: wide.integral(),
        lobes: 2,
        inverse_tails: [1.0, 40.0],
        ..record
    };
    two.constants.lobes = Some(record);
    let mut three = two.clone();
    two.name = "two".to_owned();
    three.constants.lobes = Some(LobesRecord { lobes: 3, ..record });
    for materials in [vec![three.clone()], vec![three, two]] {
        let mut set = MaterialSet::new(&materials, tables_with(&layout));
        let machine = lit_from_below(&emit(&set, Form::Baked, Target::Wgsl).unwrap(), &materials, &image);
        set.functions = [FunctionGroup::Sample, FunctionGroup::Albedo].into_iter().collect();
        let drawing = lit_from_below(&emit(&set, Form::Baked, Target::Wgsl).unwrap(), &materials, &image);
        let mut farthest = 0.0_f64;
        for (wi, wo) in directions(300) {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            let part = |part: u32| bilinear(&image, layout.position(0, [eye.z, f64::from(part)]), WeightBits::Exact);
            let of_two = Row::of_parts(&(0..8).map(part).collect::<Vec<_>>(), false);
            assert_eq!(of_two.lobes.len(), 2);
            let ([r, g, b, shift], [x, y, _, share]) = (part(6), part(7));
            let third = Lobe {
                strength: [r, g, b],
                share,
                shift,
                sharpness: [x, y].map(|x| x * INVERSE_TAIL.sqrt()),
                shear: 0.0,
                tail: 1.0 / INVERSE_TAIL,
            };
            let mut of_three = of_two.clone();
            of_three.lobes.push(third);
            let [expected, of_two] = [of_three, of_two].map(|row| Below::new(frame, row, eye).eval(light));
            assert_light(&machine, [wi, wo], expected, "three lobes");
            farthest = farthest.max(expected[0] - of_two[0]);
            let eye = vector(&wo.map(|w| w as f32));
            if materials.len() == 2 {
                let prepared = machine.call("luthier_prepare_lobes", vec![Value::U(1), eye.clone()]);
                let found = machine.call("luthier_light_lobes", vec![prepared, vector(&wi.map(|w| w as f32))]).floats();
                for (found, expected) in found.iter().zip(of_two) {
                    let error = (f64::from(*found) - expected).abs() / expected.abs().max(0.03);
                    assert!(error < 1e-4, "two lobes {wi:?} {wo:?}: {found} {expected}");
                }
            }
            let prepared = drawing.call("luthier_prepare_lobes", vec![Value::U(0), eye]);
            let albedo = drawing.call("luthier_albedo_lobes", vec![prepared.clone()]).floats();
            let below = drawing.call("luthier_lobe_below", vec![prepared, Value::U(2)]);
            let given = albedo.iter().zip([0.9, 0.8, 0.7]);
            for (found, expected) in given.chain(below.members()[0].floats().iter().zip([r, g, b].map(|x| share * x))) {
                assert!((f64::from(*found) - expected).abs() < 1e-5, "{wo:?}: {found} {expected}");
            }
        }
        assert!(farthest > 0.1, "{farthest}");
    }
}
