//! Surface files, and the surfaces of a bake.

use std::path::PathBuf;

use luthier_layers::effects::heterogeneous::{Map, Switch};
use luthier_layers::noise::perlin::Perlin;
use luthier_layers::noise::voronoi::Voronoi;
use luthier_manifest::{CellsRecord, ParticlesRecord, SurfaceEntry, SwitchBy, SwitchRecord};
use luthier_material::{Diagnostic, Surface, SurfaceCells, parse_surface};

use super::TomlFile;
use crate::sha256;

/// A surface file that was read, and its surface or its errors. [`surface_map`] evaluates the entry of one.
///
/// ```
/// use luthier::{Files, TomlFile};
///
/// let file = TomlFile { path: "stone.toml".into(), bytes: b"surface = 1\nname = \"stone\"\n".to_vec() };
/// let stone = &Files::of(vec![file]).surfaces[0];
/// assert!(stone.entry().is_none(), "it has no cells");
/// assert!(stone.diagnostics()[0].is_error());
/// ```
#[derive(Debug, Clone)]
pub struct SurfaceSource {
    /// The file.
    pub path: PathBuf,
    /// The file, as it was named or found.
    pub label: String,
    /// Its text.
    pub text: String,
    /// The surface, or why it is none.
    pub parsed: Result<Surface, Vec<Diagnostic>>,
    /// Warnings about a usable surface.
    pub warnings: Vec<Diagnostic>,
    /// The numbers of its materials among those of the package, in the order of [`Surface::materials`].
    pub(crate) numbers: Vec<usize>,
}

impl SurfaceSource {
    pub(super) fn of(file: TomlFile) -> Self {
        let (path, label) = (file.path.clone(), file.label());
        let (text, parsed) = match file.text() {
            Ok(text) => {
                let parsed = parse_surface(&label, &text);
                (text, parsed)
            }
            Err((text, error)) => (text, Err(vec![error])),
        };
        Self { path, label, text, parsed, warnings: Vec::new(), numbers: Vec::new() }
    }

    /// The errors of an unusable surface, or the warnings of a usable one.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        self.parsed.as_ref().err().map_or(&self.warnings, Vec::as_slice)
    }

    /// The entry of the surface in a manifest; `None` where it is unusable.
    pub fn entry(&self) -> Option<SurfaceEntry> {
        let surface = self.parsed.as_ref().ok()?;
        let mut numbers = self.numbers.iter().map(|&number| number as u32);
        Some(SurfaceEntry {
            name: surface.name.clone(),
            source: self.label.clone(),
            source_hash: sha256(self.text.as_bytes()),
            cells: cells_record(&surface.cells, &mut numbers),
            switches: surface
                .switches
                .iter()
                .map(|switch| SwitchRecord { by: switch.by, cells: cells_record(&switch.cells, &mut numbers) })
                .collect(),
            glitter: surface.glitter.as_ref().map(|glitter| ParticlesRecord {
                cells: cells_record(&glitter.cells, &mut numbers),
                filled: glitter.filled,
                tilt: glitter.tilt,
            }),
        })
    }
}

/// A record of cells, which takes as many of the next material numbers as the cells name materials.
fn cells_record(cells: &SurfaceCells, numbers: &mut impl Iterator<Item = u32>) -> CellsRecord {
    let materials = numbers.take(cells.materials.len()).collect();
    CellsRecord { seed: cells.seed, frequency: cells.frequency, materials }
}

/// The places of a switch.
pub(super) fn switch_of(by: &SwitchBy) -> Switch {
    match *by {
        SwitchBy::Noise { seed, frequency, octaves, between } => {
            Switch::Noise { noise: Perlin { seed, frequency, octaves }, between }
        }
        SwitchBy::Tiles { seed, frequency, share } => Switch::Tiles { cells: Voronoi { seed, frequency }, share },
    }
}

/// The f64 twin of `luthier_pick`: its picks have the numbers of materials.
///
/// ```
/// use luthier_layers::effects::heterogeneous::Map;
/// use luthier_manifest::{CellsRecord, SurfaceEntry};
///
/// let cells = CellsRecord { seed: 1, frequency: 20.0, materials: vec![4, 2] };
/// let (name, source, source_hash) = ("stone".to_owned(), "stone.toml".to_owned(), String::new());
/// let surface = SurfaceEntry { name, source, source_hash, cells, switches: Vec::new(), glitter: None };
/// assert!(matches!(luthier::surface_map(&surface), Map::Cells { stacks, .. } if stacks == [4, 2]));
/// ```
pub fn surface_map(surface: &SurfaceEntry) -> Map {
    // The first switch of the file is the outermost.
    let map = surface.switches.iter().rev().fold(grains(&surface.cells), |under, switch| Map::Switch {
        switch: switch_of(&switch.by),
        inside: Box::new(grains(&switch.cells)),
        outside: Box::new(under),
    });
    match &surface.glitter {
        None => map,
        Some(glitter) => {
            let (cells, stacks) = twin(&glitter.cells);
            Map::Glitter { cells, stacks, filled: glitter.filled, tilt: glitter.tilt, under: Box::new(map) }
        }
    }
}

/// The cells as the twin has them, and the material number of each stack.
fn twin(record: &CellsRecord) -> (Voronoi, Vec<usize>) {
    let stacks = record.materials.iter().map(|&material| material as usize).collect();
    (Voronoi { seed: record.seed, frequency: record.frequency }, stacks)
}

fn grains(record: &CellsRecord) -> Map {
    let (cells, stacks) = twin(record);
    Map::Cells { cells, stacks }
}
