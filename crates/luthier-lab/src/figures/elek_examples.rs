//! Figures of Elek 2010 with examples: against the simulation, edges of patina, car paint, lacquers, concrete.

use luthier::{Bake, MemoryStore, lit};
use luthier_gpu::Shape;
use luthier_manifest::{Form, MapSlot, ShadingModel};
use luthier_material::Material;
use luthier_report::lightness_chroma_hue;
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::elek_places::{from_above, grown};
use super::figure::{Figure, Labelled, Made, SIMULATED, SMALL, TONE, enlarged};
use super::numbers::places::{
    correlation, greenness, middle_values, nearest, places_of_square, quantile, sparkles, steepness,
};
use super::numbers::tint::saturations;
use super::numbers::{highlight, middle, share};
use super::studio::{Studio, layered, mapped, material, shaded};

pub(crate) const FIGURES: [Figure; 3] = [
    Figure {
        name: "elek-3",
        title: "the real-time model against Monte Carlo",
        source: "Elek 2010, figure 3",
        caption: "Top row: the simulation. Bottom row: Elek's model in f64. Both are under two lights. From left to right: glaze, lacquer, latex, foil, car paint. \
                  The paper adjusts the parameters of each real-time picture to look like its original; here both have the numbers of one file. Smooth coats on \
                  diffuse bases are too bright by up to the square of the index, because the model lacks that factor; the shapes of the highlights agree.",
        size: SIMULATED,
        claim: Claim {
            text: "The model in real time looks like the simulation of each surface (mean FLIP of at most 0.1).",
            checks: &[
                Check::Within("glaze: mean FLIP", 0.0, 0.1),
                Check::Within("lacquer: mean FLIP", 0.0, 0.1),
                Check::Within("latex: mean FLIP", 0.0, 0.1),
                Check::Within("foil: mean FLIP", 0.0, 0.1),
                Check::Within("car paint: mean FLIP", 0.0, 0.1),
            ],
        },
        make: simulated,
    },
    Figure {
        name: "elek-9",
        title: "edges of the patina",
        source: "Elek 2010, figure 9",
        caption: "The map that says where patina grows first, and patina with a wide transition (0.9) and a narrow one (0.2) at the same extent, 0.45. With the wide \
                  one all places have half grown; with the narrow one, metal and patina lie side by side. The numbers are of a level square of the same \
                  material: how green a pixel is, from -1 (red) to 1.",
        size: SMALL,
        claim: Claim {
            text: "A narrow transition puts bare metal and patina side by side with sharp boundaries, a wide one blurs them.",
            checks: &[
                Check::Falls(&[
                    "transition 0.2: steepest change of green between pixels of the square",
                    "transition 0.9: steepest change of green between pixels of the square",
                ]),
                Check::Falls(&["transition 0.2: range of green", "transition 0.9: range of green"]),
                // Bare metal is redder than green, and patina is greener.
                Check::Within("transition 0.2: share of the square that is green", 0.05, 0.95),
                Check::Within("transition 0.2: green of the tenth with least", -1.0, 0.0),
                Check::Within("transition 0.2: green of the tenth with most", 0.0, 1.0),
            ],
        },
        make: edges,
    },
    Figure {
        name: "elek-10",
        title: "car paint, lacquers and concrete",
        source: "Elek 2010, figure 10",
        caption: "From left to right: car paint whose flakes have slopes of 25 degrees; an orange and a purple lacquer on chromium, whose thickness a map \
                  varies; concrete, a base of Oren and Nayar with sigma 0.5, bare and under a blue transparent varnish. Numbers and map are luthier's. A pixel sparkles \
                  where it is at least twice as bright as the median around it. Hues are those of CIELAB: orange is Munsell's yellow-red (42 to 77 degrees), purple his purple \
                  (298 to 335), blue is from the least of his blue to the primary of Rec.709 (215 to 306). The correlations are those of a level square with the map of thickness.",
        size: SMALL,
        claim: Claim {
            text: "Car paint sparkles strongly. An orange and a purple lacquer are deeper where they are thicker: darker, and more \
                  saturated. A transparent varnish turns grey concrete blue and glossy.",
            checks: &[
                Check::Falls(&["flakes: sparkles", "the same paint without flakes: sparkles"]),
                Check::Falls(&["flakes: sparkles", "orange: sparkles"]),
                // Each hundredth pixel: more than the single points of a smooth paint.
                Check::Within("flakes: sparkles", 0.01, 0.5),
                Check::Within("orange: hue", 42.0, 77.0),
                Check::Within("purple: hue", 298.0, 335.0),
                Check::Within("orange: correlation of thickness and saturation", 0.5, 1.0),
                Check::Within("orange: correlation of thickness and luminance", -1.0, -0.5),
                Check::Within("purple: correlation of thickness and saturation", 0.5, 1.0),
                Check::Within("purple: correlation of thickness and luminance", -1.0, -0.5),
                Check::Within("concrete: chroma", 0.0, 10.0),
                Check::Within("varnished: hue", 215.0, 306.3),
                Check::Falls(&["varnished: chroma", "concrete: chroma"]),
                Check::Falls(&["varnished: highlight over the median", "concrete: highlight over the median"]),
            ],
        },
        make: examples,
    },
];

