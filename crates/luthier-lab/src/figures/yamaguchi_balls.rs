//! Figures of Yamaguchi et al. 2019 about anisotropy: layered balls, and distributions projected on the base plane.

use glam::DVec3;
use luthier_gpu::{Backdrop, Shape};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::registry;
use luthier_lut::Image;
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::figure::{Figure, LARGE, Labelled, Made, SMALL};
use super::numbers::across;
use super::numbers::light::FROM_EYE;
use super::numbers::spot::{Spot, spot, spot_in, spot_of};
use super::studio::{Studio, material, shaded};

pub(crate) const FIGURES: [Figure; 2] = [
    Figure {
        name: "yamaguchi-1",
        title: "isotropic and anisotropic layers",
        source: "Yamaguchi et al. 2019, figure 1",
        caption: "Coats of index 1.49 under the surroundings, by Yamaguchi's model, on a torus whose tangents follow the ring. The bases are the printed ones: of index (1 + 1i, 1, 1) in (a) to (d), which \
                  reflects red, and green and blue only at the rim, where light in the coat is reflected totally, and of (e)'s gold. From left to right: both layers isotropic (a); an anisotropic base (b); an anisotropic coat (c); both, along one tangent (d); both, the coat across (e). \
                  The paper does not print which of (a) to (d) has which; these are luthier's, as are meshes, slopes and surroundings. The bases of (a) to (d) are dark: their pictures have four times the exposure. The numbers are of balls of the same materials under one light \
                  from the eye, whose tangents are level: the standard deviation of the highlight to the side over that upwards. That of the base is red less blue, which the coat does not tint. `coat alone` is the coat over an opaque absorber.",
        seen: "Highlights are round in (a), long in one layer in (b) and (c) and in both in (d), and cross in (e). The paper's meshes, \
               slopes and surroundings are not known, so that only the kinds of highlights can be compared.",
        size: SMALL,
        claim: Claim {
            text: "Each layer may be isotropic or anisotropic along its own tangents, which differ from layer to layer. The highlight of \
                  a layer is round where it is isotropic, and else stretched along its own tangent.",
            checks: &[
                Check::Within("a isotropic: length of the base's highlight over its height", 0.95, 1.05),
                Check::Within("a isotropic: length of the whole highlight over its height", 0.95, 1.05),
                Check::Within("b base: length of the base's highlight over its height", 1.1, 100.0),
                Check::Within("c coat: length of the whole highlight over its height", 1.1, 100.0),
                Check::Within("d one way: length of the base's highlight over its height", 1.1, 100.0),
                Check::Within("e crossed: length of the base's highlight over its height", 1.1, 100.0),
                Check::Falls(&[
                    "d one way: length of the whole highlight over its height",
                    "e crossed: length of the whole highlight over its height",
                ]),
                Check::Within("coat alone, one way: length of the whole highlight over its height", 1.1, 100.0),
                Check::Within("coat alone, crossed: length of the whole highlight over its height", 0.01, 0.9),
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
                  is wider by 2 cos 45 degrees = 1.41 along both. The numbers are the standard deviations of the part of each above half of its greatest value. \
                  `turned` is the same surface, whose tangent is 30 degrees from the plane of the light.",
        seen: "Two ellipses with level axes, the right one larger and to the side, as in the paper.",
        size: LARGE,
        claim: Claim {
            text: "The distribution of normals and the BRDF are ellipses with the same axes on the base plane, that of the BRDF \
                  wider by 1.41.",
            checks: &[
                Check::Within("BRDF over normals: standard deviation along x", 1.34, 1.49),
                Check::Within("BRDF over normals: standard deviation along y", 1.34, 1.49),
                // Turned by 30 degrees against the plane of the light, so that neither axis is that of the light.
                Check::Within("turned: axis of the normals, degrees", 25.0, 35.0),
                Check::Within("turned: axis of the BRDF less that of the normals, degrees", -5.0, 5.0),
            ],
        },
        make: projected,
    },
];

/// Slopes along and across the tangent, and its turn in degrees, of coat and base, and the index of the base.
type Ball = (&'static str, [f64; 3], [f64; 3], &'static str);

pub(super) const BALLS: [Ball; 5] = [
    ("a isotropic", [0.05, 0.05, 0.0], [0.2, 0.2, 0.0], RED),
    ("b base", [0.05, 0.05, 0.0], [0.45, 0.08, 0.0], RED),
    ("c coat", [0.3, 0.05, 0.0], [0.2, 0.2, 0.0], RED),
    ("d one way", [0.3, 0.05, 0.0], [0.45, 0.08, 0.0], RED),
    ("e crossed", [0.05, 0.3, 0.0], [0.45, 0.08, 0.0], GOLD),
];

/// Index of the bases of figure 1 (a) to (d): red alone is reflected by more than the step to the coat. Wavelengths are labels, see
/// `materials/papers/yamaguchi-brushed.toml`.
pub(super) const RED: &str = "{ n = [1, 1, 1], k = [1, 0, 0], wavelengths_nm = [690, 550, 450] }";

/// Index of the base of figure 1 (e).
pub(super) const GOLD: &str =
    "{ n = [0.143, 0.373, 1.444], k = [3.983, 2.387, 1.602], wavelengths_nm = [690, 550, 450] }";

/// A coat of index 1.49 on a base of an index, with slopes, and with further keys of the coat.
pub(super) fn brushed(name: &str, coat: [f64; 3], base: [f64; 3], ior: &str, more: &str) -> Outcome<Material> {
    let [coat, base] = [coat, base].map(|[x, y, turn]| format!("alpha_x = {x}\nalpha_y = {y}\nrotation_deg = {turn}"));
    let text = format!(
        "schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.49\n{coat}\n{more}[[layer]]\ntype = \"conductor\"\n{base}\n\
         ior = {ior}\n[bake]\ncolor = \"three-wavelengths\"\nwavelengths_nm = [690, 550, 450]\n"
    );
    Ok(shaded(&material(name, &text)?, name, ShadingModel::Yamaguchi))
}

/// Factor on the exposure of pictures of [`RED`], which reflects 17 parts of 100 in red, and 4 else.
const BRIGHTER: f32 = 4.0;

fn balls(studio: &Studio, made: &mut Made) -> Outcome {
    let mut materials = Vec::new();
    for (i, (_, coat, base, ior)) in BALLS.into_iter().enumerate() {
        materials.push(brushed(&format!("ball-{i}"), coat, base, ior, "")?);
    }
    let pictures = studio.pictures(&materials, Form::Baked, Shape::Torus, |n, settings| {
        settings.exposure = if BALLS[n].3 == RED { BRIGHTER } else { 1.0 };
        settings.backdrop = Backdrop::Plain([0.1 / settings.exposure; 3]);
    })?;
    for (name, turn) in [("alone-one-way", 0.0), ("alone-crossed", 90.0)] {
        // The light of the base is lost on its way.
        materials.push(brushed(
            name,
            [0.3, 0.05, turn],
            [0.2, 0.2, 0.0],
            GOLD,
            "thickness_um = 1\nabsorption_per_um = 100\n",
        )?);
    }
    let lit = studio.lit(&materials, Form::Baked, Shape::Sphere, FROM_EYE)?;
    let labels = BALLS.iter().map(|(label, ..)| *label).chain(["coat alone, one way", "coat alone, crossed"]);
    for (label, picture) in labels.zip(&lit) {
        made.measure(format!("{label}: length of the whole highlight over its height"), spot(picture).elongation());
        // The coat reflects without colour, and the bases do not.
        let base = spot_of(picture, |[red, _, blue]| red - blue).elongation();
        made.measure(format!("{label}: length of the base's highlight over its height"), base);
    }
    made.sheet("yamaguchi-1", BALLS.iter().map(|(label, ..)| *label).zip(pictures), 5);
    Ok(())
}

/// Side of the grid on which deviations are measured.
const FINE: u32 = 768;

/// A picture of a function of directions above the base plane, and its spot on a fine grid.
fn fine(size: u32, f: &dyn Fn(DVec3) -> f64) -> (Image, Spot) {
    let f = |x: f64, y: f64| f(DVec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt()));
    (over_plane(size, f).0, over_plane(FINE, f).1)
}

/// A picture of a function over the unit disk of the base plane, as a share of its greatest value, with the part above half of it.
fn over_plane(size: u32, f: impl Fn(f64, f64) -> f64) -> (Image, Spot) {
    let values: Vec<f64> = (0..size * size)
        .map(|i| (across(i % size, size), -across(i / size, size)))
        .map(|(x, y)| if x * x + y * y < 0.999 { f(x, y) } else { 0.0 })
        .collect();
    let most = values.iter().fold(0.0, |a: f64, b| a.max(*b));
    let mut image = Image::zeros(size, size, 3);
    for (texel, value) in image.data.chunks_mut(3).zip(&values) {
        texel.fill((value / most) as f32);
    }
    (image, spot_in(&values, size))
}

fn projected(studio: &Studio, made: &mut Made) -> Outcome {
    let text = "schema = 1\nname = \"brushed\"\n[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.4 }\nalpha_x = 0.12\nalpha_y = 0.04\n";
    let stack = Monochrome::new(&material("brushed", text)?.stack, 550.0, 1);
    let turned = Monochrome::new(&material("turned", &format!("{text}rotation_deg = 30\n"))?.stack, 550.0, 1);
    let model =
        registry::model("microfacet").ok_or_else(|| Failure::Input(anyhow::anyhow!("no model `microfacet`")))?;
    let wi = DVec3::new(0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt());
    let [(normals, brdf), (turned_normals, turned_brdf)] = [&stack, &turned].map(|stack| {
        // Half vectors of light and eye in one direction: D over the square of the cosine, and masking.
        let normals = fine(studio.size, &|wo| model.eval(stack, wo, wo) * wo.z);
        (normals, fine(studio.size, &|wo| model.eval(stack, wi, wo)))
    });
    let axes = [turned_normals, turned_brdf].map(|(_, spot)| spot.axis_deg());
    made.measure("turned: axis of the normals, degrees", axes[0]);
    made.measure("turned: axis of the BRDF less that of the normals, degrees", axes[1] - axes[0]);
    let [normals, brdf] =
        [normals, brdf].map(|(image, spot)| (image, [spot.deviation([1.0, 0.0]), spot.deviation([0.0, 1.0])]));
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
    Ok(())
}
