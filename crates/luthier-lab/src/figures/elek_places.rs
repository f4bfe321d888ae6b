//! Figures of Elek 2010 about surfaces that vary.

use luthier_export::{MemoryStore, Package, lit};
use luthier_gpu::Shape;
use luthier_lut::Image;
use luthier_manifest::{Form, MapSlot, ShadingModel};
use luthier_material::{Material, VariationSource};
use luthier_optics::color::luminance;
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::figure::{Figure, Made, SMALL};
use super::numbers::over_red;
use super::studio::{Studio, mapped, material, shaded};

pub(crate) const FIGURES: [Figure; 2] = [
    Figure {
        name: "elek-7",
        title: "metal flakes with distance",
        source: "Elek 2010, figure 7",
        caption: "The pictures show chromium flakes under a red coat from four distances, with one ray to a pixel \
                  and no filtering. The ball covers fewer pixels at larger distances, and is enlarged. In the top \
                  row, the flakes' normal is weighted by the distance from distance 4 on, as in the paper, and the \
                  paint becomes smooth. In the bottom row it is not weighted, and the ball stays noisy at any \
                  distance, down to single dark and bright pixels. The number is the variation of luminance that \
                  flakes cause between pixels, divided by the mean, in the middle of the picture; at distance 32 \
                  that is a square of a sixteenth of the picture's side.",
        size: SMALL,
        claim: Claim {
            text: "Flakes whose normals are scaled by the distance fade into a smooth paint; without it the paint stays noisy at \
                  any distance.",
            checks: &[
                Check::Falls(&[
                    "scaled, distance 4: noise of the flakes",
                    "scaled, distance 8: noise of the flakes",
                    "scaled, distance 16: noise of the flakes",
                    "scaled, distance 32: noise of the flakes",
                ]),
                Check::Falls(&["plain, distance 32: noise of the flakes", "scaled, distance 32: noise of the flakes"]),
                Check::Within("plain, distance 32 over distance 4: noise of the flakes", 0.5, 2.0),
            ],
        },
        make: flakes,
    },
    Figure {
        name: "elek-8",
        title: "a growing patina",
        source: "Elek 2010, figure 8",
        caption: "The pictures show copper under cuprite at the six stages of the paper, with its width of the \
                  transition. Patina grows first where the map is dark: in blotches, and in streaks that water has left. The \
                  transition is so wide that no edge is visible: the copper pales, turns green unevenly and ends as a matt \
                  green with the tarnish below. A map makes the patina thicker in some places; copper shows through where it is thin. The numbers are the mean amount of patina over the map, and the mean of the green \
                  channel over that of the red one in the middle of each picture. The maps, the model, the green and the tarnish are luthier's; see \
                  `materials/copper-patina.toml`.",
        size: SMALL,
        claim: Claim {
            text: "As extent grows from -0.65 to 1.65, bare copper becomes green all over, at no sharp edge.",
            checks: &[
                Check::Falls(&[
                    "extent 1.65: mean amount of patina",
                    "extent 0.75: mean amount of patina",
                    "extent 0.45: mean amount of patina",
                    "extent 0.15: mean amount of patina",
                    "extent -0.05: mean amount of patina",
                    "extent -0.65: mean amount of patina",
                ]),
                Check::Falls(&[
                    "extent 1.65: green over red",
                    "extent 0.75: green over red",
                    "extent 0.45: green over red",
                    "extent 0.15: green over red",
                    "extent -0.05: green over red",
                    "extent -0.65: green over red",
                ]),
            ],
        },
        make: patina,
    },
];

const CAR_PAINT: &str = include_str!("../../../../materials/chromium-car-paint.toml");
const PATINA: &str = include_str!("../../../../materials/copper-patina.toml");

/// Distances of the eye; in the first the flakes begin to fade.
const DISTANCES: [f32; 4] = [4.0, 8.0, 16.0, 32.0];

