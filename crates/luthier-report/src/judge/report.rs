//! Data of a judgement.

use luthier_lut::TableKind;
use luthier_manifest::{ColorMode, Search, ShadingModel};
use serde::{Deserialize, Serialize};

use crate::error::ReportError;
use crate::judge::evidence::{Costs, PictureErrors, ReferencePaths, ShaderVerdict, ShapeCost, StabilitySummary, Times};
use crate::judge::exceptions::Exception;
use crate::judge::limits::Limit;
use crate::judge::profile::{AngleProfile, Exceedance};
use crate::measure::directions::DirectionSet;
use crate::measure::scan::report::TableReport;
use crate::measure::seen::{Seen, SeenLight};
use crate::measure::statistics::Statistics;
use crate::measure::table_terms::Weights;
use crate::models::AgainstReference;
use crate::places::AtPlaces;
use crate::stability::Shipped;
use crate::text::json;

/// Version of the report's shape.
pub const REPORT_SCHEMA: u32 = 3;

/// The judgement of a bake: `report.json`, whose shape is `docs/report.schema.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`REPORT_SCHEMA`].
    pub schema: u32,
    /// Program and version that baked.
    pub generator: String,
    /// The reflectance model of shaders and reference.
    pub model: String,
    /// Facts about the run, in the caller's order.
    pub provenance: Vec<(String, String)>,
    /// The adapter; absent when no shader was run.
    pub device: Option<String>,
    /// The interpolation weights that explain the device's values best; absent when no shader was run.
    pub device_weights: Option<Weights>,
    /// The limit on [`Report::max_error`], if one was set.
    pub budget: Option<f64>,
    /// Pairs of directions in every set.
    pub pairs_per_set: u32,
    /// The floor of the relative errors: [`crate::FLOOR`].
    pub floor: f64,
    /// Doubts, in words: values that are not finite, figures of the baker that the judge does not confirm.
    pub findings: Vec<String>,
    /// The target that exceptions miss: [`crate::TARGET_MAX_REL_ERR`].
    pub target_max_rel_err: f64,
    /// Every material and shader that misses the target somewhere, in the order of the materials. Without a device, every material whose tables miss
    /// it, read with 8-bit weights. Samples that are not finite are findings instead.
    pub exceptions: Vec<Exception>,
    /// Limits other than [`Report::budget`], with the values that they were compared with.
    pub limits: Vec<Limit>,
    /// Searches of the baker for sizes, mappings and formats of tables, with its own figures.
    pub searches: Vec<Search>,
    /// Costs of shaders, if they were given.
    pub costs: Option<Costs>,
    /// Paths of the reference that models were compared with, if any.
    pub reference: Option<ReferencePaths>,
    /// A run of the stability suite, if one was given.
    pub stability: Option<StabilitySummary>,
    /// Measured times of the shaders, if they were asked for.
    #[serde(default)]
    pub times: Option<Times>,
    /// The shaders, with the judges that they passed when they were emitted.
    #[serde(default)]
    pub shaders: Vec<ShaderVerdict>,
    /// The tables, in binding order.
    pub tables: Vec<TableReport>,
    /// The materials, in the order of the manifest.
    pub materials: Vec<MaterialReport>,
}

/// One material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialReport {
    /// Its name.
    pub name: String,
    /// Path of the material file.
    pub source: String,
    /// SHA-256, hex, of the material file and of the files that it names.
    pub source_hash: String,
    /// Surface class a-h.
    pub class: String,
    /// The reflectance model that its shaders evaluate.
    pub model: ShadingModel,
    /// Colour mode of its tables, which decides the reference of the baked shader.
    pub color: ColorMode,
    /// The layers from the top down, in words.
    pub layers: Vec<String>,
    /// Comparisons, each over all sets of directions.
    pub comparisons: Vec<Comparison>,
    /// The models of shaders against the reference of whole stacks; empty unless asked for.
    pub against_reference: Vec<AgainstReference>,
    /// Shader, tables and lobes at random places of its maps; `None` for a material that is the same everywhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_places: Option<AtPlaces>,
    /// Tables and shaders of it where methods fail: values at grazing, mirrored, equal and opposite directions, and albedos; `None` in earlier reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<Shipped>,
    /// Searches for this material alone, by the baker's figures.
    pub alone: Vec<Search>,
    /// Differences between its pictures.
    pub picture: Option<PictureErrors>,
    /// The cost of its shader, by the kinds of its layers; `None` if the caller does not know it.
    pub shape_cost: Option<ShapeCost>,
    /// Reason for the choice of its model: the words of the manifest of a scene.
    pub choice: Option<serde_json::Value>,
}

