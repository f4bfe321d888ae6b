//! The exercise of Palubicki's lecture: 25 balls.

use luthier::{Bake, MemoryStore, lit};
use luthier_gpu::{GRID_SIDE, Shape};
use luthier_lut::Image;
use luthier_manifest::Form;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::figure::{Figure, Made, SMALL};
use super::numbers::spot::spot;
use super::numbers::{highlight, pixels};
use super::studio::{Studio, material};

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "lecture-25",
    title: "25 balls, metallic against roughness",
    source: "W. Palubicki, lecture GRK 7, exercise",
    caption: "Metallic falls from 1 to 0 down the rows, roughness grows from 0.1 to 1 along them. The files are of type `metallic-roughness` with the lecture's F0 of \
              copper as base colour (0.955, 0.638, 0.538), and F0 of 0.04 where nothing is metallic; F0 lies on the straight line between. The model is \
              `belcour`, which follows all bounces, so that the base shows its colour. The numbers are F0 down the rows, R, G, B, as the interface of the file has it.",
    seen: "The grid is that of the exercise: copper fades to paint down the rows, and highlights to dull surfaces along them.",
    size: SMALL,
    claim: Claim {
        text: "F0 falls from that of copper to 0.04 with metallic, and highlights get wider and dimmer with roughness.",
        checks: &[
            Check::Falls(&[
                "metallic 1: F0, R",
                "metallic 0.75: F0, R",
                "metallic 0.5: F0, R",
                "metallic 0.25: F0, R",
                "metallic 0: F0, R",
            ]),
            Check::Within("metallic 0: F0, R", 0.0399, 0.0401),
            Check::Falls(&[
                "metallic 1, roughness 0.1: highlight over the median",
                "metallic 1, roughness 0.325: highlight over the median",
                "metallic 1, roughness 0.55: highlight over the median",
                "metallic 1, roughness 0.775: highlight over the median",
                "metallic 1, roughness 1: highlight over the median",
            ]),
            Check::Falls(&[
                "metallic 1, roughness 1: width of the highlight",
                "metallic 1, roughness 0.775: width of the highlight",
                "metallic 1, roughness 0.55: width of the highlight",
                "metallic 1, roughness 0.325: width of the highlight",
                "metallic 1, roughness 0.1: width of the highlight",
            ]),
            // Halfway between 0.955 and 0.04.
            Check::Within("metallic 0.5: F0, R", 0.4970, 0.4980),
            Check::Within("metallic 1: F0, B", 0.5375, 0.5385),
        ],
    },
    make: balls,
}];

/// The lecture's F0 of copper.
const COPPER: [f64; 3] = [0.955, 0.638, 0.538];

fn balls(studio: &Studio, made: &mut Made) -> Outcome {
    let last = f64::from(GRID_SIDE - 1);
    let mut materials = Vec::new();
    for row in 0..GRID_SIDE {
        for column in 0..GRID_SIDE {
            let (metallic, roughness) = (1.0 - f64::from(row) / last, 0.1 + 0.9 * f64::from(column) / last);
            let name = format!("ball-{row}-{column}");
            let text = format!(
                "schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"metallic-roughness\"\nbase_color = {COPPER:?}\n\
                 metallic = {metallic:.3}\nroughness = {roughness:.3}\n[bake]\nmodel = \"belcour\"\n"
            );
            let material = material(&name, &text)?;
            if let Some(interface) = Interface::of(&material.stack, 0).filter(|_| column == 0) {
                for (channel, f0) in ["R", "G", "B"].into_iter().zip(interface.sampled(&Color::Spectral).rgb(1.0)) {
                    made.measure(format!("metallic {metallic}: F0, {channel}"), f0);
                }
            }
            materials.push(material);
        }
    }
    let package = Bake::lit().package(&lit(&materials), &MemoryStore::default())?;
    let scene = studio.gpu()?.scene(&package, Form::Baked)?;
    let mut settings = studio.settings(Shape::Grid)?;
    // One picture holds all balls.
    settings.size = 4 * studio.size;
    settings.samples = 4;
    settings.environment_samples = 0;
    let all: Vec<u32> = (0..materials.len() as u32).collect();
    let picture = scene.render(&all, &settings).map_err(Failure::device)?;
    let side = picture.width / GRID_SIDE;
    for column in 0..GRID_SIDE {
        // The ball of all metal, in its cell of the first row.
        let mut ball = Image::zeros(side, side, 3);
        for (x, y) in pixels(&ball) {
            ball.texel_mut(x, y).copy_from_slice(picture.texel(column * side + x, y));
        }
        let roughness = 0.1 + 0.9 * f64::from(column) / last;
        made.measure(format!("metallic 1, roughness {roughness}: highlight over the median"), highlight(&ball));
        made.measure(format!("metallic 1, roughness {roughness}: width of the highlight"), spot(&ball).share.sqrt());
    }
    made.sheet("lecture-25", vec![("metal down, rough right".to_owned(), picture)], 1);
    Ok(())
}
