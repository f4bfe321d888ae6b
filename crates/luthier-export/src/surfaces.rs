//! Surface files on disk, and the material files that they name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use luthier_layers::effects::heterogeneous::{Map, Switch, SwitchShare, switch_shares};
use luthier_layers::noise::perlin::Perlin;
use luthier_layers::noise::voronoi::Voronoi;
use luthier_manifest::{CellsRecord, ParticlesRecord, SurfaceEntry, SwitchBy, SwitchRecord};
use luthier_material::{
    Diagnostic, Material, NamedMaterial, Surface, SurfaceCells, SurfaceSwitch, is_surface, parse_surface,
};

use crate::make::file;
use crate::sources::{Source, label, plain};
use crate::{ExportError, input, sha256};

/// A surface file that was read, and what became of it.
#[derive(Debug, Clone)]
pub struct SurfaceSource {
    /// The file, as it was named or found.
    pub label: String,
    /// Its text.
    pub text: String,
    /// The surface, or why it is none.
    pub parsed: Result<Surface, Vec<Diagnostic>>,
    /// Doubts about a surface that can be used, see [`doubt_surfaces`].
    pub warnings: Vec<Diagnostic>,
    /// The numbers of its materials among [`Gathered::materials`], in the order of [`Surface::materials`].
    numbers: Vec<usize>,
}

/// Files of a bake by what they are.
#[derive(Debug, Clone, Default)]
pub struct Gathered {
    /// Surface files.
    pub surface_files: Vec<PathBuf>,
    /// Material files: those that were given, then others that surfaces name. Each once.
    pub materials: Vec<PathBuf>,
    /// The surfaces.
    pub surfaces: Vec<SurfaceSource>,
}

/// Tells surfaces from other files, and adds the materials that they name.
///
/// # Errors
/// [`ExportError::File`], of a file that was given. A file that a surface names and that cannot be read is in [`SurfaceSource::parsed`].
pub fn gather(files: &[PathBuf]) -> Result<Gathered, ExportError> {
    let mut gathered = Gathered::default();
    for path in files {
        let bytes = input::bytes(path).map_err(|source| file("read", path, source))?;
        match String::from_utf8(bytes) {
            Ok(text) if is_surface(&text) => {
                let label = label(path);
                let parsed = parse_surface(&label, &text);
                gathered.surface_files.push(path.clone());
                gathered.surfaces.push(SurfaceSource {
                    label,
                    text,
                    parsed,
                    warnings: Vec::new(),
                    numbers: Vec::new(),
                });
            }
            _ => gathered.materials.push(path.clone()),
        }
    }
    let same = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let mut numbers: BTreeMap<PathBuf, usize> =
        gathered.materials.iter().enumerate().map(|(number, path)| (same(path), number)).collect();
    for (path, source) in gathered.surface_files.iter().zip(&mut gathered.surfaces) {
        let Ok(surface) = &source.parsed else { continue };
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut errors: Vec<Diagnostic> = Vec::new();
        for named in surface.materials() {
            let path = plain(&folder.join(&named.file));
            match unusable(&path) {
                Some((message, hint)) => errors.push(surface.diagnostic(named, message, hint)),
                None => source.numbers.push(*numbers.entry(same(&path)).or_insert_with(|| {
                    gathered.materials.push(path);
                    gathered.materials.len() - 1
                })),
            }
        }
        if !errors.is_empty() {
            source.parsed = Err(errors);
        }
    }
    Ok(gathered)
}

/// Why a file that a surface names is no material, and what to do.
fn unusable(path: &Path) -> Option<(String, &'static str)> {
    match input::bytes(path) {
        Err(error) => {
            Some((format!("cannot read {}: {error}", label(path)), "the path is relative to the surface file"))
        }
        Ok(bytes) if is_surface(&String::from_utf8_lossy(&bytes)) => Some((
            format!("{} is a surface, and surfaces are made of materials", label(path)),
            "name the materials of that surface instead",
        )),
        Ok(_) => None,
    }
}

/// Makes surfaces unusable that cannot be baked with these materials, the sources of [`Gathered::materials`]: names that others have, and
/// particles whose normal something else says.
pub fn refuse_surfaces(surfaces: &mut [SurfaceSource], materials: &[Source]) {
    let parsed: Vec<Option<&Material>> =
        materials.iter().map(|source| source.parsed.as_ref().ok().map(|parsed| &parsed.material)).collect();
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for material in parsed.iter().flatten() {
        let constant = luthier_shader::surface_identifier(&material.name).unwrap_or_default();
        names.insert(constant, format!("the material of {}", material.place("name")));
    }
    for source in surfaces {
        let Ok(surface) = &source.parsed else { continue };
        let mut errors = Vec::new();
        match luthier_shader::surface_identifier(&surface.name) {
            Err(error) => errors.push(surface.of_name(error.to_string())),
            Ok(constant) => {
                if let Some(other) = names.get(&constant) {
                    errors.push(surface.of_name(format!("{other} has this name, or one that is the same in a shader")));
                }
                names.insert(constant, format!("the surface {}", source.label));
            }
        }
        let grains = source.numbers.len() - surface.particles().len();
        let particles = surface.particles().iter().zip(&source.numbers[grains..]);
        errors.extend(particles.filter_map(|(named, number)| turned(surface, named, parsed.get(*number).copied()??)));
        if !errors.is_empty() {
            source.parsed = Err(errors);
        }
    }
}

