//! Figures of the course of Weidlich and Wilkie about its shader: absorption, bases, internal reflection, varnishes, bumps.

use std::sync::Arc;

use glam::DVec3;
use luthier_gpu::{Environment, Light, Shape};
use luthier_lut::Image;
use luthier_manifest::{Form, InternalReflection};
use luthier_material::Material;
use luthier_optics::fresnel::transmitted;
use luthier_optics::masking::v_cavity;
use luthier_report::lightness_chroma_hue;
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::course::{by_course, numbered};
use super::elek::light;
use super::figure::{Figure, Labelled, MEDIUM, Made, SMALL, TONE};
use super::numbers::light::{FROM_EYE, KEY};
use super::numbers::places::{ball_normal, color_at};
use super::numbers::spot::spot;
use super::numbers::tint::{hue, lightness_apart, saturation, tint_deviation};
use super::numbers::{across, brightness, grain, highlight, middle, over_red, pixels, rgb};
use super::studio::{Studio, mapped};

pub(crate) const FIGURES: [Figure; 6] = [
    Figure {
        name: "course-3-3",
        title: "a lacquer with and without absorption",
        source: "A. Weidlich and A. Wilkie, Exploring the Potential of Layered BRDF Models, SIGGRAPH Asia 2009 Courses, figure 3.3",
        caption: "The first ball has a red lacquer that absorbs, the second a clear coat over a base whose albedo has the colour of the first ball's \
                  middle. The other pictures are the differences of hue, chroma and lightness (CIE 1976), grey where there is none and brighter where the \
                  absorbing lacquer has more. Chroma and lightness differ most at the rim, where paths in the lacquer are long, and hue least, as the course says. \
                  The difference of hue is CIE's, in the unit of the other two, of which an eye just notices 2.3: the lacquer changes lightness and chroma at the rim by about that. \
                  More is not to be had, because paths in a coat of index 1.5 get longer by at most a third. The rim is outside of two thirds of the radius. The absorption is luthier's.",
        seen: "The hue's picture is even, and those of chroma and lightness change all over and most at the rim, as in the course. The course calls \
               these changes considerable; here an eye just notices them.",
        size: SMALL,
        claim: Claim {
            text: "An absorbing lacquer differs from a clear one over a base of its colour in chroma and lightness, \
                  mainly at grazing angles, and practically not in hue.",
            checks: &[
                // 2.3 units of CIELAB is the difference that an eye just notices (Mahy et al. 1994).
                Check::Within("mean difference of hue, where both have a colour", 0.0, 2.3),
                Check::Falls(&["mean difference of chroma at the rim", "mean difference of chroma in the middle"]),
                Check::Falls(&[
                    "mean difference of lightness at the rim",
                    "mean difference of lightness in the middle",
                ]),
                Check::Falls(&["mean difference of chroma at the rim", "mean difference of hue at the rim"]),
                Check::Falls(&["mean difference of lightness at the rim", "mean difference of hue at the rim"]),
            ],
        },
        make: absorption,
    },
    Figure {
        name: "course-3-5",
        title: "bases of Oren and Nayar",
        source: "Weidlich and Wilkie 2009, figure 3.5",
        caption: "Balls with sigma 0, 0.2, 0.4, 0.6, 0.8 and 1.0 under a light from the eye. Sigma 0 falls off towards the rim as Lambert's cosine; with \
                  sigma the ball gets flat like the full Moon. The numbers are the radiance at 0.9 of the radius over that of the middle.",
        seen: "The balls get flat with sigma, as in the course.",
        size: SMALL,
        claim: Claim {
            text: "With growing sigma the base sends more light back to where it came from: from Lambert's cosine at sigma 0, the \
                  ball under a light from the eye gets flat.",
            checks: &[
                Check::Within(
                    "sigma 0: radiance near the rim over that of the middle, over Lambert's cosine",
                    0.98,
                    1.02,
                ),
                Check::Falls(&[
                    "sigma 1: radiance near the rim over that of the middle",
                    "sigma 0.8: radiance near the rim over that of the middle",
                    "sigma 0.6: radiance near the rim over that of the middle",
                    "sigma 0.4: radiance near the rim over that of the middle",
                    "sigma 0.2: radiance near the rim over that of the middle",
                    "sigma 0: radiance near the rim over that of the middle",
                ]),
            ],
        },
        make: bases,
    },
    Figure {
        name: "course-3-6",
        title: "silver under a blue varnish that gets thicker",
        source: "Weidlich and Wilkie 2009, figure 3.6",
        caption: "The varnish of the course in six thicknesses, from none to opaque, over silver. The mirrored surroundings get blue and dark, while the \
                  reflection of the varnish itself stays white. The absorption is luthier's.",
        seen: "Silver gets blue and dark, as in the course; the highlights of thin varnishes are blown out.",
        size: SMALL,
        claim: Claim {
            text: "The thicker a blue varnish on silver is, the darker and the more saturated is the ball, and its hue turns on in \
                  blue.",
            checks: &[
                Check::Falls(&[
                    "0 um: mean luminance",
                    "0.2 um: mean luminance",
                    "0.5 um: mean luminance",
                    "1 um: mean luminance",
                    "2 um: mean luminance",
                    "5 um: mean luminance",
                ]),
                Check::Falls(&[
                    "5 um: saturation",
                    "2 um: saturation",
                    "1 um: saturation",
                    "0.5 um: saturation",
                    "0.2 um: saturation",
                    "0 um: saturation",
                ]),
                Check::Falls(&["5 um: hue", "2 um: hue", "1 um: hue", "0.5 um: hue"]),
                // From the least hue of Munsell's blue to the blue primary of Rec.709, which is at 306 degrees in CIELAB.
                Check::Within("1 um: hue", 215.0, 306.3),
                Check::Within("5 um: hue", 215.0, 306.3),
            ],
        },
        make: silver,
    },
    Figure {
        name: "course-3-7",
        title: "with and without internal reflection",
        source: "Weidlich and Wilkie 2009, figure 3.7",
        caption: "Silver under a blue lacquer with the internal reflection t (left) and without it (middle, `internal_reflection = \"none\"`), and the t of a light \
                  from the upper left, white where it is 1 (right). The index of the lacquer is 1.3 above and 2.5 below. The term darkens a lacquer of a low index \
                  by a few hundredths, and that of a high index by a fifth. At the rim facets hide each other, and t is 1 again. The course names neither the indices \
                  nor the slope; its picture of a low index has t between 0.95 and 1.",
        seen: "At the low index no difference is seen, and at the high one a subtle one, as in the course; the pictures of t agree.",
        size: MEDIUM,
        claim: Claim {
            text: "Internal reflection is almost negligible for a lacquer of a low index, where t is from 0.95 to 1. It is more \
                  prominent for a high index, and still subtle.",
            checks: &[
                // 2.3 units of CIELAB is what an eye just notices, and colours 10 apart are still called similar.
                Check::Within("index 1.3: mean difference of lightness", 0.0, 2.3),
                Check::Within("index 2.5: mean difference of lightness", 0.0, 10.0),
                Check::Falls(&["index 2.5: mean difference of lightness", "index 1.3: mean difference of lightness"]),
                Check::Falls(&[
                    "index 1.3: light with the term over that without",
                    "index 2.5: light with the term over that without",
                ]),
                Check::Within("index 1.3: least t of the light from the upper left", 0.95, 1.0),
            ],
        },
        make: inside,
    },
    Figure {
        name: "course-3-8",
        title: "parts of the shader",
        source: "Weidlich and Wilkie 2009, figure 3.8",
        caption: "From left to right: the coat alone, over black; the base alone; the base through a clear coat; through the coat that absorbs; all of it. \
                  The coat is the surface of the course's shader, Blinn's distribution with V-cavities. \
                  The course's figure adds an ambient term and an environment; here the surroundings are seen by all parts.",
        seen: "The parts add up to the whole, as in the course, whose ambient term luthier does not have.",
        size: SMALL,
        claim: Claim {
            text: "The shader is the sum of what the coat mirrors and of the base, which absorption multiplies: straight on by \
                  exp(-2 a d), 0.951, 0.407 and 0.497.",
            checks: &[
                Check::Within("straight on, share of the base that is left: R", 0.941, 0.961),
                Check::Within("straight on, share of the base that is left: G", 0.397, 0.417),
                Check::Within("straight on, share of the base that is left: B", 0.487, 0.507),
                Check::Falls(&["clear coat: highlight over the median", "base: highlight over the median"]),
                Check::Falls(&["clear coat: mean luminance", "absorbs: mean luminance"]),
                Check::Falls(&["clear coat: blue over red", "absorbs: blue over red"]),
            ],
        },
        make: parts,
    },
    Figure {
        name: "course-3-9",
        title: "a torus under four varnishes",
        source: "Weidlich and Wilkie 2009, figure 3.9",
        caption: "A smooth clear varnish on a diffuse base (a), a smooth tinted one (b), a varnish whose thickness a map varies (c), and a matt varnish over aluminium with \
                  bumps (d): the normal map tilts only what lies below the varnish, whose own reflection runs over the bumps undisturbed. In (e), which the course does not show, \
                  the varnish has the bumps, too. Maps and numbers are luthier's. Widths and grain are those under the key light alone.",
        seen: "The four tori are recognised; the course's bump map is not known. The metal of (d) is bright.",
        size: SMALL,
        claim: Claim {
            text: "A smooth varnish has a sharp highlight (a, b), and a matt one a wide highlight (d). A tinted one colours the base \
                  (b). Where the thickness varies, the colour does (c). Bumps below a varnish are seen through it (d).",
            checks: &[
                Check::Falls(&["b tinted: saturation", "a clear: saturation"]),
                Check::Falls(&["c thickness: deviation of the colour", "b tinted: deviation of the colour"]),
                Check::Falls(&["d below: width of the highlight", "a clear: width of the highlight"]),
                Check::Falls(&["d below: width of the highlight", "b tinted: width of the highlight"]),
                Check::Falls(&["d below: grain", "without bumps: grain"]),
            ],
        },
        make: varnishes,
    },
];

