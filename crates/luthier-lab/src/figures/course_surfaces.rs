//! Figures of the course of Weidlich and Wilkie about surfaces of several materials.

use luthier_export::{MemoryStore, lit};
use luthier_gpu::{Package, Shape, Shown};
use luthier_manifest::{CellsRecord, Form, ParticlesRecord, SurfaceEntry};
use luthier_material::{Surface, SurfaceCells, parse_surface};
use luthier_terminal::{Failure, Outcome};

use super::figure::{Figure, Made};
use super::studio::{Studio, material};

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "course-5-1",
    title: "stones of grains and glitter",
    source: "A. Weidlich and A. Wilkie, Exploring the Potential of Layered BRDF Models, SIGGRAPH Asia 2009 Courses, figure 5.1",
    caption: "Sunstone has one colour, a varnish over a Lambertian base, and a glitter map of copper flakes below varnish of that colour. Lepidolite has \
              a surface map of grains in three colours and of silver, and few flakes of silver on top. The noise that puts marble into the course's lepidolite \
              is missing. Indices and slopes are the course's, colours and numbers of cells luthier's: the files are in `materials/surfaces`.",
    make: stones,
}];

macro_rules! texts {
    ($folder:literal: $($name:literal),*) => {
        (
            include_str!(concat!("../../../../materials/surfaces/", $folder, ".toml")),
            &[$((
                concat!($folder, "/", $name, ".toml"),
                include_str!(concat!("../../../../materials/surfaces/", $folder, "/", $name, ".toml")),
            )),*],
        )
    };
}

/// A surface file, and the materials that it names.
type Texts = (&'static str, &'static [(&'static str, &'static str)]);

const STONES: [Texts; 2] =
    [texts!("sunstone": "stone", "copper", "pale-copper"), texts!("lepidolite": "lilac", "pink", "violet", "silver")];

fn stones(studio: &Studio) -> Outcome<Made> {
    let mut made = Made::default();
    let mut pictures = Vec::new();
    for (text, files) in STONES {
        let wrong = |errors: Vec<_>| Failure::Input(anyhow::anyhow!("{errors:?}"));
        let surface = parse_surface("stone.toml", text).map_err(wrong)?;
        let materials = files.iter().map(|(name, text)| material(name, text)).collect::<Outcome<Vec<_>>>()?;
        let entries = vec![entry(&surface, files)];
        let package = Package::of_surfaces(&lit(&materials), entries, &MemoryStore::default())?;
        let scene = studio.gpu()?.scene(&package, Form::Baked)?;
        let picture = scene.render_shown(&[Shown::Surface(0)], &studio.settings(Shape::Sphere)?)?;
        pictures.push((surface.name, picture));
    }
    made.sheet("course-5-1", pictures, 2);
    Ok(made)
}

fn entry(surface: &Surface, files: &[(&str, &str)]) -> SurfaceEntry {
    let number = |file: &str| files.iter().position(|(name, _)| *name == file).unwrap_or(0) as u32;
    let cells = |cells: &SurfaceCells| CellsRecord {
        seed: cells.seed,
        frequency: cells.frequency,
        materials: cells.materials.iter().map(|named| number(&named.file)).collect(),
    };
    SurfaceEntry {
        name: surface.name.clone(),
        source: surface.source.clone(),
        source_hash: String::new(),
        cells: cells(&surface.cells),
        glitter: surface.glitter.as_ref().map(|glitter| ParticlesRecord {
            cells: cells(&glitter.cells),
            filled: glitter.filled,
            tilt: glitter.tilt,
        }),
    }
}
