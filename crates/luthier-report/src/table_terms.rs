//! The model's terms as a shader reads them: from texels.

use luthier_layers::elek::Terms;
use luthier_lut::{Encoding, LayerKind, TableKind, TexelFormat, WeightBits, bilinear};
use luthier_optics::Rgb;
use luthier_optics::stack::Distribution;
use serde::{Deserialize, Serialize};

use crate::subject::Table;
use crate::{ReportError, Subject};

/// How precisely a filtering sampler weighs texels. Formats that core WebGPU does not filter are read with four fetches
/// and weighed in the shader, exactly, under either.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// 8 fractional bits: most hardware.
    EightBit,
    /// As precise as the arithmetic: software rasterisers.
    Exact,
}

impl Weights {
    fn bits(self, format: TexelFormat) -> WeightBits {
        match self {
            Self::EightBit if format.is_filterable() => WeightBits::Fixed(8),
            Self::EightBit | Self::Exact => WeightBits::Exact,
        }
    }
}

impl Table<'_> {
    /// A sampled read of a tile.
    pub(crate) fn read(&self, tile: u32, values: [f64; 2], weights: Weights) -> [f64; 4] {
        let position = self.entry.layout.position(tile, values);
        let texel = bilinear(self.texels, position, weights.bits(self.entry.format));
        Encoding::of(self.entry.kind, self.entry.format).decode(texel)
    }
}

/// What the x axis of a table over an angle is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AngleAxis {
    Theta,
    CosTheta,
}

impl AngleAxis {
    /// Of a Fresnel, distribution or FGD table.
    ///
    /// # Errors
    /// [`ReportError::Layout`] when the axes are not those of such a table.
    pub(crate) fn of(table: &Table<'_>) -> Result<Self, ReportError> {
        let kind = table.entry.kind;
        let refuse = |reason| Err(ReportError::Layout { kind, reason });
        if kind != TableKind::Fresnel && table.entry.layout.y.is_none() {
            return refuse("it has no alpha axis");
        }
        match table.entry.layout.x.quantity.as_str() {
            "theta" | "theta_h" => Ok(Self::Theta),
            "cos_theta" | "cos_theta_h" => Ok(Self::CosTheta),
            _ => refuse("its x axis is neither an angle nor a cosine"),
        }
    }

    /// The axis value of an angle, from its cosine and squared sine.
    fn value(self, cos_theta: f64, sin_theta_sq: f64) -> f64 {
        match self {
            Self::Theta => libm::atan2(sin_theta_sq.max(0.0).sqrt(), cos_theta),
            Self::CosTheta => cos_theta,
        }
    }

    /// The axis value of a cosine.
    pub(crate) fn value_at(self, cos_theta: f64) -> f64 {
        self.value(cos_theta, (1.0 - cos_theta) * (1.0 + cos_theta))
    }

    /// Cosine and squared sine of an axis value.
    pub(crate) fn cos_and_sin_sq(self, value: f64) -> (f64, f64) {
        match self {
            Self::Theta => {
                let sin = libm::sin(value);
                (libm::cos(value), sin * sin)
            }
            Self::CosTheta => (value, (1.0 - value * value).max(0.0)),
        }
    }
}

/// Terms of one material, read from the shipped tables with f64 arithmetic.
#[derive(Debug)]
pub struct TableTerms<'a> {
    fresnel: Option<(Table<'a>, AngleAxis)>,
    fresnel_tiles: Vec<u32>,
    distribution: Option<(Table<'a>, AngleAxis)>,
    distribution_tiles: Vec<(Distribution, u32)>,
    weights: Weights,
}

impl<'a> TableTerms<'a> {
    /// The terms of a material, by number.
    ///
    /// # Errors
    /// A table that does not fit its layout, or a layer that needs a tile and has none.
    pub fn new(subject: &'a Subject<'_>, material: usize, weights: Weights) -> Result<Self, ReportError> {
        let with_angle = |kind| match subject.table(kind)? {
            Some(table) => Ok(Some((table, AngleAxis::of(&table)?))),
            None => Ok::<_, ReportError>(None),
        };
        let fresnel = with_angle(TableKind::Fresnel)?;
        let distribution = with_angle(TableKind::Distribution)?;
        let mut terms =
            Self { fresnel, fresnel_tiles: Vec::new(), distribution, distribution_tiles: Vec::new(), weights };
        let Some(entry) = subject.manifest.materials.get(material) else {
            return Err(ReportError::MaterialCount {
                manifest: subject.manifest.materials.len(),
                stacks: subject.stacks.len(),
            });
        };
        for (layer, record) in entry.layers.iter().enumerate() {
            if record.kind == LayerKind::Diffuse {
                break;
            }
            let tile = |kind, table: Option<&Table<'_>>, tile: Option<u32>| {
                let exists = |t: &u32| table.is_some_and(|table| *t < table.entry.layout.tiles);
                tile.filter(exists).ok_or(ReportError::MissingTile { material: entry.name.clone(), layer, kind })
            };
            let table = terms.fresnel.as_ref().map(|(table, _)| table);
            terms.fresnel_tiles.push(tile(TableKind::Fresnel, table, record.fresnel_tile)?);
            let table = terms.distribution.as_ref().map(|(table, _)| table);
            let distribution_tile = tile(TableKind::Distribution, table, record.distribution_tile)?;
            let distribution = if record.distribution == Distribution::Ggx.name() {
                Distribution::Ggx
            } else {
                Distribution::Beckmann
            };
            terms.distribution_tiles.push((distribution, distribution_tile));
            if record.kind == LayerKind::Conductor {
                break;
            }
        }
        Ok(terms)
    }

    /// Name of the row that a layer reads; empty for a layer that reads none.
    pub(crate) fn fresnel_name(&self, layer: usize) -> &str {
        tile_name(self.fresnel.as_ref().map(|(table, _)| table), self.fresnel_tiles.get(layer).copied())
    }

    /// Name of the tile of a distribution; empty when there is none.
    pub(crate) fn distribution_name(&self, distribution: Distribution) -> &str {
        let tile = self.distribution_tiles.iter().find(|(d, _)| *d == distribution).map(|(_, tile)| *tile);
        tile_name(self.distribution.as_ref().map(|(table, _)| table), tile)
    }
}

fn tile_name<'a>(table: Option<&Table<'a>>, tile: Option<u32>) -> &'a str {
    table.zip(tile).and_then(|(table, tile)| table.entry.tiles.get(tile as usize)).map_or("", |tile| &tile.name)
}

impl Terms for TableTerms<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        let (Some((table, angle)), Some(&tile)) = (&self.fresnel, self.fresnel_tiles.get(layer)) else {
            return [f64::NAN; 3];
        };
        let [r, g, b, _] = table.read(tile, [angle.value_at(cos_theta_d), 0.0], self.weights);
        [r, g, b]
    }

    fn distribution(&self, distribution: Distribution, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        let tile = self.distribution_tiles.iter().find(|(d, _)| *d == distribution);
        let (Some((table, angle)), Some(&(_, tile))) = (&self.distribution, tile) else { return f64::NAN };
        table.read(tile, [angle.value(cos_theta_h, sin_theta_h_sq), alpha], self.weights)[0]
    }
}
