//! Own normals of layers in the shader of `lobes`.

use glam::DVec3;
use luthier_layers::frame::local;
use luthier_layers::models::lobes::{Below, Critical, Frame, Painted, Row, ViewAxis, Wide};
use luthier_lut::{WeightBits, bilinear};
use luthier_manifest::{FunctionGroup, LobesRecord, MapSlot, PaintedRecord};
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::{lit_from_below, rows_over_base, set, tables_with};
use crate::arithmetic::directions;
use crate::features::with_map;
use crate::machine::{Value, vector};
use crate::scenes::FLAKES;

/// Own normals of three layers and of the place, with flakes and without: the twin in the frame of the first one, with the angles between the normals, and the
/// sum of the slopes of flakes and of the lowest interface. The light of all functions.
#[test]
fn own_normals_change_lobes_as_in_the_twin() {
    let (layout, image) = rows_over_base();
    for (name, has_flakes) in [("lobes-bumps", false), ("lobes-bumps", true), ("lobes-bumps-mixed", false)] {
        let mut materials = set(name);
        let [coat, chalk] = [("lobes", 0), ("lobes-mixed", 1)].map(|(name, i)| set(name)[i].layers[0].clone());
        let index = coat.eta;
        let given = &mut materials[0];
        given.layers = vec![coat.clone(), coat, chalk];
        let record = given.constants.lobes.unwrap();
        let painted = Painted { albedo: [0.3, 0.5, 0.7], is_lambertian: false };
        let wide = Wide::new(record.falloff, ViewAxis::new(2, Critical::default()));
        let frame = Frame { base: Some(painted), ..Frame::new(record.index, wide) };
        let of_base = Some(PaintedRecord { albedo: painted.albedo, moments: None });
        given.constants.lobes = Some(LobesRecord { integral: wide.integral(), painted: of_base, ..record });
        given.constants.flakes = has_flakes.then_some(FLAKES);
        given.maps = (0..3).flat_map(|layer| with_map(given.clone(), MapSlot::Bumps, layer).maps).collect();
        let functions = [FunctionGroup::Light, FunctionGroup::Sample, FunctionGroup::Albedo].into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables_with(&layout)) };
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        let machine = lit_from_below(&text, &materials, &image);
        let neutral = machine.call("luthier_place", Vec::new());
        let place = text.split("struct LuthierPlace {").nth(1).unwrap();
        let names = place.lines().filter_map(|line| line.trim().split_once(": "));
        let flake_member = names.map(|(name, _)| name).position(|name| name == "flake_normal").unwrap_or_default();
        let mut moved = 0.0_f64;
        for (k, (wi, wo)) in directions(150).enumerate() {
            let unit = |x: f64, y: f64| DVec3::new(x, y, 1.0).normalize().as_vec3().as_dvec3();
            let t = 0.02 * k as f64;
            let (normal, own) =
                (unit(0.1, t % 0.2 - 0.1), [unit(t % 0.3 - 0.1, 0.1), unit(0.2, -t % 0.25), unit(-0.1, t % 0.4)]);
            let mut place = neutral.clone();
            place.members_mut()[0] = vector(&normal.as_vec3().to_array());
            let flake = if has_flakes { unit(t % 0.2, -0.1) } else { DVec3::Z };
            if has_flakes {
                place.members_mut()[flake_member] = vector(&flake.as_vec3().to_array());
            }
            let layers = place.members_mut().last_mut().unwrap();
            for (member, own) in layers.members_mut().iter_mut().zip(own) {
                member.members_mut()[0] = vector(&own.as_vec3().to_array());
            }
            let [light, eye] = [wi, wo].map(DVec3::from);
            let back = DVec3::new(-normal.x, -normal.y, normal.z);
            let [first, second, third] = own.map(|own| local(back, own));
            let [here, wo_here] = [light, eye].map(|w| local(first, w));
            if [light, eye, here, wo_here].iter().any(|w| w.z < 1e-3) {
                continue;
            }
            let part =
                |part: i32| bilinear(&image, layout.position(0, [wo_here.z, f64::from(part)]), WeightBits::Exact);
            let row = Row::of_parts(&(-2..6).map(part).collect::<Vec<_>>(), true);
            let straight = Below::new(frame, row, wo_here);
            let slopes = [flake, local(first, second)].map(|normal| normal.truncate() / normal.z);
            let lowest = (slopes[0] + slopes[1]).extend(1.0).normalize();
            let below = straight.clone().tilted(lowest, index).leaning(local(first, third), index, None);
            let there = below.eval(here);
            let [wi, wo] = [wi, wo].map(|w| vector(&w.map(|w| w as f32)));
            let at = vec![place.clone(), Value::U(0), wi.clone(), wo.clone()];
            let prepared = machine.call("luthier_prepare_at", vec![place, Value::U(0), wo]);
            let albedo = machine.call("luthier_albedo", vec![prepared.clone()]).floats();
            for value in [machine.call("luthier_eval_at", at), machine.call("luthier_light", vec![prepared, wi])] {
                let found = value.floats();
                for c in 0..3 {
                    let error = (f64::from(found[c]) - there[c]).abs() / there[c].abs().max(0.03);
                    assert!(error < 1e-3, "{name} {k}: {found:?} {there:?}");
                    moved = moved.max((there[c] - straight.eval(here)[c]).abs());
                }
            }
            for c in 0..3 {
                let stated = below.row().albedo_dir[c];
                assert!(
                    (f64::from(albedo[c]) - stated).abs() < 1e-3 * stated.abs().max(1.0),
                    "{name} {k}: {albedo:?} {stated}"
                );
            }
        }
        assert!(moved > 0.1, "{name}: {moved}");
    }
}