fn coat(thickness_um: f64, absorption: &str) -> String {
    format!(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nslope_deg = 1.5\ndistribution = \"beckmann\"\n\
         thickness_um = {thickness_um}\nabsorption_per_um = {absorption}\n"
    )
}

fn diffuse(albedo: &str) -> String {
    format!("[[layer]]\ntype = \"diffuse\"\nalbedo = {albedo}\n")
}

const RED: &str = "[0.05, 0.9, 0.7]";
const CLEAR: &str = "0";

/// Thickness of the red lacquer of figure 3.3.
const RED_UM: f64 = 0.6;

fn absorption(studio: &Studio, made: &mut Made) -> Outcome {
    let tinted = by_course("tinted", &(coat(RED_UM, RED) + &diffuse("0.8")))?;
    let with = studio.picture(tinted, Form::Full, Shape::Sphere)?;
    // The colour of the base seen straight on: twice through the lacquer at the normal.
    let base = [0.05, 0.9, 0.7].map(|a: f64| 0.8 * libm::exp(-2.0 * RED_UM * a));
    let clear = by_course("clear", &(coat(RED_UM, CLEAR) + &diffuse(&format!("{base:?}"))))?;
    let without = studio.picture(clear, Form::Full, Shape::Sphere)?;
    let mut pictures: Labelled =
        vec![("absorbs".to_owned(), TONE.image(with.clone())), ("clear".to_owned(), TONE.image(without.clone()))];
    for (c, (name, scale)) in [("hue", 8.0), ("chroma", 12.0), ("lightness", 8.0)].into_iter().enumerate() {
        let mut apart = Image::zeros(with.width, with.height, 3);
        let (mut sum, mut count) = (0.0, 0.0);
        // Sums and counts within two thirds of the radius, and outside.
        let mut zones = [[0.0, 0.0]; 2];
        for (x, y) in pixels(&with) {
            let [a, b] = [&with, &without].map(|image| lightness_chroma_hue(rgb(image.texel(x, y))));
            // In the order of the course: hue, chroma, lightness.
            let (mut d, seen) = (a[2 - c] - b[2 - c], a[1].min(b[1]) > 5.0);
            if c == 0 {
                d -= 360.0 * (d / 360.0).round();
                // CIE's difference of hue, in the unit of chroma and lightness.
                d = if seen { 2.0 * (a[1] * b[1]).sqrt() * libm::sin(0.5 * d.to_radians()) } else { 0.0 };
            }
            if seen {
                (sum, count) = (sum + d.abs(), count + 1.0);
                let [right, down] = [x, y].map(|i| across(i, with.width) / BALL);
                let zone = &mut zones[usize::from(libm::hypot(right, down) > 2.0 / 3.0)];
                *zone = [zone[0] + d.abs(), zone[1] + 1.0];
            }
            let shade = (0.5 + 0.5 * d / scale).clamp(0.0, 1.0) as f32;
            apart.texel_mut(x, y).fill(shade * shade);
        }
        made.measure(format!("mean difference of {name}, where both have a colour"), sum / f64::max(count, 1.0));
        for ([sum, count], zone) in zones.into_iter().zip(["in the middle", "at the rim"]) {
            made.measure(format!("mean difference of {name} {zone}"), sum / f64::max(count, 1.0));
        }
        pictures.push((format!("d {name}"), apart));
    }
    made.shown("course-3-3", pictures, 5);
    Ok(())
}

