//! From tiles to atlases.

use luthier_lut::{
    Atlas, AtlasLayout, Axis, ColorMode, Image, LayerRecord, MaterialConstants, ShadingModel, TableKind, TexelFormat,
    Tile,
};
use luthier_material::Material;

use crate::BakeError;
use crate::constants::constants;
use crate::graph::{Observer, Results};
use crate::job::Key;
use crate::maps::{MaterialMap, maps};
use crate::plan::{ImageReader, Plan, PlannedLayers, Tiles, color_mode, shading_model};
use crate::settings::Settings;

/// What a set of materials needs at run time.
#[derive(Debug, Clone, PartialEq)]
pub struct Bake {
    /// At most one atlas of each kind, in binding order.
    pub atlases: Vec<Atlas>,
    /// Each material, in the order given.
    pub materials: Vec<BakedMaterial>,
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
}

/// Longest side that textures are laid out for while tiles fit: any device of the last decade has it.
const MAX_SIDE: u32 = 2048;

/// What a bake of these materials would consist of, without computing it: each material with the tiles that serve it, and the
/// layout and texel format of each table, in binding order.
///
/// # Errors
/// See [`BakeError`].
pub fn outline(materials: &[Material], read_image: ImageReader<'_>) -> Result<Outline, BakeError> {
    let Plan { settings, tiles, records, .. } = plan(materials, read_image)?;
    let tables =
        used(&tiles).map(|(kind, tiles)| (kind, layout(kind, tiles, &settings), format(kind, &settings))).collect();
    let keys = used(&tiles).map(|(_, tiles)| tiles.tiles.iter().map(|(_, key)| *key).collect()).collect();
    Ok(Outline { tables, keys, materials: baked_materials(materials, records) })
}

/// Bakes all tables of a set of materials. `read_image` fetches thickness maps.
///
/// # Errors
/// See [`BakeError`]. Nothing depends on the number of threads of the current rayon pool but the time it takes.
pub fn bake(materials: &[Material], read_image: ImageReader<'_>, observer: &dyn Observer) -> Result<Bake, BakeError> {
    let Plan { settings, graph, tiles, records } = plan(materials, read_image)?;
    let results = graph.run(observer);
    let atlases = used(&tiles).map(|(kind, tiles)| atlas(kind, tiles, &settings, &results)).collect();
    Ok(Bake { atlases, materials: baked_materials(materials, records) })
}

fn plan(materials: &[Material], read_image: ImageReader<'_>) -> Result<Plan, BakeError> {
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
    Plan::new(materials, read_image)
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

fn axes(kind: TableKind, settings: &Settings) -> (&Axis, Option<&Axis>) {
    match kind {
        TableKind::Fresnel => (&settings.fresnel.0, None),
        TableKind::Distribution => (&settings.distribution.0[0], Some(&settings.distribution.0[1])),
        TableKind::Fgd => (&settings.fgd.0[0], Some(&settings.fgd.0[1])),
        TableKind::Phase => (&settings.phase.0, None),
        TableKind::Thickness => (&settings.thickness.0[0], Some(&settings.thickness.0[1])),
        TableKind::Film => (&settings.film.0[0], Some(&settings.film.0[1])),
        TableKind::Escape => (&settings.escape.0[0], Some(&settings.escape.0[1])),
    }
}

fn format(kind: TableKind, settings: &Settings) -> TexelFormat {
    match kind {
        TableKind::Fresnel => settings.fresnel.1,
        TableKind::Distribution => settings.distribution.1,
        TableKind::Fgd => settings.fgd.1,
        TableKind::Phase => settings.phase.1,
        TableKind::Thickness => settings.thickness.1,
        TableKind::Film => settings.film.1,
        TableKind::Escape => settings.escape.1,
    }
}

/// Tiles in one column while they fit, else in as many as it takes.
fn layout(kind: TableKind, tiles: &Tiles, settings: &Settings) -> AtlasLayout {
    let (x, y) = axes(kind, settings);
    let apron = u32::from(kind == TableKind::Thickness);
    let count = tiles.tiles.len() as u32;
    let mut layout = AtlasLayout { x: x.clone(), y: y.cloned(), apron, columns: 1, tiles: count };
    let [width, height] = layout.tile_size();
    let rows = (MAX_SIDE / height).max(1);
    layout.columns = count.div_ceil(rows).min((MAX_SIDE / width).max(1));
    layout
}

fn atlas(kind: TableKind, tiles: &Tiles, settings: &Settings, results: &Results) -> Atlas {
    let layout = layout(kind, tiles, settings);
    let format = format(kind, settings);
    let channels = tiles.tiles.first().map_or(1, |(_, key)| results.tile(*key).truth.channels);
    let [width, height] = layout.size();
    let mut truth = Image::zeros(width, height, channels);
    let mut texels = Image::zeros(width, height, format.channels());
    let mut entries = Vec::with_capacity(tiles.tiles.len());
    for (index, (name, key)) in tiles.tiles.iter().enumerate() {
        let data = results.tile(*key);
        let origin = layout.origin(index as u32);
        place(&mut truth, origin, &data.truth);
        place(&mut texels, origin, &data.texels);
        entries.push(Tile {
            name: name.clone(),
            model: data.model.clone(),
            input_hash: key.to_string(),
            error: data.error.clone(),
        });
    }
    Atlas { kind, layout, format, tiles: entries, truth, texels }
}

/// Copies a tile into an atlas.
fn place(atlas: &mut Image, [ox, oy]: [u32; 2], tile: &Image) {
    for j in 0..tile.height {
        for i in 0..tile.width {
            atlas.texel_mut(ox + i, oy + j).copy_from_slice(tile.texel(i, j));
        }
    }
}
