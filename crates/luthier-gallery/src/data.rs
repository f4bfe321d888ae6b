//! The data that the script of a page reads.

use std::collections::BTreeMap;

use luthier_export::Package;
use luthier_lut::TableKind;
use luthier_manifest::reads;
use luthier_manifest::{Form, LayerRecord, MaterialEntry};
use rayon::prelude::*;
use serde::Serialize;

use crate::live::PageLive;
use crate::maps::PageMaps;
use crate::roughness::PageSlopes;
use crate::sets::{PageSet, PageTable, constants, is_blurred, tables};
use crate::skies::{PageSky, Reads};
use crate::{Exhibit, Gallery, GalleryError, Look, Simulated, pack};

/// All that the script of a page reads.
#[derive(Debug, Serialize)]
pub(crate) struct PageData {
    glsl: BTreeMap<&'static str, String>,
    /// Tables, each once.
    tables: Vec<PageTable>,
    /// Numbers of the tables of each package.
    packages: Vec<Vec<usize>>,
    sets: Vec<Set>,
    skies: Vec<PageSky>,
    materials: Vec<PageMaterial>,
}

#[derive(Debug, Serialize)]
struct Set {
    #[serde(flatten)]
    set: PageSet,
    count: usize,
}

#[derive(Debug, Serialize)]
struct PageMaterial {
    name: String,
    looks: Vec<PageLook>,
    #[serde(skip_serializing_if = "Option::is_none")]
    maps: Option<PageMaps>,
    #[serde(skip_serializing_if = "Option::is_none")]
    simulated: Option<PageSimulated>,
}

#[derive(Debug, Serialize)]
struct PageLook {
    set: usize,
    /// Number in the set.
    number: usize,
    model: &'static str,
    is_blurred: bool,
    slopes: PageSlopes,
    #[serde(skip_serializing_if = "Option::is_none")]
    live: Option<PageLive>,
    bytes: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    table_error: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lobe_error: Option<String>,
    cycles: BTreeMap<&'static str, String>,
}

#[derive(Debug, Serialize)]
struct PageSimulated {
    size: u32,
    samples: u32,
    texels: String,
}

impl PageData {
    pub(crate) fn new(gallery: &Gallery) -> Result<Self, GalleryError> {
        let names: Vec<&str> = gallery.exhibits.iter().map(|exhibit| exhibit.name.as_str()).collect();
        if let Some(i) = (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
            return Err(GalleryError::Twice { name: names[i].to_owned() });
        }
        let numbered: Vec<(usize, &Package)> = gallery.packages.iter().enumerate().collect();
        let sets: Vec<Vec<PageSet>> =
            numbered.par_iter().map(|(i, package)| PageSet::of(*i, package)).collect::<Result<_, GalleryError>>()?;
        let sets: Vec<PageSet> = sets.into_iter().flatten().collect();
        let of_packages: Vec<Vec<PageTable>> = numbered
            .par_iter()
            .map(|(i, package)| {
                let own = sets.iter().filter(|set| set.is_of(*i));
                let read: Vec<&str> = own.flat_map(PageSet::tables).map(String::as_str).collect();
                tables(package, |name| read.contains(&name))
            })
            .collect::<Result<_, GalleryError>>()?;
        let mut all: Vec<PageTable> = Vec::new();
        let packages =
            of_packages.into_iter().map(|own| own.into_iter().map(|table| number(&mut all, table)).collect());
        let packages = packages.collect();
        let shown = gallery.packages.iter().flat_map(|package| &package.manifest.materials);
        let reads = Reads::of(shown.filter(|entry| is_blurred(entry)));
        let mut skies = vec![PageSky::studio(reads)?];
        for &scenery in &gallery.skies {
            skies.push(PageSky::scenery(scenery, reads)?);
        }
        let materials = gallery.exhibits.par_iter().map(|exhibit| PageMaterial::new(exhibit, gallery, &sets));
        let materials = materials.collect::<Result<_, GalleryError>>()?;
        let sets = sets.into_iter().map(|set| Set { count: set.count(), set }).collect();
        Ok(Self { glsl: glsl(), tables: all, packages, sets, skies, materials })
    }

    /// JSON that can stand in a script of HTML.
    pub(crate) fn json(&self) -> String {
        let json = serde_json::to_string(self).expect("strings and numbers");
        json.replace('<', "\\u003c")
    }
}

/// The code around emitted shaders.
fn glsl() -> BTreeMap<&'static str, String> {
    let texts = [
        ("view", include_str!("glsl/view.glsl")),
        ("blurred", include_str!("glsl/blurred.glsl")),
        ("drawn", include_str!("glsl/drawn.glsl")),
        ("main", include_str!("glsl/main.glsl")),
        ("show", include_str!("glsl/show.glsl")),
    ];
    let mut glsl: BTreeMap<&'static str, String> = texts.map(|(name, text)| (name, text.to_owned())).into();
    glsl.insert("constants", constants());
    glsl
}