/// Two sides of a comparison; always `f cos_theta_i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compared {
    /// The table-reading shader on the device, against exact terms in f64.
    BakedDevice,
    /// The tables alone: f64 arithmetic, 8-bit weights, against exact terms.
    TablesEightBit,
    /// The tables alone: f64 arithmetic, exact weights, against exact terms.
    TablesExact,
    /// f32 arithmetic alone: the table-reading shader on the device, against f64 arithmetic on the same tables.
    Arithmetic,
    /// The table-free shader on the device, against exact terms at its three wavelengths in f64.
    FullDevice,
    /// Three wavelengths against the spectrum, both in f64: no error but a difference of models.
    ThreeWavelengths,
}

impl Compared {
    /// Short name, for tables and legends.
    pub fn name(self) -> &'static str {
        match self {
            Self::BakedDevice => "baked shader",
            Self::TablesEightBit => "tables, 8-bit weights",
            Self::TablesExact => "tables, exact weights",
            Self::Arithmetic => "f32 arithmetic",
            Self::FullDevice => "full shader",
            Self::ThreeWavelengths => "three wavelengths",
        }
    }

    /// Whether [`Report::max_error`] covers this comparison, in a run with or without a device.
    pub(crate) fn is_judged(self, with_device: bool) -> bool {
        match self {
            Self::BakedDevice | Self::FullDevice => with_device,
            Self::TablesEightBit => !with_device,
            Self::TablesExact | Self::Arithmetic | Self::ThreeWavelengths => false,
        }
    }
}

/// A comparison over all sets of directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Two sides of the comparison.
    pub compared: Compared,
    /// Statistics per set, in the order of [`DirectionSet::ALL`].
    pub sets: Vec<(DirectionSet, Statistics)>,
    /// Largest error by angle, over all sets.
    pub by_angle: AngleProfile,
    /// Counts of errors above thresholds, over all sets.
    pub exceedance: Exceedance,
    /// Colour differences over all sets, one entry for each light.
    pub seen: Vec<Seen>,
}

impl Comparison {
    /// The largest relative error of all sets; infinite when a sample is not finite.
    pub fn max_error(&self) -> f64 {
        self.sets.iter().map(|(_, s)| s.max_error()).fold(0.0, f64::max)
    }
}

impl MaterialReport {
    /// The comparison of a kind, if it was made.
    pub fn comparison(&self, compared: Compared) -> Option<&Comparison> {
        self.comparisons.iter().find(|c| c.compared == compared)
    }
}

/// Place of the largest error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstCase<'a> {
    /// Name of the material.
    pub material: &'a str,
    /// Two sides of the comparison.
    pub compared: Compared,
    /// Set of directions.
    pub set: DirectionSet,
    /// The statistics of that set; the pair is its `worst`, or `not_finite_at` when that is given.
    pub statistics: &'a Statistics,
    /// The error, which [`Report::max_error`] returns.
    pub error: f64,
}

impl Report {
    /// The largest error of `f cos_theta_i` over all channels, sets and materials, relative to max(brightest channel of the reference,
    /// [`crate::FLOOR`]). A limit is compared with this figure.
    ///
    /// It covers both shaders on the device against their f64 references, or, without a device, the tables read with 8-bit weights; and errors at
    /// places. It is infinite if one of these samples, a read of the table scans, or a value at the directions of [`Shipped`] is not finite.
    pub fn max_error(&self) -> f64 {
        let reads = self.tables.iter().flat_map(|t| &t.tiles).any(|t| t.not_finite > 0);
        let stressed = self.materials.iter().filter_map(|m| m.stability.as_ref()).any(|s| s.not_finite() > 0);
        let at_places = self.worst_place().map_or(0.0, |(_, at)| at.max_error());
        if reads || stressed { f64::INFINITY } else { self.worst().map_or(0.0, |w| w.error).max(at_places) }
    }

    /// The material with the largest error of shader or tables at places.
    pub fn worst_place(&self) -> Option<(&str, &AtPlaces)> {
        let at_places = self.materials.iter().filter_map(|m| Some((m.name.as_str(), m.at_places.as_ref()?)));
        at_places.max_by(|a, b| a.1.max_error().total_cmp(&b.1.max_error()))
    }

