//! Error of a table: a scan that compares sampled values with the function.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The function and a sampled read of its table at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// The function, per channel.
    pub expected: [f64; 4],
    /// The sampled read, per channel. Channels that do not matter are equal to `expected`.
    pub sampled: [f64; 4],
}

/// The worst point of a scan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Axis values there; one per axis.
    pub at: Vec<f64>,
    /// Channel, 0-based.
    pub channel: u32,
    /// The function there.
    pub expected: f64,
    /// Value of a sampled read.
    pub sampled: f64,
}

/// Measured absolute error of a sampled table against the function it stands for, over all channels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorStats {
    /// Largest: the difference at `worst`, after local refinement around the worst points of the scan, and `slack`.
    pub max_abs_err: f64,
    /// Root mean square over the scan, and in quadrature the root mean square error of the function itself.
    pub rms_err: f64,
    /// 99th percentile over the scan, and `slack`.
    pub p99_abs_err: f64,
    /// Error of the function itself that reads were compared with; 0 for closed forms.
    #[serde(default)]
    pub slack: f64,
    /// Where the largest difference is.
    pub worst: Worst,
    /// Points of the scan, at nodes and between them.
    pub points: u64,
}

impl ErrorStats {
    /// The error with more points, which were chosen for their large errors: they count in the largest error alone.
    #[must_use]
    pub fn with_worst_of(self, more: Self) -> Self {
        let points = self.points + more.points;
        if more.max_abs_err > self.max_abs_err {
            return Self { max_abs_err: more.max_abs_err, worst: more.worst, points, ..self };
        }
        Self { points, ..self }
    }

    /// The error if the function itself is inexact, by `largest` at most and by `rms` in the root mean square.
    #[must_use]
    pub fn with_slack(self, largest: f64, rms: f64) -> Self {
        Self {
            max_abs_err: self.max_abs_err + largest,
            rms_err: libm::hypot(self.rms_err, rms),
            p99_abs_err: self.p99_abs_err + largest,
            slack: self.slack + largest,
            ..self
        }
    }
}

/// Places at which a table is compared with its function.
///
/// ```
/// use luthier_lut::Scan;
///
/// // A row of five nodes, with two points in each of its four intervals.
/// let scan = Scan::whole([4, 0], [2, 1]);
/// let places: Vec<f64> = scan.coordinates().map(|[u, _]| u).collect();
/// assert_eq!(places.len(), 4 * 2 + 5);
/// assert_eq!((places[0], places[8]), (1.0 / 16.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan {
    /// Points along each axis, in the middle of equal intervals of `u`; 1 (as 0 is) along an axis that the table lacks.
    pub points: [u32; 2],
    /// Lowest coordinate `u` along each axis.
    pub from: [f64; 2],
    /// Highest coordinate `u` along each axis; equal to `from` along an axis that the table lacks.
    pub to: [f64; 2],
    /// Intervals of equal `u` along each axis. Their ends, the nodes of a table, are points too, because balancing moves nodes. 0 for none,
    /// and along an axis that the table lacks.
    pub nodes: [u32; 2],
    /// Halvings of the search radius around the worst point.
    pub refinements: u32,
}

impl Scan {
    /// Halvings that functions in closed form can afford.
    pub const REFINEMENTS: u32 = 12;

    /// The whole table: its nodes, and `per_cell[k]` points in each of `cells[k]` intervals between them; a one-axis table has
    /// `cells[1] == 0`.
    pub fn whole(cells: [u32; 2], per_cell: [u32; 2]) -> Self {
        Self {
            points: [0, 1].map(|k: usize| (cells[k] * per_cell[k]).max(1)),
            from: cells.map(|cells| if cells > 0 { 0.0 } else { 0.5 }),
            to: cells.map(|cells| if cells > 0 { 1.0 } else { 0.5 }),
            nodes: cells,
            refinements: Self::REFINEMENTS,
        }
    }

    /// All coordinates of the scan: the points between nodes row by row, then the nodes likewise.
    pub fn coordinates(&self) -> impl Iterator<Item = [f64; 2]> {
        let [width, height] = self.points.map(|n| n.max(1));
        let between = (0..height).flat_map(move |j| (0..width).map(move |i| self.coordinate([i, j])));
        let [columns, rows] = [0, 1].map(|k: usize| self.node_coordinates(k));
        between.chain(rows.into_iter().flat_map(move |v| columns.clone().into_iter().map(move |u| [u, v])))
    }

