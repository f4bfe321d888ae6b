//! Figures of Yamaguchi et al. 2019 about anisotropy: layered balls, and distributions projected on the base plane.

use glam::DVec3;
use luthier_gpu::Shape;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::registry;
use luthier_lut::Image;
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::figure::{Figure, LARGE, Labelled, Made, SMALL};
use super::studio::{Studio, material, shaded};

pub(crate) const FIGURES: [Figure; 2] = [
    Figure {
        name: "yamaguchi-1",
        title: "isotropic and anisotropic layers",
        source: "Yamaguchi et al. 2019, figure 1",
        caption: "A coat of index 1.49 on gold under the surroundings, by Yamaguchi's model, on a torus whose tangents follow the ring. From left to right: both layers isotropic (a); an \
                  anisotropic base (b); an anisotropic coat (c); both, along one tangent (d); both, the coat across (e). The highlights stretch across the \
                  brushing of the layer that has it. The paper's meshes, slopes and surroundings are not known; these are luthier's.",
        size: SMALL,
        claim: Claim {
            text: "Each layer may be isotropic or anisotropic, along its own tangents, and the surface looks another way each \
                  time.",
            checks: &[
                Check::Within("b base against a isotropic: mean FLIP", 0.02, 1.0),
                Check::Within("c coat against a isotropic: mean FLIP", 0.02, 1.0),
                Check::Within("d one way against a isotropic: mean FLIP", 0.02, 1.0),
                Check::Within("e crossed against a isotropic: mean FLIP", 0.02, 1.0),
                Check::Within("e crossed against d one way: mean FLIP", 0.02, 1.0),
            ],
        },
        make: balls,
    },
    Figure {
        name: "yamaguchi-3",
        title: "distributions projected on the base plane",
        source: "Yamaguchi et al. 2019, figure 3",
        caption: "Left: an anisotropic distribution of normals over the plane of its half vectors. Right: the BRDF of that surface over the plane of its \
                  outgoing directions, for light at 45 degrees. Both are ellipses with the same axes, as the paper says; by its equation 4 that of the BRDF \
                  is wider by 2 cos 45 degrees = 1.41 along both. The numbers are the standard deviations of the part of each above half of its greatest value.",
        size: LARGE,
        claim: Claim {
            text: "The distribution of normals and the BRDF are ellipses with the same axes on the base plane, that of the BRDF \
                  wider by 1.41.",
            checks: &[
                Check::Within("BRDF over normals: standard deviation along x", 1.34, 1.49),
                Check::Within("BRDF over normals: standard deviation along y", 1.34, 1.49),
            ],
        },
        make: projected,
    },
];

/// Slopes along and across the tangent, and its turn in degrees, of coat and base.
const BALLS: [(&str, [f64; 3], [f64; 3]); 5] = [
    ("a isotropic", [0.05, 0.05, 0.0], [0.25, 0.25, 0.0]),
    ("b base", [0.05, 0.05, 0.0], [0.45, 0.12, 0.0]),
    ("c coat", [0.25, 0.06, 0.0], [0.25, 0.25, 0.0]),
    ("d one way", [0.25, 0.06, 0.0], [0.45, 0.12, 0.0]),
    ("e crossed", [0.25, 0.06, 90.0], [0.45, 0.12, 0.0]),
];

fn brushed(name: &str, coat: [f64; 3], base: [f64; 3]) -> Outcome<Material> {
    let surface = |[x, y, turn]: [f64; 3]| format!("alpha_x = {x}\nalpha_y = {y}\nrotation_deg = {turn}");
    let text = format!(
        "schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.49\n{}\n[[layer]]\ntype = \"conductor\"\n{}\n\
         ior = {{ n = [0.143, 0.373, 1.444], k = [3.983, 2.387, 1.602], wavelengths_nm = [690, 550, 450] }}\n\
         [bake]\ncolor = \"three-wavelengths\"\nwavelengths_nm = [690, 550, 450]\n",
        surface(coat),
        surface(base)
    );
    Ok(shaded(&material(name, &text)?, name, ShadingModel::Yamaguchi))
}

