//! Figures of the course of Weidlich and Wilkie about fluorescent bases under a varnish.

use glam::DVec3;
use luthier_layers::effects::fluorescence::Fluorescent;
use luthier_layers::monochrome::Monochrome;
use luthier_lut::Image;
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::figure::{Figure, LARGE, Labelled, MEDIUM, Made};
use super::numbers::across;
use super::numbers::spot::spot_of;
use super::studio::{Studio, material};

pub(crate) const FIGURES: [Figure; 3] = [
    Figure {
        name: "course-5-6",
        title: "a green laser on orange day-glo cardboard",
        source: "Weidlich and Wilkie 2009, figures 5.4 to 5.6",
        caption: "Light of 532 nm falls in from the left on a rough varnish, slope 17 degrees, over a base that sends 0.7 of it out at 600 nm and nothing at 532 nm. The \
                  course calls 5 degrees grazing: its angles are those to the surface. Each picture is the hemisphere of the eye seen from above: its middle is the normal, its edge the horizon. The facets of the varnish mirror in green, \
                  forward of the normal, and the base glows orange everywhere. The colours are those of the two wavelengths in Rec.709, its negative channels cut off. The numbers are the shares of the light that leave in green and in orange, and how far to the right \
                  the light of each lies, in radii. The share of 0.7 and the index (1.5) are luthier's.",
        seen: "A green spot on orange, strongest for flat light, as in the course. At 60 degrees a broad yellow glow is left, where the \
               course sees almost no green.",
        size: LARGE,
        claim: Claim {
            text: "The base glows in orange, and the varnish mirrors in green, forward, the more the flatter the light falls in. At 60 \
                   degrees to the surface practically all that leaves is orange.",
            checks: &[
                Check::Falls(&[
                    "5 degrees: leaves in green",
                    "20 degrees: leaves in green",
                    "60 degrees: leaves in green",
                ]),
                // Almost no green: a tenth at most.
                Check::Within("60 degrees: green of all that leaves", 0.0, 0.1),
                Check::Within("5 degrees: forward, green over orange", 1.0, 1e6),
                Check::Falls(&["5 degrees: green, to the right", "5 degrees: orange, to the right"]),
                Check::Falls(&["20 degrees: green, to the right", "20 degrees: orange, to the right"]),
                // The base looks the same from all sides, so the middle of its light is the middle of the disk.
                Check::Within("5 degrees: orange, to the right", -0.05, 0.05),
                Check::Within("60 degrees: orange, to the right", -0.05, 0.05),
            ],
        },
        make: cardboard,
    },
    Figure {
        name: "course-phong",
        title: "a fluorescent base under Phong's lobe and under a varnish",
        source: "Weidlich and Wilkie 2009, section 5.2.2 and the slide that compares Phong with Torrance-Sparrow at the angles of figure 5.6",
        caption: "Top row: the varnish of course-5-6 over its fluorescent base. Bottom row: Phong's lobe as a BRDF (Lafortune and Willems 1994) plus Lambert, with the same matrix: a base that glows as strongly at all angles, and a \
                  lobe about the mirror direction that has the same weight at all angles. Weight and exponent are those that mirror as much as the varnish, and as widely, for light along the normal: \
                  the exponent is a quarter of Blinn's for the same slope, 2 over its square less 2. Angles are to the surface, and numbers as in course-5-6.",
        seen: "In the top row the spot depends on the angle, in the bottom row it does not but for its place: the difference of the \
               course's slide.",
        size: MEDIUM,
        claim: Claim {
            text: "The colour of the reflection depends on the direction. The varnish mirrors far more green for flat light than for \
                   steep light, and holds back the orange; Phong plus Lambert does neither.",
            checks: &[
                Check::Falls(&[
                    "varnish, 5 degrees: leaves in green",
                    "varnish, 20 degrees: leaves in green",
                    "varnish, 60 degrees: leaves in green",
                ]),
                Check::Falls(&[
                    "varnish, 60 degrees: leaves in orange",
                    "varnish, 20 degrees: leaves in orange",
                    "varnish, 5 degrees: leaves in orange",
                ]),
                Check::Within("Phong, 5 degrees over 60 degrees: leaves in green", 0.0, 1.0),
                Check::Within("Phong, 5 degrees over 60 degrees: leaves in orange", 0.99, 1.01),
                Check::Falls(&[
                    "varnish, 5 degrees: green of all that leaves",
                    "Phong, 5 degrees: green of all that leaves",
                ]),
                // For steep light they are alike, within a third.
                Check::Within("varnish over Phong, 60 degrees: leaves in green", 0.75, 1.33),
            ],
        },
        make: phong,
    },
    Figure {
        name: "course-glow-paint",
        title: "specular fluorescent paint",
        source: "Weidlich and Wilkie 2009, section 5.2.2, which has no figure of it",
        caption: "The paint of ambulances and police cars, as the course describes it: a glossy paint, slope 2 degrees, whose diffuse base fluoresces. Light, matrix, angles and numbers are those of course-5-6. \
                  `materials/surfaces/paints/fluorescent-paint.toml` is such a paint for shaders; course-5-7 shows it in white light. The width of the green spot is the root of the share of the picture that is \
                  at least half as bright.",
        seen: "Small green spots on an orange glow: the same two colours, much more focused.",
        size: MEDIUM,
        claim: Claim {
            text: "A glossy paint shows the two colours, too, but in a much more focused way: the green spot is narrower than that \
                   of the cardboard, and brighter.",
            checks: &[
                Check::Falls(&[
                    "cardboard, 20 degrees: width of the green spot",
                    "paint, 20 degrees: width of the green spot",
                ]),
                Check::Falls(&[
                    "cardboard, 60 degrees: width of the green spot",
                    "paint, 60 degrees: width of the green spot",
                ]),
                Check::Falls(&[
                    "paint, 20 degrees: forward, green over orange",
                    "cardboard, 20 degrees: forward, green over orange",
                ]),
                Check::Falls(&[
                    "paint, 60 degrees: forward, green over orange",
                    "cardboard, 60 degrees: forward, green over orange",
                ]),
                Check::Falls(&["paint, 5 degrees: leaves in green", "paint, 60 degrees: leaves in green"]),
            ],
        },
        make: paint,
    },
];

