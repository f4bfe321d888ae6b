//! From tiles to atlases.

use luthier_lut::{
    Atlas, AtlasLayout, Axis, Budget, ColorMode, FormatSet, Image, LayerRecord, MaterialConstants, RowBase, Search,
    ShadingModel, TableKind, TexelFormat, Tile,
};
use luthier_material::{BudgetSettings, Material};

use crate::constants::constants;
use crate::fresnel::RowShape;
use crate::graph::{Observer, Results, Silent};
use crate::job::{JobKind, Key};
use crate::maps::{MaterialMap, maps};
use crate::plan::{ImageReader, Plan, PlannedLayers, Tiles, color_mode, shading_model};
use crate::search;
use crate::settings::Settings;
use crate::{BakeError, DEFAULT_BUDGET};

/// What a set of materials needs at run time.
#[derive(Debug, Clone, PartialEq)]
pub struct Bake {
    /// At most one atlas of each kind, in binding order.
    pub atlases: Vec<Atlas>,
    /// Each material, in the order given.
    pub materials: Vec<BakedMaterial>,
    /// How the tables came by their sizes, mappings and formats, where these were searched for.
    pub searches: Vec<Search>,
}

/// One material of a bake.
#[derive(Debug, Clone, PartialEq)]
pub struct BakedMaterial {
    /// The reflectance model of its shader.
    pub model: ShadingModel,
    /// How its tables came by their colour.
    pub color: ColorMode,
    /// What belongs to the whole surface.
    pub constants: MaterialConstants,
    /// Its layers from the top down, with the tiles that serve them.
    pub records: Vec<LayerRecord>,
    /// Its maps: layers from the top down, then effects.
    pub maps: Vec<MaterialMap>,
}

/// What a bake would consist of.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Kind, layout and texel format of each table, in binding order.
    pub tables: Vec<(TableKind, AtlasLayout, TexelFormat)>,
    /// The job of each tile, table by table: where these and `tables` are the same, so are the texels.
    pub keys: Vec<Vec<Key>>,
    /// Each material, in the order given.
    pub materials: Vec<BakedMaterial>,
    /// What the search for tables found.
    pub searches: Vec<Search>,
}

/// Longest side that textures are laid out for while tiles fit: any device of the last decade has it.
const MAX_SIDE: u32 = 2048;

/// How a bake is to be made, beside what the materials say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Limits, each in place of those that materials state.
    pub budget: Budget,
    /// Whether sizes, mappings and formats that no material decides are searched for; otherwise they are fixed defaults, and budgets
    /// are not looked at.
    pub search: bool,
    /// Whether a material has tiles only in the tables that the `baked` shader of its model reads. Otherwise it has one in every kind,
    /// for whoever lights it with an environment.
    pub lean: bool,
    /// Fresnel rows of this form, of the size and axis that materials ask for or that are fixed, in place of those of a search.
    pub rows: Option<(RowBase, TexelFormat)>,
    /// Texel formats that a search may take; those of core WebGPU unless the target is known.
    pub formats: FormatSet,
}

impl Default for Options {
    fn default() -> Self {
        Self { budget: Budget::default(), search: true, lean: false, rows: None, formats: FormatSet::CORE }
    }
}

/// What a bake of these materials would consist of: each material with the tiles that serve it, and the layout and texel format of each
/// table, in binding order. Little is computed for it, unless a material has a budget: what holds that must be measured.
///
/// # Errors
/// See [`BakeError`].
pub fn outline(materials: &[Material], read_image: ImageReader<'_>) -> Result<Outline, BakeError> {
    let planned = plan(materials, &Options::default(), read_image, &Silent)?;
    let Plan { settings, tiles, records, .. } = planned.plan;
    let tables = used(&tiles)
        .filter_map(|(kind, tiles)| Some((kind, layout(kind, tiles, &settings)?, shape(kind, &settings)?.format)))
        .collect();
    let keys = used(&tiles).map(|(_, tiles)| tiles.tiles.iter().map(|(_, key)| *key).collect()).collect();
    Ok(Outline { tables, keys, materials: baked_materials(materials, records), searches: planned.searches })
}

/// Bakes all tables of a set of materials. `read_image` fetches thickness maps.
///
/// # Errors
/// See [`BakeError`]. Nothing depends on the number of threads of the current rayon pool but the time it takes.
pub fn bake(materials: &[Material], read_image: ImageReader<'_>, observer: &dyn Observer) -> Result<Bake, BakeError> {
    bake_with(materials, &Options::default(), read_image, observer)
}

/// The same with options.
///
/// # Errors
/// See [`BakeError`].
pub fn bake_with(
    materials: &[Material],
    options: &Options,
    read_image: ImageReader<'_>,
    observer: &dyn Observer,
) -> Result<Bake, BakeError> {
    let Planned { plan, results, searches } = plan(materials, options, read_image, observer)?;
    let Plan { settings, graph, tiles, records } = plan;
    let results = graph.run(observer, results);
    let atlases = used(&tiles).filter_map(|(kind, tiles)| atlas(kind, tiles, &settings, &results)).collect();
    Ok(Bake { atlases, materials: baked_materials(materials, records), searches })
}

