//! Assembly of tiles into atlases.

use luthier_lut::{Atlas, AtlasLayout, Image, TableKind, TexelFormat, Tile, Values};
use luthier_manifest::{Budget, ColorMode, LayerRecord, MaterialConstants, Search, ShadingModel, SideRecord, Tiles};
use luthier_material::Material;
use luthier_optics::interface::Interface;
use rayon::prelude::*;

use crate::BakeError;
use crate::candidates::AIM;
use crate::constants::constants;
use crate::graph::{JobKind, Key, MemoryStore, Observer, Results, Silent, Store};
use crate::kinds::{is_left, lobes};
use crate::limits::layouts;
use crate::maps::{MaterialMap, maps};
use crate::options::{Options, budget};
use crate::plan::{Plan, PlannedLayers, TileList};
use crate::planner::color_mode;
use crate::relief::ImageReader;
use crate::search::{Planned, plan};
use crate::settings::Settings;
use crate::tile::texels;

/// Tables, layer records and maps of a set of materials, ready for a shader.
#[derive(Debug, Clone, PartialEq)]
pub struct Baked {
    /// Atlases in binding order, at most one of each kind.
    pub atlases: Vec<Atlas>,
    /// Each material, in the order given.
    pub materials: Vec<BakedMaterial>,
    /// Reports of the searches for sizes, mappings and formats; empty where nothing was searched.
    pub searches: Vec<Search>,
}

/// One material of a bake.
#[derive(Debug, Clone, PartialEq)]
pub struct BakedMaterial {
    /// The reflectance model of its shader.
    pub model: ShadingModel,
    /// How the spectra in its tables became colours.
    pub color: ColorMode,
    /// Constants of the whole surface.
    pub constants: MaterialConstants,
    /// Its layers from the top down, with the tiles that serve them.
    pub records: Vec<LayerRecord>,
    /// Its maps: layers from the top down, then effects.
    pub maps: Vec<MaterialMap>,
}

impl BakedMaterial {
    /// Removes the tile numbers of every layer, for shaders that read no tables.
    pub fn forget_tables(&mut self) {
        self.records.iter_mut().chain(self.constants.bare_mut()).for_each(|record| record.tiles = Tiles::default());
    }
}

/// Outline of a bake: its tables, tiles and materials, without texels.
///
/// ```
/// # let text = "schema = 1\nname = \"glass\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n";
/// # let read = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// # let glass = luthier_material::parse("glass.toml", text, &read).unwrap().material;
/// let mut copy = glass.clone();
/// copy.name = "copy".to_owned();
/// let outline = luthier_bake::outline(&[glass, copy], &|_, _| Err("no images".into()))?;
/// // Equal interfaces share a tile.
/// assert_eq!((outline.materials.len(), outline.keys[0].len()), (2, 1));
/// # Ok::<(), luthier_bake::BakeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Kind, layout and texel format of each table, in binding order.
    pub tables: Vec<(TableKind, AtlasLayout, TexelFormat)>,
    /// Key of the job of each tile, table by table. Two outlines with equal keys and equal `tables` have equal texels.
    pub keys: Vec<Vec<Key>>,
    /// Each material, in the order given.
    pub materials: Vec<BakedMaterial>,
    /// Reports of the searches for tables.
    pub searches: Vec<Search>,
}

/// The outline of a bake: each material with its tile numbers, and the layout and texel format of each table, in
/// binding order.
///
/// An outline is cheap to compute, with two exceptions: a budget, whose candidates must be measured, and the model
/// `lobes`, which must be fitted.
///
/// # Errors
/// See [`BakeError`].
pub fn outline(materials: &[Material], read_image: ImageReader<'_>) -> Result<Outline, BakeError> {
    outline_with(materials, &Options::default(), read_image, &MemoryStore::default())
}

