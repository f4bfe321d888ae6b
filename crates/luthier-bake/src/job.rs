//! Jobs: what there is to compute, as values.

use std::fmt;

use luthier_lut::{Atlas, AtlasLayout, Axis, ErrorStats, Image, RowBase, TableKind, TexelFormat, Tile};
use luthier_optics::color::Color;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::balance;
use crate::distribution::DistributionJob;
use crate::escape::EscapeJob;
use crate::facet_grid::{CrossedGrid, CrossedJob, FacetGrid, FacetGridJob};
use crate::fgd::{FgdJob, FgdTruth, FgdTruthJob};
use crate::film::FilmJob;
use crate::fresnel::FresnelJob;
use crate::graph::Inputs;
use crate::phase::PhaseJob;
use crate::thickness::ThicknessJob;

/// Changes whenever the same inputs give other bytes than before; part of every key.
const REVISION: u32 = 5;

/// SHA-256 of a job's inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key([u8; 32]);

impl Key {
    fn of(kind: JobKind, inputs: &Value) -> Self {
        let text = json!({"kind": kind.name(), "revision": REVISION, "inputs": inputs}).to_string();
        Self(Sha256::digest(text.as_bytes()).into())
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// The kinds of jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum JobKind {
    /// One Fresnel row.
    Fresnel,
    /// One tile of D.
    Distribution,
    /// How light meets the facets of a slope distribution, for all directions and alphas of a table.
    FacetGrid,
    /// Light that crosses a dielectric and comes back.
    Crossed,
    /// The values of one FGD tile, before they become texels.
    FgdTruth,
    /// One FGD tile.
    Fgd,
    /// One phase row.
    Phase,
    /// One thickness texture.
    Thickness,
    /// One film tile.
    Film,
    /// One escape tile.
    Escape,
}

impl JobKind {
    /// The name in keys and progress reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fresnel => "fresnel",
            Self::Distribution => "distribution",
            Self::FacetGrid => "facet-grid",
            Self::Crossed => "crossed",
            Self::FgdTruth => "fgd-truth",
            Self::Fgd => "fgd",
            Self::Phase => "phase",
            Self::Thickness => "thickness",
            Self::Film => "film",
            Self::Escape => "escape",
        }
    }
}

/// A computation, with everything that decides the result.
#[derive(Debug, Clone)]
pub(crate) enum Job {
    Fresnel(FresnelJob),
    Distribution(DistributionJob),
    FacetGrid(FacetGridJob),
    Crossed(CrossedJob),
    FgdTruth(FgdTruthJob),
    Fgd(FgdJob),
    Phase(PhaseJob),
    Thickness(ThicknessJob),
    Film(FilmJob),
    Escape(EscapeJob),
}

impl Job {
    pub(crate) fn kind(&self) -> JobKind {
        match self {
            Self::Fresnel(_) => JobKind::Fresnel,
            Self::Distribution(_) => JobKind::Distribution,
            Self::FacetGrid(_) => JobKind::FacetGrid,
            Self::Crossed(_) => JobKind::Crossed,
            Self::FgdTruth(_) => JobKind::FgdTruth,
            Self::Fgd(_) => JobKind::Fgd,
            Self::Phase(_) => JobKind::Phase,
            Self::Thickness(_) => JobKind::Thickness,
            Self::Film(_) => JobKind::Film,
            Self::Escape(_) => JobKind::Escape,
        }
    }

    pub(crate) fn key(&self) -> Key {
        let inputs = match self {
            Self::Fresnel(job) => job.inputs(),
            Self::Distribution(job) => job.inputs(),
            Self::FacetGrid(job) => job.inputs(),
            Self::Crossed(job) => job.inputs(),
            Self::FgdTruth(job) => job.inputs(),
            Self::Fgd(job) => job.inputs(),
            Self::Phase(job) => job.inputs(),
            Self::Thickness(job) => job.inputs(),
            Self::Film(job) => job.inputs(),
            Self::Escape(job) => job.inputs(),
        };
        Key::of(self.kind(), &inputs)
    }

    /// Jobs whose results this one needs.
    pub(crate) fn dependencies(&self) -> Vec<Job> {
        match self {
            Self::FgdTruth(job) => job.dependencies(),
            Self::Fgd(job) => job.dependencies(),
            _ => Vec::new(),
        }
    }

    pub(crate) fn run(&self, inputs: &Inputs<'_>) -> Output {
        match self {
            Self::Fresnel(job) => Output::Tile(job.run()),
            Self::Distribution(job) => Output::Tile(job.run()),
            Self::FacetGrid(job) => Output::FacetGrid(job.run()),
            Self::Crossed(job) => Output::Crossed(job.run()),
            Self::FgdTruth(job) => Output::FgdTruth(job.run(inputs)),
            Self::Fgd(job) => Output::Tile(job.run(inputs)),
            Self::Phase(job) => Output::Tile(job.run()),
            Self::Thickness(job) => Output::Tile(job.run()),
            Self::Film(job) => Output::Tile(job.run()),
            Self::Escape(job) => Output::Tile(job.run()),
        }
    }
}

/// Result of a job.
#[derive(Debug)]
pub(crate) enum Output {
    Tile(TileData),
    FacetGrid(FacetGrid),
    Crossed(CrossedGrid),
    FgdTruth(FgdTruth),
}

/// One tile, apron included: its values, its texels, and its error as sampled.
#[derive(Debug, Clone)]
pub(crate) struct TileData {
    pub(crate) model: String,
    pub(crate) truth: Image,
    pub(crate) texels: Image,
    pub(crate) bytes: Vec<u8>,
    pub(crate) error: ErrorStats,
}

/// A single tile as an atlas of its own, to be sampled and measured.
pub(crate) fn lone_tile(kind: TableKind, axes: &[&Axis], format: TexelFormat, truth: &Image) -> Atlas {
    let periodic = axes.iter().any(|a| a.mapping == luthier_lut::Mapping::Periodic);
    let layout = AtlasLayout {
        x: axes[0].clone(),
        y: axes.get(1).map(|&y| y.clone()),
        apron: u32::from(periodic),
        columns: 1,
        tiles: 1,
        base: RowBase::Zero,
    };
    let tiles: Vec<Tile> = Vec::new();
    let (bytes, texels) = balance::texels(kind, format, truth);
    Atlas { kind, layout, format, tiles, truth: truth.clone(), texels, bytes }
}

/// How the colour of a tile was made, for its description.
pub(crate) fn color_in_words(color: &Color) -> String {
    match color {
        Color::Spectral => "spectral, CIE 1931 under D65, linear Rec.709".to_owned(),
        Color::ThreeWavelengths([r, g, b]) => format!("RGB taken at {r}, {g} and {b} nm"),
    }
}
