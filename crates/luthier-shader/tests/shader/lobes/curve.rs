//! First interfaces that reflect by polynomials, above rows of other forms than short lobes.

use glam::DVec3;
use luthier_layers::models::lobes::{Below, Critical, Frame, Lobe, Row, ViewAxis, Wide};
use luthier_lut::{AtlasLayout, Axis, TableKind, WeightBits, bilinear};
use luthier_manifest::LobesRecord;
use luthier_optics::stack::Distribution;
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::short::{REFLECTANCE, first_interface};
use super::{assert_light, lit_from_below, of_parts, set};
use crate::arithmetic::directions;
use crate::scenes::tables;

/// Oracles: a first interface by other formulas, with Smith's masking by tangents, and below it lobes whose frame knows nothing of polynomials. A set of
/// GGX alone has its masking by roots, and one with Beckmann's has not.
#[test]
fn a_polynomial_is_the_reflectance_of_the_first_interface() {
    for (lobes, has_beckmann) in [(0, false), (0, true), (1, false), (1, true)] {
        let mut tables = tables();
        let face = tables.iter_mut().find(|table| table.kind == TableKind::Lobes).unwrap();
        let last = 1 + 2 * lobes;
        let y = face.layout.y.clone().map(|y| Axis { max: f64::from(last), size: last + 1, ..y });
        let layout = AtlasLayout { y, ..face.layout.clone() };
        face.layout = layout.clone();
        let (albedo, wide) = ([0.9, 0.8, 0.7, 0.0], |c: f64| [0.3 * c, 0.2, 0.1, 0.0]);
        let lobe = |c: f64| [[0.5, 0.4 + 0.1 * c, 0.3, 0.3], [8.0 + c, 6.0, 2.0, 0.6]];
        let image = match lobes {
            0 => of_parts(&layout, |c| [wide(c), albedo]),
            _ => of_parts(&layout, |c| [wide(c), lobe(c)[0], lobe(c)[1], albedo]),
        };
        let wide = Wide::new([0.6, 0.3], ViewAxis::new(2, Critical::default()));
        let mut materials = set("lobes");
        let record = materials[0].constants.lobes.unwrap();
        materials[0].constants.lobes = Some(LobesRecord {
            index: 1.4,
            falloff: [0.6, 0.3],
            integral: wide.integral(),
            lobes,
            inverse_tails: [2.0, 0.0],
            reflectance: Some(REFLECTANCE),
            ..record
        });
        for layer in materials.iter_mut().flat_map(|material| &mut material.layers) {
            layer.tiles[TableKind::Distribution] = None;
            if !has_beckmann {
                layer.distribution = Distribution::Ggx;
            }
        }
        materials[0].layers[0].distribution = Distribution::Ggx;
        let alpha = materials[0].layers[0].alpha;
        let text = emit(&MaterialSet::new(&materials, tables), Form::Baked, Target::Wgsl).unwrap();
        let machine = lit_from_below(&text, &materials, &image);
        let mut brightest = [0.0_f64; 2];
        for (wi, wo) in directions(300) {
            let [light, eye] = [wi, wo].map(DVec3::from);
            if light.z <= 0.0 || eye.z <= 0.0 {
                continue;
            }
            let part = |part: u32| bilinear(&image, layout.position(0, [eye.z, f64::from(part)]), WeightBits::Exact);
            let [r, g, b, _] = part(0);
            let lobe = (lobes > 0).then(|| {
                let ([red, green, blue, shift], [x, y, z, share]) = (part(1), part(2));
                let sharpness = [x, y].map(|x| x * z.sqrt());
                Lobe { strength: [red, green, blue], share, shift, sharpness, shear: 0.0, tail: 1.0 / z }
            });
            let lobes = lobe.into_iter().collect();
            let row = Row { albedo_dir: [0.9, 0.8, 0.7], lobes, wide: [r, g, b], base: None };
            let frame = Frame::new(1.4f32.into(), wide);
            let below = Below::new(frame, row, eye).eval(light);
            let first = first_interface(alpha, light, eye);
            assert_light(&machine, [wi, wo], below.map(|below| below + first), "polynomial");
            brightest = [brightest[0].max(below[0]), brightest[1].max(first)];
        }
        assert!(brightest[0] > 0.02 && brightest[1] > 0.1, "{brightest:?}");
    }
}