/// [`outline`] with options and a store, as [`bake_with`] takes them. Without a search and without fits, nothing is
/// computed.
///
/// # Errors
/// See [`BakeError`].
pub fn outline_with(
    materials: &[Material],
    options: &Options<'_>,
    read_image: ImageReader<'_>,
    store: &dyn Store,
) -> Result<Outline, BakeError> {
    let planned = plan(materials, options, read_image, &Silent, store)?;
    let tables = layouts(&planned.plan)?;
    let keys = planned.plan.used().map(|(_, tiles)| tiles.tiles.iter().map(|(_, key)| *key).collect()).collect();
    let Plan { records, settings, .. } = planned.plan;
    Ok(Outline {
        tables,
        keys,
        materials: baked_materials(materials, records, &settings, &planned.results),
        searches: planned.searches,
    })
}

/// Numbers and errors of the layers whose Fresnel rows would miss [`AIM`] in a bake of this material alone.
///
/// Only interfaces that reflect grazing light totally are looked at, and of these only the ones with a kink at the
/// critical angle: no choice of axis makes their rows smooth.
///
/// # Errors
/// See [`BakeError`].
pub fn kinked_rows(material: &Material, read_image: ImageReader<'_>) -> Result<Vec<(usize, f64)>, BakeError> {
    let (stack, color) = (material.reflecting_stack(), material.color());
    let layers = (0..stack.layers.len()).filter(|&i| Interface::of(&stack, i).is_some_and(|i| i.has_kink(&color)));
    let layers: Vec<usize> = layers.collect();
    let materials = std::slice::from_ref(material);
    if layers.is_empty() || !budget(materials, &Budget::default())?.of_texels().is_empty() {
        return Ok(Vec::new());
    }
    let Planned { plan, results, .. } =
        plan(materials, &Options { fits: false, ..Options::default() }, read_image, &Silent, &MemoryStore::default())?;
    if !is_left(&plan.settings, TableKind::Fresnel) {
        return Ok(Vec::new());
    }
    let results = plan.graph.only(|job| job.kind() == JobKind::tile(TableKind::Fresnel)).run(
        &Silent,
        &MemoryStore::default(),
        results,
    )?;
    let rows = &plan.tiles[TableKind::Fresnel as usize].tiles;
    let errors = layers.into_iter().filter_map(|layer| {
        let (_, key) = rows.get(plan.records[0].layers[layer].tiles[TableKind::Fresnel]? as usize)?;
        Some((layer, results.find(*key)?.error.max_abs_err))
    });
    Ok(errors.filter(|(_, error)| *error > AIM).collect())
}

/// Bakes all tables of a set of materials. `read_image` fetches thickness maps.
///
/// # Errors
/// See [`BakeError`]. The number of threads of the current rayon pool changes the time taken and nothing else.
pub fn bake(materials: &[Material], read_image: ImageReader<'_>, observer: &dyn Observer) -> Result<Baked, BakeError> {
    bake_with(materials, &Options::default(), read_image, observer, &MemoryStore::default())
}

/// [`bake`] with options. Results that the store holds are not computed again; new results go into the store.
///
/// # Errors
/// See [`BakeError`].
pub fn bake_with(
    materials: &[Material],
    options: &Options<'_>,
    read_image: ImageReader<'_>,
    observer: &dyn Observer,
    store: &dyn Store,
) -> Result<Baked, BakeError> {
    let options = Options { fits: true, ..*options };
    let Planned { plan, results, searches } = plan(materials, &options, read_image, observer, store)?;
    let layouts = layouts(&plan)?;
    let Plan { settings, graph, tiles, records } = plan;
    let mut results = graph.run(observer, store, results)?;
    let is_asked = !options.search || !budget(materials, &options.budget)?.of_texels().is_empty();
    let mut atlases = Vec::with_capacity(layouts.len());
    for (kind, layout, format) in layouts {
        let aim = (!is_asked && is_left(&settings, kind)).then_some(AIM);
        atlases.push(atlas(kind, layout, format, &tiles[kind as usize], &mut results, aim));
    }
    Ok(Baked { atlases, materials: baked_materials(materials, records, &settings, &results), searches })
}

