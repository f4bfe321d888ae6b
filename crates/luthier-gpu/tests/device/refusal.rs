//! A refusal of the device comes back as an error, and leaves the device usable.

use luthier_gpu::{GpuError, Package, Shader};
use luthier_manifest::{BindingEntry, Form};

use crate::adapter::gpu;
use crate::bake_by_hand::{diffuse, manifest};

const GOOD: &str = "
@group(0) @binding(6) var<storage, read> luthier_materials: array<vec4<f32>>;
fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    return wi + wo + luthier_materials[material].xyz;
}";

/// A bake whose shader and binding are given as they are.
fn bake(wgsl: &str, name: &str, resource: &str) -> Package {
    let mut manifest = manifest(vec![vec![diffuse([0.5; 3], 0.0)]], &[]);
    manifest.bindings = vec![BindingEntry { binding: 6, name: name.to_owned(), resource: resource.to_owned() }];
    let shaders = vec![Shader::wgsl(Form::Full, wgsl.to_owned())];
    Package::from_parts(manifest, Vec::new(), shaders).unwrap()
}

#[test]
fn bad_shaders_are_errors_and_the_device_lives_on() {
    let Some(gpu) = gpu() else { return };
    let materials = "luthier_materials";
    for (wgsl, name, resource) in [
        ("this is not WGSL", materials, "buffer"),
        ("fn luthier_eval(a: u32) -> f32 { return 1.0; }", materials, "buffer"),
        // Declared by the shader, absent from the manifest; and bound as something else.
        (GOOD, "something_else", "buffer"),
        (GOOD, materials, "sampler"),
    ] {
        let error = gpu.scene(&bake(wgsl, name, resource), Form::Full).unwrap_err();
        assert!(matches!(&error, GpuError::Refused { what, .. } if what.contains("full")), "{error}");
    }
    let error = gpu.scene(&bake(GOOD, materials, "texture_3d<f32>"), Form::Full).unwrap_err();
    assert!(matches!(error, GpuError::Binding { .. }), "{error}");
    // A table of no kind.
    let water = "@group(0) @binding(6) var luthier_water: texture_2d<f32>;";
    let error = gpu.scene(&bake(water, "luthier_water", "texture_2d<f32>"), Form::Full).unwrap_err();
    assert!(matches!(error, GpuError::Binding { .. }), "{error}");

    let scene = gpu.scene(&bake(GOOD, materials, "buffer"), Form::Full).unwrap();
    assert_eq!(scene.form(), Form::Full);
    // The header word of material 0: its layers begin behind its header, and there is one; whole numbers lie above 2^23.
    let got = scene.evaluate(0, &[([0.0, 0.0, 1.0], [2.0, 0.0, 0.0])]).unwrap();
    let whole = |n: usize| ((1 << 23) + n) as f32;
    assert_eq!(got, [[whole(luthier_manifest::MATERIAL_WORDS + 2), whole(1), whole(1)]]);
}
