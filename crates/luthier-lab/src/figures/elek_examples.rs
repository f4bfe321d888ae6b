//! Figures of Elek 2010 with examples: against the simulation, edges of patina, car paint, lacquers, concrete.

use luthier::{Bake, MemoryStore, lit};
use luthier_gpu::Shape;
use luthier_lut::Image;
use luthier_manifest::{Form, MapSlot, ShadingModel};
use luthier_material::Material;
use luthier_report::lightness_chroma_hue;
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::elek_places::{DIM, from_above, grown};
use super::figure::{Figure, Labelled, Made, SIMULATED, SMALL, TONE, compared, enlarged};
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
        caption: "Top row: the simulation of five surfaces. Bottom row: Elek's model in f64, its parameters adjusted to the best visual match, as in the paper. Both are under two lights. \
                  From left to right: glaze, lacquer, latex, foil, car paint. A search finds the albedo of a diffuse base or the absorption above a metal, channel by channel, and the slope of a metal, of which a \
                  display shows the least squared difference. With the numbers of the file (`unmatched`) bases are too bright, because the model lacks the factor 1/n^2. \
                  Balls stand alone, so that no light passes from one object to another: that is the one difference in kind that the paper names.",
        seen: "Each ball of the bottom row is taken for the one above it, as in the paper.",
        size: SIMULATED,
        claim: Claim {
            text: "With parameters adjusted to the best match, the model in real time looks like the simulation of each surface, and \
                  more so than with the numbers of the simulation.",
            checks: &[
                Check::Falls(&["glaze, unmatched: mean FLIP", "glaze: mean FLIP"]),
                Check::Falls(&["lacquer, unmatched: mean FLIP", "lacquer: mean FLIP"]),
                Check::Falls(&["latex, unmatched: mean FLIP", "latex: mean FLIP"]),
                Check::Falls(&["foil, unmatched: mean FLIP", "foil: mean FLIP"]),
                Check::Falls(&["car paint, unmatched: mean FLIP", "car paint: mean FLIP"]),
                // Neighbours in a row differ by far more than a ball and its match.
                Check::Within("largest mean FLIP of a match over the least between two surfaces", 0.0, 0.5),
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
        seen: "Blurred and sharp regions look as in the paper.",
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
        caption: "From left to right: car paint with the flakes of elek-6; an orange and a purple lacquer on chromium, whose thickness a map \
                  varies; concrete, a base of Oren and Nayar with sigma 0.5, bare and under a blue transparent varnish. Numbers and map are luthier's. A pixel sparkles \
                  where it is at least twice as bright as the median around it. Hues are those of CIELAB: orange is Munsell's yellow-red (42 to 77 degrees), purple his purple \
                  (298 to 335), blue is from the least of his blue to the primary of Rec.709 (215 to 306). The correlations are those of a level square with the map of thickness.",
        seen: "Car paint, lacquers, concrete and varnish look as the paper describes them. The flakes sparkle strongly, and are larger \
               than the paper's.",
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
    let (mut top, mut bottom): (Vec<Image>, Vec<Image>) = (Vec::new(), Vec::new());
    let mut largest = 0.0_f64;
    for (label, text) in COMPARED {
        let file = material(label, text)?;
        let reference = studio.simulated(&file)?;
        made.measure(format!("{label}, simulation: noise, in units of the RMSE"), reference.noise);
        made.errors(&format!("{label}, unmatched"), &studio.ball(&file, "elek")?, &reference.image)?;
        let matched = matched(studio, made, label, text)?;
        let model = studio.ball(&matched, "elek")?;
        made.errors(label, &model, &reference.image)?;
        largest = largest.max(compared(&model, &reference.image)?.flip_mean);
        top.push(reference.image);
        bottom.push(model);
    }
    let mut least = f64::INFINITY;
    for (i, image) in top.iter().enumerate() {
        for other in &top[..i] {
            least = least.min(compared(image, other)?.flip_mean);
        }
    }
    made.measure("largest mean FLIP of a match over the least between two surfaces", largest / least);
    let labels = COMPARED.iter().map(|(label, _)| *label).chain(["elek"; COMPARED.len()]);
    made.sheet("elek-3", labels.zip(top.into_iter().chain(bottom)), COMPARED.len() as u32);
    Ok(())
}

/// Side of the pictures of a search.
const SEARCHED: u32 = 40;

/// Factors on the slope of a metal that are tried.
const SLOPES: [f64; 5] = [0.8, 1.0, 1.2, 1.5, 1.9];

/// Steps of a search, each of which shortens it to 0.618.
const STEPS: u32 = 14;

/// A material with the parameters by which Elek's model looks most like the simulation of the file: the colour of the base or of the coat, channel by channel, and
/// the slope of a metal. Their factors on the numbers of the file are measured.
fn matched(studio: &Studio, made: &mut Made, label: &str, text: &str) -> Outcome<Material> {
    let reference = studio.simulated_of_size(&material(label, text)?, SEARCHED)?.image;
    let has_metal = text.contains("\"conductor\"");
    let (key, most) = if has_metal { ("absorption_per_um", 6.0) } else { ("albedo", 1.0) };
    let errors = |factors: [f64; 3], slope: f64| -> Outcome<[f64; 3]> {
        let ball = studio.ball_of_size(&material(label, &adjusted(text, key, factors, slope))?, "elek", SEARCHED)?;
        let mut sums = [0.0; 3];
        for (a, b) in ball.texels().zip(reference.texels()) {
            for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
                let apart = f64::from(TONE.value(*a) - TONE.value(*b));
                *sum += apart * apart;
            }
        }
        Ok(sums)
    };
    let slopes: &[f64] = if has_metal { &SLOPES } else { &[1.0] };
    let mut best = (f64::INFINITY, [1.0; 3], 1.0);
    for slope in slopes {
        // Golden sections, in each channel on its own.
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = ([0.0; 3], [most; 3]);
        for _ in 0..STEPS {
            let near = [0, 1, 2].map(|c: usize| high[c] - golden * (high[c] - low[c]));
            let far = [0, 1, 2].map(|c: usize| low[c] + golden * (high[c] - low[c]));
            let (of_near, of_far) = (errors(near, *slope)?, errors(far, *slope)?);
            let ends =
                [0, 1, 2].map(|c: usize| if of_near[c] < of_far[c] { [low[c], far[c]] } else { [near[c], high[c]] });
            (low, high) = (ends.map(|end| end[0]), ends.map(|end| end[1]));
        }
        let factors = [0, 1, 2].map(|c: usize| 0.5 * (low[c] + high[c]));
        let error = errors(factors, *slope)?.iter().sum();
        if error < best.0 {
            best = (error, factors, *slope);
        }
    }
    let (_, factors, slope) = best;
    for (channel, factor) in ["R", "G", "B"].into_iter().zip(factors) {
        made.measure(
            format!("{label}: {} of the match over that of the file, {channel}", key.replace("_per_um", "")),
            factor,
        );
    }
    if has_metal {
        made.measure(format!("{label}: slope of the metal of the match over that of the file"), slope);
    }
    material(label, &adjusted(text, key, factors, slope))
}