    /// The comparisons of a material that [`Report::max_error`] covers.
    pub(crate) fn judged<'a>(&'a self, material: &'a MaterialReport) -> impl Iterator<Item = &'a Comparison> + Clone {
        material.comparisons.iter().filter(move |comparison| comparison.compared.is_judged(self.device.is_some()))
    }

    /// Place of the largest error of the shaders, or, without a device, of the tables; `None` without materials.
    pub fn worst(&self) -> Option<WorstCase<'_>> {
        let mut worst: Option<WorstCase<'_>> = None;
        for material in &self.materials {
            for comparison in self.judged(material) {
                for (set, statistics) in &comparison.sets {
                    let error = statistics.max_error();
                    if worst.is_none_or(|w| error > w.error) {
                        let (material, compared) = (material.name.as_str(), comparison.compared);
                        worst = Some(WorstCase { material, compared, set: *set, statistics, error });
                    }
                }
            }
        }
        worst
    }

    /// The largest error of f32 arithmetic, measured like [`Report::max_error`]: that of the table-reading shader against f64 on the same tables, or
    /// that of the table-free shader against its reference. `None` without a device.
    pub fn max_arithmetic_error(&self) -> Option<f64> {
        self.device.as_ref()?;
        let compared = [Compared::Arithmetic, Compared::FullDevice];
        let comparisons = self.materials.iter().flat_map(|m| compared.map(|compared| m.comparison(compared)));
        Some(comparisons.flatten().map(Comparison::max_error).fold(0.0, f64::max))
    }

    /// Whether [`Report::max_error`] is within the budget and every limit is held; `None` without a budget and limits.
    pub fn is_within_budget(&self) -> Option<bool> {
        let budget = self.budget.map(|budget| self.max_error() <= budget);
        let limits = self.limits.iter().map(|limit| limit.is_held);
        budget.into_iter().chain(limits).reduce(|a, b| a && b)
    }

    /// The largest error of tables against their functions, measured here or stated by the baker, with the kind of table and the name of the tile.
    pub fn worst_table(&self) -> Option<(f64, TableKind, &str)> {
        let tiles = self.tables.iter().flat_map(|t| t.tiles.iter().map(move |tile| (t.kind, tile)));
        let errors = tiles.map(|(kind, tile)| (tile.max_abs_err(), kind, tile.name.as_str()));
        errors.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The largest colour difference under a light of the comparisons that [`Report::max_error`] covers, with the name of the material.
    pub fn worst_seen(&self, light: SeenLight) -> Option<(f64, &str)> {
        let all = self.materials.iter().map(|m| {
            let seen = self.judged(m).flat_map(|c| &c.seen).filter(|s| s.light == light);
            (seen.map(|s| s.max).fold(0.0, f64::max), m.name.as_str())
        });
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The comparison with the largest lobe error of a model that ships against the reference, with the name of the material.
    pub fn worst_model(&self) -> Option<(&str, &AgainstReference)> {
        let all = self.materials.iter().filter_map(|m| {
            let shipped = m.against_reference.iter().find(|a| a.model == m.model)?;
            Some((m.name.as_str(), shipped))
        });
        all.max_by(|a, b| a.1.lobe_err.total_cmp(&b.1.lobe_err))
    }

    /// JSON, with objects indented, arrays in a line, and a final newline. It has three members beside the fields: `max_error` and
    /// `max_arithmetic_error` (null if not finite), and `within_budget`.
    ///
    /// # Errors
    /// [`ReportError::Json`], should the writer fail.
    pub fn to_json(&self) -> Result<String, ReportError> {
        #[derive(Serialize)]
        struct WithFigures<'a> {
            max_error: Option<f64>,
            max_arithmetic_error: Option<f64>,
            within_budget: Option<bool>,
            #[serde(flatten)]
            report: &'a Report,
        }
        json::to_string(&WithFigures {
            max_error: Some(self.max_error()).filter(|e| e.is_finite()),
            max_arithmetic_error: self.max_arithmetic_error().filter(|e| e.is_finite()),
            within_budget: self.is_within_budget(),
            report: self,
        })
    }

    /// Reads what [`Report::to_json`] wrote.
    ///
    /// # Errors
    /// [`ReportError::Json`] for other JSON.
    pub fn from_json(json: &str) -> Result<Self, ReportError> {
        Ok(serde_json::from_str(json)?)
    }
}
