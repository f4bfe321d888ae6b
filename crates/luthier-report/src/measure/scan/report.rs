//! Figures of a scan, as reports have them.

use luthier_lut::{AtlasLayout, COARSE, ErrorStats, TableKind, TexelFormat};
use serde::{Deserialize, Serialize};

use crate::measure::statistics::UNCERTAINTY_MARGIN;

/// One table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TableReport {
    /// Kind of the table.
    pub kind: TableKind,
    /// Texels of the texture.
    pub size: [u32; 2],
    /// Axes, mappings and tiles.
    pub layout: AtlasLayout,
    /// Texel format.
    pub format: TexelFormat,
    /// Bytes of its texels, uncompressed.
    pub texel_bytes: u64,
    /// The file, relative to the manifest.
    pub path: String,
    /// One entry per tile.
    pub tiles: Vec<TileReport>,
}

/// One tile of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TileReport {
    /// Its name.
    pub name: String,
    /// Function that was tabulated.
    pub model: String,
    /// The layers that read it, as `material/layer`.
    pub users: Vec<String>,
    /// Its error as the baker measured it.
    pub baker: ErrorStats,
    /// Its error as measured here from the shipped texels, with 8-bit weights if a sampler filters the format. `None` for tiles that no layer reads, and for
    /// thickness tiles whose maps the subject lacks.
    pub judge: Option<ErrorStats>,
    /// Standard error of the reference at the worst point of `judge`, if the reference is an estimate.
    pub uncertainty: Option<f64>,
    /// The error of sampled reads that the baker aimed at, if nothing else was asked for.
    #[serde(default)]
    pub aim: Option<f64>,
    /// Largest magnitude of the function at the points of `judge`; without one, the largest at the nodes, by the baker.
    #[serde(default)]
    pub largest: Option<f64>,
    /// Reads that were not finite; they are not part of `judge`.
    pub not_finite: u64,
    /// Curves of the tile, for charts.
    pub curves: Curves,
}

impl TileReport {
    /// Whether a layer of a material reads the tile.
    pub(crate) fn is_read_by(&self, material: &str) -> bool {
        self.users.iter().any(|user| user.split('/').next() == Some(material))
    }

    /// Its largest error: the one that was measured here or the one that the baker states, whichever is larger. Both look at points of their own.
    pub fn max_abs_err(&self) -> f64 {
        self.judge.as_ref().map_or(0.0, |judge| judge.max_abs_err).max(self.baker.max_abs_err)
    }

    /// The sampled error of the tile and the aim of the bake, if the error exceeds the aim. The error is the larger of the one that was measured here
    /// and the one that the baker states.
    pub fn miss(&self) -> Option<(f64, f64)> {
        let stated = (self.baker.worst.expected - self.baker.worst.sampled).abs();
        let doubt = UNCERTAINTY_MARGIN * self.uncertainty.unwrap_or(0.0);
        let found = self.judge.as_ref().map_or(0.0, |judge| judge.max_abs_err - doubt).max(stated);
        self.aim.filter(|aim| found > *aim).map(|aim| (found, aim))
    }

    /// The error of the tile and its largest value, if the error is more than [`COARSE`] of that value.
    pub fn coarse(&self) -> Option<(f64, f64)> {
        let error = self.max_abs_err();
        self.largest.filter(|largest| error > COARSE * largest).map(|largest| (error, largest))
    }
}

/// Curves of a tile, in four significant digits: for drawing.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Curves {
    /// No curves.
    #[default]
    None,
    /// A Fresnel row, as read.
    Reflectance(ReflectanceCurve),
    /// The error of a distribution.
    ByAlpha(Vec<AlphaPoint>),
}

/// A Fresnel row over the angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReflectanceCurve {
    /// Degrees from one point to the next; the first is at the normal.
    pub step_deg: f64,
    /// Reflectance, RGB.
    pub rgb: Vec<[f64; 3]>,
}

/// The error of a distribution in a band of alpha.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AlphaPoint {
    /// Middle of the band.
    pub alpha: f64,
    /// Largest error over the angle, as a fraction of the largest value at that alpha.
    pub max_err_of_peak: f64,
}
