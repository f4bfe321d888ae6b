//! n and k over wavelength, joined to an index.

use super::columns::Unit;
use super::error::plain;
use super::{IndexFileError, NOISE_K, Reason, VALUE_MAX};
use crate::color::VISIBLE_NM;
use crate::ior::{Ior, IorSample};

/// A value of n or of k, and where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub(super) nm: f64,
    pub(super) unit: Option<Unit>,
    pub(super) value: f64,
    pub(super) line: Option<usize>,
    pub(super) column: Option<usize>,
}

impl Point {
    fn error(&self, reason: Reason) -> IndexFileError {
        IndexFileError { line: self.line, column: self.column, reason }
    }
}

fn is_seen(nm: f64) -> bool {
    (VISIBLE_NM.0..=VISIBLE_NM.1).contains(&nm)
}

/// The index that n and k make; points may come in any order.
pub(super) fn joined(n: Vec<Point>, k: Vec<Point>, notes: &mut Vec<String>) -> Result<Ior, IndexFileError> {
    if n.is_empty() {
        return Err(if k.is_empty() { Reason::Empty } else { Reason::OnlyK }.at(None));
    }
    let n = checked(read("n", n, notes)?, notes, |point| match point {
        Point { nm, value, .. } if *value < 0.0 => Err(Reason::NegativeN { nm: plain(*nm), n: *value }),
        Point { nm, value, .. } if *value > VALUE_MAX => {
            Err(Reason::TooLarge { name: "n", nm: plain(*nm), value: *value })
        }
        Point { value, .. } => Ok(*value),
    })?;
    let mut noise = Vec::new();
    let k = if k.is_empty() { k } else { read("k", k, notes)? };
    let k = checked(k, notes, |point| match point {
        Point { nm, value, .. } if *value < NOISE_K => Err(Reason::NegativeK { nm: plain(*nm), k: *value }),
        Point { nm, value, .. } if *value > VALUE_MAX => {
            Err(Reason::TooLarge { name: "k", nm: plain(*nm), value: *value })
        }
        Point { value, .. } if *value < 0.0 => {
            noise.push(*value);
            Ok(0.0)
        }
        Point { value, .. } => Ok(*value),
    })?;
    if let Some(least) = noise.iter().copied().min_by(f64::total_cmp) {
        notes.push(format!("negative values of k, {} in all, down to {least}, are read as 0", noise.len()));
    }
    if let (Some(first), Some(last), [n_first, .., n_last]) = (k.first(), k.last(), n.as_slice())
        && (first.nm > n_first.nm.max(VISIBLE_NM.0) || last.nm < n_last.nm.min(VISIBLE_NM.1))
    {
        let [first, last] = [first, last].map(|point| plain(point.nm));
        notes.push(format!("k is given from {first} to {last} nm alone: outside, it is held constant"));
    }
    let mut samples: Vec<IorSample> = Vec::new();
    for (nm, line) in wavelengths(&n, &k) {
        let sample = IorSample { wavelength_nm: nm, n: at(&n, nm), k: at(&k, nm) };
        match sample.n == 0.0 && sample.k == 0.0 {
            true if is_seen(nm) => return Err(Reason::Nothing(plain(nm)).at(line)),
            true => {}
            false => samples.push(sample),
        }
    }
    // The points ascend and have been checked one by one.
    Ior::sampled(samples).map_err(|_| Reason::Empty.at(None))
}

/// The points in ascending order of wavelengths, each wavelength once, as far as visible light depends on them.
fn read(name: &str, mut points: Vec<Point>, notes: &mut Vec<String>) -> Result<Vec<Point>, IndexFileError> {
    points.sort_by(|a, b| a.nm.total_cmp(&b.nm));
    let mut found: Vec<Point> = Vec::new();
    let mut averaged = Vec::new();
    for equal in points.chunk_by(|a, b| a.nm == b.nm) {
        let mean = equal.iter().map(|point| point.value).sum::<f64>() / equal.len() as f64;
        let differ = equal.iter().any(|point| point.value != equal[0].value);
        if differ && is_seen(equal[0].nm) {
            averaged.push(equal[0].nm);
        }
        found.push(Point { value: if differ { mean } else { equal[0].value }, ..equal[0] });
    }
    if let Some(first) = averaged.first() {
        notes.push(format!(
            "several values of {name} at one wavelength, {} in all, first at {} nm: the mean is taken",
            averaged.len(),
            plain(*first)
        ));
    }
    let (low, high) = VISIBLE_NM;
    let (first, last) = (found[0], found[found.len() - 1]);
    if found.len() > 1 && (last.nm < low || first.nm > high) || found.len() == 1 && !is_seen(first.nm) {
        return Err(Reason::NotVisible(plain(first.nm), plain(last.nm)).at(None));
    }
    // A sample on each side, if the range begins or ends between two.
    let from = found.partition_point(|point| point.nm <= low).saturating_sub(1);
    let to = (found.partition_point(|point| point.nm < high) + 1).min(found.len());
    found.truncate(to);
    found.drain(..from);
    Ok(found)
}

/// The points with the values that a check gives them. Refused points outside the visible range are left out.
fn checked(
    points: Vec<Point>,
    notes: &mut Vec<String>,
    mut check: impl FnMut(&Point) -> Result<f64, Reason>,
) -> Result<Vec<Point>, IndexFileError> {
    let mut found = Vec::with_capacity(points.len());
    for point in points {
        match check(&point) {
            Ok(value) => found.push(Point { value, ..point }),
            Err(reason) if is_seen(point.nm) => return Err(point.error(reason)),
            Err(reason) => notes.push(format!("{}: the row is left out", point.error(reason))),
        }
    }
    Ok(found)
}

/// The wavelengths of an index, with a line of each: those of n, and between them those of k.
fn wavelengths(n: &[Point], k: &[Point]) -> Vec<(f64, Option<usize>)> {
    let (Some(first), Some(last)) = (n.first(), n.last()) else { return Vec::new() };
    let inner = k.iter().filter(|point| n.len() > 1 && first.nm < point.nm && point.nm < last.nm);
    let mut all: Vec<_> = n.iter().chain(inner).map(|point| (point.nm, point.line)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.dedup_by(|b, a| a.0 == b.0);
    all
}

/// The value at a wavelength, on lines between points and held constant outside; 0 without points.
fn at(points: &[Point], nm: f64) -> f64 {
    let after = points.partition_point(|point| point.nm <= nm);
    match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
        (None, None) => 0.0,
        (None, Some(point)) => point.value,
        (Some(point), None) => point.value,
        (Some(a), Some(_)) if a.nm == nm => a.value,
        (Some(a), Some(b)) => a.value + (b.value - a.value) * ((nm - a.nm) / (b.nm - a.nm)),
    }
}
