//! The subject of a judgement: manifest, decoded tables, stacks.

use luthier_layers::layers::{Below, Layer, Layers};
use luthier_lut::{Image, Picture, TableKind};
use luthier_manifest::{ColorMode, LayerKind, LayerRecord, Manifest, MapSlot, MaterialEntry, TableEntry};
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use crate::error::ReportError;

/// Subject of a judgement: a bake as it ships, and the surfaces that it was made from.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    /// The manifest of the bake.
    pub manifest: &'a Manifest,
    /// The texels of every table as a shader reads them: decoded from the shipped textures.
    pub textures: Vec<(TableKind, Image)>,
    /// The surfaces that the materials describe, parallel to the materials of the manifest.
    pub stacks: Vec<Stack>,
    /// The maps of the materials. Materials with maps are judged at places.
    pub maps: Vec<SurfaceMap>,
    /// Maps of films that vary, as the material files describe them. Thickness tiles of other films are held to their range alone.
    pub films: Vec<FilmMap>,
}

/// Map of a film that varies in thickness.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmMap {
    /// Number of the material.
    pub material: u32,
    /// Number of the layer.
    pub layer: u32,
    /// Source of the map.
    pub source: FilmSource,
    /// Width of one repeat on the surface.
    pub extent_um: f64,
}

/// Source of a film's map: 0 is the thinnest, 1 the thickest.
#[derive(Debug, Clone, PartialEq)]
pub enum FilmSource {
    /// Fractal Perlin noise on a torus, stretched to 0..1 over the nodes of the tile.
    Noise {
        /// Seed of the noise.
        seed: u32,
        /// Cells of the first octave in a repeat.
        frequency: f64,
        /// Octaves.
        octaves: u32,
    },
    /// A picture of one channel that repeats.
    Image(Image),
}

/// A map of a material as it ships.
#[derive(Debug, Clone)]
pub struct SurfaceMap {
    /// Number of the material.
    pub material: u32,
    /// Quantity that the map varies.
    pub slot: MapSlot,
    /// The layer that the map varies; `None` for a map of the whole surface.
    pub layer: Option<u32>,
    /// Its texels.
    pub picture: Picture,
}

/// The colour that the tables of a material hold.
pub(crate) fn color(material: &MaterialEntry) -> Color {
    match material.color {
        ColorMode::Spectral => Color::Spectral,
        ColorMode::ThreeWavelengths => Color::ThreeWavelengths(material.wavelengths_nm),
    }
}

/// A table whose texels fit its layout.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Table<'a> {
    pub(crate) entry: &'a TableEntry,
    pub(crate) texels: &'a Image,
}

impl Subject<'_> {
    /// The table of a kind, if the bake has one, checked so that every read of one of its tiles is in bounds.
    ///
    /// # Errors
    /// [`ReportError::MissingTexture`], [`ReportError::Layout`], [`ReportError::TextureSize`].
    pub(crate) fn table(&self, kind: TableKind) -> Result<Option<Table<'_>>, ReportError> {
        let Some(entry) = self.manifest.table(kind) else { return Ok(None) };
        let (_, texels) = self.textures.iter().find(|(k, _)| *k == kind).ok_or(ReportError::MissingTexture(kind))?;
        let [width, height] = checked_size(entry).map_err(|reason| ReportError::Layout { kind, reason })?;
        let values = u128::from(width) * u128::from(height) * u128::from(texels.channels);
        let fits = [texels.width, texels.height] == [width, height];
        if !fits || texels.channels == 0 || texels.channels > 4 || values != texels.data.len() as u128 {
            let (found_width, found_height) = (texels.width, texels.height);
            return Err(ReportError::TextureSize { kind, width, height, found_width, found_height });
        }
        Ok(Some(Table { entry, texels }))
    }

    /// Checks that stacks and records describe the same layers.
    ///
    /// # Errors
    /// [`ReportError::MaterialCount`], [`ReportError::Layers`].
    pub(crate) fn check(&self) -> Result<(), ReportError> {
        let (manifest, stacks) = (self.manifest.materials.len(), self.stacks.len());
        if manifest != stacks {
            return Err(ReportError::MaterialCount { manifest, stacks });
        }
        for (material, stack) in self.manifest.materials.iter().zip(&self.stacks) {
            let layers = Layers::isotropic_rgb(stack).layers;
            let differs = if layers.len() == material.layers.len() {
                layers.iter().zip(&material.layers).position(|(layer, record)| !same_kind(layer, record))
            } else {
                Some(layers.len().min(material.layers.len()))
            };
            if let Some(layer) = differs {
                return Err(ReportError::Layers { material: material.name.clone(), layer });
            }
        }
        Ok(())
    }
}

/// The texels across and down that a layout needs, or its fault.
fn checked_size(TableEntry { layout, tiles, .. }: &TableEntry) -> Result<[u32; 2], &'static str> {
    if layout.tiles == 0 || layout.columns == 0 {
        return Err("no tiles");
    }
    if tiles.len() != layout.tiles as usize {
        return Err("its tiles are not those that the manifest describes");
    }
    for axis in [Some(&layout.x), layout.y.as_ref()].into_iter().flatten() {
        if axis.size < 2 {
            return Err("an axis has fewer than two nodes");
        }
        let ordered = axis.min < axis.max;
        if !ordered || !axis.min.is_finite() || !axis.max.is_finite() {
            return Err("an axis has no extent");
        }
    }
    layout.checked_size().ok_or("it is larger than any texture")
}

fn same_kind(layer: &Layer, record: &LayerRecord) -> bool {
    let named = record.distribution == layer.surface.distribution;
    match layer.below {
        Below::Dielectric { .. } => record.kind == LayerKind::Dielectric && named,
        Below::Conductor => record.kind == LayerKind::Conductor && named,
        Below::Diffuse { .. } => record.kind == LayerKind::Diffuse,
    }
}
