//! Figures of the course of Weidlich and Wilkie about the look of materials.

use std::path::Path;

use luthier::Sources;
use luthier_gpu::Shape;
use luthier_lut::Image;
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;
use luthier_optics::color::luminance;
use luthier_report::lightness_chroma_hue;
use luthier_terminal::{Failure, Outcome, valid};

use super::claim::{Check, Claim};
use super::course::{by_course, exposure};
use super::figure::{Figure, Labelled, MEDIUM, Made, SMALL};
use super::numbers::light::{FROM_EYE, KEY, even_sky};
use super::numbers::places::color_at;
use super::numbers::spot::spot;
use super::numbers::tint::{chroma, hue, saturation};
use super::numbers::{blown_out, brightest, variation};
use super::studio::{Studio, material, shaded};

pub(crate) const FIGURES: [Figure; 2] = [
    Figure {
        name: "course-4-1",
        title: "metals, coated metals and paints",
        source: "Weidlich and Wilkie 2009, figure 4.1",
        caption: "Top row: gold, silver and copper, whose highlights have the colour of the metal. Middle row: silver under three coloured lacquers. Bottom row: \
                  the same lacquers over a white base. Middle and bottom have equal lacquers and slopes, and the same colours, as in the course. \
                  The metals mirror the surroundings; the paints mirror next to nothing of them, and show their colour all over. The colour of a highlight is one less the smallest channel over the largest, in the middle of a ball under a white light from the eye. The \
                  contrast of the surroundings is the variation of luminance without the light, over the mean. Hues are those of the mean of the middle.",
        seen: "The spheres of one colour differ as in the course: lamps and floor are seen in the metals, and a faint sheen in the paints.",
        size: MEDIUM,
        claim: Claim {
            text: "Highlights of gold and copper have a colour, and that of silver has none. Metals under a lacquer and paints of the same \
                   colour and roughness still look different: the metals reflect the surroundings clearly, the paints only weakly.",
            checks: &[
                Check::Falls(&["gold: colour of the highlight", "silver: colour of the highlight"]),
                Check::Falls(&["copper: colour of the highlight", "silver: colour of the highlight"]),
                // Silver's F0 in the lecture, 0.972, 0.960, 0.915, has 0.06.
                Check::Within("silver: colour of the highlight", 0.0, 0.1),
                // Neighbours in Munsell's circle of ten hues are 36 degrees apart.
                Check::Within("purple: difference of hue", 0.0, 18.0),
                Check::Within("orange: difference of hue", 0.0, 18.0),
                Check::Within("green: difference of hue", 0.0, 18.0),
                Check::Within("purple: contrast of the surroundings in metal over paint", 2.0, 100.0),
                Check::Within("orange: contrast of the surroundings in metal over paint", 2.0, 100.0),
                Check::Within("green: contrast of the surroundings in metal over paint", 2.0, 100.0),
            ],
        },
        make: metals,
    },
    Figure {
        name: "course-5-7",
        title: "samples of materials",
        source: "Weidlich and Wilkie 2009, figure 5.7 and section 5.1",
        caption: "The samples of chapter 5 from the files in `materials/papers/` by the course's model: frosted paints (sugar, latex, house paint, frosted acrylic), \
                  glossy paints (ceramic glaze, red and acrylic lacquer), foils (brass, polished gold), metallic paints (gold, blue), frosted metal (silver and gold paint), and a car \
                  paint. Four from `materials/surfaces/paints/` the course has in words: garnet red, a rough clear varnish of slope 12 degrees and index 1.6 over Munsell's 7.5R 2/8; \
                  a Christmas orb, tinted lacquer over a silvered inside; fabric, of several layers; and specular fluorescent paint, in white light. Silver, gold metallic paint and sugar have less exposure than the others. \
                  Widths and brightest places are those under the key light alone. The highlight over the base is the brightest light of the coat over a black base, over the \
                  brightest of what the base adds. Saturation is that of what the base adds under a light from the eye. It grows to the rim of the red lacquer by one part in a hundred, which no eye sees, because the base of that sheet is itself of a deep red \
                  (albedo 1, 0.03, 0.05), which absorption cannot deepen much.",
        seen: "The samples are recognised: matt, glossy, metallic. As in course-classes, the frosted metals (f) mirror too sharply. The \
               saturation of the red lacquer grows by less than an eye sees.",
        size: SMALL,
        claim: Claim {
            text: "Ceramic glaze looks smoother than the lacquer, and mirrors more brightly than acrylic. The tinted lacquer gets more \
                  saturated to the rim, and the glaze has one colour all over. Sugar and latex have very weak highlights. \
                  Garnet red mirrors more at grazing angles. Car paint is darker at its edges.",
            checks: &[
                Check::Falls(&["red-lacquer: width of the highlight", "ceramic-glaze: width of the highlight"]),
                Check::Falls(&["ceramic-glaze: brightest place", "acrylic-lacquer: brightest place"]),
                Check::Falls(&[
                    "red-lacquer: saturation at the rim over that in the middle",
                    "ceramic-glaze: saturation at the rim over that in the middle",
                ]),
                // The least difference of saturation that an eye sees is about 2.3 of 100.
                Check::Within("ceramic-glaze: saturation at the rim over that in the middle", 0.977, 1.023),
                // Very weak: the coat adds at most a tenth to the base.
                Check::Within("sugar: highlight over the base", 0.0, 0.1),
                Check::Within("latex: highlight over the base", 0.0, 0.1),
                Check::Falls(&["ceramic-glaze: highlight over the base", "sugar: highlight over the base"]),
                Check::Falls(&["ceramic-glaze: highlight over the base", "latex: highlight over the base"]),
                Check::Falls(&["garnet-red: highlight of a grazing light", "garnet-red: highlight of a steep light"]),
                Check::Falls(&[
                    "car-paint: luminance in the middle, all around",
                    "car-paint: luminance at the rim, all around",
                ]),
            ],
        },
        make: samples,
    },
];

