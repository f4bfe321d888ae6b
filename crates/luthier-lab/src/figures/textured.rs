//! Figures with textures of single layers: crossed tangents, bumps of one interface, flakes of a height field, colours and metal.

use luthier_export::{MemoryStore, Package};
use luthier_gpu::{RenderSettings, Shape};
use luthier_lut::Image;
use luthier_manifest::{Form, MapSlot, ShadingModel};
use luthier_material::Material;
use luthier_terminal::{Failure, Outcome};
use luthier_texture::png;

use super::claim::{Check, Claim};
use super::figure::{Figure, LARGE, Labelled, Made, SMALL, TONE, compared};
use super::numbers::{grain, over_red};
use super::studio::{Studio, layered, mapped};

pub(crate) const FIGURES: [Figure; 5] = [
    Figure {
        name: "elek-6",
        title: "flakes from a height field",
        source: "Elek 2010, figure 6",
        caption: "Chromium flakes under a tinted coat, the heights of the flakes, and the normals that the bake makes of them by finite differences. The flakes are larger than \
                  the paper's, so that single ones can be seen. Heights and numbers are luthier's; `crates/luthier-lab/maps/make.py` draws them.",
        size: LARGE,
        claim: Claim {
            text: "Flakes of a height field sparkle on an object of metallic paint.",
            checks: &[
                Check::Within("flakes against none: mean FLIP", 0.03, 1.0),
                Check::Falls(&["flakes: grain", "none: grain"]),
            ],
        },
        make: flakes,
    },
    Figure {
        name: "elek-line-22",
        title: "a diffuse map under lacquers",
        source: "Elek 2010, Algorithm 1, line 22, which no figure shows",
        caption: "A painted base, the same under a clear lacquer, and under a lacquer that absorbs. The map multiplies the albedo of the base. Map and numbers are luthier's.",
        size: LARGE,
        claim: Claim {
            text: "A map colours the base, and lacquers lie over it.",
            checks: &[
                Check::Within("clear, with the map against without: mean FLIP", 0.1, 1.0),
                Check::Falls(&["clear: blue over red", "tinted: blue over red"]),
            ],
        },
        make: painted,
    },
    Figure {
        name: "lecture-metal",
        title: "textures of base colour and metal",
        source: "The lecture's slide on textures, which has no figure of a layered surface",
        caption: "A metallic-roughness surface without metal, with a map of how metallic it is, and all of metal. The left and the right picture have a white map in its place. \
                  In the middle paint has come off a metal. Maps and numbers are luthier's.",
        size: LARGE,
        claim: Claim {
            text: "One map makes some places of a surface metal and leaves others paint.",
            checks: &[
                Check::Within("the map against paint: mean FLIP", 0.05, 1.0),
                Check::Within("the map against metal: mean FLIP", 0.05, 1.0),
            ],
        },
        make: metal,
    },
    Figure {
        name: "yamaguchi-2",
        title: "a ball with two crossed fields",
        source: "Yamaguchi et al. 2019, figure 2",
        caption: "A coat of index 1.49 on gold, by Yamaguchi's model. From left to right: both layers isotropic, as Belcour's model has them; the tangents of the base on circles \
                  around the middle; those of the coat on rays; both, so that the fields cross everywhere. Each layer has a map of its own. The paper's fields and slopes \
                  are not known; these are luthier's.",
        size: SMALL,
        claim: Claim {
            text: "Each layer follows a field of tangents of its own, which isotropic distributions cannot show.",
            checks: &[
                Check::Within("base against isotropic: mean FLIP", 0.02, 1.0),
                Check::Within("coat against isotropic: mean FLIP", 0.02, 1.0),
                Check::Within("crossed against isotropic: mean FLIP", 0.02, 1.0),
            ],
        },
        make: crossed,
    },
    Figure {
        name: "course-3-9-own",
        title: "bumps of one interface",
        source: "Weidlich and Wilkie 2009, figure 3.9d and its reverse",
        caption: "A matt varnish over aluminium: bumps of the metal alone, bumps of the varnish alone above flat metal, and bumps of both. Where the metal is flat, its \
                  reflection is bent by the bumps through which it is seen, less than a bumpy metal bends it. Dark spots are where light that is mirrored inside \
                  would be totally reflected on its way out, which bumps of both avoid. Map and numbers are luthier's.",
        size: SMALL,
        claim: Claim {
            text: "Bumps of the metal alone leave the reflection of the varnish as it is, and bumps of the varnish alone bend the \
                  metal less than its own do.",
            checks: &[Check::Falls(&[
                "below against flat: RMSE of linear radiance",
                "above against flat: RMSE of linear radiance",
            ])],
        },
        make: bumps,
    },
];