/// Radius of the ball over half the side of a picture.
const BALL: f64 = 0.8;

fn bases(studio: &Studio, made: &mut Made) -> Outcome {
    let sigmas = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
    let layers = sigmas.map(|sigma| format!("{}sigma = {sigma}\n", diffuse("[0.5, 0.35, 0.25]")));
    let materials = numbered("sigma", layers)?;
    let dark = Arc::new(Environment::new(Image::zeros(16, 8, 3)).map_err(Failure::device)?);
    let pictures = studio.pictures(&materials, Form::Full, Shape::Sphere, |_, settings| {
        settings.environment = dark.clone();
        settings.lights = vec![Light::Directional { direction: [0.0, 0.0, 1.0], irradiance: [2.0; 3] }];
    })?;
    for (sigma, picture) in sigmas.into_iter().zip(&pictures) {
        let middle = picture.width / 2;
        let edge = middle + (f64::from(middle) * BALL) as u32 * 9 / 10;
        let ratio = rgb(picture.texel(edge, middle))[1] / rgb(picture.texel(middle, middle))[1].max(1e-9);
        made.measure(format!("sigma {sigma}: radiance near the rim over that of the middle"), ratio);
        if sigma == 0.0 {
            let cos_theta_i = ball_normal([across(edge, picture.width), 0.0]).map_or(f64::NAN, |[_, _, z]| z);
            let what = format!("sigma {sigma}: radiance near the rim over that of the middle, over Lambert's cosine");
            made.measure(what, ratio / cos_theta_i);
        }
    }
    made.sheet("course-3-5", sigmas.iter().map(|sigma| format!("sigma {sigma}")).zip(pictures), 6);
    Ok(())
}