/// A plan whose settings are final, results that were needed to find them, and what the search found.
struct Planned {
    plan: Plan,
    results: Results,
    searches: Vec<Search>,
}

/// Often enough for the error of every choice to be confirmed or refuted by the exact measurement.
const ROUNDS: usize = 24;

fn plan(
    materials: &[Material],
    options: &Options,
    read_image: ImageReader<'_>,
    observer: &dyn Observer,
) -> Result<Planned, BakeError> {
    if materials.is_empty() {
        return Err(BakeError::Empty);
    }
    for (i, second) in materials.iter().enumerate() {
        if let Some(first) = materials[..i].iter().find(|m| m.name == second.name) {
            return Err(BakeError::DuplicateName {
                name: second.name.clone(),
                first: first.source.clone(),
                second: second.source.clone(),
            });
        }
    }
    let mut settings = Settings { lean: options.lean, formats: options.formats, ..Settings::of(materials)? };
    if let Some(rows) = options.rows {
        settings.take_rows(rows);
    }
    let fixed = Plan::new(materials, settings.clone(), read_image)?;
    if !options.search {
        return Ok(Planned { plan: fixed, results: Results::default(), searches: Vec::new() });
    }
    let asked = budget(materials, &options.budget)?;
    let is_asked = !asked.is_empty();
    let budget = if is_asked { asked } else { DEFAULT_BUDGET };
    // Costly tables are made once; candidates are compared with them.
    let mut results = Results::default();
    if is_asked {
        results = fixed.graph.only(&search::READ).run(observer, results);
    }
    let mut found = search::candidates(&fixed, &results, &budget, is_asked);
    if !is_asked {
        found.iter_mut().for_each(affordable);
        found.retain(|found| found.comes_near(&budget));
    }
    let searched: Vec<TableKind> = found.iter().map(|f| f.kind).collect();
    let fixed_bytes = used(&fixed.tiles)
        .filter(|(kind, _)| !searched.contains(kind))
        .filter_map(|(kind, tiles)| {
            let [width, height] = layout(kind, tiles, &settings)?.size();
            let texel = shape(kind, &settings)?.format.texel_bytes();
            Some(u64::from(width) * u64::from(height) * u64::from(texel))
        })
        .sum();
    let kinds = [JobKind::Fresnel, JobKind::Distribution, JobKind::Phase, JobKind::Fgd, JobKind::Film];
    let mut plan = fixed;
    let (mut chosen, mut refusal) = (Vec::new(), None);
    for _ in 0..ROUNDS {
        // What a refusal says would do is confirmed too, before it is said.
        refusal = None;
        chosen = if is_asked {
            match search::choose(&found, &budget, fixed_bytes) {
                Ok(chosen) => chosen,
                Err(error) => {
                    let unlimited = Budget { max_bytes: None, max_cost: None, ..budget };
                    let Ok(would) = search::choose(&found, &unlimited, fixed_bytes) else { return Err(error) };
                    refusal = Some(error);
                    would
                }
            }
        } else {
            search::best_effort(&found, &budget)
        };
        let mut settings = settings.clone();
        for (kind, &choice) in found.iter().zip(&chosen) {
            search::apply(&mut settings, kind.kind, &kind.candidates[choice].form);
        }
        plan = Plan::new(materials, settings, read_image)?;
        // The measurement of the bake itself climbs to the worst points; it has the last word.
        let exact = plan.graph.only(if is_asked { &kinds } else { &kinds[..1] });
        results = exact.run(observer, results);
        let mut is_confirmed = true;
        for (kind, &choice) in found.iter_mut().zip(&chosen) {
            let tiles = &plan.tiles[kind.kind as usize].tiles;
            let exact = tiles.iter().filter_map(|(_, key)| results.find(*key)).map(|t| t.error.max_abs_err);
            is_confirmed &= kind.confirm(choice, exact.fold(0.0, f64::max));
        }
        if is_confirmed {
            break;
        }
    }
    if let Some(error) = refusal {
        return Err(error);
    }
    let searches = found.iter().zip(&chosen).map(|(f, &choice)| search::report(f, choice, &budget)).collect();
    Ok(Planned { plan, results, searches })
}

/// Where nobody asks for less, a read costs at most half as much again as one of the fixed default.
fn affordable(found: &mut search::Found) {
    let most = 1.5 * found.fixed_cost;
    found.candidates.retain(|c| c.cost <= most);
}