    /// Coordinates of the nodes along an axis; none if either of two axes has no nodes.
    fn node_coordinates(&self, axis: usize) -> Vec<f64> {
        let (from, to, count) = (self.from[axis], self.to[axis], self.nodes[axis]);
        match count {
            0 if self.nodes == [0, 0] || from < to => Vec::new(),
            0 => vec![from],
            _ => (0..=count).map(|i| f64::from(i) / f64::from(count)).filter(|u| (from..=to).contains(u)).collect(),
        }
    }

    /// Coordinate of a point between nodes.
    pub fn coordinate(&self, point: [u32; 2]) -> [f64; 2] {
        [0, 1].map(|k: usize| {
            let t = (f64::from(point[k]) + 0.5) / f64::from(self.points[k].max(1));
            self.from[k] + (self.to[k] - self.from[k]) * t
        })
    }
}

/// Points of a scan that the search for the worst error starts from.
const CLIMBS: usize = 12;

/// [`measure_scan`] over the whole table.
pub fn measure(
    cells: [u32; 2],
    per_cell: [u32; 2],
    compare: impl Fn([f64; 2]) -> Comparison + Sync,
    axis_values: impl Fn([f64; 2]) -> Vec<f64>,
) -> ErrorStats {
    measure_scan(&Scan::whole(cells, per_cell), compare, axis_values)
}

/// Compares a table with its function at the points of a scan, then climbs from the worst of them, each to its local maximum,
/// halving the step whenever no neighbour is worse. Quantised texels and weights make the error a saw: one climb would stop
/// at the nearest tooth.
///
/// `compare` receives coordinates `u` in 0..=1; `axis_values` turns the worst `u` into what is reported. Points are compared
/// side by side and added up in a fixed order: the result does not depend on threads.
pub fn measure_scan(
    scan: &Scan,
    compare: impl Fn([f64; 2]) -> Comparison + Sync,
    axis_values: impl Fn([f64; 2]) -> Vec<f64>,
) -> ErrorStats {
    let mut errors = Errors::default();
    // The worst points between nodes and the worst nodes are climbed from, so that neither crowd out the other.
    let between: usize = scan.points.map(|n| n.max(1) as usize).into_iter().product();
    let mut starts = Vec::with_capacity(2 * CLIMBS);
    let points: Vec<[f64; 2]> = scan.coordinates().collect();
    let compared: Vec<Candidate> = points.into_par_iter().map(|u| Candidate::at(u, &compare(u))).collect();
    for (i, candidate) in compared.into_iter().enumerate() {
        if i == between {
            starts.append(&mut errors.worst);
        }
        errors.add(candidate);
    }
    starts.append(&mut errors.worst);
    let climbed: Vec<Candidate> = starts.into_par_iter().map(|start| climb(scan, start, &compare)).collect();
    let worst = climbed.into_iter().fold(NOWHERE, Candidate::max);
    errors.stats(worst, &compare(worst.u), axis_values(worst.u))
}

/// The error at given points and no others: axis values, and the comparison there.
pub fn measure_at(points: impl IntoIterator<Item = (Vec<f64>, Comparison)>) -> ErrorStats {
    let mut errors = Errors::default();
    let points: Vec<(Vec<f64>, Comparison)> = points.into_iter().collect();
    points.iter().enumerate().for_each(|(i, (_, there))| errors.add(Candidate::at([i as f64, 0.0], there)));
    let worst = errors.worst.first().copied().unwrap_or(NOWHERE);
    let nothing = (Vec::new(), Comparison { expected: [0.0; 4], sampled: [0.0; 4] });
    let (at, there) = points.into_iter().nth(worst.u[0] as usize).unwrap_or(nothing);
    errors.stats(worst, &there, at)
}

/// A candidate that any point replaces.
const NOWHERE: Candidate = Candidate { u: [0.5, 0.5], channel: 0, error: -1.0 };

/// Errors as they come in.
#[derive(Default)]
struct Errors {
    all: Vec<f64>,
    sum_of_squares: f64,
    /// The worst first; of equals the first.
    worst: Vec<Candidate>,
}

impl Errors {
    fn add(&mut self, candidate: Candidate) {
        self.sum_of_squares += candidate.error * candidate.error;
        self.all.push(candidate.error);
        let place = self.worst.partition_point(|s| s.error >= candidate.error);
        self.worst.insert(place, candidate);
        self.worst.truncate(CLIMBS);
    }

