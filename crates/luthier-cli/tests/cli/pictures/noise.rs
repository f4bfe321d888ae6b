//! Noise of environments that go through the shader: directions are drawn for the place, whatever maps say of it.

use luthier::{Bake, MemoryStore, Source, lit};
use luthier_gpu::{Backdrop, RenderSettings, Scene, Shape};
use luthier_lut::Image;
use luthier_manifest::Form;

use crate::eval::twin::gpu;
use crate::workshop::Workshop;

/// Directions for each lobe where materials have maps of layers.
const DIRECTIONS: u32 = 64;

/// Directions of a picture whose noise is an eighth of that.
const MANY: u32 = 4096;

/// Materials of every kind of map. `grey` is dark: a factor that makes rough layers smooth.
fn materials() -> [(&'static str, String); 8] {
    let head = "schema = 1\nname = \"m\"\n";
    let coat = |more: &str| {
        format!(
            "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nthickness_um = 10\nabsorption_per_um = [0.01, 0.02, 0.03]\n{more}\n"
        )
    };
    let paint = "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.6, 0.4, 0.2]\nmaps = { albedo = \"white.png\" }\n";
    let metal = |more: &str| format!("[[layer]]\ntype = \"conductor\"\nior = \"ag\"\n{more}\n");
    let model = |name: &str| format!("[bake]\nmodel = \"{name}\"\ncolor = \"three-wavelengths\"\n");
    [
        (
            "roughness and albedo",
            [head, &coat("alpha = 0.6\nmaps = { roughness = \"grey.png\" }"), paint, &model("elek")].concat(),
        ),
        (
            "roughness and albedo",
            [head, &coat("alpha = 0.6\nmaps = { roughness = \"grey.png\" }"), paint, &model("belcour")].concat(),
        ),
        (
            "thickness and albedo",
            [head, &coat("alpha = 0.1\nmaps = { thickness = \"grey.png\" }"), paint, &model("elek")].concat(),
        ),
        (
            "normals and albedo",
            [head, &coat("alpha = 0.05\nmaps = { normal = \"lean.png\" }"), paint, &model("elek")].concat(),
        ),
        ("alpha of a layer", [head, &metal("alpha = 0.7\nmaps = { alpha = \"grey.png\" }"), &model("elek")].concat()),
        (
            "axes of a layer",
            [head, &metal("alpha_x = 0.02\nalpha_y = 0.5\nmaps = { tangent = \"lean.png\" }"), &model("elek")].concat(),
        ),
        (
            "bumps below a coat",
            [head, &coat("alpha = 0.02"), &metal("alpha = 0.1\nmaps = { bumps = \"lean.png\" }"), &model("elek")]
                .concat(),
        ),
        (
            "metallic and roughness",
            format!(
                "{head}[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.9, 0.6, 0.3]\nmetallic = 1\nroughness = 0.8\n\
                 maps = {{ metallic = \"white.png\", roughness = \"grey.png\" }}\n{}",
                model("microfacet")
            ),
        ),
    ]
}

fn scene(workshop: &Workshop, gpu: &luthier_gpu::Gpu, text: &str) -> Scene {
    workshop.write("m.toml", text);
    let parsed = Source::read(&workshop.path("m.toml")).unwrap().parsed;
    let material = parsed.unwrap_or_else(|errors| panic!("{errors:?}")).material;
    let package = Bake::lit().package(&lit(&[material]), &MemoryStore::default()).unwrap();
    gpu.scene(&package, Form::Baked).unwrap()
}

/// Number of pixels that are brighter than they should be by half, and by a twentieth.
fn outliers(found: &Image, expected: &Image) -> usize {
    let is_one = |(a, b): (&[f32], &[f32])| (0..3).any(|c| a[c] > 1.5 * b[c] + 0.05);
    found.texels().zip(expected.texels()).filter(|pair| is_one(*pair)).count()
}

/// Oracle: the picture with 64 times as many directions, which has an eighth of the noise.
#[test]
fn pictures_of_maps_have_no_white_dots() {
    let Some(gpu) = gpu() else { return };
    let workshop = Workshop::new();
    for (name, texel) in [("white.png", [255u8; 3]), ("grey.png", [64; 3]), ("lean.png", [190, 128, 238])] {
        image::RgbImage::from_pixel(1, 1, image::Rgb(texel)).save(workshop.path(name)).unwrap();
    }
    for (kind, text) in materials() {
        let scene = scene(&workshop, &gpu, &text);
        let picture = |environment_samples| {
            let settings = RenderSettings {
                size: 16,
                samples: 1,
                environment_samples,
                lights: Vec::new(),
                backdrop: Backdrop::Plain([0.0; 3]),
                ..RenderSettings::new(Shape::Sphere).unwrap()
            };
            scene.render(&[0], &settings).unwrap()
        };
        let (few, many) = (picture(DIRECTIONS), picture(MANY));
        let sum = |image: &Image| image.data.iter().map(|v| f64::from(*v)).sum::<f64>();
        let (dots, share) = (outliers(&few, &many), sum(&few) / sum(&many));
        eprintln!("{kind}: {dots} dots, brightness {share:.4}");
        assert!(dots == 0 && (share - 1.0).abs() < 0.01, "{kind}: {dots} dots, brightness {share}");
    }
}
