//! Figures of the course of Weidlich and Wilkie about the look of materials.

use luthier_gpu::{RenderSettings, Shape};
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;
use luthier_report::lightness_chroma_hue;
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::course::{by_course, exposure};
use super::figure::{Figure, Labelled, MEDIUM, Made, SMALL};
use super::numbers::{blown_out, highlight, variation};
use super::studio::{Studio, material, shaded};

pub(crate) const FIGURES: [Figure; 2] = [
    Figure {
        name: "course-4-1",
        title: "metals, coated metals and paints",
        source: "Weidlich and Wilkie 2009, figure 4.1",
        caption: "Top row: gold, silver and copper, whose highlights have the colour of the metal. Middle row: silver under three coloured lacquers. Bottom row: \
                  the same lacquers over a white base. Middle and bottom have equal lacquers and slopes; the metals mirror the surroundings, the paints show their \
                  colour, as the course says. The numbers are the variation of luminance over each picture, divided by its mean.",
        size: MEDIUM,
        claim: Claim {
            text: "Metals and coated metals mirror the surroundings, and paints show their own colour.",
            checks: &[
                Check::Falls(&[
                    "gold: variation of luminance",
                    "purple-metal: variation of luminance",
                    "purple-paint: variation of luminance",
                ]),
                Check::Falls(&[
                    "silver: variation of luminance",
                    "orange-metal: variation of luminance",
                    "orange-paint: variation of luminance",
                ]),
                Check::Falls(&[
                    "copper: variation of luminance",
                    "green-metal: variation of luminance",
                    "green-paint: variation of luminance",
                ]),
            ],
        },
        make: metals,
    },
    Figure {
        name: "course-5-7",
        title: "samples of materials",
        source: "Weidlich and Wilkie 2009, figure 5.7 and section 5.1",
        caption: "The samples of chapter 5 from the files in `materials/` by the course's model: frosted paints (sugar, latex, house paint, frosted acrylic), \
                  glossy paints (ceramic glaze, red and acrylic lacquer), foils (brass, polished gold), metallic paints (gold, blue), frosted metal (silver and gold paint), a car \
                  paint, and two samples that the course has in words alone: garnet red, a rough clear varnish of slope 12 degrees and index 1.6 over Munsell's 7.5R 2/8, \
                  and a Christmas ball, tinted lacquer over a silvered inside. Silver, gold metallic paint and sugar have less exposure than the others.",
        size: SMALL,
        claim: Claim {
            text: "Sixteen samples look apart: glossy ones have a highlight, frosted ones have none, and no sample is blown out.",
            checks: &[
                Check::Falls(&["ceramic-glaze: highlight over the median", "latex: highlight over the median"]),
                Check::Falls(&["red-lacquer: highlight over the median", "frosted-acrylic: highlight over the median"]),
                Check::Falls(&["acrylic-lacquer: highlight over the median", "sugar: highlight over the median"]),
                Check::Within("silver-paint: share blown out", 0.0, 0.01),
                Check::Within("gold-metallic-paint: share blown out", 0.0, 0.01),
                Check::Within("sugar: share blown out", 0.0, 0.01),
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

fn metals(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
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
    for ((_, material), picture) in all.iter().zip(&pictures) {
        made.measure(format!("{}: variation of luminance", material.name), variation(picture));
    }
    made.sheet("course-4-1", all.into_iter().map(|(name, _)| name).zip(pictures).collect(), 3);
    Ok(made)
}

macro_rules! sample {
    ($name:literal, $label:literal) => {
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
    sample!("polished-gold", "gold"),
    sample!("gold-metallic-paint", "gold"),
    sample!("blue-metallic-paint", "blue"),
    sample!("silver-paint", "silver"),
    sample!("gold-paint", "gold"),
    sample!("car-paint", "car paint"),
];

/// Garnet red (section 5.1.2). The albedo is Munsell 7.5R 2/8 in linear Rec.709, from its CIE xyY of 1943 (0.482, 0.293, 0.031).
const GARNET: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.6\nslope_deg = 12\ndistribution = \"beckmann\"\nthickness_um = 0.5\n\
                      [[layer]]\ntype = \"diffuse\"\nalbedo = [0.098, 0.008, 0.019]\n";

/// A Christmas ball (section 4.2): glass with silver on its inside, under a tinted lacquer.
const CHRISTMAS: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nslope_deg = 0.2\ndistribution = \"beckmann\"\nthickness_um = 1\n\
                         absorption_per_um = [0.02, 1.3, 0.9]\n\
                         [[layer]]\ntype = \"conductor\"\nior = \"ag\"\nslope_deg = 0.2\ndistribution = \"beckmann\"\n";

fn samples(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let mut all = Vec::new();
    for (name, label, text) in SAMPLES {
        all.push((label.to_owned(), shaded(&material(name, text)?, name, ShadingModel::WeidlichWilkie)));
    }
    for (name, layers) in [("garnet", GARNET), ("christmas", CHRISTMAS)] {
        all.push((name.to_owned(), by_course(name, layers)?));
    }
    let mut pictures: Labelled = Vec::new();
    for (label, material) in &all {
        let look = |_, settings: &mut RenderSettings| settings.exposure = exposure(&material.name);
        let shown = studio.pictures(std::slice::from_ref(material), Form::Full, Shape::Sphere, look)?;
        for picture in shown {
            let middle = picture.texel(picture.width / 2, picture.height / 2);
            let [lightness, chroma, _] = lightness_chroma_hue([0, 1, 2].map(|c: usize| f64::from(middle[c])));
            made.measure(format!("{}, middle of the ball: lightness", material.name), lightness);
            made.measure(format!("{}, middle of the ball: chroma", material.name), chroma);
            made.measure(format!("{}: highlight over the median", material.name), highlight(&picture));
            made.measure(format!("{}: share blown out", material.name), blown_out(&picture));
            pictures.push((format!("{} {label}", material.class.symbol()), picture));
        }
    }
    made.sheet("course-5-7", pictures, 4);
    Ok(made)
}
