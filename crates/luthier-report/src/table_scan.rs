//! The judge's own measurement of shipped tables, at points that the baker did not choose.

use luthier_layers::elek::Terms;
use luthier_layers::terms::Exact;
use luthier_lut::{AtlasLayout, ErrorStats, TableKind, Worst};
use luthier_optics::microfacet::scaled_distribution;
use luthier_optics::stack::{Distribution, Stack};

use crate::report::{AlphaPoint, Curves, ReflectancePoint, TableReport, TileReport};
use crate::statistics::summarise;
use crate::subject::Table;
use crate::table_terms::{AngleAxis, Weights};
use crate::{ReportError, Subject};

/// Points in every cell of a Fresnel row.
const POINTS_PER_CELL: u32 = 8;
/// Extra cosines below 0.1, log-uniform down to 1e-6: the first cells hold the steepest part.
const GRAZING_POINTS: u32 = 256;
/// Bands of alpha that a distribution's error is shown for.
const ALPHA_BANDS: u32 = 64;
/// Degrees between the points of a drawn reflectance curve.
const CURVE_STEP_DEG: f64 = 1.5;
/// 1/phi and 1/phi^2 of the plastic number: steps of the two-dimensional additive recurrence (Roberts 2018).
const R2: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_2];

/// Reports every table of the subject; `exact[m]` are the exact terms that the tables of material `m` stand for.
pub(crate) fn scan(subject: &Subject<'_>, exact: &[Exact]) -> Result<Vec<TableReport>, ReportError> {
    let mut reports = Vec::new();
    for kind in TableKind::ALL {
        let Some(table) = subject.table(kind)? else { continue };
        let entry = table.entry;
        let mut tiles = Vec::new();
        for (number, tile) in (0..entry.layout.tiles).zip(&entry.tiles) {
            let users = users(subject, kind, number);
            let measured = match kind {
                TableKind::Fresnel => Some(fresnel(&table, number, &users, exact)),
                TableKind::Distribution => distribution(&table, number, &users, subject)?,
                TableKind::Fgd | TableKind::Phase | TableKind::Thickness => None,
            };
            let (judge, not_finite, curves) = match measured {
                Some(Measured { scan, curves }) => {
                    let not_finite = scan.not_finite;
                    (scan.stats(), not_finite, curves)
                }
                None => (None, 0, Curves::None),
            };
            tiles.push(TileReport {
                name: tile.name.clone(),
                model: tile.model.clone(),
                users: users.iter().map(|u| format!("{}/{}", subject.manifest.materials[u.0].name, u.1)).collect(),
                baker: tile.error.clone(),
                judge,
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

/// The layers, as (material, layer), that read a tile.
fn users(subject: &Subject<'_>, kind: TableKind, tile: u32) -> Vec<(usize, usize)> {
    let mut out = Vec::new();
    for (m, material) in subject.manifest.materials.iter().enumerate() {
        for (l, record) in material.layers.iter().enumerate() {
            let used = match kind {
                TableKind::Fresnel => record.fresnel_tile,
                TableKind::Distribution => record.distribution_tile,
                TableKind::Fgd => record.fgd_tile,
                TableKind::Phase => record.phase_tile,
                TableKind::Thickness => record.thickness_tile,
            };
            if used == Some(tile) {
                out.push((m, l));
            }
        }
    }
    out
}

struct Measured {
    scan: Scan,
    curves: Curves,
}

#[derive(Default)]
struct Scan {
    errors: Vec<f64>,
    worst: Option<(f64, Worst)>,
    not_finite: u64,
}

impl Scan {
    fn add(&mut self, at: &[f64], channel: usize, expected: f64, sampled: f64) {
        let error = (expected - sampled).abs();
        if !error.is_finite() {
            self.not_finite += 1;
            return;
        }
        self.errors.push(error);
        if self.worst.as_ref().is_none_or(|(worst, _)| error > *worst) {
            self.worst = Some((error, Worst { at: at.to_vec(), channel: channel as u32, expected, sampled }));
        }
    }

    fn stats(self) -> Option<ErrorStats> {
        let (_, worst) = self.worst?;
        let points = self.errors.len() as u64;
        let summary = summarise(self.errors);
        Some(ErrorStats { max_abs_err: summary.max, rms_err: summary.rms, p99_abs_err: summary.p99, worst, points })
    }
}

/// Coordinate of scan point `n` of `count` along an axis: stratified, never on a node.
fn coordinate(n: u32, count: u32, step: f64) -> f64 {
    let jitter = 0.5 + f64::from(n) * step;
    (f64::from(n) + 0.05 + 0.9 * (jitter - libm::floor(jitter))) / f64::from(count)
}

/// A Fresnel row against every interface that reads it: a row that two different interfaces share is wrong for one.
fn fresnel(table: &Table<'_>, tile: u32, users: &[(usize, usize)], exact: &[Exact]) -> Measured {
    let axis = &table.entry.layout.x;
    let count = axis.intervals() * POINTS_PER_CELL;
    let regular = (0..count).map(|n| axis.decode(coordinate(n, count, R2[0])));
    let grazing = (0..GRAZING_POINTS).map(|n| 1e-6 * libm::pow(1e5, coordinate(n, GRAZING_POINTS, R2[0])));
    let cosines: Vec<f64> = regular.chain(grazing).map(|c| c.clamp(0.0, 1.0)).collect();
    let mut scan = Scan::default();
    for &(material, layer) in users {
        for &cos_theta in &cosines {
            let expected = exact[material].fresnel(layer, cos_theta);
            let sampled = table.read(tile, [cos_theta, 0.0], Weights::EightBit);
            for channel in 0..3 {
                scan.add(&[cos_theta], channel, expected[channel], sampled[channel]);
            }
        }
    }
    let steps = (90.0 / CURVE_STEP_DEG) as u32;
    let reflectance = (0..=steps).map(|n| {
        let theta_deg = CURVE_STEP_DEG * f64::from(n);
        let [r, g, b, _] = table.read(tile, [libm::cos(theta_deg.to_radians()), 0.0], Weights::Exact);
        ReflectancePoint { theta_deg: theta_deg as f32, rgb: [r as f32, g as f32, b as f32] }
    });
    Measured { scan, curves: Curves::Reflectance(reflectance.collect()) }
}

/// A distribution tile over its whole domain, one point a cell.
fn distribution(
    table: &Table<'_>,
    tile: u32,
    users: &[(usize, usize)],
    subject: &Subject<'_>,
) -> Result<Option<Measured>, ReportError> {
    let AtlasLayout { x, y: Some(y), .. } = &table.entry.layout else { return Ok(None) };
    let angle = AngleAxis::of(table)?;
    let Some(distribution) = users.iter().find_map(|&(m, l)| distribution_of(&subject.stacks[m], l)) else {
        return Ok(None);
    };
    let (columns, rows) = (x.intervals(), y.intervals());
    let bands = ALPHA_BANDS.min(rows);
    let mut worst_of_peak = vec![0.0_f64; bands as usize];
    let mut scan = Scan::default();
    for j in 0..rows {
        let alpha = y.decode(coordinate(j, rows, R2[1]));
        let (mut peak, mut max_err) = (0.0_f64, 0.0_f64);
        for i in 0..columns {
            let value = x.decode(shifted(i, j, columns));
            let (cos_theta_h, sin_theta_h_sq) = angle.cos_and_sin_sq(value);
            let expected = scaled_distribution(distribution, alpha, cos_theta_h, sin_theta_h_sq);
            let sampled = table.read(tile, [value, alpha], Weights::EightBit)[0];
            scan.add(&[value, alpha], 0, expected, sampled);
            peak = peak.max(expected);
            max_err = max_err.max((expected - sampled).abs());
        }
        let band = (u64::from(j) * u64::from(bands) / u64::from(rows)) as usize;
        if peak > 0.0 {
            worst_of_peak[band] = worst_of_peak[band].max(max_err / peak);
        }
    }
    let points = (0..bands).map(|b| AlphaPoint {
        alpha: y.decode((f64::from(b) + 0.5) / f64::from(bands)) as f32,
        max_err_of_peak: worst_of_peak[b as usize] as f32,
    });
    Ok(Some(Measured { scan, curves: Curves::ByAlpha(points.collect()) }))
}

fn distribution_of(stack: &Stack, layer: usize) -> Option<Distribution> {
    stack.layers.get(layer).map(|l| l.surface.distribution)
}

/// Like [`coordinate`], with another offset in every row.
fn shifted(i: u32, j: u32, count: u32) -> f64 {
    let jitter = 0.5 + f64::from(i) * R2[0] + f64::from(j) * R2[1];
    (f64::from(i) + 0.05 + 0.9 * (jitter - libm::floor(jitter))) / f64::from(count)
}