/// Renders materials whose maps are those of the lab.
fn pictures(studio: &Studio, materials: Vec<Material>, form: Form, shape: Shape) -> Outcome<Vec<Image>> {
    let materials: Vec<Material> = materials.into_iter().map(mapped).collect();
    studio.pictures(&materials, form, shape, |_, _| {})
}

/// Says how far two pictures are apart.
fn measure(made: &mut Made, what: &str, a: &Image, b: &Image) -> Outcome {
    let apart = compared(a, b)?;
    made.measure(format!("{what}: RMSE of linear radiance"), apart.rms_err);
    made.measure(format!("{what}: mean FLIP"), apart.flip_mean);
    Ok(())
}

/// A map in another size, its first channel as grey where it has one colour.
fn scaled(map: &Image, size: u32) -> Image {
    let mut shown = Image::zeros(size, size, 3);
    for y in 0..size {
        for x in 0..size {
            let texel = map.texel(x * map.width / size, y * map.height / size);
            shown.texel_mut(x, y).copy_from_slice(&[texel[0], texel[1], texel[2]]);
        }
    }
    shown
}

const CHROMIUM: &str = "[[layer]]\ntype = \"conductor\"\n\
     ior = { n = [3.84, 3.18, 1.99], k = [4.37, 4.41, 4.22], wavelengths_nm = [690, 550, 450] }\n\
     alpha = 0.12\ndistribution = \"beckmann\"\n";

fn lacquer(absorption: &str) -> String {
    format!(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.03\ndistribution = \"beckmann\"\nthickness_um = 3\n\
         absorption_per_um = {absorption}\n"
    )
}

fn flakes(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let heights =
        "[effects.flakes]\nheight_map = { image = \"heights.png\", height = 0.03 }\ntiling = 2\nfade_start = 1000\n";
    let coat = lacquer("[0.02, 0.2, 0.6]");
    let with = mapped(layered("flakes", &(coat.clone() + CHROMIUM + heights), ShadingModel::Elek)?);
    let package = Package::for_renderer(&[with], &MemoryStore::default())?;
    let ball = studio.rendered(&package, Form::Full, Shape::Sphere, |_, _| {})?.swap_remove(0);
    let plain = layered("no-flakes", &(coat + CHROMIUM), ShadingModel::Elek)?;
    let plain = pictures(studio, vec![plain], Form::Full, Shape::Sphere)?.swap_remove(0);
    measure(&mut made, "flakes against none", &ball, &plain)?;
    made.measure("flakes: grain", grain(&ball));
    made.measure("none: grain", grain(&plain));
    let heights = png::decode(include_bytes!("../../maps/heights.png")).map_err(Failure::input)?;
    let mut shown: Labelled = vec![("ball".to_owned(), TONE.image(ball))];
    shown.push(("heights".to_owned(), scaled(&heights, studio.size)));
    if let Some(map) = package.maps.iter().find(|map| map.slot == MapSlot::FlakeNormal) {
        shown.push(("normals".to_owned(), scaled(&map.image, studio.size)));
    }
    made.shown("elek-6", shown, 3);
    Ok(made)
}

