//! Figures of Elek 2010 with examples: against the simulation, edges of patina, car paint, lacquers, concrete.

use luthier_export::{MemoryStore, Package, lit};
use luthier_gpu::Shape;
use luthier_lut::Image;
use luthier_manifest::{Form, MapSlot, ShadingModel};
use luthier_material::{Material, VariationSource};
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::elek_places::crusted;
use super::figure::{Figure, Labelled, Made, SIMULATED, SMALL, TONE, compared};
use super::numbers::{grain, over_red};
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
                  one all places have half grown; with the narrow one, metal and patina lie side by side.",
        size: SMALL,
        claim: Claim {
            text: "A wide transition blurs the boundary of the patina, a narrow one makes it sharp.",
            checks: &[Check::Falls(&[
                "transition 0.9: share of the map where patina has half grown",
                "transition 0.2: share of the map where patina has half grown",
            ])],
        },
        make: edges,
    },
    Figure {
        name: "elek-10",
        title: "car paint, lacquers and concrete",
        source: "Elek 2010, figure 10",
        caption: "From left to right: car paint whose flakes have slopes of 25 degrees; an orange and a purple lacquer on chromium, whose thickness a map \
                  varies; concrete, a base of Oren and Nayar with sigma 0.5, bare and under a blue transparent varnish. Numbers and map are luthier's.",
        size: SMALL,
        claim: Claim {
            text: "Car paint sparkles, lacquers are deeper where they are thicker, and a transparent varnish turns grey concrete \
                  blue.",
            checks: &[
                Check::Falls(&["flakes: grain", "orange: grain"]),
                Check::Falls(&["varnished: blue over red", "concrete: blue over red"]),
                Check::Falls(&["purple: blue over red", "orange: blue over red"]),
                Check::Within("orange, with the map of thickness against without: mean FLIP", 0.02, 1.0),
            ],
        },
        make: examples,
    },
];

macro_rules! file {
    ($name:literal) => {
        include_str!(concat!("../../../../materials/", $name, ".toml"))
    };
}

const COMPARED: [(&str, &str); 5] = [
    ("glaze", file!("ceramic-glaze")),
    ("lacquer", file!("red-lacquer")),
    ("latex", file!("latex")),
    ("foil", file!("brass-foil")),
    ("car paint", file!("car-paint")),
];

fn simulated(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let (mut top, mut bottom): (Labelled, Labelled) = (Vec::new(), Vec::new());
    for (label, text) in COMPARED {
        let material = material(label, text)?;
        let reference = studio.simulated(&material)?;
        let model = studio.ball(&material, "elek")?;
        let apart = compared(&model, &reference.image)?;
        made.measure(format!("{label}, simulation: noise, in units of the RMSE"), reference.noise);
        made.measure(format!("{label}: RMSE of linear radiance"), apart.rms_err);
        made.measure(format!("{label}: mean FLIP"), apart.flip_mean);
        top.push((label.to_owned(), TONE.image(reference.image)));
        bottom.push(("elek".to_owned(), TONE.image(model)));
    }
    top.append(&mut bottom);
    made.shown("elek-3", top, COMPARED.len() as u32);
    Ok(made)
}

/// Transitions of figure 9.
const TRANSITIONS: [f64; 2] = [0.9, 0.2];

fn edges(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let copper = crusted()?;
    let mut materials = Vec::new();
    for (i, transition) in TRANSITIONS.into_iter().enumerate() {
        let mut stage = shaded(&copper, &format!("edge-{i}"), ShadingModel::Elek);
        let missing = || Failure::Input(anyhow::anyhow!("copper-patina.toml has no patina"));
        let patina = stage.effects.patina.as_mut().ok_or_else(missing)?;
        (patina.extent, patina.transition) = (0.45, transition);
        patina.map = VariationSource::Image { path: "patina.png".to_owned() };
        materials.push(mapped(stage));
    }
    let package = Package::for_renderer(&lit(&materials), &MemoryStore::default())?;
    let mut pictures: Labelled = Vec::new();
    if let Some(map) = package.maps.iter().find(|map| map.slot == MapSlot::Patina) {
        pictures.push(("map".to_owned(), scaled(&map.image, 2 * studio.size)));
        for transition in TRANSITIONS {
            let amount = |texel: &[f32]| (0.5 + (0.45 - f64::from(texel[0])) / (2.0 * transition)).clamp(0.0, 1.0);
            let amounts: Vec<f64> = map.image.texels().map(amount).collect();
            let half = amounts.iter().filter(|amount| (0.02..0.98).contains(*amount)).count();
            let share = half as f64 / amounts.len() as f64;
            made.measure(format!("transition {transition}: share of the map where patina has half grown"), share);
        }
    }
    let rendered = studio.staged(&package, |_, _| {})?;
    for (transition, picture) in TRANSITIONS.into_iter().zip(rendered) {
        pictures.push((format!("{transition}"), TONE.image(picture)));
    }
    made.shown("elek-9", pictures, 3);
    Ok(made)
}

/// The first channel of a map, as grey, in another size.
fn scaled(map: &Image, size: u32) -> Image {
    let mut grey = Image::zeros(size, size, 3);
    for y in 0..size {
        for x in 0..size {
            let value = map.texel(x * map.width / size, y * map.height / size)[0];
            let at = 3 * (y * size + x) as usize;
            grey.data[at..at + 3].fill(value);
        }
    }
    grey
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

fn lacquer(absorption: &str) -> String {
    format!(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.03\ndistribution = \"beckmann\"\nthickness_um = 3\n\
         absorption_per_um = {absorption}\n"
    )
}

fn examples(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
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
        let mut one = studio.pictures(std::slice::from_ref(material), Form::Full, Shape::Sphere, |_, _| {})?;
        pictures.push(((*label).to_owned(), one.swap_remove(0)));
    }
    for (label, picture) in &pictures {
        made.measure(format!("{label}: grain"), grain(picture));
        made.measure(format!("{label}: blue over red"), over_red(picture, 2));
    }
    let even = by_elek("even", &(lacquer("[0.02, 0.3, 0.9]") + CHROMIUM))?;
    let even = studio.pictures(&[even], Form::Full, Shape::Sphere, |_, _| {})?.swap_remove(0);
    made.apart("orange, with the map of thickness against without", &pictures[1].1, &even)?;
    made.sheet("elek-10", pictures, all.len() as u32);
    Ok(made)
}