fn silver(studio: &Studio, made: &mut Made) -> Outcome {
    let thicknesses = [0.0, 0.2, 0.5, 1.0, 2.0, 5.0];
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"ag\"\nslope_deg = 3\ndistribution = \"beckmann\"\n";
    let materials = numbered("silver", thicknesses.map(|thickness| coat(thickness, "[0.6, 0.35, 0.05]") + metal))?;
    let pictures = studio.pictures(&materials, Form::Full, Shape::Sphere, |_, _| {})?;
    for (thickness, picture) in thicknesses.iter().zip(&pictures) {
        made.measure(format!("{thickness} um: mean luminance"), brightness(picture));
        made.measure(format!("{thickness} um: saturation"), saturation(middle(picture, 0.5)));
        made.measure(format!("{thickness} um: hue"), hue(picture, 0.5));
    }
    made.sheet("course-3-6", thicknesses.iter().map(|d| format!("{d} um")).zip(pictures), 6);
    Ok(())
}

fn inside(studio: &Studio, made: &mut Made) -> Outcome {
    let (indices, slope_deg) = ([1.3, 2.5], 8.0);
    let mut materials = Vec::new();
    for index in indices {
        for internal in [InternalReflection::Facets, InternalReflection::None] {
            let coat = coat(1.0, "[0.6, 0.35, 0.05]").replace("ior = 1.5", &format!("ior = {index}"));
            let coat = coat.replace("slope_deg = 1.5", &format!("slope_deg = {slope_deg}"));
            let metal = format!(
                "[[layer]]\ntype = \"conductor\"\nior = \"ag\"\nslope_deg = {slope_deg}\ndistribution = \"beckmann\"\n"
            );
            let mut material = by_course(&format!("inside-{}", materials.len()), &(coat + &metal))?;
            material.bake.internal_reflection = Some(internal);
            materials.push(material);
        }
    }
    let pictures = studio.pictures(&materials, Form::Full, Shape::Sphere, |_, settings| settings.exposure = 0.4)?;
    let mut shown: Labelled = Vec::new();
    for (index, pair) in indices.into_iter().zip(pictures.chunks_exact(2)) {
        if let [with, without] = pair {
            made.measure(format!("index {index}: light with the term over that without"), light(with) / light(without));
            made.measure(format!("index {index}: mean difference of lightness"), lightness_apart(with, without));
            shown.push((format!("{index} with"), TONE.image(with.clone())));
            shown.push((format!("{index} without"), TONE.image(without.clone())));
        }
        let (image, least) = seen_inside(studio.size, index);
        made.measure(format!("index {index}: least t of the light from the upper left"), least);
        shown.push(("t".to_owned(), image));
    }
    made.shown("course-3-7", shown, 3);
    Ok(())
}

