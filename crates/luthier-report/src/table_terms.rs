//! The model's terms as a shader reads them: from texels.

use luthier_layers::statistics::diffuse_base::Veil;
use luthier_layers::statistics::energy::Energy;
use luthier_layers::terms::{ShaderTerms, Terms};
use luthier_lut::{TableKind, TexelFormat, WeightBits, read};
use luthier_manifest::{LayerKind, LayerRecord, MaterialEntry, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::microfacet::scaled_distribution;
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
    /// Weights as precise as the arithmetic: software rasterisers.
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
        let entry = self.entry;
        read(entry.kind, &entry.layout, entry.format, self.texels, tile, values, weights.bits(entry.format))
    }
}

/// Quantity of the x axis of a table over an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AngleAxis {
    Theta,
    CosTheta,
}

impl AngleAxis {
    /// The quantity of a Fresnel, distribution or FGD table.
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
    distribution: Option<(Table<'a>, AngleAxis)>,
    phase: Option<Table<'a>>,
    film: Option<Table<'a>>,
    fgd: Option<(Table<'a>, AngleAxis)>,
    escape: Option<Table<'a>>,
    veil: Veil<3>,
    records: &'a [LayerRecord],
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
        let Some(entry) = subject.manifest.materials.get(material) else {
            return Err(ReportError::MaterialCount {
                manifest: subject.manifest.materials.len(),
                stacks: subject.stacks.len(),
            });
        };
        let terms = Self {
            fresnel: with_angle(TableKind::Fresnel)?,
            distribution: with_angle(TableKind::Distribution)?,
            phase: subject.table(TableKind::Phase)?,
            film: subject.table(TableKind::Film)?,
            fgd: with_angle(TableKind::Fgd)?,
            escape: subject.table(TableKind::Escape)?,
            veil: recorded_veil(entry),
            records: &entry.layers,
            weights,
        };
        for (layer, kind) in read_by(entry) {
            let is_computed = matches!(kind, TableKind::Distribution | TableKind::Phase) && terms.table(kind).is_none();
            if !is_computed && terms.tile(kind, layer).is_none() {
                return Err(ReportError::MissingTile { material: entry.name.clone(), layer, kind });
            }
        }
        Ok(terms)
    }

    fn table(&self, kind: TableKind) -> Option<Table<'a>> {
        match kind {
            TableKind::Fresnel => self.fresnel.map(|(table, _)| table),
            TableKind::Distribution => self.distribution.map(|(table, _)| table),
            TableKind::Phase => self.phase,
            TableKind::Film => self.film,
            TableKind::Fgd => self.fgd.map(|(table, _)| table),
            TableKind::Escape => self.escape,
            TableKind::Thickness => None,
        }
    }

    /// The tile that a layer reads, if it is there.
    fn tile(&self, kind: TableKind, layer: usize) -> Option<u32> {
        let record = self.records.get(layer)?;
        let tile = match kind {
            TableKind::Fresnel => record.fresnel_tile,
            TableKind::Distribution => record.distribution_tile,
            TableKind::Phase => record.phase_tile,
            TableKind::Film => record.film_tile,
            TableKind::Fgd => record.fgd_tile,
            TableKind::Escape => record.escape_tile,
            TableKind::Thickness => None,
        };
        let tiles = self.table(kind)?.entry.layout.tiles;
        tile.filter(|tile| *tile < tiles)
    }

    /// Name of the row that a layer reads; empty for a layer that reads none.
    pub(crate) fn fresnel_name(&self, layer: usize) -> &str {
        let kind = if self.tile(TableKind::Film, layer).is_some() { TableKind::Film } else { TableKind::Fresnel };
        self.name(kind, layer)
    }

    /// Name of the tile of a kind that a layer reads; empty when there is none.
    pub(crate) fn name(&self, kind: TableKind, layer: usize) -> &str {
        let tile = self.table(kind).zip(self.tile(kind, layer));
        tile.and_then(|(table, tile)| table.entry.tiles.get(tile as usize)).map_or("", |tile| &tile.name)
    }
}

/// Whether a model follows the statistics of light.
pub(crate) fn is_statistical(model: ShadingModel) -> bool {
    matches!(model, ShadingModel::Belcour | ShadingModel::Yamaguchi)
}

/// The veil of the layers above a diffuse base that shaders of the statistical models are told.
pub(crate) fn recorded_veil(entry: &MaterialEntry) -> Veil<3> {
    let constants = &entry.constants;
    Veil { internal: constants.internal_reflectance, upward: [1.0 - constants.upward_loss; 3] }
}

