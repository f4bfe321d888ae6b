//! Figures of the course of Weidlich and Wilkie.

use luthier::{Bake, MemoryStore};
use luthier_gpu::Shape;
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;
use luthier_report::{Curve, Plot, PlotAxis, PlotColor, lightness_chroma_hue};
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::figure::{Figure, Made, SMALL};
use super::numbers::light::{KEY, even_sky, one_light};
use super::numbers::spot::spot;
use super::numbers::tint::saturation;
use super::numbers::{blown_out, middle, variation};
use super::studio::{Studio, layered, material, shaded};

pub(crate) const FIGURES: [Figure; 2] = [
    Figure {
        name: "course-classes",
        title: "the eight classes of layered surfaces",
        source: "A. Weidlich and A. Wilkie, Exploring the Potential of Layered BRDF Models, SIGGRAPH Asia 2009 Courses, figures 4.4 \
                 and 5.7",
        caption: "The pictures show one material of the course for each class, by Weidlich and Wilkie's model. In a \
                  and b, a smooth coat, clear and tinted, has a white highlight on a diffuse base; in c no \
                  highlight is left. The metal of d mirrors the room in colour. In e, a sharp white \
                  reflection of the light lies over a soft coloured one. In f, a rough coat lies over a metal that \
                  still mirrors sharply, because this model does not blur the light that crosses the coat (elek-2 \
                  compares it with the simulation): f mirrors the surroundings more clearly than the foil, and the course's \
                  tree would not call it frosted. The material of g is matt and bright: its picture has about a third of the exposure of the others. In h, two clear layers lie \
                  on a blue base, too rough to show the light. The width of a highlight is the root of the share of the \
                  picture that is at least half as bright as the brightest place, under the key light alone. The contrast of the \
                  surroundings is the variation of luminance without that light, over the mean. Mean FLIP is between the picture \
                  of the tables and that of the full evaluation.",
        seen: "Seven of eight look as the course says. Frosted metal (f) does not: it mirrors too sharply, because the model does not blur \
               what passes the rough coat, so that the course's own sheet gives a polished metal.",
        size: SMALL,
        claim: Claim {
            text: "By the course's tree: paints of a smooth coat have a sharp highlight (a, b), and frosted paint has a blurred \
                  one (c). Foil mirrors the surroundings clearly (d). Metallic paint mirrors them less clearly, below a sharp \
                  highlight (e). The highlight of frosted metal is blurred (f), and that of patina is wider still (g).",
            checks: &[
                Check::Falls(&["c latex: width of the highlight", "a ceramic-glaze: width of the highlight"]),
                Check::Falls(&["c latex: width of the highlight", "b red-lacquer: width of the highlight"]),
                Check::Falls(&[
                    "g silver-paint: width of the highlight",
                    "f blue-metallic-paint: width of the highlight",
                    "e car-paint: width of the highlight",
                ]),
                Check::Falls(&[
                    "d brass-foil: contrast of the surroundings",
                    "e car-paint: contrast of the surroundings",
                    "c latex: contrast of the surroundings",
                ]),
                Check::Falls(&[
                    "d brass-foil: contrast of the surroundings",
                    "a ceramic-glaze: contrast of the surroundings",
                ]),
                Check::Falls(&[
                    "d brass-foil: contrast of the surroundings",
                    "f blue-metallic-paint: contrast of the surroundings",
                ]),
            ],
        },
        make: classes,
    },
    Figure {
        name: "course-varnish",
        title: "a varnish that gets thicker",
        source: "Weidlich and Wilkie 2009, figure 3.4",
        caption: "The pictures show white balls under a yellow varnish at the twelve thicknesses of the course. \
                  First the saturation grows at nearly constant lightness. Then the hue turns from yellow over \
                  orange to red, and the ball darkens, most at its rim, where paths in the varnish are longest. The \
                  highlights stay white. The chart shows the colour of the middle of each ball; saturation is the chroma that the colour has at a luminance of 0.5, over 100. The absorption is \
                  luthier's. The hue of the ball without varnish is that of the light, and has little meaning at so \
                  small a chroma.",
        seen: "Twelve balls from white over yellow and orange to red, as the course describes them.",
        size: SMALL,
        claim: Claim {
            text: "A thin yellow varnish makes white yellow. The thicker it is, the darker and the more saturated is the ball, and its hue \
                  turns on from yellow.",
            checks: &[
                Check::Falls(&[
                    "thickness 0: lightness L*",
                    "thickness 0.2: lightness L*",
                    "thickness 0.4: lightness L*",
                    "thickness 0.6: lightness L*",
                    "thickness 0.8: lightness L*",
                    "thickness 1.2: lightness L*",
                    "thickness 1.6: lightness L*",
                    "thickness 3: lightness L*",
                    "thickness 5: lightness L*",
                    "thickness 7.5: lightness L*",
                    "thickness 10: lightness L*",
                    "thickness 15: lightness L*",
                ]),
                Check::Falls(&[
                    "thickness 15: saturation",
                    "thickness 10: saturation",
                    "thickness 7.5: saturation",
                    "thickness 5: saturation",
                    "thickness 3: saturation",
                    "thickness 1.6: saturation",
                    "thickness 1.2: saturation",
                    "thickness 0.8: saturation",
                    "thickness 0.6: saturation",
                    "thickness 0.4: saturation",
                    "thickness 0.2: saturation",
                    "thickness 0: saturation",
                ]),
                // Yellow of Munsell and its neighbours.
                Check::Within("thickness 0.4: hue, degrees", 77.0, 115.0),
                Check::Falls(&[
                    "thickness 0.2: hue, degrees",
                    "thickness 0.4: hue, degrees",
                    "thickness 0.6: hue, degrees",
                    "thickness 0.8: hue, degrees",
                    "thickness 1.2: hue, degrees",
                    "thickness 1.6: hue, degrees",
                    "thickness 3: hue, degrees",
                    "thickness 5: hue, degrees",
                    "thickness 7.5: hue, degrees",
                    "thickness 10: hue, degrees",
                    "thickness 15: hue, degrees",
                ]),
            ],
        },
        make: varnish,
    },
];

