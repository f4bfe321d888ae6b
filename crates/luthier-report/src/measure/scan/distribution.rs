//! Scan of distribution tiles against the closed forms of D.

use luthier_lut::AtlasLayout;
use luthier_optics::microfacet::scaled_distribution;

use super::{Measured, R2, Scan, User, fraction};
use crate::error::ReportError;
use crate::measure::scan::report::{AlphaPoint, Curves};
use crate::measure::subject::{Subject, Table};
use crate::measure::table_terms::{AngleAxis, Weights};
use crate::text::format::rounded;

/// Number of bands of alpha in the chart of a distribution's error.
const ALPHA_BANDS: u32 = 64;

/// Scans a distribution tile over its whole domain: one point in each cell, and all nodes.
pub(super) fn scan(
    table: &Table<'_>,
    tile: u32,
    users: &[User],
    subject: &Subject<'_>,
) -> Result<Option<Measured>, ReportError> {
    let angle = AngleAxis::of(table)?;
    let AtlasLayout { x, y: Some(y), .. } = &table.entry.layout else { return Ok(None) };
    let distribution = users.iter().find_map(|&(m, l)| subject.stacks[m].layers.get(l).map(|l| l.surface.distribution));
    let Some(distribution) = distribution else { return Ok(None) };
    let (columns, rows) = (x.intervals(), y.intervals());
    let bands = ALPHA_BANDS.min(rows);
    let mut worst_of_peak = vec![0.0_f64; bands as usize];
    let mut scan = Scan::default();
    for j in 0..rows {
        let alpha = y.decode((f64::from(j) + 0.05 + 0.9 * fraction(0.5 + f64::from(j) * R2[1])) / f64::from(rows));
        let (mut peak, mut max_err) = (0.0_f64, 0.0_f64);
        for i in 0..columns {
            // The offset differs from row to row, so that points do not line up.
            let jitter = fraction(0.5 + f64::from(i) * R2[0] + f64::from(j) * R2[1]);
            let value = x.decode((f64::from(i) + 0.05 + 0.9 * jitter) / f64::from(columns));
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
    for alpha in (0..y.size).map(|j| y.node(j)) {
        for value in (0..x.size).map(|i| x.node(i)) {
            let (cos_theta_h, sin_theta_h_sq) = angle.cos_and_sin_sq(value);
            let expected = scaled_distribution(distribution, alpha, cos_theta_h, sin_theta_h_sq);
            scan.add(&[value, alpha], 0, expected, table.read(tile, [value, alpha], Weights::EightBit)[0]);
        }
    }
    let points = (0..bands).map(|b| AlphaPoint {
        alpha: rounded(y.decode((f64::from(b) + 0.5) / f64::from(bands)), 4),
        max_err_of_peak: rounded(worst_of_peak[b as usize], 4),
    });
    Ok(Some(Measured { scan, curves: Curves::ByAlpha(points.collect()), uncertainty: None }))
}