/// An error about a particle that has a normal of its own.
fn turned(surface: &Surface, named: &NamedMaterial, material: &Material) -> Option<Diagnostic> {
    let has_map = material.layers.first().is_some_and(|layer| layer.maps.normal.is_some());
    let what = match (has_map, material.effects.glitter.is_some()) {
        (true, _) => "a normal map",
        (_, true) => "glitter",
        _ => return None,
    };
    let message = format!("{} has {what}, and a particle has the normal of its tilt", named.file);
    Some(surface.diagnostic(named, message, "name a material without it, or put this one into `cells`"))
}

/// Share of a surface below which grains count as unseen.
const UNSEEN: f64 = 1e-3;

/// Warns of switches whose grains are on less than a thousandth of a surface: the noise hardly reaches their range, their share of the tiles is small,
/// or switches before them in the file have their places.
pub fn doubt_surfaces(surfaces: &mut [SurfaceSource]) {
    for source in surfaces {
        let Ok(surface) = &source.parsed else { continue };
        source.warnings = unseen(surface);
    }
}

/// A warning for each switch with unseen grains.
fn unseen(surface: &Surface) -> Vec<Diagnostic> {
    let switches: Vec<Switch> = surface.switches.iter().map(|switch| switch_of(&switch.by)).collect();
    let shares = switch_shares(&switches);
    let unseen = surface.switches.iter().zip(&shares).filter(|(_, share)| share.seen < UNSEEN);
    let warning = |(switch, share): (&SurfaceSwitch, &SwitchShare)| {
        let message = format!("these grains are on less than {} % of the surface", 100.0 * UNSEEN);
        let hint = match share.noise {
            _ if share.own >= UNSEEN => "switches before it in the file have its places: put it before them".to_owned(),
            Some([least, most]) => {
                format!(
                    "this noise is from {least:.2} to {most:.2} nearly everywhere: choose a range inside, or a wider one"
                )
            }
            None => "give it a larger `share`".to_owned(),
        };
        surface.of_switch(switch, message, hint)
    };
    unseen.map(warning).collect()
}

impl SurfaceSource {
    /// Its errors; of a surface that can be used, its warnings.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        self.parsed.as_ref().err().map_or(&self.warnings, Vec::as_slice)
    }

    /// The surface as the manifest has it; `None` where it is unusable.
    pub fn entry(&self) -> Option<SurfaceEntry> {
        let surface = self.parsed.as_ref().ok()?;
        let mut numbers = self.numbers.iter().map(|&number| number as u32);
        let mut cells = |cells: &SurfaceCells| CellsRecord {
            seed: cells.seed,
            frequency: cells.frequency,
            materials: numbers.by_ref().take(cells.materials.len()).collect(),
        };
        Some(SurfaceEntry {
            name: surface.name.clone(),
            source: self.label.clone(),
            source_hash: sha256(self.text.as_bytes()),
            cells: cells(&surface.cells),
            switches: surface
                .switches
                .iter()
                .map(|switch| SwitchRecord { by: switch.by, cells: cells(&switch.cells) })
                .collect(),
            glitter: surface.glitter.as_ref().map(|glitter| ParticlesRecord {
                cells: cells(&glitter.cells),
                filled: glitter.filled,
                tilt: glitter.tilt,
            }),
        })
    }
}

/// The places of a switch.
fn switch_of(by: &SwitchBy) -> Switch {
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
/// assert!(matches!(luthier_export::surface_map(&surface), Map::Cells { stacks, .. } if stacks == [4, 2]));
/// ```
pub fn surface_map(surface: &SurfaceEntry) -> Map {
    let voronoi = |cells: &CellsRecord| Voronoi { seed: cells.seed, frequency: cells.frequency };
    let stacks = |cells: &CellsRecord| cells.materials.iter().map(|&material| material as usize).collect();
    let grains = |cells: &CellsRecord| Map::Cells { cells: voronoi(cells), stacks: stacks(cells) };
    // The first switch of the file is the outermost.
    let map = surface.switches.iter().rev().fold(grains(&surface.cells), |under, switch| Map::Switch {
        switch: switch_of(&switch.by),
        inside: Box::new(grains(&switch.cells)),
        outside: Box::new(under),
    });
    match &surface.glitter {
        None => map,
        Some(glitter) => Map::Glitter {
            cells: voronoi(&glitter.cells),
            stacks: stacks(&glitter.cells),
            filled: glitter.filled,
            tilt: glitter.tilt,
            under: Box::new(map),
        },
    }
}