/// The text of a material with factors on the three channels of a key, and one on the slope of its last layer.
fn adjusted(text: &str, key: &str, factors: [f64; 3], slope: f64) -> String {
    let last = text.rfind("[[layer]]").unwrap_or_default();
    let mut at = 0;
    let mut changed = String::new();
    for line in text.lines() {
        let value = line.split_once(" = ").map(|(name, value)| (name, value.trim_matches(['[', ']'])));
        match value {
            Some((name, list)) if name == key => {
                let values = list.split(',').zip(factors);
                let values: Vec<f64> =
                    values.map(|(value, factor)| value.trim().parse::<f64>().unwrap_or(0.0) * factor).collect();
                changed += &format!("{key} = {values:?}\n");
            }
            Some(("slope_deg", value)) if at > last => {
                changed += &format!("slope_deg = {}\n", value.parse::<f64>().unwrap_or(0.0) * slope);
            }
            _ => changed = changed + line + "\n",
        }
        at += line.len() + 1;
    }
    changed
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
    // As the stages of figure 8.
    let rendered = studio.staged(&package, |_, settings| settings.exposure = DIM)?;
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
    // The map of elek-6 in place of cells, which would be wider than high on a ball.
    let facets = file!("chromium-car-paint")
        .replace(
            "cells = { seed = 1, count = 64, spread_deg = 15 }",
            "height_map = { image = \"facets.png\", height = 0.02 }",
        )
        .replace("tiling = 1000", "tiling = 4")
        .replace("fade_start = 1.0", "fade_start = 1000")
        .replace("alpha = 0.2\n", "alpha = 0.07\n");
    let paint = mapped(shaded(&material("chromium-car-paint.toml", &facets)?, "strong-flakes", ShadingModel::Elek));
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
