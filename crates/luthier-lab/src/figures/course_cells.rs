//! The figure of the course of Weidlich and Wilkie about tilted cells alone, without the stone below them.

use luthier_gpu::Shape;
use luthier_manifest::Form;
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::course::by_course;
use super::figure::{Figure, LARGE, Labelled, Made};
use super::numbers::light::KEY;
use super::numbers::middle_differs;
use super::numbers::places::sparkles;
use super::numbers::spot::spot;
use super::studio::Studio;

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "course-5-1-cells",
    title: "tilted cells alone",
    source: "Weidlich and Wilkie 2009, section 5.2.1 and figure 5.1",
    caption: "Copper of the sunstone's glitter, slope 3 degrees, over the whole ball: level, with every cell tilted, and with one cell in ten tilted. Each cell of \
              the Voronoi diagram has a normal of its own, up to 25 degrees off, and mirrors another part of the surroundings; its edges are straight. The course's stones \
              have such cells over grains, which course-5-1 shows. The numbers are the shares of the middle half of the picture that differ from the level ball. The \
              number of cells and the angle are luthier's. The scatter is the root mean square distance of the places that are at least half as bright as the brightest, under the key \
              light alone, in half sides of the picture.",
    seen: "Facets scatter the highlight over the ball, as glitter does; the course has no picture of them without a stone.",
    size: LARGE,
    claim: Claim {
        text: "Every filled cell is a facet with a normal of its own, so that the highlight is scattered over the ball. The other cells \
               stay as they are.",
        checks: &[
            Check::Within("all tilted: share that differs from level", 0.9, 1.0),
            Check::Within("one in ten: share that differs from level", 0.05, 0.15),
            Check::Falls(&["all tilted: scatter of the highlight", "level: scatter of the highlight"]),
            Check::Falls(&["all tilted: sparkles", "one in ten: sparkles", "level: sparkles"]),
        ],
    },
    make: cells,
}];

/// Shares of the cells that are tilted.
const FILLED: [(&str, f64); 3] = [("level", 0.0), ("all tilted", 1.0), ("one in ten", 0.1)];

fn cells(studio: &Studio, made: &mut Made) -> Outcome {
    let mut pictures: Labelled = Vec::new();
    for (label, filled) in FILLED {
        let layers = format!(
            "[[layer]]\ntype = \"conductor\"\nior = \"cu\"\nslope_deg = 3\ndistribution = \"beckmann\"\n\
             [effects.glitter]\nseed = 11\nfrequency = 40\nfilled = {filled}\ntilt_deg = 25\n"
        );
        let material = by_course(&label.replace(' ', "-"), &layers)?;
        // Directions would be drawn about the level surface, which misses what tilted cells mirror.
        for lit in studio.lit(std::slice::from_ref(&material), Form::Baked, Shape::Sphere, KEY)? {
            made.measure(format!("{label}: scatter of the highlight"), spot(&lit).scatter());
        }
        let picture =
            studio.pictures(&[material], Form::Baked, Shape::Sphere, |_, settings| settings.environment_samples = 0)?;
        made.measure(format!("{label}: sparkles"), picture.first().map_or(0.0, sparkles));
        pictures.extend(picture.into_iter().map(|picture| (label.to_owned(), picture)));
    }
    if let [(_, level), others @ ..] = pictures.as_slice() {
        for (label, picture) in others {
            made.measure(format!("{label}: share that differs from level"), middle_differs(picture, level));
            made.apart(&format!("{label} against level"), picture, level)?;
        }
    }
    made.sheet("course-5-1-cells", pictures, 3);
    Ok(())
}
