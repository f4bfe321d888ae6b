//! Surfaces: the material at each place.

use serde::{Deserialize, Serialize};

/// A surface of several materials (Weidlich and Wilkie 2009, section 5.2.1). The shader's `luthier_pick` has its numbers as
/// constants.
///
/// ```
/// use luthier_manifest::{CellsRecord, SurfaceEntry};
///
/// let cells = CellsRecord { seed: 0, frequency: 20.0, materials: vec![4, 1, 4] };
/// let name = "lepidolite".to_owned();
/// let (source, source_hash) = ("lepidolite.toml".to_owned(), String::new());
/// let surface = SurfaceEntry { name, source, source_hash, cells, switches: Vec::new(), glitter: None };
/// assert_eq!(surface.materials(), [1, 4]);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceEntry {
    /// Name, unique among the surfaces and materials of the bake; letters, digits and hyphens.
    pub name: String,
    /// Its file, as of a material.
    pub source: String,
    /// SHA-256, hex, of that file.
    pub source_hash: String,
    /// Grains that cover it.
    pub cells: CellsRecord,
    /// Other grains at some places; the first switch that holds at a place is seen.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub switches: Vec<SwitchRecord>,
    /// Particles on top of all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub glitter: Option<ParticlesRecord>,
}

/// Voronoi cells, each of one of some materials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellsRecord {
    /// Seed of the cells.
    pub seed: u32,
    /// Cells per unit of texture coordinate.
    pub frequency: f64,
    /// Numbers of the materials, all as likely.
    pub materials: Vec<u32>,
}

/// Grains in place of others, and their places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SwitchRecord {
    /// The places.
    #[serde(flatten)]
    pub by: SwitchBy,
    /// The grains.
    pub cells: CellsRecord,
}

/// Places of a switch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SwitchBy {
    /// Where Perlin's noise is within a range.
    Noise {
        /// Seed of the first octave; each has the next number.
        seed: u32,
        /// Lattice cells of the first octave per unit of texture coordinate.
        frequency: f64,
        /// Octaves, each of twice the frequency and half the weight.
        octaves: u32,
        /// The least value inside and the largest, -1..=1.
        between: [f64; 2],
    },
    /// A share of larger Voronoi cells.
    Tiles {
        /// Seed of the cells.
        seed: u32,
        /// Cells per unit of texture coordinate.
        frequency: f64,
        /// Share of the cells that is inside, 0..=1.
        share: f64,
    },
}

/// Voronoi cells of which a share is tilted, each of one of some materials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParticlesRecord {
    /// The cells, and the materials of those that glitter.
    pub cells: CellsRecord,
    /// Share of the cells that glitter, 0..=1.
    pub filled: f64,
    /// Largest tilt of a glittering cell, radians; tilts are uniform in solid angle.
    pub tilt: f64,
}

impl SurfaceEntry {
    /// All its cells: those that cover it, those of its switches, and the particles.
    pub fn all_cells(&self) -> impl Iterator<Item = &CellsRecord> + Clone {
        let switched = self.switches.iter().map(|switch| &switch.cells);
        std::iter::once(&self.cells).chain(switched).chain(self.glitter.iter().map(|glitter| &glitter.cells))
    }

    /// The numbers of its materials, each once, ascending.
    pub fn materials(&self) -> Vec<u32> {
        let mut all: Vec<u32> = self.all_cells().flat_map(|cells| &cells.materials).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