fn baked_materials(
    materials: &[Material],
    records: Vec<PlannedLayers>,
    settings: &Settings,
    results: &Results,
) -> Vec<BakedMaterial> {
    let baked = materials.par_iter().zip(records).map(|(m, planned)| {
        let lobes = m.model().is_fitted().then(|| lobes::record(m, settings, results));
        let of_lobes = m.side().map(|side| SideRecord {
            lobes: lobes::has_rows(&side).then(|| lobes::record(&side, settings, results)),
            without_film: m.weighs_film(),
        });
        let of_path = m.weighs_film() && m.model().is_path();
        let side = of_lobes.or(of_path.then_some(SideRecord { lobes: None, without_film: true }));
        let (constants, color) = (constants(m, planned.bare, lobes, side), color_mode(m));
        BakedMaterial { model: m.model(), color, constants, records: planned.layers, maps: maps(m) }
    });
    baked.collect()
}

/// The atlas of the tiles of a kind. Each result is forgotten once it is copied: the results of many materials take as
/// much memory as the atlas.
fn atlas(
    kind: TableKind,
    layout: AtlasLayout,
    format: TexelFormat,
    tiles: &TileList,
    results: &mut Results,
    aim: Option<f64>,
) -> Atlas {
    let channels = tiles.tiles.first().map_or(1, |(_, key)| results.tile(*key).truth.channels);
    let [width, height] = layout.size();
    let mut truth = Image::zeros(width, height, channels);
    let mut bytes = vec![0; width as usize * height as usize * format.texel_bytes() as usize];
    let mut entries = Vec::with_capacity(tiles.tiles.len());
    for (index, (name, key)) in tiles.tiles.iter().enumerate() {
        let data = results.tile(*key);
        let origin = layout.origin(index as u32);
        place(&mut truth, origin, &data.truth);
        place_bytes(&mut bytes, width, format, origin, data.size[0], &data.bytes);
        entries.push(Tile {
            name: name.clone(),
            model: data.model.clone(),
            input_hash: key.to_string(),
            error: data.error.clone(),
            aim,
            largest: largest(kind, &data.truth),
        });
        results.forget(*key);
    }
    if format.has_steps() {
        // Tiles side by side are one row, whose steps lead from one to the next.
        bytes = texels(kind, format, &truth).0;
    }
    let texels = format.decode(width, height, &bytes).unwrap_or_else(|_| unreachable!("the bytes are those of tiles"));
    Atlas { kind, layout, format, tiles: entries, truth, texels, bytes }
}

/// The largest magnitude in a tile whose channels are all values of one function.
fn largest(kind: TableKind, truth: &Image) -> Option<f64> {
    let is_one_function = matches!(kind.facts().values, Values::Positive | Values::Signed);
    is_one_function.then(|| truth.data.iter().fold(0.0, |largest: f64, value| largest.max(f64::from(value.abs()))))
}

/// Copies the bytes of a tile that is `across` texels wide into those of an atlas of this width, a row of texels or
/// blocks at a time.
fn place_bytes(atlas: &mut [u8], width: u32, format: TexelFormat, [x, y]: [u32; 2], across: u32, bytes: &[u8]) {
    let [row, pitch, left] = [across, width, x].map(|texels| format.row_bytes(texels) as usize);
    let top = (y / format.block_side()) as usize;
    for (j, source) in (top..).zip(bytes.chunks_exact(row)) {
        atlas[j * pitch + left..][..row].copy_from_slice(source);
    }
}

/// Copies a tile into an atlas.
fn place(atlas: &mut Image, [ox, oy]: [u32; 2], tile: &Image) {
    for j in 0..tile.height {
        for i in 0..tile.width {
            atlas.texel_mut(ox + i, oy + j).copy_from_slice(tile.texel(i, j));
        }
    }
}