macro_rules! of_class {
    ($name:literal, $label:literal) => {
        ($name, $label, include_str!(concat!("../../../../materials/papers/", $name, ".toml")))
    };
}

/// Name, label and text of a material of the course for each class, a to h.
const CLASSES: [(&str, &str, &str); 8] = [
    of_class!("ceramic-glaze", "glaze"),
    of_class!("red-lacquer", "lacquer"),
    of_class!("latex", "latex"),
    of_class!("brass-foil", "foil"),
    of_class!("car-paint", "car paint"),
    of_class!("blue-metallic-paint", "metallic"),
    of_class!("silver-paint", "silver"),
    of_class!("house-paint", "house"),
];

/// Exposure of a material. Bright rough metals would be blown out under the usual one.
pub(super) fn exposure(material: &str) -> f32 {
    match material {
        "silver-paint" => 0.35,
        "gold-metallic-paint" => 0.5,
        "sugar" => 0.8,
        _ => 1.0,
    }
}

fn classes(studio: &Studio, made: &mut Made) -> Outcome {
    let mut materials = Vec::new();
    for (name, _, text) in CLASSES {
        materials.push(shaded(&material(name, text)?, name, ShadingModel::WeidlichWilkie));
    }
    let package = Bake::lit().package(&materials, &MemoryStore::default())?;
    let [baked, full] = [Form::Baked, Form::Full].map(|form| {
        studio.rendered(&package, form, Shape::Sphere, |n, settings| settings.exposure = exposure(CLASSES[n].0))
    });
    let (baked, full) = (baked?, full?);
    let dark = even_sky(0.0)?;
    let lit = studio.rendered(&package, Form::Baked, Shape::Sphere, |_, settings| one_light(settings, &dark, KEY))?;
    let room = studio.rendered(&package, Form::Baked, Shape::Sphere, |_, settings| settings.lights.clear())?;
    for (material, (lit, room)) in materials.iter().zip(lit.iter().zip(&room)) {
        let name = format!("{} {}", material.class.symbol(), material.name);
        made.measure(format!("{name}: width of the highlight"), spot(lit).share.sqrt());
        made.measure(format!("{name}: contrast of the surroundings"), variation(room));
    }
    for ((material, baked), full) in materials.iter().zip(&baked).zip(&full) {
        made.apart(&format!("{} {}, tables against full", material.class, material.name), baked, full)?;
        let name = format!("{} {}", material.class.symbol(), material.name);
        made.measure(format!("{name}: share blown out"), blown_out(baked));
    }
    let classes = materials.iter().zip(CLASSES);
    let labels = classes.map(|(material, (_, label, _))| format!("{} {label}", material.class.symbol()));
    made.sheet("course-classes", labels.zip(baked), 4);
    Ok(())
}