fn flakes(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let paint = material("chromium-car-paint.toml", CAR_PAINT)?;
    let variant = |name: &str, fade_start: f64, scale: f64| -> Outcome<Material> {
        let mut paint = shaded(&paint, name, ShadingModel::Elek);
        let missing = || Failure::Input(anyhow::anyhow!("chromium-car-paint.toml has no flakes"));
        let flakes = paint.effects.flakes.as_mut().ok_or_else(missing)?;
        (flakes.fade_start, flakes.scale) = (fade_start, scale);
        Ok(paint)
    };
    let near = f64::from(DISTANCES[0]);
    let materials = [variant("fading", near, 1.0)?, variant("not-fading", 1e6, 1.0)?, variant("smooth", near, 0.0)?];
    let package = Package::for_renderer(&lit(&materials), &MemoryStore::default())?;
    let mut rows = [Vec::new(), Vec::new()];
    let mut plain = Vec::new();
    for (step, distance) in DISTANCES.into_iter().enumerate() {
        // A pixel is always as wide at the eye; what is far away is smaller, and enlarged.
        let size = (studio.size >> step).max(8);
        let mut pictures = studio.rendered(&package, Form::Baked, Shape::Sphere, |_, settings| {
            settings.camera.eye = [0.0, 0.0, distance];
            settings.camera.half_extent = 1.25;
            settings.size = size;
            settings.samples = 1;
            settings.environment_samples = 0;
        })?;
        let smooth = pictures.pop().unwrap_or_else(|| Image::zeros(size, size, 3));
        for ((row, image), what) in rows.iter_mut().zip(pictures).zip(["scaled", "plain"]) {
            let noise = noise(&image, &smooth);
            made.measure(format!("{what}, distance {distance}: noise of the flakes"), noise);
            if what == "plain" {
                plain.push(noise);
            }
            row.push((format!("{what}, {distance}"), enlarged(&image, studio.size)));
        }
    }
    if let [near, .., far] = plain.as_slice() {
        made.measure("plain, distance 32 over distance 4: noise of the flakes", far / near);
    }
    let [with, without] = rows;
    made.sheet("elek-7", [with, without].concat(), DISTANCES.len() as u32);
    Ok(made)
}

/// Root mean square of what flakes do to the luminance of the middle half of a picture, over its mean.
fn noise(image: &Image, smooth: &Image) -> f64 {
    let value = |image: &Image, x: u32, y: u32| {
        let texel = image.texel(x, y);
        luminance([0, 1, 2].map(|c| f64::from(texel[c])))
    };
    let middle = image.width / 4..image.width * 3 / 4;
    let count = f64::from((middle.end - middle.start).max(1));
    let (mut squares, mut sum) = (0.0, 0.0);
    for y in middle.clone() {
        for x in middle.clone() {
            let (here, bare) = (value(image, x, y), value(smooth, x, y));
            squares += (here - bare) * (here - bare);
            sum += bare;
        }
    }
    // Both are sums over as many pixels.
    squares.sqrt() * count / sum.max(1e-12)
}

/// Every pixel repeated.
fn enlarged(image: &Image, size: u32) -> Image {
    let mut large = Image::zeros(size, size, 3);
    for y in 0..size {
        for x in 0..size {
            large.texel_mut(x, y).copy_from_slice(image.texel(x * image.width / size, y * image.height / size));
        }
    }
    large
}

/// The stages of figure 8, and its transition.
const EXTENTS: [f64; 6] = [-0.65, -0.05, 0.15, 0.45, 0.75, 1.65];
const TRANSITION: f64 = 0.65;

/// Copper under a patina that lies thicker in some places than in others.
pub(super) fn crusted() -> Outcome<Material> {
    let absorption = "absorption_per_um = [0.9, 0.25, 0.5]\n";
    material(
        "copper-patina.toml",
        &PATINA.replace(absorption, &format!("{absorption}maps = {{ thickness = \"crust.png\" }}\n")),
    )
}

fn patina(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let copper = crusted()?;
    let mut materials = Vec::new();
    let map = || VariationSource::Image { path: "patina.png".to_owned() };
    for (i, extent) in EXTENTS.into_iter().enumerate() {
        let mut stage = shaded(&copper, &format!("stage-{i}"), ShadingModel::Elek);
        let missing = || Failure::Input(anyhow::anyhow!("copper-patina.toml has no patina"));
        let patina = stage.effects.patina.as_mut().ok_or_else(missing)?;
        (patina.extent, patina.transition, patina.map) = (extent, TRANSITION, map());
        materials.push(mapped(stage));
    }
    let package = Package::for_renderer(&lit(&materials), &MemoryStore::default())?;
    let map = package.maps.iter().find(|map| map.slot == MapSlot::Patina).map(|map| &map.image);
    for extent in EXTENTS {
        let amounts = map
            .into_iter()
            .flat_map(Image::texels)
            .map(|texel| (0.5 + (extent - f64::from(texel[0])) / (2.0 * TRANSITION)).clamp(0.0, 1.0));
        let count = map.map_or(1, Image::texel_count);
        made.measure(format!("extent {extent}: mean amount of patina"), amounts.sum::<f64>() / count as f64);
    }
    let pictures = studio.staged(&package, |_, _| {})?;
    for (extent, picture) in EXTENTS.iter().zip(&pictures) {
        made.measure(format!("extent {extent}: green over red"), over_red(picture, 1));
    }
    let labels = EXTENTS.iter().map(|extent| format!("extent {extent}"));
    made.sheet("elek-8", labels.zip(pictures).collect(), 3);
    Ok(made)
}