/// Layers and tables without which the shader of a material cannot be evaluated.
fn read_by(entry: &MaterialEntry) -> Vec<(usize, TableKind)> {
    let count = match entry.model {
        ShadingModel::Phong => 0,
        ShadingModel::Microfacet | ShadingModel::GranierHeidrich => 1,
        ShadingModel::Elek | ShadingModel::WeidlichWilkie | ShadingModel::Belcour | ShadingModel::Yamaguchi => {
            entry.layers.len()
        }
    };
    let mut out = Vec::new();
    for (layer, record) in entry.layers.iter().enumerate().take(count) {
        if record.kind == LayerKind::Diffuse {
            break;
        }
        let has_film = record.film_ior_n[0] > 0.0;
        if entry.model == ShadingModel::GranierHeidrich {
            match record.kind {
                _ if has_film => out.push((layer, TableKind::Phase)),
                LayerKind::Conductor => out.push((layer, TableKind::Fresnel)),
                LayerKind::Dielectric | LayerKind::Diffuse => {}
            }
            continue;
        }
        if is_statistical(entry.model) {
            out.push((layer, TableKind::Fgd));
            // An interface below a denser medium: part of its lobe is totally reflected.
            let next = entry.layers.get(layer + 1).is_some_and(|next| next.kind != LayerKind::Diffuse);
            if next && record.kind == LayerKind::Dielectric && record.eta > 1.0 {
                out.push((layer, TableKind::Escape));
            }
            if record.kind == LayerKind::Conductor {
                break;
            }
            continue;
        }
        out.push((layer, if record.film_tile.is_some() { TableKind::Film } else { TableKind::Fresnel }));
        // A layer without a tile has D computed.
        if record.distribution_tile.is_some() {
            out.push((layer, TableKind::Distribution));
        }
        if record.kind == LayerKind::Conductor {
            break;
        }
    }
    out
}

impl Terms for TableTerms<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        let cos_theta_d = self.records[layer].row_cosine(cos_theta_d);
        let [r, g, b, _] = if let (Some(table), Some(tile)) = (self.film, self.tile(TableKind::Film, layer)) {
            let record = &self.records[layer];
            table.read(tile, [cos_theta_d, record.film_thickness_nm / record.film_thickness_max_nm], self.weights)
        } else if let (Some((table, angle)), Some(tile)) = (self.fresnel, self.tile(TableKind::Fresnel, layer)) {
            table.read(tile, [angle.value_at(cos_theta_d), 0.0], self.weights)
        } else {
            [f64::NAN; 4]
        };
        [r, g, b]
    }

    /// Read where the layer has a tile; else the closed form.
    fn distribution(&self, layer: usize, form: Distribution, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        match (self.distribution, self.tile(TableKind::Distribution, layer)) {
            (Some((table, angle)), Some(tile)) => {
                table.read(tile, [angle.value(cos_theta_h, sin_theta_h_sq), alpha], self.weights)[0]
            }
            _ => scaled_distribution(form, alpha, cos_theta_h, sin_theta_h_sq),
        }
    }

    /// The swing from the row over s, the sum of the cosines times d / (2 d_max) (Granier and Heidrich 2003, eq. 19).
    fn interference(&self, layer: usize, channel: usize, cosines: f64) -> Option<f64> {
        let (table, tile) = (self.phase?, self.tile(TableKind::Phase, layer)?);
        let record = &self.records[layer];
        let s = 0.5 * cosines * record.film_thickness_nm / record.film_thickness_max_nm;
        Some(table.read(tile, [s, 0.0], self.weights)[channel])
    }
}

impl Energy<3> for TableTerms<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> Rgb {
        match (self.fgd, self.tile(TableKind::Fgd, layer)) {
            (Some((table, angle)), Some(tile)) => {
                let [r, g, b, _] = table.read(tile, [angle.value_at(cos_theta_i), alpha], self.weights);
                [r, g, b]
            }
            _ => [f64::NAN; 3],
        }
    }

    /// The table is over the cosine outside, of the direction that is refracted to `cos_theta_i`.
    fn escaping(&self, layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        match (self.escape, self.tile(TableKind::Escape, layer)) {
            (Some(table), Some(tile)) => {
                let sin_sq = (1.0 - cos_theta_i) * (1.0 + cos_theta_i) / (eta * eta);
                table.read(tile, [(1.0 - sin_sq).max(0.0).sqrt(), alpha], self.weights)[0]
            }
            _ => f64::NAN,
        }
    }
}

impl ShaderTerms for TableTerms<'_> {
    fn veil(&self) -> Veil<3> {
        self.veil
    }
}
