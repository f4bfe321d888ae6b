//! The judge's own measurement of shipped tables, at points that the baker did not choose.

mod albedo;
mod distribution;
mod escape;
mod film;
mod fresnel;
mod lobes;
mod phase;
pub(crate) mod report;
mod thickness;

use luthier_layers::twins::terms::Exact;
use luthier_lut::{Axis, ErrorStats, TableKind, Worst};
use serde::{Deserialize, Serialize};

use crate::error::ReportError;
use crate::measure::memory::Remembered;
use crate::measure::readers::{User, bare_users, tiles, users};
use crate::measure::references::References;
use crate::measure::scan::report::{Curves, TableReport, TileReport};
use crate::measure::statistics::summarise;
use crate::measure::subject::Subject;

pub(crate) use albedo::{DOMAIN_ALPHA, DOMAIN_COS_THETA, REPEATS, STEPS, points};

/// Key of scans of tiles in a memory.
const TILE: &str = "judge-tile";

/// 1/phi and 1/phi^2 of the plastic number: steps of the two-dimensional additive recurrence (Roberts 2018).
const R2: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_2];

/// Reports every table of the subject. `references[m]` has the exact terms for the tables of material `m`. Tiles that were scanned before for equal
/// readers are not scanned again. `step` is called [`STEPS`] times in all.
pub(crate) fn scan(
    subject: &Subject<'_>,
    references: &[References],
    remembered: &Remembered<'_>,
    pairs_per_set: u32,
    step: &mut dyn FnMut(),
    findings: &mut Vec<String>,
) -> Result<Vec<TableReport>, ReportError> {
    let exact: Vec<&Exact> = references.iter().map(References::baked).collect();
    let exact = exact.as_slice();
    let mut known: Vec<Vec<Option<Found>>> = Vec::with_capacity(TableKind::ALL.len());
    for kind in TableKind::ALL {
        let tiles = subject.table(kind)?.map_or(0, |table| table.entry.layout.tiles);
        let inputs = (0..tiles).map(|tile| remembered.tile(subject, kind, tile, pairs_per_set));
        known.push(inputs.map(|inputs| remembered.recall(TILE, &inputs)).collect());
    }
    let mut reports = Vec::new();
    let mut albedo = None;
    if let Some(table) = subject.table(TableKind::Fgd)? {
        let known = &known[TableKind::Fgd as usize];
        albedo = Some(albedo::scan(&table, subject, &|t| known[t as usize].is_none(), points(pairs_per_set), step)?);
    } else {
        (0..STEPS).for_each(|_| step());
    }
    for kind in TableKind::ALL {
        let Some(table) = subject.table(kind)? else { continue };
        let entry = table.entry;
        let mut tiles = Vec::new();
        for (number, tile) in (0..entry.layout.tiles).zip(&entry.tiles) {
            let users = users(subject, kind, number);
            let known = known[kind as usize][number as usize].take();
            if known.is_none() && kind == TableKind::Lobes {
                users.iter().for_each(|(m, _)| remembered.fit(&references[*m], &subject.manifest.materials[*m]));
            }
            let measured = match kind {
                TableKind::Thickness => {
                    findings.extend(thickness::doubts(&table, number, &users, subject));
                    if known.is_some() { None } else { thickness::scan(&table, number, &users, subject) }
                }
                _ if known.is_some() => None,
                TableKind::Fresnel => Some(fresnel::scan(&table, number, &users, subject, exact)?),
                TableKind::Distribution => distribution::scan(&table, number, &users, subject)?,
                TableKind::Fgd => albedo.as_mut().and_then(|tiles| tiles[number as usize].take()),
                TableKind::Phase => phase::scan(&table, number, &users, subject),
                TableKind::Escape => escape::scan(&table, number, &users, subject),
                TableKind::Film => film::scan(&table, number, &users, subject),
                TableKind::Lobes => lobes::scan(&table, number, &users, subject, exact),
            };
            let Found { judge, not_finite, curves, uncertainty, largest } = known.unwrap_or_else(|| {
                let found = Found::from(measured.unwrap_or_default());
                remembered.keep(TILE, &remembered.tile(subject, kind, number, pairs_per_set), &found);
                found
            });
            tiles.push(TileReport {
                name: tile.name.clone(),
                model: tile.model.clone(),
                users: names(subject, kind, number),
                baker: tile.error.clone(),
                aim: tile.aim,
                uncertainty,
                judge,
                largest: largest.or(tile.largest),
                not_finite,
                curves,
            });
        }
        reports.push(TableReport {
            kind,
            size: entry.layout.size(),
            layout: entry.layout.clone(),
            format: entry.format,
            texel_bytes: entry.texel_bytes,
            path: entry.texture.path.clone(),
            tiles,
        });
    }
    Ok(reports)
}