    fn stats(mut self, worst: Candidate, there: &Comparison, at: Vec<f64>) -> ErrorStats {
        self.all.sort_by(f64::total_cmp);
        let points = self.all.len().max(1);
        let rank = (points * 99).div_ceil(100) - 1;
        ErrorStats {
            max_abs_err: worst.error.max(0.0),
            rms_err: (self.sum_of_squares / points as f64).sqrt(),
            p99_abs_err: self.all.get(rank).copied().unwrap_or_default(),
            slack: 0.0,
            worst: Worst {
                at,
                channel: worst.channel as u32,
                expected: there.expected[worst.channel],
                sampled: there.sampled[worst.channel],
            },
            points: self.all.len() as u64,
        }
    }
}

/// Climbs from a point to a local maximum of the error.
fn climb(scan: &Scan, start: Candidate, compare: &impl Fn([f64; 2]) -> Comparison) -> Candidate {
    let mut worst = start;
    let axes = [0, 1].into_iter().filter(|&k: &usize| scan.to[k] > scan.from[k]);
    let mut step = [0, 1].map(|k: usize| 0.5 * (scan.to[k] - scan.from[k]) / f64::from(scan.points[k].max(1)));
    let mut halvings = 0;
    while halvings < scan.refinements {
        let before = worst.error;
        for axis in axes.clone() {
            for sign in [-1.0, 1.0] {
                let mut u = worst.u;
                u[axis] = (u[axis] + sign * step[axis]).clamp(scan.from[axis], scan.to[axis]);
                worst = worst.max(Candidate::at(u, &compare(u)));
            }
        }
        if worst.error <= before {
            step = step.map(|s| 0.5 * s);
            halvings += 1;
        }
    }
    worst
}

#[derive(Clone, Copy)]
struct Candidate {
    u: [f64; 2],
    channel: usize,
    error: f64,
}

impl Candidate {
    fn at(u: [f64; 2], c: &Comparison) -> Self {
        let mut best = Self { u, channel: 0, error: -1.0 };
        for channel in 0..4 {
            let difference = (c.expected[channel] - c.sampled[channel]).abs();
            // A read that is not a number is infinitely wrong.
            let error = if difference.is_nan() { f64::INFINITY } else { difference };
            best = best.max(Self { u, channel, error });
        }
        best
    }