/// The term t of eq. 3.3 on a ball under one light, white where it is 1, and its least value.
fn seen_inside(size: u32, index: f64) -> (Image, f64) {
    let light = DVec3::new(-0.45, 0.7, 0.6).normalize();
    let eye = DVec3::Z;
    let wh = (light + eye).normalize();
    let cos_theta_d = eye.dot(wh);
    let passed = transmitted(1.0, &[], index, cos_theta_d);
    let (mut image, mut least) = (Image::zeros(size, size, 3), 1.0);
    for (x, y) in pixels(&image) {
        let (nx, ny) = (across(x, size) / BALL, -(across(y, size) / BALL));
        let normal = DVec3::new(nx, ny, (1.0 - nx * nx - ny * ny).max(0.0).sqrt());
        let (cos_i, cos_o) = (normal.dot(light), normal.z);
        if cos_i <= 0.0 || cos_o <= 0.0 {
            continue;
        }
        let g = v_cavity(cos_i, cos_o, normal.dot(wh), cos_theta_d);
        let t = (1.0 - g) + passed * g;
        least = f64::min(least, t);
        image.texel_mut(x, y).fill(t as f32);
    }
    (image, least)
}

fn parts(studio: &Studio, made: &mut Made) -> Outcome {
    let base = diffuse("[0.7, 0.55, 0.3]");
    let all = [
        ("coat", coat(0.5, CLEAR) + &diffuse("0")),
        ("base", base.clone()),
        ("clear coat", coat(0.5, CLEAR) + &base),
        ("absorbs", coat(0.5, RED) + &base),
        ("and rough", coat(0.5, RED).replace("slope_deg = 1.5", "slope_deg = 8") + &base),
    ];
    // The course's `blinnD`.
    let materials = numbered("part", all.iter().map(|(_, layers)| layers.replace("beckmann", "blinn")))?;
    let pictures = studio.pictures(&materials, Form::Full, Shape::Sphere, |_, _| {})?;
    for ((label, _), picture) in all.iter().zip(&pictures) {
        made.measure(format!("{label}: mean luminance"), brightness(picture));
        made.measure(format!("{label}: blue over red"), over_red(picture, 2));
        made.measure(format!("{label}: highlight over the median"), highlight(picture));
    }
    // Under a light from the eye, in the middle of the ball: less what the coat mirrors, the base through an absorbing coat over
    // that through a clear one.
    let lit = studio.lit(&materials, Form::Full, Shape::Sphere, FROM_EYE)?;
    let [coat, _, clear, absorbs, _] = [0, 1, 2, 3, 4].map(|i: usize| color_at(&lit[i], [0.0; 2]));
    for (c, channel) in ["R", "G", "B"].into_iter().enumerate() {
        let left = (absorbs[c] - coat[c]) / (clear[c] - coat[c]);
        made.measure(format!("straight on, share of the base that is left: {channel}"), left);
    }
    made.sheet("course-3-8", all.iter().map(|(name, _)| *name).zip(pictures), 5);
    Ok(())
}