fn balls(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let mut materials = Vec::new();
    for (i, (_, coat, base)) in BALLS.into_iter().enumerate() {
        materials.push(brushed(&format!("ball-{i}"), coat, base)?);
    }
    let pictures = studio.pictures(&materials, Form::Baked, Shape::Torus, |_, _| {})?;
    for ((label, ..), picture) in BALLS.iter().zip(&pictures).skip(1) {
        made.apart(&format!("{label} against a isotropic"), picture, &pictures[0])?;
    }
    made.apart("e crossed against d one way", &pictures[4], &pictures[3])?;
    made.sheet("yamaguchi-1", BALLS.iter().map(|(label, ..)| (*label).to_owned()).zip(pictures).collect(), 5);
    Ok(made)
}

/// Side of the grid on which deviations are measured.
const FINE: u32 = 768;

/// A picture of a function over the unit disk of the base plane, as a share of its greatest value, with its standard deviations within half of it.
fn over_plane(size: u32, f: impl Fn(f64, f64) -> f64) -> (Image, [f64; 2]) {
    let at = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(size) - 1.0;
    let values: Vec<f64> = (0..size * size)
        .map(|i| (at(i % size), -at(i / size)))
        .map(|(x, y)| if x * x + y * y < 0.999 { f(x, y) } else { 0.0 })
        .collect();
    let most = values.iter().fold(0.0, |a: f64, b| a.max(*b));
    let mut image = Image::zeros(size, size, 3);
    let (mut weight, mut mean, mut square) = (0.0, [0.0; 2], [0.0; 2]);
    for (i, value) in (0..size * size).zip(&values) {
        image.data[3 * i as usize..3 * i as usize + 3].fill((value / most) as f32);
        if *value > 0.5 * most {
            weight += value;
            for (c, x) in [at(i % size), -at(i / size)].into_iter().enumerate() {
                mean[c] += value * x;
                square[c] += value * x * x;
            }
        }
    }
    (image, [0, 1].map(|c: usize| (square[c] / weight - (mean[c] / weight) * (mean[c] / weight)).max(0.0).sqrt()))
}

fn projected(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let text = "schema = 1\nname = \"brushed\"\n[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.4 }\nalpha_x = 0.12\nalpha_y = 0.04\n";
    let stack = Monochrome::new(&material("brushed", text)?.stack, 550.0, 1);
    let model =
        registry::model("microfacet").ok_or_else(|| Failure::Input(anyhow::anyhow!("no model `microfacet`")))?;
    let up = |x: f64, y: f64| DVec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
    // Half vectors of light and eye in one direction: D over the square of the cosine, and masking.
    let fine = |f: &dyn Fn(f64, f64) -> f64| (over_plane(studio.size, f).0, over_plane(FINE, f).1);
    let normals = fine(&|x, y| model.eval(&stack, up(x, y), up(x, y)) * up(x, y).z);
    let wi = DVec3::new(0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt());
    let brdf = fine(&|x, y| model.eval(&stack, wi, up(x, y)));
    let mut pictures: Labelled = Vec::new();
    for (c, axis) in ["x", "y"].into_iter().enumerate() {
        let ratio = brdf.1[c] / normals.1[c].max(1e-9);
        made.measure(format!("BRDF over normals: standard deviation along {axis}"), ratio);
    }
    for (label, (image, [x, y])) in [("normals", normals), ("BRDF", brdf)] {
        made.measure(format!("{label}: standard deviation along x"), x);
        made.measure(format!("{label}: standard deviation along y"), y);
        pictures.push((label.to_owned(), image));
    }
    made.shown("yamaguchi-3", pictures, 2);
    Ok(made)
}