/// The thicknesses of figure 3.4, in a unit that the course does not name; um here.
const THICKNESSES: [f64; 12] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.2, 1.6, 3.0, 5.0, 7.5, 10.0, 15.0];

/// A material of some layers by Weidlich and Wilkie's model.
pub(super) fn by_course(name: &str, layers: &str) -> Outcome<Material> {
    layered(name, layers, ShadingModel::WeidlichWilkie)
}

/// Materials by the course's model, with numbers in their names.
pub(super) fn numbered(stem: &str, all: impl IntoIterator<Item = String>) -> Outcome<Vec<Material>> {
    all.into_iter().enumerate().map(|(i, layers)| by_course(&format!("{stem}-{i}"), &layers)).collect()
}

/// White under a yellow varnish. The course does not state the absorption.
fn varnished(thickness: f64) -> String {
    format!(
        "[[layer]]
type = \"dielectric\"
ior = 1.5
slope_deg = 2
distribution = \"beckmann\"
\
         thickness_um = {thickness}
absorption_per_um = [0.02, 0.1, 0.8]
\
         [[layer]]
type = \"diffuse\"
albedo = 0.9
"
    )
}

fn varnish(studio: &Studio, made: &mut Made) -> Outcome {
    let materials = numbered("varnish", THICKNESSES.map(varnished))?;
    let pictures = studio.pictures(&materials, Form::Baked, Shape::Sphere, |_, _| {})?;
    let names = [("lightness L*", PlotColor::Ink), ("chroma C*", PlotColor::Red), ("hue, degrees", PlotColor::Blue)];
    let mut curves = names.map(|(name, color)| Curve { name: name.to_owned(), color, points: Vec::new() });
    for (thickness, picture) in THICKNESSES.into_iter().zip(&pictures) {
        let values = lightness_chroma_hue(middle(picture, 0.2));
        made.measure(format!("thickness {thickness}: saturation"), saturation(middle(picture, 0.2)));
        for (curve, value) in curves.iter_mut().zip(values) {
            made.measure(format!("thickness {thickness}: {}", curve.name), value);
            curve.points.push([thickness, value]);
        }
    }
    let labels = THICKNESSES.iter().map(f64::to_string);
    made.sheet("course-varnish", labels.zip(pictures), 6);
    made.plot(
        "course-varnish-colour",
        Plot {
            title: "Colour of the middle of the balls against the thickness of the varnish".to_owned(),
            x: PlotAxis::new("thickness of the varnish", [0.0, 15.0], 2.5),
            y: PlotAxis::new("CIE 1976 lightness and chroma; hue", [0.0, 120.0], 20.0),
            curves: curves.to_vec(),
        },
    );
    Ok(())
}