    fn max(self, other: Self) -> Self {
        if other.error > self.error { other } else { self }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn only(channel: usize, error: f64) -> Comparison {
        let expected = [0.5; 4];
        let mut sampled = expected;
        sampled[channel] += error;
        Comparison { expected, sampled }
    }

    proptest! {
        /// A cone with its tip anywhere: the scan is 100 points a side, so without the climb it would miss by up to
        /// 0.5 %; each halving of the step halves the miss.
        #[test]
        fn a_planted_worst_point_is_found(tip in [0.0..=1.0f64, 0.0..=1.0f64], channel in 0..4usize) {
            let compare = |u: [f64; 2]| only(channel, 1.0 - (u[0] - tip[0]).abs() - (u[1] - tip[1]).abs());
            let stats = measure([25, 25], [4, 4], compare, |u| vec![10.0 * u[0], u[1]]);
            prop_assert!((stats.max_abs_err - 1.0).abs() < 1e-5, "{}", stats.max_abs_err);
            prop_assert!((stats.worst.at[0] - 10.0 * tip[0]).abs() < 1e-4);
            prop_assert!((stats.worst.at[1] - tip[1]).abs() < 1e-5);
            prop_assert_eq!(stats.worst.channel, channel as u32);
            prop_assert_eq!(stats.worst.expected, 0.5);
            prop_assert!((stats.worst.sampled - 1.5).abs() < 1e-5);
        }
    }

    /// The error |u| has rms 1/sqrt(3) and a 99th percentile of 0.99; the midpoint rule over 1000 points is good to 1e-6.
    #[test]
    fn statistics_of_a_ramp() {
        let scan = Scan { nodes: [0, 0], ..Scan::whole([100, 0], [10, 0]) };
        let stats = measure_scan(&scan, |u| only(2, -u[0]), |u| vec![u[0]]);
        assert_eq!(stats.points, 1000);
        assert!((stats.rms_err - (1.0f64 / 3.0).sqrt()).abs() < 1e-6);
        assert!((stats.p99_abs_err - 0.9895).abs() < 1e-9, "{}", stats.p99_abs_err);
        assert!((stats.max_abs_err - 1.0).abs() < 1e-5);
        assert_eq!((stats.worst.at.len(), stats.worst.channel), (1, 2));
    }

    /// Every node of the table is a point, and so are points all between them.
    #[test]
    fn a_scan_has_all_nodes_and_points_between() {
        let (cells, per_cell) = ([7, 3], [4, 5]);
        let scanned: Vec<[f64; 2]> = Scan::whole(cells, per_cell).coordinates().collect();
        assert_eq!(scanned.len(), 7 * 4 * 3 * 5 + 8 * 4);
        let places = |u: &[f64; 2]| [0, 1].map(|k: usize| u[k] * f64::from(cells[k]));
        let (between, nodes) = scanned.split_at(7 * 4 * 3 * 5);
        // The nearest points lie half a step from a node: a tenth of a cell at five points per cell.
        assert!(between.iter().flat_map(places).all(|place| (place - place.round()).abs() > 0.099));
        for (n, u) in nodes.iter().enumerate() {
            let [i, j] = places(u);
            assert!((i - (n % 8) as f64).abs() < 1e-12 && (j - (n / 8) as f64).abs() < 1e-12, "{u:?}");
        }
    }

    /// A table that errs at its nodes alone, as a balanced one does where its function has a kink.
    #[test]
    fn an_error_at_a_node_is_found() {
        let spike = |u: [f64; 2]| only(1, (1.0 - 1e5 * (u[0] - 0.3).abs()).max(0.0));
        let stats = measure([10, 0], [16, 0], spike, |u| vec![u[0]]);
        assert!((stats.max_abs_err - 1.0).abs() < 1e-9 && (stats.worst.at[0] - 0.3).abs() < 1e-9, "{stats:?}");
    }

    #[test]
    fn slack_is_named_and_counts_in_every_figure() {
        let stats = measure([100, 0], [10, 0], |u| only(2, 0.3 * u[0]), |u| vec![u[0]]);
        let with = stats.clone().with_slack(0.5, 0.4);
        let difference = (with.worst.expected - with.worst.sampled).abs();
        assert_eq!((with.slack, with.max_abs_err), (0.5, difference + 0.5));
        assert_eq!(with.p99_abs_err, stats.p99_abs_err + 0.5);
        assert!((with.rms_err * with.rms_err - stats.rms_err * stats.rms_err - 0.16).abs() < 1e-12);
    }

    #[test]
    fn points_by_themselves_are_measured_alone() {
        let points = [0.1, -0.4, 0.2].map(|error| (vec![10.0 * error], only(3, error)));
        let stats = measure_at(points);
        assert!((stats.max_abs_err - 0.4).abs() < 1e-15 && stats.worst.channel == 3 && stats.points == 3);
        assert_eq!(stats.worst.at, [-4.0]);
        assert!((stats.rms_err - 0.07f64.sqrt()).abs() < 1e-12);
        assert_eq!(measure_at([]).max_abs_err, 0.0);
        let more = measure_at([(vec![9.0], only(0, 2.0))]);
        let both = stats.clone().with_worst_of(more);
        assert_eq!((both.max_abs_err, both.rms_err, both.points, both.worst.at[0]), (2.0, stats.rms_err, 4, 9.0));
        assert_eq!(stats.clone().with_worst_of(measure_at([])), stats);
    }

    #[test]
    fn not_a_number_is_infinitely_wrong() {
        let compare = |u: [f64; 2]| only(1, if u[0] > 0.7 { f64::NAN } else { 0.0 });
        let stats = measure([10, 0], [3, 0], compare, |u| vec![u[0]]);
        assert_eq!(stats.max_abs_err, f64::INFINITY);
        assert_eq!(stats.worst.channel, 1);
    }

    #[test]
    fn a_partial_scan_stays_inside() {
        let scan = Scan { points: [10, 0], from: [0.25, 0.5], to: [0.5, 0.5], nodes: [8, 0], refinements: 8 };
        let compare = |u: [f64; 2]| {
            assert!((0.25..=0.5).contains(&u[0]) && u[1] == 0.5, "{u:?}");
            only(3, u[0])
        };
        let stats = measure_scan(&scan, compare, |u| vec![u[0]]);
        assert_eq!(stats.points, 10 + 3, "nodes at 2, 3 and 4 eighths");
        // The climb goes to the border, where the error is largest.
        assert!((stats.max_abs_err - 0.5).abs() < 1e-3);
    }

    #[test]
    fn an_empty_scan_still_looks_once() {
        assert_eq!(measure([0, 0], [0, 0], |_| only(0, 0.25), |u| u.to_vec()).points, 1);
    }
}
