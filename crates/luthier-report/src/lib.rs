//! The judge of bakes: errors of tables and shaders against the f64 reference, as numbers and as a page.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`judge`] takes the result of a bake (manifest, decoded texels), the stacks that it was made from, and optionally a
//! [`Device`] that runs the emitted shaders. Every figure of the [`Report`] comes from that run:
//!
//! - tables are read back through the sampler of `luthier-lut` at points of the judge's own choosing;
//! - shaders are compared with `luthier_layers::twins::real_time` over deterministic sets of directions;
//! - the error of the baked shader is split into an error of the tables and an error of f32 arithmetic;
//! - the difference between three wavelengths and the spectrum is a separate figure, because it is not an error of the bake;
//! - materials that vary over the surface are judged at random places ([`Places`]): the shader, f64 on the tables that ship ([`Rows`]), and exact terms or
//!   the simulation of the stack at the place;
//! - colour differences show which errors are visible under which light ([`Seen`]);
//! - samples that miss [`TARGET_MAX_REL_ERR`] are listed with the factor that causes the error;
//! - directional albedos (FGD) are estimated anew, wavelength by wavelength, with the uncertainty of the estimate.
//!
//! The caller adds the rest of a page (searches, costs, pictures, models against the reference) to the report: [`Costs`],
//! [`Exhibits`], [`judge_shading_models`]. [`limits()`] compares the report with budgets.
//!
//! Other judgements stand alone:
//!
//! - [`audit()`] judges a table of another program against the function that it should hold;
//! - [`parity`] compares the shaders of all models with their f64 twins;
//! - [`judge_models`] compares every reflectance model with the Monte Carlo simulation of whole stacks;
//! - [`stability`] runs every method on stacks where methods fail, and finds the domain of each;
//! - [`compare_pictures`] compares two pictures, [`render_ball`] renders one in f64, [`render_ball_of`] from values of any source, and [`sheet()`] puts
//!   many on one;
//! - [`Certificate`] is the page of one table, [`Plot`] draws curves, [`Scatter`] points of error over cost, and [`Spread`] summarises times of a stopwatch.
//!
//! A room uses the rooms above it in this list, and none below:
//!
//! - `error`, `text`, `svg`: failures; numbers and JSON as a reader wants them; charts;
//! - `measure`: the subject, both sides of a comparison, their statistics, causes of errors, tables;
//! - `models`: models against the simulation of whole stacks;
//! - `places`: materials that maps vary;
//! - `parity`, `stability`: shaders against their twins, methods where methods fail;
//! - `judge`: all of it, of a bake, as a [`Report`];
//! - `pages`: the report as a page.
//!
//! `audit`, `certificate` and `picture` stand beside these and use the first row alone.
//!
//! Simplifications: without [`FilmMap`]s the judge checks only the range and the normalisation of thickness tiles. The estimate of albedos uses the walks and the quadrature of `luthier-optics`, as the baker does, but
//! with other seeds, numbers and colour treatment.

mod audit;
mod certificate;
mod error;
mod judge;
mod measure;
mod models;
mod pages;
mod parity;
mod picture;
mod places;
pub mod stability;
mod svg;
mod text;

pub use audit::{
    Audit, AuditError, AuditVerdict, Candidate, Mistake, Model, Stated, StatedError, Statement, Term, audit,
};
pub use certificate::{Certificate, ErrorMap};
pub use error::ReportError;
pub use judge::evidence::{
    Costs, Exhibit, Exhibits, PictureErrors, ReferencePaths, ShaderCost, ShaderTime, ShaderVerdict, ShapeCost,
    StabilitySummary, Times,
};
pub use judge::exceptions::Exception;
pub use judge::limits::{Asked, FileBudget, Limit, limits};
pub use judge::profile::{ANGLE_BINS, AngleProfile, Exceedance};
pub use judge::report::{Compared, Comparison, MaterialReport, REPORT_SCHEMA, Report, WorstCase};
pub use judge::{Progress, Settings, judge};
pub use luthier_manifest::Form;
pub use measure::causes::{Cause, Factor, Part};
pub use measure::device::Device;
pub use measure::directions::{DirectionSet, Pair};
pub use measure::memory::{Memory, contents};
pub use measure::scan::report::{AlphaPoint, Curves, ReflectanceCurve, TableReport, TileReport};
pub use measure::seen::{Seen, SeenLight, picture_color_difference};
pub use measure::statistics::{
    DIM_FLOOR, ErrorSummary, FLOOR, PEAK_FRACTION, Spread, Statistics, TARGET_MAX_REL_ERR, WorstPair, statistics,
};
pub use measure::subject::{FilmMap, FilmSource, Subject, SurfaceMap};
pub use measure::table_terms::{TableTerms, Weights};
pub use models::{
    AgainstReference, CellDifferences, ColorView, MaterialModels, ModelErrors, ModelSettings, ModelSubject,
    ModelsReport, PHI_DEG, Quantity, Reference, ReferenceSettings, Shown, ViewError, Worst, judge_models,
    judge_shading_models,
};
pub use parity::{
    AT_PLACES, KNOWN, Known, POLISHED_ALPHAS, Parity, ParityCase, ParityRow, ParitySet, Share, Verdict, parity,
    tolerance,
};
pub use picture::ball::{BallPicture, DistantLight, render_ball, render_ball_of};
pub use picture::flip::lightness_chroma_hue;
pub use picture::{PIXELS_PER_DEGREE, PictureComparison, brightened_difference, compare_pictures, sheet};
pub use places::{
    AlbedoSettings, AlbedosAt, AtPlaces, PLACE_FLOOR, PLACES_SEED, PlaceErrors, Places, Rows, SimulatedAt,
    SimulatedErrors, SimulatedSettings, Site, Ways, WorstPlace, albedos, at_places, simulated, simulated_by,
};
pub use svg::{Curve, Plot, PlotAxis, PlotColor, Scatter, ScatterPanel, ScatterPoint};
