//! Surfaces: which material is at each place.

use serde::{Deserialize, Serialize};

/// A surface of several materials (Weidlich and Wilkie 2009, section 5.2.1). The shader's `luthier_pick` has its numbers as
/// constants.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceEntry {
    /// Name, unique among the surfaces and materials of the bake; letters, digits and hyphens.
    pub name: String,
    /// The file it came from, as it was named on the command line.
    pub source: String,
    /// SHA-256, hex, of that file.
    pub source_hash: String,
    /// Grains that cover it.
    pub cells: CellsRecord,
    /// Particles on top of them.
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
    /// The numbers of its materials, each once, ascending.
    pub fn materials(&self) -> Vec<u32> {
        let of_glitter = self.glitter.iter().flat_map(|glitter| &glitter.cells.materials);
        let mut all: Vec<u32> = self.cells.materials.iter().chain(of_glitter).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