macro_rules! file {
    ($name:literal) => {
        include_str!(concat!("../../../../materials/papers/", $name, ".toml"))
    };
}

const COMPARED: [(&str, &str); 5] = [
    ("glaze", file!("ceramic-glaze")),
    ("lacquer", file!("red-lacquer")),
    ("latex", file!("latex")),
    ("foil", file!("brass-foil")),
    ("car paint", file!("car-paint")),
];

fn simulated(studio: &Studio, made: &mut Made) -> Outcome {
    let (mut top, mut bottom): (Labelled, Labelled) = (Vec::new(), Vec::new());
    for (label, text) in COMPARED {
        let material = material(label, text)?;
        let reference = studio.simulated(&material)?;
        let model = studio.ball(&material, "elek")?;
        made.measure(format!("{label}, simulation: noise, in units of the RMSE"), reference.noise);
        made.errors(label, &model, &reference.image)?;
        top.push((label.to_owned(), TONE.image(reference.image)));
        bottom.push(("elek".to_owned(), TONE.image(model)));
    }
    top.append(&mut bottom);
    made.shown("elek-3", top, COMPARED.len() as u32);
    Ok(())
}

/// Transitions of figure 9.
const TRANSITIONS: [f64; 2] = [0.9, 0.2];

fn edges(studio: &Studio, made: &mut Made) -> Outcome {
    let mut materials = Vec::new();
    for (i, transition) in TRANSITIONS.into_iter().enumerate() {
        materials.push(grown(&format!("edge-{i}"), 0.45, transition)?);
    }
    let package = Bake::lit().package(&lit(&materials), &MemoryStore::default())?;
    let mut pictures: Labelled = Vec::new();
    if let Some(map) = package.maps.iter().find(|map| map.slot == MapSlot::Patina) {
        pictures.push(("map".to_owned(), enlarged(&map.picture.image(), 2 * studio.size, [0; 3])));
    }
    for (transition, picture) in TRANSITIONS.into_iter().zip(from_above(studio, &package)?) {
        let green = greenness(&picture);
        let [least, most] = [0.1, 0.9].map(|share| quantile(&green, share));
        let share = share(green.iter().map(|green| *green > 0.0));
        for (what, value) in [
            ("steepest change of green between pixels of the square", steepness(&green)),
            ("range of green", most - least),
            ("green of the tenth with least", least),
            ("green of the tenth with most", most),
            ("share of the square that is green", share),
        ] {
            made.measure(format!("transition {transition}: {what}"), value);
        }
    }
    let rendered = studio.staged(&package, |_, _| {})?;
    for (transition, picture) in TRANSITIONS.into_iter().zip(rendered) {
        pictures.push((format!("{transition}"), TONE.image(picture)));
    }
    made.shown("elek-9", pictures, 3);
    Ok(())
}

