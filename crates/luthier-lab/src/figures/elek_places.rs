//! Figures of Elek 2010 about surfaces that vary.

use luthier::{Bake, MemoryStore, lit};
use luthier_export::Package;
use luthier_gpu::Shape;
use luthier_lut::Image;
use luthier_manifest::{Form, MapSlot, ShadingModel};
use luthier_material::{Material, PictureRef, VariationSource};
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::course_surfaces::square;
use super::figure::{Figure, Made, SMALL, enlarged};
use super::numbers::places::{correlation, greenness, nearest, noise, places_of_square, sparkles};
use super::numbers::{highlight, over_red, share};
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
                  distance. The noise is the standard deviation of luminance \
                  between neighbouring pixels that the flakes cause, divided by the mean, in the middle of the picture; a pixel sparkles where it is at least twice as \
                  bright as the median around it. A flake is smaller than a pixel, so that a pixel shows one of many by chance. The paper's code adds two terms to a normal that is z already, and so its sum \
                  is z + d z + m, d the distance and m the flake's normal; its text has the last two terms alone. luthier has the code. From distance 4 to 32, where \
                  d grows from 1 to 8, the code makes a flake's tilt smaller by 10 over 3, and the text would by 9 over 2. `rays` is \
                  the mean over the flakes itself, of 64 rays to a pixel; the noise is what one ray adds to it.",
        seen: "Near, the paint glitters; in the top row it is smooth at distance 32, and in the bottom row it is not. It looks as the \
               paper describes it.",
        size: SMALL,
        claim: Claim {
            text: "Near, flakes sparkle. Scaled by the distance, the influence of their normals falls, so that the paint looks \
                  smooth from far. Without it the paint stays noisy at any distance.",
            checks: &[
                Check::Falls(&["plain, distance 4: sparkles", "without flakes, distance 4: sparkles"]),
                Check::Within("plain, distance 4: noise of the flakes", 0.1, 10.0),
                Check::Falls(&[
                    "scaled, distance 4: noise of the flakes",
                    "scaled, distance 8: noise of the flakes",
                    "scaled, distance 16: noise of the flakes",
                    "scaled, distance 32: noise of the flakes",
                ]),
                Check::Within("scaled, distance 4 over distance 32: noise of the flakes", 2.0, 100.0),
                Check::Within("plain, distance 4 over distance 32: noise of the flakes", 0.5, 2.0),
                // For the eye, the scaled flakes are nearer to the mean than plain ones.
                Check::Falls(&[
                    "plain against rays, distance 32: mean FLIP",
                    "scaled against rays, distance 32: mean FLIP",
                ]),
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
                  green with the tarnish below. A map makes the patina up to twice as thick in some places as in others. The numbers are the green \
                  channel over the red one in the middle of each picture. On a level square of the same material the share of pixels that are greener than red is the covered part; \
                  how green each pixel is goes with how dark the map is there. The maps, the model, the green and the tarnish are luthier's; see \
                  `materials/papers/copper-patina.toml`.",
        seen: "The stages go from copper with a highlight to green, matt patina, unevenly, as the paper describes them. Copper is as pale \
               as its indices make it. The paper's object has cracks and wrinkles in which patina begins; here blotches and streaks stand \
               for them.",
        size: SMALL,
        claim: Claim {
            text: "As extent grows, patina covers more of the copper: nothing at -0.65, all at 1.65, first where the map is dark. \
                  Bare copper is red and has a highlight; patina is green and matt.",
            checks: &[
                Check::Within("extent -0.65: share of the square that is green", 0.0, 0.01),
                Check::Within("extent 1.65: share of the square that is green", 0.99, 1.0),
                Check::Within("extent 0.15: correlation of green with the darkness of the map", 0.5, 1.0),
                Check::Within("extent 0.45: correlation of green with the darkness of the map", 0.5, 1.0),
                Check::Falls(&["extent -0.65: highlight over the median", "extent 1.65: highlight over the median"]),
                Check::Within("extent -0.65: green over red", 0.0, 1.0),
                Check::Within("extent 1.65: green over red", 1.0, 10.0),
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

const CAR_PAINT: &str = include_str!("../../../../materials/papers/chromium-car-paint.toml");
const PATINA: &str = include_str!("../../../../materials/papers/copper-patina.toml");

/// Distances of the eye; in the first the flakes begin to fade.
const DISTANCES: [f32; 4] = [4.0, 8.0, 16.0, 32.0];

/// Rays along each side of a pixel of the mean over flakes.
const MANY_RAYS: u32 = 8;

/// Flakes smoother than those of the file, so that single ones sparkle: the paper prints no number.
const SMOOTHER: &str = "alpha = 0.07\n";

fn flakes(studio: &Studio, made: &mut Made) -> Outcome {
    let paint = material("chromium-car-paint.toml", &CAR_PAINT.replace("alpha = 0.2\n", SMOOTHER))?;
    let near = f64::from(DISTANCES[0]);
    let mut materials = Vec::new();
    for (name, fade_start, scale) in [("fading", near, 1.0), ("not-fading", 1e6, 1.0), ("smooth", near, 0.0)] {
        let mut paint = shaded(&paint, name, ShadingModel::Elek);
        let Some(flakes) = &mut paint.effects.flakes else {
            return Err(Failure::Input(anyhow::anyhow!("chromium-car-paint.toml has no flakes")));
        };
        (flakes.fade_start, flakes.scale) = (fade_start, scale);
        materials.push(paint);
    }
    let package = Bake::lit().package(&lit(&materials), &MemoryStore::default())?;
    let mut rows = [Vec::new(), Vec::new()];
    let mut noises = [Vec::new(), Vec::new()];
    for (step, distance) in DISTANCES.into_iter().enumerate() {
        // A pixel always has the same width at the eye. The picture of a far ball has fewer pixels, and is enlarged.
        let size = (studio.size >> step).max(8);
        let [pictures, means] = [1, MANY_RAYS].map(|samples| {
            studio.rendered(&package, Form::Baked, Shape::Sphere, |_, settings| {
                settings.camera.eye = [0.0, 0.0, distance];
                settings.camera.half_extent = 1.25;
                (settings.size, settings.samples, settings.environment_samples) = (size, samples, 0);
            })
        });
        let (pictures, means) = (pictures?, means?);
        if let ([scaled, plain, _], [_, mean, _]) = (pictures.as_slice(), means.as_slice()) {
            for (what, picture) in [("scaled", scaled), ("plain", plain)] {
                made.apart(&format!("{what} against rays, distance {distance}"), picture, mean)?;
            }
        }
        let (Some(smooth), Some(mean_smooth)) = (pictures.last().cloned(), means.last()) else { continue };
        made.measure(format!("without flakes, distance {distance}: sparkles"), sparkles(&smooth));
        let rows = rows.iter_mut().zip(&mut noises).zip(["scaled", "plain"]);
        for (((row, noises), what), (image, mean)) in rows.zip(pictures.into_iter().zip(&means)) {
            // One ray without the noise of flakes: the smooth paint, plus the mean change that flakes make.
            let mut expected = smooth.clone();
            for (value, (mean, smooth)) in expected.data.iter_mut().zip(mean.data.iter().zip(&mean_smooth.data)) {
                *value += mean - smooth;
            }
            let noise = noise(&image, &expected);
            made.measure(format!("{what}, distance {distance}: noise of the flakes"), noise);
            made.measure(format!("{what}, distance {distance}: sparkles"), sparkles(&image));
            noises.push(noise);
            row.push((format!("{what}, {distance}"), enlarged(&image, studio.size, [0, 1, 2])));
        }
    }
    for (what, noises) in ["scaled", "plain"].into_iter().zip(noises) {
        if let [near, .., far] = noises.as_slice() {
            made.measure(format!("{what}, distance 4 over distance 32: noise of the flakes"), near / far);
        }
    }
    let [with, without] = rows;
    made.sheet("elek-7", [with, without].concat(), DISTANCES.len() as u32);
    Ok(())
}

/// Exposure of the figures of patina: bare copper would be blown out under the usual one.
pub(super) const DIM: f32 = 0.5;

/// The stages of figure 8, and its transition.
const EXTENTS: [f64; 6] = [-0.65, -0.05, 0.15, 0.45, 0.75, 1.65];
const TRANSITION: f64 = 0.65;

/// Copper under a patina that lies thicker in some places than in others.
pub(super) fn grown(name: &str, extent: f64, transition: f64) -> Outcome<Material> {
    let absorption = "absorption_per_um = [0.9, 0.25, 0.5]\n";
    let crusted = PATINA.replace(absorption, &format!("{absorption}maps = {{ thickness = \"crust.png\" }}\n"));
    let mut stage = shaded(&material("copper-patina.toml", &crusted)?, name, ShadingModel::Elek);
    let patina = stage.effects.patina.as_mut();
    let patina = patina.ok_or_else(|| Failure::Input(anyhow::anyhow!("copper-patina.toml has no patina")))?;
    (patina.extent, patina.transition) = (extent, transition);
    patina.map = VariationSource::Image(PictureRef::plain("patina.png"));
    Ok(mapped(stage))
}

fn patina(studio: &Studio, made: &mut Made) -> Outcome {
    let mut materials = Vec::new();
    for (i, extent) in EXTENTS.into_iter().enumerate() {
        materials.push(grown(&format!("stage-{i}"), extent, TRANSITION)?);
    }
    let package = Bake::lit().package(&lit(&materials), &MemoryStore::default())?;
    let level = from_above(studio, &package)?;
    let dark = darkness(&package, level.first());
    for (extent, picture) in EXTENTS.iter().zip(&level) {
        let green = greenness(picture);
        let covered = share(green.iter().map(|green| *green > 0.0));
        made.measure(format!("extent {extent}: share of the square that is green"), covered);
        let correlation = correlation(&green, &dark);
        made.measure(format!("extent {extent}: correlation of green with the darkness of the map"), correlation);
    }
    let pictures = studio.staged(&package, |_, settings| settings.exposure = DIM)?;
    for (extent, picture) in EXTENTS.iter().zip(&pictures) {
        made.measure(format!("extent {extent}: green over red"), over_red(picture, 1));
        made.measure(format!("extent {extent}: highlight over the median"), highlight(picture));
    }
    let labels = EXTENTS.iter().map(|extent| format!("extent {extent}"));
    made.sheet("elek-8", labels.zip(pictures), 3);
    Ok(())
}

/// Each material of a bake on a level square that fills the picture.
pub(super) fn from_above(studio: &Studio, package: &Package) -> Outcome<Vec<Image>> {
    let square = square(studio)?;
    studio.rendered(package, Form::Baked, Shape::Plane, |_, settings| *settings = square.clone())
}

/// Darkness of the patina's map in each pixel of the middle half of a level square, row by row.
fn darkness(package: &Package, square: Option<&Image>) -> Vec<f64> {
    let map = package.maps.iter().find(|map| map.slot == MapSlot::Patina).map(|map| map.picture.image());
    let (Some(map), Some(square)) = (map, square) else { return Vec::new() };
    places_of_square(square).map(|[u, v]| 1.0 - f64::from(nearest(&map, [u, v])[0])).collect()
}