/// Angles of the light to the surface, degrees.
const ANGLES: [f64; 3] = [5.0, 20.0, 60.0];

/// Factor on radiance under light of irradiance 1.
const EXPOSURE: f64 = 4.0;

/// Light of 532 and of 600 nm in linear Rec.709, from CIE's functions of 1931 (0.191, 0.887, 0.038 and 1.062, 0.631, 0.001): the largest channel is 1, and negative ones are 0.
const COLORS: [[f64; 3]; 2] = [[0.0, 1.0, 0.0], [1.0, 0.0625, 0.0]];

/// Share of the light that the base sends out at 600 nm.
const GLOW: f64 = 0.7;

/// Slopes of the varnish of the cardboard and of the paint, degrees.
const CARDBOARD_DEG: f64 = 17.0;
const PAINT_DEG: f64 = 2.0;

/// A fluorescent base under a varnish of a slope.
fn coated(slope_deg: f64) -> Outcome<Fluorescent> {
    let text = format!(
        "schema = 1\nname = \"coated\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nslope_deg = {slope_deg}\ndistribution = \"beckmann\"\n\
         [[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n"
    );
    let stack = material("coated", &text)?.stack;
    let coats = [532.0, 600.0].map(|nm| Monochrome::new(&stack, nm, 1)).to_vec();
    // Rows are bins of the light that comes out, columns bins of the light that falls in.
    Fluorescent::new(coats, &[0.0, 0.0, GLOW, GLOW]).map_err(Failure::input)
}

/// `f cos_theta_i` in green and in orange of green light.
fn of_varnish(surface: &Fluorescent) -> impl Fn(DVec3, DVec3) -> [f64; 2] {
    |wi, wo| [0, 1].map(|bin: usize| surface.eval(wi, 0, wo, bin))
}

/// Shares of light that leaves a surface at an angle.
struct Leaving {
    green: f64,
    orange: f64,
}