/// The limits of the materials, the tightest of each; those of the options in their place.
fn budget(materials: &[Material], given: &Budget) -> Result<Budget, BakeError> {
    let of = |material: &Material| {
        let BudgetSettings { max_abs, max_rel, delta_e, max_bytes, max_cost } = material.budget;
        Budget { max_abs, max_rel, delta_e, max_bytes, max_cost }
    };
    let stated = materials.iter().map(of).fold(Budget::default(), |a, b| a.tighter(&b));
    let budget = Budget {
        max_abs: given.max_abs.or(stated.max_abs),
        max_rel: given.max_rel.or(stated.max_rel),
        delta_e: given.delta_e.or(stated.delta_e),
        max_bytes: given.max_bytes.or(stated.max_bytes),
        max_cost: given.max_cost.or(stated.max_cost),
    };
    for (name, value, example) in [
        ("max_abs", budget.max_abs, "1e-3"),
        ("max_rel", budget.max_rel, "1e-2"),
        ("delta_e", budget.delta_e, "0.5"),
        ("max_bytes", budget.max_bytes.map(|bytes| bytes as f64), "65536"),
        ("max_cost", budget.max_cost, "200"),
    ] {
        if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
            return Err(BakeError::BudgetValue { name, value, example });
        }
    }
    Ok(budget)
}

fn used(tiles: &[Tiles; TableKind::ALL.len()]) -> impl Iterator<Item = (TableKind, &Tiles)> {
    TableKind::ALL.into_iter().zip(tiles).filter(|(_, tiles)| !tiles.tiles.is_empty())
}

fn baked_materials(materials: &[Material], records: Vec<PlannedLayers>) -> Vec<BakedMaterial> {
    let baked = |(m, planned): (&Material, PlannedLayers)| BakedMaterial {
        model: shading_model(m),
        color: color_mode(m),
        constants: constants(m, planned.bare),
        records: planned.layers,
        maps: maps(m),
    };
    materials.iter().zip(records).map(baked).collect()
}

/// What one kind of table looks like.
struct Shape<'a> {
    x: &'a Axis,
    y: Option<&'a Axis>,
    format: TexelFormat,
    base: RowBase,
}

/// The shape of a kind; none where its values are computed.
fn shape(kind: TableKind, settings: &Settings) -> Option<Shape<'_>> {
    let ([x, y], format) = match kind {
        TableKind::Fresnel => {
            let RowShape { axis, format, base } = &settings.fresnel;
            return Some(Shape { x: axis, y: None, format: *format, base: *base });
        }
        TableKind::Phase => {
            let (x, format) = settings.phase.as_ref()?;
            return Some(Shape { x, y: None, format: *format, base: RowBase::Zero });
        }
        TableKind::Distribution => settings.distribution.as_ref()?,
        TableKind::Fgd => &settings.fgd,
        TableKind::Thickness => &settings.thickness,
        TableKind::Film => &settings.film,
        TableKind::Escape => &settings.escape,
    };
    Some(Shape { x, y: Some(y), format: *format, base: RowBase::Zero })
}

/// Tiles in one column while they fit, else in as many as it takes.
fn layout(kind: TableKind, tiles: &Tiles, settings: &Settings) -> Option<AtlasLayout> {
    let Shape { x, y, base, .. } = shape(kind, settings)?;
    let apron = u32::from(kind == TableKind::Thickness);
    let count = tiles.tiles.len() as u32;
    let mut layout = AtlasLayout { x: x.clone(), y: y.cloned(), apron, columns: 1, tiles: count, base };
    let [width, height] = layout.tile_size();
    let rows = (MAX_SIDE / height).max(1);
    layout.columns = count.div_ceil(rows).min((MAX_SIDE / width).max(1));
    Some(layout)
}

fn atlas(kind: TableKind, tiles: &Tiles, settings: &Settings, results: &Results) -> Option<Atlas> {
    let layout = layout(kind, tiles, settings)?;
    let format = shape(kind, settings)?.format;
    let channels = tiles.tiles.first().map_or(1, |(_, key)| results.tile(*key).truth.channels);
    let [width, height] = layout.size();
    let mut truth = Image::zeros(width, height, channels);
    let mut texels = Image::zeros(width, height, format.channels());
    let mut bytes = vec![0; (width * height * format.texel_bytes()) as usize];
    let mut entries = Vec::with_capacity(tiles.tiles.len());
    for (index, (name, key)) in tiles.tiles.iter().enumerate() {
        let data = results.tile(*key);
        let origin = layout.origin(index as u32);
        place(&mut truth, origin, &data.truth);
        place(&mut texels, origin, &data.texels);
        place_bytes(&mut bytes, width, format, origin, &data.texels, &data.bytes);
        entries.push(Tile {
            name: name.clone(),
            model: data.model.clone(),
            input_hash: key.to_string(),
            error: data.error.clone(),
        });
    }
    Some(Atlas { kind, layout, format, tiles: entries, truth, texels, bytes })
}

/// Copies the bytes of a tile into those of an atlas of this width, a row of texels or blocks at a time.
fn place_bytes(atlas: &mut [u8], width: u32, format: TexelFormat, [x, y]: [u32; 2], tile: &Image, bytes: &[u8]) {
    let [row, pitch, left] = [tile.width, width, x].map(|texels| format.row_bytes(texels) as usize);
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