/// Names of the readers of a tile: layers, and the bare layers under a patina or a coat.
fn names(subject: &Subject<'_>, kind: TableKind, tile: u32) -> Vec<String> {
    let materials = &subject.manifest.materials;
    let layers = materials.iter().flat_map(|m| m.layers.iter().enumerate().map(move |(l, layer)| (m, l, layer)));
    let layers = layers
        .filter(|(m, _, layer)| layer.tiles[kind].is_some_and(|first| (first..first + tiles(m, kind)).contains(&tile)));
    let bare = bare_users(subject, kind, tile).into_iter().map(|number| format!("{}/bare", materials[number].name));
    layers.map(|(m, l, _)| format!("{}/{l}", m.name)).chain(bare).collect()
}

/// Raw results of the scan of a tile.
#[derive(Default)]
struct Measured {
    scan: Scan,
    curves: Curves,
    /// Standard error of the reference at the worst point, when the reference is an estimate.
    uncertainty: Option<f64>,
}

/// The result of the scan of a tile, as it is reported and kept.
#[derive(Serialize, Deserialize)]
struct Found {
    judge: Option<ErrorStats>,
    not_finite: u64,
    curves: Curves,
    uncertainty: Option<f64>,
    largest: Option<f64>,
}

impl From<Measured> for Found {
    fn from(Measured { scan, curves, uncertainty }: Measured) -> Self {
        let (not_finite, largest) = (scan.not_finite, scan.largest);
        let judge = scan.stats();
        let largest = judge.as_ref().map(|_| largest);
        Self { uncertainty: uncertainty.filter(|_| judge.is_some()), judge, not_finite, curves, largest }
    }
}

#[derive(Default)]
struct Scan {
    errors: Vec<f64>,
    worst: Option<(f64, Worst)>,
    /// Largest magnitude of the function at a point.
    largest: f64,
    not_finite: u64,
}

impl Scan {
    /// Adds a sample and returns whether it is the worst so far.
    fn add(&mut self, at: &[f64], channel: usize, expected: f64, sampled: f64) -> bool {
        let error = (expected - sampled).abs();
        if !error.is_finite() {
            self.not_finite += 1;
            return false;
        }
        self.errors.push(error);
        self.largest = self.largest.max(expected.abs());
        let is_worst = self.worst.as_ref().is_none_or(|(worst, _)| error > *worst);
        if is_worst {
            self.worst = Some((error, Worst { at: at.to_vec(), channel: channel as u32, expected, sampled }));
        }
        is_worst
    }

    fn stats(self) -> Option<ErrorStats> {
        let (_, worst) = self.worst?;
        let points = self.errors.len() as u64;
        let summary = summarise(self.errors);
        let (max_abs_err, rms_err, p99_abs_err) = (summary.max, summary.rms, summary.p99);
        Some(ErrorStats { max_abs_err, rms_err, p99_abs_err, slack: 0.0, worst, points })
    }
}

/// Coordinates of a scan along an axis: stratified points in every cell, never on a node; then the nodes, because balancing moves their values.
fn coordinates(axis: &Axis, points_per_cell: u32) -> Vec<f64> {
    let count = axis.intervals() * points_per_cell;
    let nodes = (0..axis.size).map(|i| axis.node_coordinate(f64::from(i)));
    (0..count).map(|n| coordinate(n, count)).chain(nodes).collect()
}

/// Coordinate of scan point `n` of `count` along an axis: stratified, never on a node.
fn coordinate(n: u32, count: u32) -> f64 {
    (f64::from(n) + 0.05 + 0.9 * fraction(0.5 + f64::from(n) * R2[0])) / f64::from(count)
}

fn fraction(x: f64) -> f64 {
    x - libm::floor(x)
}