fn metal(ior: &str) -> String {
    format!("[[layer]]\ntype = \"conductor\"\nior = \"{ior}\"\nslope_deg = 4\ndistribution = \"beckmann\"\n")
}

fn lacquer(absorption: [f64; 3]) -> String {
    format!(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nslope_deg = 2\ndistribution = \"beckmann\"\nthickness_um = 1\n\
         absorption_per_um = {absorption:?}\n"
    )
}

/// Absorption of a purple, an orange and a green lacquer.
const LACQUERS: [(&str, [f64; 3]); 3] =
    [("purple", [0.25, 1.1, 0.2]), ("orange", [0.02, 0.45, 1.6]), ("green", [1.1, 0.15, 0.8])];

fn metals(studio: &Studio, made: &mut Made) -> Outcome {
    let mut all = Vec::new();
    for (name, ior) in [("gold", "au"), ("silver", "ag"), ("copper", "cu")] {
        all.push((name.to_owned(), by_course(name, &metal(ior))?));
    }
    for (kind, below) in
        [("metal", metal("ag")), ("paint", "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.85\n".to_owned())]
    {
        for (color, absorption) in LACQUERS {
            let name = format!("{color}-{kind}");
            all.push((color.to_owned(), by_course(&name, &(lacquer(absorption) + &below))?));
        }
    }
    let materials: Vec<Material> = all.iter().map(|(_, material)| material.clone()).collect();
    let pictures = studio.pictures(&materials, Form::Full, Shape::Sphere, |_, _| {})?;
    let lit = studio.lit(&materials, Form::Full, Shape::Sphere, FROM_EYE)?;
    let room = studio.pictures(&materials, Form::Full, Shape::Sphere, |_, settings| settings.lights.clear())?;
    for ((_, material), ((picture, lit), room)) in all.iter().zip(pictures.iter().zip(&lit).zip(&room)) {
        let name = &material.name;
        let channels = color_at(lit, [0.0; 2]);
        let [least, most] =
            [channels.into_iter().fold(f64::INFINITY, f64::min), channels.into_iter().fold(0.0, f64::max)];
        made.measure(format!("{name}: colour of the highlight"), 1.0 - least / most.max(1e-9));
        made.measure(format!("{name}: contrast of the surroundings"), variation(room));
        made.measure(format!("{name}: chroma"), chroma(picture));
    }
    for (color, _) in LACQUERS {
        let [on_metal, on_paint] = ["metal", "paint"].map(|kind| {
            let at =
                materials.iter().position(|material| material.name == format!("{color}-{kind}")).unwrap_or_default();
            (variation(&room[at]), hue(&pictures[at], 0.5))
        });
        let ratio = on_metal.0 / on_paint.0.max(1e-9);
        made.measure(format!("{color}: contrast of the surroundings in metal over paint"), ratio);
        let apart = (on_metal.1 - on_paint.1).rem_euclid(360.0);
        made.measure(format!("{color}: difference of hue"), apart.min(360.0 - apart));
    }
    made.sheet("course-4-1", all.into_iter().map(|(name, _)| name).zip(pictures), 3);
    Ok(())
}

