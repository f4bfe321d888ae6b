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
    /// What a sampled read gives.
    pub sampled: f64,
}

/// Measured absolute error of a sampled table against the function it stands for, over all channels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorStats {
    /// Largest, after local refinement around the worst point of the scan.
    pub max_abs_err: f64,
    /// Root mean square over the scan.
    pub rms_err: f64,
    /// 99th percentile over the scan.
    pub p99_abs_err: f64,
    /// Where the largest is.
    pub worst: Worst,
    /// Points of the scan, all off the nodes.
    pub points: u64,
}

/// Where to compare a table with its function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan {
    /// Points along each axis, in the middle of equal intervals of `u`; 1 (as 0 is) along an axis that the table lacks.
    pub points: [u32; 2],
    /// Lowest coordinate `u` along each axis.
    pub from: [f64; 2],
    /// Highest coordinate `u` along each axis; equal to `from` along an axis that the table lacks.
    pub to: [f64; 2],
    /// Halvings of the search radius around the worst point.
    pub refinements: u32,
}

impl Scan {
    /// Halvings that functions in closed form can afford.
    pub const REFINEMENTS: u32 = 12;

    /// The whole table: `per_cell[k]` points in each of `cells[k]` intervals between nodes; a one-axis table has
    /// `cells[1] == 0`.
    pub fn whole(cells: [u32; 2], per_cell: [u32; 2]) -> Self {
        let has = |k: usize| cells[k] > 0;
        Self {
            points: [0, 1].map(|k: usize| (cells[k] * per_cell[k]).max(1)),
            from: [0, 1].map(|k: usize| if has(k) { 0.0 } else { 0.5 }),
            to: [0, 1].map(|k: usize| if has(k) { 1.0 } else { 0.5 }),
            refinements: Self::REFINEMENTS,
        }
    }

    /// Coordinate of a point of the scan.
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
    compare: impl Fn([f64; 2]) -> Comparison,
    axis_values: impl Fn([f64; 2]) -> Vec<f64>,
) -> ErrorStats {
    measure_scan(&Scan::whole(cells, per_cell), compare, axis_values)
}

/// Compares a table with its function at the points of a scan, then climbs from the worst of them, each to its local maximum,
/// halving the step whenever no neighbour is worse. Quantised texels and weights make the error a saw: one climb would stop
/// at the nearest tooth.
///
/// `compare` receives coordinates `u` in 0..=1; `axis_values` turns the worst `u` into what is reported. The scan
/// is sequential and sums in a fixed order: the result does not depend on threads.
pub fn measure_scan(
    scan: &Scan,
    compare: impl Fn([f64; 2]) -> Comparison,
    axis_values: impl Fn([f64; 2]) -> Vec<f64>,
) -> ErrorStats {
    let counts = scan.points.map(|n| n.max(1));
    let mut errors = Vec::with_capacity(counts[0] as usize * counts[1] as usize);
    let mut sum_of_squares = 0.0;
    let mut starts: Vec<Candidate> = Vec::with_capacity(CLIMBS + 1);
    for j in 0..counts[1] {
        for i in 0..counts[0] {
            let candidate = Candidate::at(scan.coordinate([i, j]), &compare);
            sum_of_squares += candidate.error * candidate.error;
            errors.push(candidate.error);
            // The worst first; of equals the first.
            let place = starts.partition_point(|s| s.error >= candidate.error);
            starts.insert(place, candidate);
            starts.truncate(CLIMBS);
        }
    }
    let nothing = Candidate { u: [0.5, 0.5], channel: 0, error: -1.0 };
    let worst = starts.into_iter().map(|start| climb(scan, start, &compare)).fold(nothing, Candidate::max);

    let points = errors.len();
    errors.sort_by(f64::total_cmp);
    let rank = (points * 99).div_ceil(100).clamp(1, points) - 1;
    let at_worst = compare(worst.u);
    ErrorStats {
        max_abs_err: worst.error,
        rms_err: (sum_of_squares / points as f64).sqrt(),
        p99_abs_err: errors[rank],
        worst: Worst {
            at: axis_values(worst.u),
            channel: worst.channel as u32,
            expected: at_worst.expected[worst.channel],
            sampled: at_worst.sampled[worst.channel],
        },
        points: points as u64,
    }
}

/// From a point to a local maximum of the error.
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
                worst = worst.max(Candidate::at(u, compare));
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
    fn at(u: [f64; 2], compare: &impl Fn([f64; 2]) -> Comparison) -> Self {
        let c = compare(u);
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
        let stats = measure([100, 0], [10, 0], |u| only(2, -u[0]), |u| vec![u[0]]);
        assert_eq!(stats.points, 1000);
        assert!((stats.rms_err - (1.0f64 / 3.0).sqrt()).abs() < 1e-6);
        assert!((stats.p99_abs_err - 0.9895).abs() < 1e-9, "{}", stats.p99_abs_err);
        assert!((stats.max_abs_err - 1.0).abs() < 1e-5);
        assert_eq!((stats.worst.at.len(), stats.worst.channel), (1, 2));
    }

    #[test]
    fn no_point_of_the_scan_is_a_node() {
        let (cells, per_cell) = ([7, 3], [4, 5]);
        let scanned = std::cell::RefCell::new(Vec::new());
        let compare = |u: [f64; 2]| {
            scanned.borrow_mut().push(u);
            only(0, 0.0)
        };
        let stats = measure(cells, per_cell, compare, |u| u.to_vec());
        assert_eq!(stats.points, 7 * 4 * 3 * 5);
        for u in &scanned.borrow()[..stats.points as usize] {
            for axis in 0..2 {
                // The nearest points lie half a step from a node: a tenth of a cell at five points per cell.
                let node = u[axis] * f64::from(cells[axis]);
                assert!((node - node.round()).abs() > 0.099, "{u:?}");
            }
        }
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
        let scan = Scan { points: [10, 0], from: [0.25, 0.5], to: [0.5, 0.5], refinements: 8 };
        let compare = |u: [f64; 2]| {
            assert!((0.25..=0.5).contains(&u[0]) && u[1] == 0.5, "{u:?}");
            only(3, u[0])
        };
        let stats = measure_scan(&scan, compare, |u| vec![u[0]]);
        assert_eq!(stats.points, 10);
        // The climb goes to the border, where the error is largest.
        assert!((stats.max_abs_err - 0.5).abs() < 1e-3);
    }

    #[test]
    fn an_empty_scan_still_looks_once() {
        assert_eq!(measure([0, 0], [0, 0], |_| only(0, 0.25), |u| u.to_vec()).points, 1);
    }
}