const METAL: &str = "[[layer]]\ntype = \"conductor\"\nior = \"al\"\nslope_deg = 6\ndistribution = \"beckmann\"\n";

fn varnishes(studio: &Studio, made: &mut Made) -> Outcome {
    let white = diffuse("[0.75, 0.72, 0.65]");
    let matt = coat(0.3, CLEAR).replace("slope_deg = 1.5", "slope_deg = 7");
    let bumps = "[effects.flakes]\nnormal_map = \"bumps.png\"\ntiling = 4\nscale = 1\nfade_start = 1000\n";
    let all = [
        ("a clear", coat(0.5, CLEAR) + &white),
        ("b tinted", coat(0.5, RED) + &white),
        ("c thickness", coat(2.0, RED) + "[layer.maps]\nthickness = \"thickness.png\"\n" + &white),
        ("d below", matt.clone() + METAL + bumps),
        ("e above", matt.clone() + "[layer.maps]\nnormal = \"bumps.png\"\n" + METAL),
    ];
    let numbered = numbered("varnish", all.iter().map(|(_, layers)| layers.clone()))?;
    let mut materials: Vec<Material> = numbered.into_iter().map(mapped).collect();
    materials.push(by_course("no-bumps", &(matt + METAL))?);
    let mut pictures = studio.pictures(&materials, Form::Full, Shape::Torus, |_, _| {})?;
    let level = pictures.pop().unwrap_or_else(|| Image::zeros(1, 1, 3));
    for (i, j) in [(1, 0), (2, 1), (4, 3)] {
        made.apart(&format!("{} against {}", all[i].0, all[j].0), &pictures[i], &pictures[j])?;
    }
    made.apart("d below against without bumps", &pictures[3], &level)?;
    let lit = studio.lit(&materials, Form::Full, Shape::Torus, KEY)?;
    let labels = all.iter().map(|(name, _)| *name).chain(["without bumps"]);
    for ((label, picture), lit) in labels.zip(pictures.iter().chain([&level])).zip(&lit) {
        made.measure(format!("{label}: saturation"), saturation(middle(picture, 0.8)));
        made.measure(format!("{label}: deviation of the colour"), tint_deviation(picture));
        made.measure(format!("{label}: grain"), grain(lit));
        made.measure(format!("{label}: width of the highlight"), spot(lit).share.sqrt());
    }
    made.sheet("course-3-9", all.iter().map(|(name, _)| *name).zip(pictures), 5);
    Ok(())
}