macro_rules! sample {
    ($name:literal, $label:literal) => {
        ($name, $label, include_str!(concat!("../../../../materials/papers/", $name, ".toml")))
    };
    // One that is not in the course.
    ($name:literal, $label:literal, own) => {
        ($name, $label, include_str!(concat!("../../../../materials/", $name, ".toml")))
    };
}

const SAMPLES: [(&str, &str, &str); 14] = [
    sample!("sugar", "sugar"),
    sample!("latex", "latex"),
    sample!("house-paint", "house"),
    sample!("frosted-acrylic", "frosted"),
    sample!("ceramic-glaze", "glaze"),
    sample!("red-lacquer", "lacquer"),
    sample!("acrylic-lacquer", "acrylic"),
    sample!("brass-foil", "brass"),
    sample!("polished-gold", "gold", own),
    sample!("gold-metallic-paint", "gold"),
    sample!("blue-metallic-paint", "blue"),
    sample!("silver-paint", "silver"),
    sample!("gold-paint", "gold"),
    sample!("car-paint", "car paint"),
];

/// Paints that the course has in words, with their labels.
const PAINTS: [(&str, &str); 4] =
    [("garnet-red", "garnet"), ("christmas-orb", "orb"), ("fabric", "fabric"), ("fluorescent-paint", "day-glo")];

/// Text of [`PAINTS`]' first.
const GARNET: &str = include_str!("../../../../materials/surfaces/paints/garnet-red.toml");

/// A paint of the repository.
fn paint(name: &str) -> Outcome<Material> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../materials/surfaces/paints/{name}.toml"));
    let materials = valid(Sources::read([path])?.materials, true)?;
    materials.into_iter().next().ok_or_else(|| Failure::Input(anyhow::anyhow!("{name} is no material")))
}

fn samples(studio: &Studio, made: &mut Made) -> Outcome {
    let mut all = Vec::new();
    for (name, label, text) in SAMPLES {
        all.push((label.to_owned(), shaded(&material(name, text)?, name, ShadingModel::WeidlichWilkie)));
    }
    for (name, label) in PAINTS {
        all.push((label.to_owned(), paint(name)?));
    }
    measured(studio, made, &all)?;
    let mut pictures: Labelled = Vec::new();
    for (label, material) in &all {
        let shown = studio.pictures(std::slice::from_ref(material), Form::Full, Shape::Sphere, |_, settings| {
            settings.exposure = exposure(&material.name)
        })?;
        for picture in shown {
            let middle = picture.texel(picture.width / 2, picture.height / 2);
            let [lightness, chroma, _] = lightness_chroma_hue([0, 1, 2].map(|c: usize| f64::from(middle[c])));
            made.measure(format!("{}, middle of the ball: lightness", material.name), lightness);
            made.measure(format!("{}, middle of the ball: chroma", material.name), chroma);
            made.measure(format!("{}: share blown out", material.name), blown_out(&picture));
            pictures.push((format!("{} {label}", material.class.symbol()), picture));
        }
    }
    made.sheet("course-5-7", pictures, 6);
    Ok(())
}