fn painted(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let base = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.9\nmaps = { albedo = \"paint.png\" }\n";
    let all = [("bare", String::new()), ("clear", lacquer("0")), ("tinted", lacquer("[0.02, 0.12, 0.3]"))];
    let mut materials = Vec::new();
    for (label, coat) in &all {
        materials.push(layered(&format!("paint-{label}"), &(coat.clone() + base), ShadingModel::Elek)?);
    }
    let even = layered(
        "even",
        &(lacquer("0") + &base.replace("maps = { albedo = \"paint.png\" }\n", "")),
        ShadingModel::Elek,
    )?;
    let even = pictures(studio, vec![even], Form::Full, Shape::Sphere)?.swap_remove(0);
    let shown = pictures(studio, materials, Form::Full, Shape::Sphere)?;
    measure(&mut made, "clear, with the map against without", &shown[1], &even)?;
    for ((label, _), picture) in all.iter().zip(&shown) {
        made.measure(format!("{label}: blue over red"), over_red(picture, 2));
    }
    made.sheet("elek-line-22", all.iter().map(|(label, _)| (*label).to_owned()).zip(shown).collect(), 3);
    Ok(made)
}

fn metal(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let surface = |metallic: u32, maps: &str| {
        format!(
            "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.95, 0.6, 0.4]\nmetallic = {metallic}\nroughness = 0.5\n{maps}"
        )
    };
    let all = [
        ("paint", surface(0, "")),
        ("map", surface(1, "maps = { metallic = \"thickness.png\" }\n")),
        ("metal", surface(1, "")),
    ];
    let mut shown = Vec::new();
    for (label, layers) in &all {
        let material = layered(&format!("metal-{label}"), layers, ShadingModel::Elek)?;
        shown.extend(pictures(studio, vec![material], Form::Full, Shape::Sphere)?);
    }
    measure(&mut made, "the map against paint", &shown[1], &shown[0])?;
    measure(&mut made, "the map against metal", &shown[1], &shown[2])?;
    made.sheet("lecture-metal", all.iter().map(|(label, _)| (*label).to_owned()).zip(shown).collect(), 3);
    Ok(made)
}

fn crossed(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let all = [
        ("isotropic", ["", ""], [0.12, 0.12], [0.23, 0.23]),
        ("base", ["", "circles.png"], [0.12, 0.12], [0.45, 0.12]),
        ("coat", ["rays.png", ""], [0.25, 0.06], [0.23, 0.23]),
        ("crossed", ["rays.png", "circles.png"], [0.25, 0.06], [0.45, 0.12]),
    ];
    let mut shown = Vec::new();
    for (label, [coat, base], above, below) in all {
        let surface = |[x, y]: [f64; 2], map: &str| {
            let map = if map.is_empty() { String::new() } else { format!("maps = {{ tangent = \"{map}\" }}\n") };
            format!("alpha_x = {x}\nalpha_y = {y}\n{map}")
        };
        let layers = format!(
            "[[layer]]\ntype = \"dielectric\"\nior = 1.49\n{}[[layer]]\ntype = \"conductor\"\n\
             ior = {{ n = [0.143, 0.373, 1.444], k = [3.983, 2.387, 1.602], wavelengths_nm = [690, 550, 450] }}\n{}",
            surface(above, coat),
            surface(below, base)
        );
        let material = layered(&format!("field-{label}"), &layers, ShadingModel::Yamaguchi)?;
        shown.extend(pictures(studio, vec![material], Form::Baked, Shape::Sphere)?);
    }
    for (label, picture) in ["base", "coat", "crossed"].into_iter().zip(&shown[1..]) {
        measure(&mut made, &format!("{label} against isotropic"), picture, &shown[0])?;
    }
    made.sheet("yamaguchi-2", all.iter().map(|(label, ..)| (*label).to_owned()).zip(shown).collect(), 4);
    Ok(made)
}

fn bumps(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let layers = |coat: &str, base: &str| {
        let bumpy = "maps = { bumps = \"bumps.png\" }\n";
        let of = |which: &str| if which == "bumps" { bumpy } else { "" };
        let varnish = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nslope_deg = 4\ndistribution = \"beckmann\"\nthickness_um = 0.3\n";
        let metal = "[[layer]]\ntype = \"conductor\"\nior = \"al\"\nslope_deg = 6\ndistribution = \"beckmann\"\n";
        [varnish, of(coat), metal, of(base)].concat()
    };
    let all = [("flat", "", ""), ("below", "", "bumps"), ("above", "bumps", ""), ("both", "bumps", "bumps")];
    let mut shown = Vec::new();
    for (label, coat, base) in all {
        let material = layered(&format!("bumps-{label}"), &layers(coat, base), ShadingModel::WeidlichWilkie)?;
        // Directions are drawn about the level surface: steep bumps need more.
        let drawn = |_, settings: &mut RenderSettings| settings.environment_samples = 128;
        shown.extend(studio.pictures(&[mapped(material)], Form::Full, Shape::Torus, drawn)?);
    }
    for (label, picture) in ["below", "above", "both"].into_iter().zip(&shown[1..]) {
        measure(&mut made, &format!("{label} against flat"), picture, &shown[0])?;
    }
    made.sheet("course-3-9-own", all.iter().map(|(label, ..)| (*label).to_owned()).zip(shown).collect(), 4);
    Ok(made)
}
