//! Operations that a window needs: scenes with other materials without compiling, and renderings that are given up.

use std::cell::Cell;

use luthier_gpu::RenderSettings;
use luthier_shader::Form;

use crate::adapter::gpu;
use crate::bake_by_hand::{artefacts, conductor, dielectric, diffuse};
use crate::render::{dark, tables, tiled, uniform};

/// The tables and the buffer are the new ones.
#[test]
fn a_rebound_scene_is_that_of_the_other_materials() {
    let Some(gpu) = gpu() else { return };
    let metal = |alpha| vec![vec![tiled(conductor(alpha, [0.1; 3], [9.0; 3]), Some(0))]];
    let furnace = RenderSettings { environment: uniform(1.0), ..dark() };
    let first = artefacts(Form::Baked, metal(0.2), &tables(0.25, 0.75));
    let other = artefacts(Form::Baked, metal(0.6), &tables(0.5, 0.375));
    let scene = gpu.scene(&first, Form::Baked).unwrap();
    let before = scene.render(&[0], &furnace).unwrap();
    let rebound = scene.rebound(&other).unwrap().expect("the same shader");
    let expected = gpu.scene(&other, Form::Baked).unwrap().render(&[0], &furnace).unwrap();
    assert!(rebound.render(&[0], &furnace).unwrap() == expected);
    assert!(expected != before);
    assert!(scene.render(&[0], &furnace).unwrap() == before, "the old one is as it was");
    let up = ([0.0, 0.0, 1.0], [0.0, 0.6, 0.8]);
    let fresh = gpu.scene(&other, Form::Baked).unwrap().evaluate(0, &[up]).unwrap();
    assert_eq!(rebound.evaluate(0, &[up]).unwrap(), fresh);
}

#[test]
fn another_shader_cannot_be_rebound() {
    let Some(gpu) = gpu() else { return };
    let matte = artefacts(Form::Baked, vec![vec![diffuse([0.5; 3], 0.0)]], &[]);
    let coated = artefacts(
        Form::Baked,
        vec![vec![tiled(dielectric(0.1, 1.5), None), diffuse([0.5; 3], 0.0)]],
        &tables(0.1, 0.1),
    );
    let scene = gpu.scene(&matte, Form::Baked).unwrap();
    assert!(scene.rebound(&coated).unwrap().is_none());
}

/// A thread may map what another one waits for: each gets its own answer, and none ends without one.
#[test]
fn threads_share_a_device() {
    let Some(gpu) = gpu() else { return };
    let scenes = [0.2, 0.5, 0.8].map(|albedo| {
        gpu.scene(&artefacts(Form::Baked, vec![vec![diffuse([albedo; 3], 0.0)]], &[]), Form::Baked).unwrap()
    });
    let up = ([0.0, 0.0, 1.0], [0.0, 0.6, 0.8]);
    std::thread::scope(|scope| {
        for scene in scenes.iter().cycle().take(6) {
            scope.spawn(|| {
                let alone = scene.evaluate(0, &[up]).unwrap();
                (0..100).for_each(|_| assert_eq!(scene.evaluate(0, &[up]).unwrap(), alone));
            });
        }
    });
    let values = scenes.each_ref().map(|scene| scene.evaluate(0, &[up]).unwrap()[0][0]);
    assert!(values[0] < values[1] && values[1] < values[2], "{values:?}");
}

#[test]
fn a_rendering_may_be_given_up_between_passes() {
    let Some(gpu) = gpu() else { return };
    let scene = gpu.scene(&artefacts(Form::Baked, vec![vec![diffuse([0.5; 3], 0.0)]], &[]), Form::Baked).unwrap();
    // Enough evaluations for a few passes, of which those of a discrete GPU are larger.
    let size = if gpu.is_software() { 256 } else { 1024 };
    let settings = RenderSettings { size, samples: 4, ..dark() };
    let asked = Cell::new(0);
    let never = || {
        asked.set(asked.get() + 1);
        false
    };
    let whole = scene.render_unless(&[0], &settings, &never).unwrap().expect("nobody stopped it");
    assert!(asked.get() > 2, "{} passes", asked.get());
    assert!(whole == scene.render(&[0], &settings).unwrap());
    asked.set(0);
    let at_the_second = || {
        asked.set(asked.get() + 1);
        asked.get() == 2
    };
    assert!(scene.render_unless(&[0], &settings, &at_the_second).unwrap().is_none());
    assert_eq!(asked.get(), 2);
}