/// The number of a table among all, to which it is added if it is new.
fn number(all: &mut Vec<PageTable>, table: PageTable) -> usize {
    let place = all.iter().position(|other| *other == table);
    place.unwrap_or_else(|| {
        all.push(table);
        all.len() - 1
    })
}

impl PageMaterial {
    fn new(exhibit: &Exhibit, gallery: &Gallery, sets: &[PageSet]) -> Result<Self, GalleryError> {
        let looks = exhibit.looks.iter();
        let looks = looks.map(|look| PageLook::new(look, gallery.packages.get(look.package)?, sets)).collect();
        let (Some(first), Some(looks)) = (exhibit.looks.first(), looks) else {
            return Err(GalleryError::NoLook { name: exhibit.name.clone() });
        };
        Ok(Self {
            name: exhibit.name.clone(),
            looks,
            maps: PageMaps::of(&gallery.packages[first.package], first.material),
            simulated: exhibit.simulated.as_ref().map(PageSimulated::new),
        })
    }
}

impl PageLook {
    fn new(look: &Look, package: &Package, sets: &[PageSet]) -> Option<Self> {
        let entry = package.manifest.materials.get(look.material as usize)?;
        let mut places = sets.iter().map(|set| set.place(look.package, look.material)).enumerate();
        let (set, number) = places.find_map(|(i, place)| Some((i, place?)))?;
        let lobes = entry.constants.lobes.and_then(|lobes| lobes.error);
        Some(Self {
            set,
            number,
            model: entry.model.name(),
            is_blurred: is_blurred(entry),
            slopes: PageSlopes::of(entry),
            live: PageLive::of(entry),
            bytes: bytes(table_bytes(package, entry)),
            table_error: table_error(package, entry).map(|error| format!("{error:.1e}")),
            lobe_error: lobes.map(|error| format!("{:.3}", error.lobe)),
            cycles: look.cycles.iter().map(|(form, text)| (Form::name(*form), text.clone())).collect(),
        })
    }
}

/// The tiles of a kind that the shader of a material reads.
fn tiles(entry: &MaterialEntry, kind: TableKind) -> Vec<usize> {
    let records: Vec<LayerRecord> = entry.records().cloned().collect();
    let read = (0..records.len()).filter(|&i| reads(entry.model, kind, &records, i));
    let mut tiles: Vec<usize> = read.filter_map(|i| records[i].tiles[kind]).map(|tile| tile as usize).collect();
    if kind == TableKind::Lobes {
        let count = |entry: &MaterialEntry| {
            let lobes = entry.constants.lobes;
            let varying = lobes.and_then(|lobes| lobes.varying).map_or(1, |varying| varying.tiles);
            varying.max(lobes.and_then(|lobes| lobes.axes).map_or(1, |axes| axes.tiles)) as usize
        };
        tiles = tiles.iter().flat_map(|&first| first..first + count(entry)).collect();
        let side = entry.side();
        let first = side.as_ref().and_then(|side| side.layers.first()?.tiles[kind]);
        if let (Some(side), Some(first)) = (&side, first) {
            tiles.extend(first as usize..first as usize + count(side));
        }
    }
    tiles.sort_unstable();
    tiles.dedup();
    tiles
}

/// Bytes of the tiles that a material reads.
fn table_bytes(package: &Package, entry: &MaterialEntry) -> u64 {
    let bytes = package.manifest.tables.iter().map(|table| {
        let [width, height] = table.layout.tile_size();
        let tile = u64::from(width) * u64::from(height) * u64::from(table.format.texel_bytes());
        tile * tiles(entry, table.kind).len() as u64
    });
    bytes.sum()
}

/// The largest error of the tiles that a material reads.
fn table_error(package: &Package, entry: &MaterialEntry) -> Option<f64> {
    let errors = package.manifest.tables.iter().filter_map(|table| {
        let tiles = tiles(entry, table.kind).into_iter().filter_map(|tile| table.tiles.get(tile));
        tiles.fold(None, |most: Option<f64>, tile| Some(most.unwrap_or(0.0).max(tile.error.max_abs_err)))
    });
    errors.reduce(f64::max)
}

pub(crate) fn bytes(count: u64) -> String {
    match count {
        0..1024 => format!("{count} B"),
        1024..1_048_576 => format!("{:.1} KiB", count as f64 / 1024.0),
        _ => format!("{:.1} MiB", count as f64 / 1_048_576.0),
    }
}

impl PageSimulated {
    fn new(simulated: &Simulated) -> Self {
        let Simulated { image, samples } = simulated;
        // Pictures of WebGL begin at the bottom.
        let mut flipped = image.clone();
        let row = (image.width * image.channels) as usize;
        flipped.data = image.data.chunks_exact(row).rev().flatten().copied().collect();
        Self { size: image.width, samples: *samples, texels: pack::images([&flipped], false) }
    }
}