/// The hemisphere above a surface at each angle, with its numbers, whose names begin with `label`.
fn hemispheres(
    studio: &Studio,
    made: &mut Made,
    label: &str,
    value: impl Fn(DVec3, DVec3) -> [f64; 2],
) -> (Labelled, Vec<Leaving>) {
    let size = studio.size;
    let (mut pictures, mut all) = (Vec::new(), Vec::new());
    for angle in ANGLES {
        let (sin, cos) = libm::sincos((90.0 - angle).to_radians());
        let wi = DVec3::new(-sin, 0.0, cos);
        let mut image = Image::zeros(size, size, 3);
        let mut green_alone = Image::zeros(size, size, 3);
        let (mut leaving, mut aside, mut forward) = ([0.0; 2], [0.0; 2], [0.0_f64; 2]);
        for (i, texel) in (0..).zip(image.data.chunks_mut(3)) {
            let [x, y] = [i % size, i / size].map(|i| across(i, size));
            let z_sq = 1.0 - x * x - y * y;
            if z_sq <= 0.0 {
                continue;
            }
            let radiances = value(wi, DVec3::new(x, -y, z_sq.sqrt()));
            for ((bin, color), radiance) in COLORS.iter().enumerate().zip(radiances) {
                // A pixel of the disk is a projected solid angle.
                let light = 4.0 * radiance / f64::from(size * size);
                leaving[bin] += light;
                aside[bin] += light * x;
                if x > 0.0 {
                    forward[bin] = forward[bin].max(radiance);
                }
                for (value, color) in texel.iter_mut().zip(color) {
                    *value += (EXPOSURE * radiance / cos * color) as f32;
                }
            }
            green_alone.texel_mut(i % size, i / size).fill(radiances[0] as f32);
        }
        let [green, orange] = leaving;
        let name = format!("{label}{angle} degrees");
        made.measure(format!("{name}: leaves in green"), green / cos);
        made.measure(format!("{name}: leaves in orange"), orange / cos);
        made.measure(format!("{name}: green of all that leaves"), green / (green + orange));
        made.measure(format!("{name}: green, to the right"), aside[0] / green);
        made.measure(format!("{name}: orange, to the right"), aside[1] / orange);
        made.measure(format!("{name}: forward, green over orange"), forward[0] / forward[1]);
        let width = spot_of(&green_alone, |[green, ..]| green).share.sqrt();
        made.measure(format!("{name}: width of the green spot"), width);
        pictures.push((name, image));
        all.push(Leaving { green: green / cos, orange: orange / cos });
    }
    (pictures, all)
}

fn cardboard(studio: &Studio, made: &mut Made) -> Outcome {
    let surface = coated(CARDBOARD_DEG)?;
    let (pictures, _) = hemispheres(studio, made, "", of_varnish(&surface));
    made.sheet("course-5-6", pictures, ANGLES.len() as u32);
    Ok(())
}

fn phong(studio: &Studio, made: &mut Made) -> Outcome {
    let surface = coated(CARDBOARD_DEG)?;
    let (mut pictures, varnished) = hemispheres(studio, made, "varnish, ", of_varnish(&surface));
    let alpha = libm::tan(CARDBOARD_DEG.to_radians());
    let exponent = 0.25 * (2.0 / (alpha * alpha) - 2.0);
    // F0 of index 1.5; the rest enters.
    let mirrored = 0.04;
    let empirical = |wi: DVec3, wo: DVec3| {
        let lobe = libm::pow(DVec3::new(-wi.x, -wi.y, wi.z).dot(wo).max(0.0), exponent) * (exponent + 2.0);
        let lobe = mirrored * lobe / std::f64::consts::TAU;
        [lobe, (1.0 - mirrored) * GLOW / std::f64::consts::PI].map(|f| f * wi.z)
    };
    let (others, plain) = hemispheres(studio, made, "Phong, ", empirical);
    if let ([grazing, .., steep], Some(layered)) = (plain.as_slice(), varnished.last()) {
        made.measure("Phong, 5 degrees over 60 degrees: leaves in green", grazing.green / steep.green);
        made.measure("Phong, 5 degrees over 60 degrees: leaves in orange", grazing.orange / steep.orange);
        made.measure("varnish over Phong, 60 degrees: leaves in green", layered.green / steep.green);
    }
    pictures.extend(others);
    made.sheet("course-phong", pictures, ANGLES.len() as u32);
    Ok(())
}

fn paint(studio: &Studio, made: &mut Made) -> Outcome {
    let (rough, glossy) = (coated(CARDBOARD_DEG)?, coated(PAINT_DEG)?);
    hemispheres(studio, made, "cardboard, ", of_varnish(&rough));
    let (pictures, _) = hemispheres(studio, made, "paint, ", of_varnish(&glossy));
    made.sheet("course-glow-paint", pictures, ANGLES.len() as u32);
    Ok(())
}