/// A place at 0.9 of the radius of a ball.
const RIM: [f64; 2] = [0.72, 0.0];

/// Direction of a light that falls on a ball from behind and grazes what is seen.
const GRAZING: [f32; 3] = [0.95, 0.0, -0.3];

/// Numbers of the samples under single lights.
fn measured(studio: &Studio, made: &mut Made, all: &[(String, Material)]) -> Outcome {
    let materials: Vec<Material> = all.iter().map(|(_, material)| material.clone()).collect();
    for (material, lit) in materials.iter().zip(studio.lit(&materials, Form::Full, Shape::Sphere, KEY)?) {
        made.measure(format!("{}: width of the highlight", material.name), spot(&lit).share.sqrt());
        made.measure(format!("{}: brightest place", material.name), brightest(&lit));
    }
    // With a black base, the light of the coat alone is left.
    for name in ["ceramic-glaze", "red-lacquer", "sugar", "latex", "garnet-red"] {
        let Some(whole) = materials.iter().find(|material| material.name == name) else { continue };
        let file = SAMPLES.iter().find(|(sample, ..)| *sample == name).map_or(GARNET, |(.., text)| text);
        let coat = shaded(&material(name, &black(file))?, "black", ShadingModel::WeidlichWilkie);
        let pair = [whole.clone(), coat];
        let [key, eye] = [KEY, FROM_EYE].map(|from| studio.lit(&pair, Form::Full, Shape::Sphere, from));
        let (key, eye) = (key?, eye?);
        if let ([whole, coat], [seen, mirrored]) = (key.as_slice(), eye.as_slice()) {
            made.measure(
                format!("{name}: highlight over the base"),
                brightest(coat) / brightest(&without(whole, coat)),
            );
            let base = without(seen, mirrored);
            let [middle, rim] = [[0.0; 2], RIM].map(|place| saturation(color_at(&base, place)));
            made.measure(format!("{name}: saturation at the rim over that in the middle"), rim / middle.max(1e-9));
        }
        if name == "garnet-red" {
            for (what, direction) in [("grazing", GRAZING), ("steep", FROM_EYE)] {
                let lit = studio.lit(&pair[1..], Form::Full, Shape::Sphere, direction)?;
                made.measure(format!("{name}: highlight of a {what} light"), lit.first().map_or(0.0, brightest));
            }
        }
    }
    let white = even_sky(1.0)?;
    let car: Vec<Material> = materials.into_iter().filter(|material| material.name == "car-paint").collect();
    let around = studio.pictures(&car, Form::Full, Shape::Sphere, |_, settings| {
        settings.lights.clear();
        settings.environment = white.clone();
    })?;
    for (side, place) in [("in the middle", [0.0; 2]), ("at the rim", RIM)] {
        let value = around.first().map_or(0.0, |picture| luminance(color_at(picture, place)));
        made.measure(format!("car-paint: luminance {side}, all around"), value);
    }
    Ok(())
}

/// The text of a material with a black base.
fn black(text: &str) -> String {
    text.lines().map(|line| if line.starts_with("albedo") { "albedo = 0\n" } else { line }.to_owned() + "\n").collect()
}

/// A picture less another.
fn without(image: &Image, other: &Image) -> Image {
    let mut rest = image.clone();
    rest.data.iter_mut().zip(&other.data).for_each(|(a, b)| *a -= b);
    rest
}