fn by_elek(name: &str, layers: &str) -> Outcome<Material> {
    let mut material = layered(name, layers, ShadingModel::Elek)?;
    material.bake.wavelengths_nm = Some([690.0, 550.0, 450.0]);
    Ok(material)
}

/// Chromium of the paper's appendix A.
const CHROMIUM: &str = "[[layer]]\ntype = \"conductor\"\n\
     ior = { n = [3.84, 3.18, 1.99], k = [4.37, 4.41, 4.22], wavelengths_nm = [690, 550, 450] }\n\
     alpha = 0.15\ndistribution = \"beckmann\"\n";

const CONCRETE: &str = "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.42, 0.4, 0.37]\nsigma = 0.5\n";

pub(super) fn lacquer(absorption: &str) -> String {
    format!(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.03\ndistribution = \"beckmann\"\nthickness_um = 3\n\
         absorption_per_um = {absorption}\n"
    )
}

fn examples(studio: &Studio, made: &mut Made) -> Outcome {
    let map = "[layer.maps]\nthickness = \"thickness.png\"\n";
    let mut paint =
        shaded(&material("chromium-car-paint.toml", file!("chromium-car-paint"))?, "strong-flakes", ShadingModel::Elek);
    if let Some(flakes) = paint.effects.flakes.as_mut() {
        // Cells as wide as a few pixels.
        (flakes.tiling, flakes.fade_start) = (3.0, 1000.0);
        if let luthier_material::FlakeSource::Cells { spread, .. } = &mut flakes.source {
            *spread = 25_f64.to_radians();
        }
    }
    let all = [
        ("flakes", paint),
        ("orange", mapped(by_elek("orange", &(lacquer("[0.02, 0.3, 0.9]") + map + CHROMIUM))?)),
        ("purple", mapped(by_elek("purple", &(lacquer("[0.15, 0.7, 0.1]") + map + CHROMIUM))?)),
        ("concrete", by_elek("concrete", CONCRETE)?),
        ("varnished", by_elek("varnished", &(lacquer("[0.35, 0.15, 0.03]") + CONCRETE))?),
    ];
    let mut pictures: Labelled = Vec::new();
    for (label, material) in &all {
        pictures.push(((*label).to_owned(), studio.picture(material.clone(), Form::Full, Shape::Sphere)?));
    }
    for (label, picture) in &pictures {
        let [_, chroma, hue] = lightness_chroma_hue(middle(picture, 0.5));
        made.measure(format!("{label}: sparkles"), sparkles(picture));
        made.measure(format!("{label}: chroma"), chroma);
        made.measure(format!("{label}: hue"), hue);
        made.measure(format!("{label}: highlight over the median"), highlight(picture));
    }
    let mut smooth = all[0].1.clone();
    if let Some(flakes) = smooth.effects.flakes.as_mut() {
        flakes.scale = 0.0;
    }
    let smooth = studio.picture(smooth, Form::Full, Shape::Sphere)?;
    made.measure("the same paint without flakes: sparkles", sparkles(&smooth));
    for (label, lacquered) in &all[1..3] {
        let package = Bake::lit().package(&lit(std::slice::from_ref(lacquered)), &MemoryStore::default())?;
        let square = from_above(studio, &package)?.swap_remove(0);
        let map = package.maps.iter().find(|map| map.slot == MapSlot::Thickness).map(|map| map.picture.image());
        let thickness: Vec<f64> = map
            .iter()
            .flat_map(|map| places_of_square(&square).map(|place| f64::from(nearest(map, place)[0])))
            .collect();
        for (what, values) in [("saturation", saturations(&square)), ("luminance", middle_values(&square))] {
            made.measure(format!("{label}: correlation of thickness and {what}"), correlation(&thickness, &values));
        }
    }
    made.sheet("elek-10", pictures, all.len() as u32);
    Ok(())
}
