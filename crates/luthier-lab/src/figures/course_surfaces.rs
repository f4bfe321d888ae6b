//! Figures of the course of Weidlich and Wilkie about surfaces of several materials.

use std::path::Path;

use luthier_export::{MemoryStore, Package, SurfaceSource, gather, lit, read_all};
use luthier_gpu::{RenderSettings, Shape, Shown};
use luthier_manifest::Form;
use luthier_terminal::{Outcome, valid};

use super::claim::{Check, Claim};
use super::figure::{Figure, LARGE, Made};
use super::numbers::glitter;
use super::studio::Studio;

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "course-5-1",
    title: "stones of grains and glitter",
    source: "A. Weidlich and A. Wilkie, Exploring the Potential of Layered BRDF Models, SIGGRAPH Asia 2009 Courses, figure 5.1",
    caption: "Sunstone has one colour, a varnish over a Lambertian base, and a glitter map of copper flakes below varnish of that colour. Lepidolite has \
              a surface map of grains in three colours and of silver, and few flakes of silver on top. The noise that puts marble into the course's lepidolite \
              is missing. Indices and slopes are the course's, colours and numbers of cells luthier's: the files are in `materials/surfaces`.",
    size: LARGE,
    claim: Claim {
        text: "Metallic cells glitter in a stone of one colour, and fewer of them in a stone of many grains.",
        checks: &[
            Check::Within("sunstone: share at least twice as bright as the median", 0.01, 0.5),
            Check::Falls(&[
                "sunstone: share at least twice as bright as the median",
                "lepidolite: share at least twice as bright as the median",
            ]),
            Check::Within("lepidolite: share at least twice as bright as the median", 0.001, 0.5),
        ],
    },
    make: stones,
}];

/// Surface files of the repository.
const STONES: [&str; 2] = ["sunstone", "lepidolite"];

fn stones(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let mut pictures = Vec::new();
    for name in STONES {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../materials/surfaces/{name}.toml"));
        let found = gather(&[path])?;
        let materials = valid(read_all(&found.materials)?, true)?;
        let surfaces = found.surfaces.iter().filter_map(SurfaceSource::entry).collect();
        let package = Package::of_surfaces(&lit(&materials), surfaces, &MemoryStore::default())?;
        let scene = studio.gpu()?.scene(&package, Form::Baked)?;
        // Directions would be drawn about the level surface, which misses what tilted flakes mirror.
        let settings = RenderSettings { environment_samples: 0, ..studio.settings(Shape::Sphere)? };
        let picture = scene.render_shown(&[Shown::Surface(0)], &settings)?;
        made.measure(format!("{name}: share at least twice as bright as the median"), glitter(&picture));
        pictures.push((name.to_owned(), picture));
    }
    made.sheet("course-5-1", pictures, 2);
    Ok(made)
}
