//! Means of an equirectangular map over the texels of a cube.
//!
//! The integral over an area is one along its border (Green's theorem, in azimuth and height). A border is cut where it
//! crosses the middles of rows and columns; between two cuts the map is linear. Heights of the cuts are exact, and
//! neighbours share their borders: no light is lost or counted twice. The azimuth counts as linear in the height
//! between two cuts, which moves some light between neighbours.

use std::f64::consts::PI;

use luthier_lut::Image;
use rayon::prelude::*;

use crate::faces::direction;

/// An integral along a border over the height: RGB, and that of radiance 1.
type Line = [f64; 4];

/// A map, ready to be integrated. It is linear between the middles of its texels; columns go round, rows end.
pub(crate) struct Integral<'a> {
    map: &'a Image,
    /// For each row, the integral of radiance from its left end to the middle of each column, from column -1 on.
    sums: Vec<[f64; 3]>,
    /// Cosine and sine of the azimuth of the middle of each column.
    azimuths: Vec<[f64; 2]>,
    /// The middle of each row.
    rows: Vec<Height>,
}

/// A polar angle: its cosine, and the integral of the angle over its cosine.
#[derive(Debug, Clone, Copy)]
struct Height {
    cos_theta: f64,
    moment: f64,
}

/// A place on a border. Columns and rows count in texels from the middle of the first.
#[derive(Debug, Clone, Copy)]
struct Place {
    column: f64,
    row: f64,
    height: Height,
}

/// A corner of texels.
struct Corner {
    /// Not unit.
    direction: [f64; 3],
    place: Place,
}

impl<'a> Integral<'a> {
    pub(crate) fn new(map: &'a Image) -> Self {
        let mut sums = Vec::with_capacity((map.height * (map.width + 1)) as usize);
        for y in 0..map.height {
            let row: Vec<[f64; 3]> =
                (0..map.width).map(|x| [0, 1, 2].map(|c: usize| f64::from(map.texel(x, y)[c]))).collect();
            let mut left = row[row.len() - 1];
            // The map begins half way between the last column and the first.
            let mut sum = [0, 1, 2].map(|c| -(0.375 * left[c] + 0.125 * row[0][c]));
            sums.push(sum);
            for right in row {
                (0..3).for_each(|c| sum[c] += 0.5 * (left[c] + right[c]));
                sums.push(sum);
                left = right;
            }
        }
        let azimuths = (0..map.width).map(|x| {
            let (sin, cos) = libm::sincos(2.0 * PI * ((f64::from(x) + 0.5) / f64::from(map.width) - 0.5));
            [cos, sin]
        });
        let rows = (0..map.height).map(|y| {
            let theta = PI * (f64::from(y) + 0.5) / f64::from(map.height);
            let (sin_theta, cos_theta) = libm::sincos(theta);
            Height { cos_theta, moment: theta * cos_theta - sin_theta }
        });
        Self { map, sums, azimuths: azimuths.collect(), rows: rows.collect() }
    }

    /// Means over the texels of a face of a cube of an even size, row by row.
    pub(crate) fn face(&self, face: usize, size: u32) -> Vec<[f64; 3]> {
        let size = size as usize;
        let side = size + 1;
        let corners: Vec<Corner> = (0..side * side)
            .into_par_iter()
            .map(|i| {
                let at = [i % side, i / side].map(|i| 2.0 * i as f64 / size as f64 - 1.0);
                self.corner(direction(face, at))
            })
            .collect();
        let corners: Vec<&[Corner]> = corners.chunks_exact(side).collect();
        // The ends of the map meet in the middle of faces, between texels. A line therefore belongs to the left or to
        // the right half.
        let level: Vec<Line> = (0..side * size)
            .into_par_iter()
            .map(|i| {
                let (x, y) = (i % size, i / size);
                self.line(&corners[y][x], &corners[y][x + 1], 2 * x >= size)
            })
            .collect();
        let rows = (0..size).into_par_iter().flat_map_iter(|y| {
            let mut left = [0.0; 4];
            let mut means = Vec::with_capacity(size);
            for x in 0..size {
                if x == 0 || 2 * x == size {
                    left = self.line(&corners[y][x], &corners[y + 1][x], 2 * x >= size);
                }
                let right = self.line(&corners[y][x + 1], &corners[y + 1][x + 1], 2 * x >= size);
                let (above, below) = (level[y * size + x], level[(y + 1) * size + x]);
                let [r, g, b, one]: Line = std::array::from_fn(|c| above[c] + right[c] - below[c] - left[c]);
                means.push([r, g, b].map(|sum| (sum / one).max(0.0)));
                left = right;
            }
            means
        });
        rows.collect()
    }

    fn corner(&self, direction: [f64; 3]) -> Corner {
        let (row, height) = self.row(direction);
        Corner { direction, place: Place { column: self.column(direction), row, height } }
    }

    /// The column of a direction.
    fn column(&self, [x, _, z]: [f64; 3]) -> f64 {
        (0.5 + libm::atan2(x, -z) / (2.0 * PI)) * f64::from(self.map.width) - 0.5
    }

    /// The row of a direction, and its height.
    fn row(&self, [x, y, z]: [f64; 3]) -> (f64, Height) {
        let across = (x * x + z * z).sqrt();
        let length = (across * across + y * y).sqrt();
        let theta = libm::atan2(across, y);
        let height = Height { cos_theta: y / length, moment: (theta * y - across) / length };
        (theta / PI * f64::from(self.map.height) - 0.5, height)
    }

    /// The place of a corner, seen from the right or from the left half of its face: at the seam, the column is one end
    /// of the map or the other.
    fn seen(&self, corner: &Corner, is_right: bool) -> Place {
        let mut place = corner.place;
        if corner.direction[0] == 0.0 && corner.direction[2] > 0.0 {
            place.column = if is_right { f64::from(self.map.width) - 0.5 } else { -0.5 };
        }
        place
    }

    /// The integral along the straight line between two corners of a texel, in the right or the left half of its face.
    /// Along the line neither columns nor rows turn back.
    fn line(&self, from: &Corner, to: &Corner, is_right: bool) -> Line {
        let [mut a, mut b] = [from, to].map(|corner| self.seen(corner, is_right));
        let (from, to) = (from.direction, to.direction);
        let [from_pole, to_pole] = [from, to].map(|[x, _, z]| x == 0.0 && z == 0.0);
        if from_pole {
            a.column = b.column;
        }
        if to_pole {
            b.column = a.column;
        }
        let step = [0, 1, 2].map(|c| to[c] - from[c]);
        let columns = Walk::new(a.column, b.column, self.map.width).map(|column| {
            let [cos, sin] = self.azimuths[column as usize];
            let [start, end] = [from, to].map(|[x, _, z]| x * cos + z * sin);
            let share = (start / (start - end)).clamp(0.0, 1.0);
            let (row, height) = self.row([0, 1, 2].map(|c| from[c] + share * step[c]));
            (share, Place { column: f64::from(column), row, height })
        });
        let rows = Walk::new(a.row, b.row, self.map.height).map(|row| {
            let height = self.rows[row as usize];
            let share = crossing(from, step, height.cos_theta);
            // A meridian has one azimuth. At the seam of the map, only the columns of its ends tell which one.
            let column =
                if a.column == b.column { a.column } else { self.column([0, 1, 2].map(|c| from[c] + share * step[c])) };
            (share, Place { column, row: f64::from(row), height })
        });
        let (mut columns, mut rows) = (columns.peekable(), rows.peekable());
        let (mut sum, mut last) = ([0.0; 4], a);
        loop {
            let is_column = match (columns.peek(), rows.peek()) {
                (Some((column, _)), Some((row, _))) => column <= row,
                (column, _) => column.is_some(),
            };
            let Some((_, place)) = (if is_column { columns.next() } else { rows.next() }) else { break };
            self.add(&mut sum, &last, &place);
            last = place;
        }
        self.add(&mut sum, &last, &b);
        sum
    }

    /// Adds the integral between two neighbouring places.
    fn add(&self, sum: &mut Line, a: &Place, b: &Place) {
        let last = self.map.height - 1;
        let rise = b.height.cos_theta - a.height.cos_theta;
        let above = (0.5 * (a.row + b.row)).floor();
        let row = above.clamp(0.0, f64::from(last)) as u32;
        // The share of the row below.
        let share = if above < 0.0 || row == last {
            0.0
        } else {
            f64::from(self.map.height) / PI * (b.height.moment - a.height.moment) - (above + 0.5) * rise
        };
        let middle = 0.5 * (a.column + b.column);
        let left = middle.floor();
        let [start, half, end] = [a.column, middle, b.column].map(|column| column - left);
        // Simpson's rule, exact for squares of places: the integrals of a linear function.
        let (first, second) =
            ((start + 4.0 * half + end) / 6.0, (start * start + 4.0 * half * half + end * end) / 12.0);
        let rows = [(row, rise - share), (row + 1, share)];
        for (row, weight) in rows.into_iter().take(if share == 0.0 { 1 } else { 2 }) {
            let [near, far] =
                [left, left + 1.0].map(|x| self.map.texel(x.rem_euclid(f64::from(self.map.width)) as u32, row));
            let before = self.sums[(row * (self.map.width + 1)) as usize + (left + 1.0) as usize];
            for c in 0..3 {
                let (near, far) = (f64::from(near[c]), f64::from(far[c]));
                sum[c] += weight * (before[c] + first * near + second * (far - near));
            }
        }
        sum[3] += rise * (left + first + 0.5);
    }
}

/// Whole numbers from 0 to below a count, between two numbers and in their order.
struct Walk {
    low: u32,
    high: u32,
    falls: bool,
}

impl Walk {
    fn new(from: f64, to: f64, count: u32) -> Self {
        let (low, high) = (from.min(to), from.max(to));
        let low = (low.floor() + 1.0).max(0.0) as u32;
        Self { low, high: (high.ceil().max(0.0) as u32).min(count).max(low), falls: from > to }
    }
}

impl Iterator for Walk {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        if self.low == self.high {
            return None;
        }
        if self.falls {
            self.high -= 1;
            return Some(self.high);
        }
        self.low += 1;
        Some(self.low - 1)
    }
}

/// The place, in 0 to 1, on a straight line at which the direction has this cosine to +y, if it has it once.
fn crossing(from: [f64; 3], step: [f64; 3], cos_theta: f64) -> f64 {
    let dot = crate::vector::dot;
    let cos_sq = cos_theta * cos_theta;
    let c = from[1] * from[1] - cos_sq * dot(from, from);
    let b = from[1] * step[1] - cos_sq * dot(from, step);
    let a = step[1] * step[1] - cos_sq * dot(step, step);
    let root = (b * b - a * c).max(0.0).sqrt();
    let far = -(b + root.copysign(b));
    let shares = [far / a, c / far];
    let [first, second] = shares.map(|share| {
        let beyond = (share - share.clamp(0.0, 1.0)).abs();
        let is_mirrored = (from[1] + share * step[1]) * cos_theta < -1e-9;
        if share.is_finite() { beyond + f64::from(u8::from(is_mirrored)) } else { f64::INFINITY }
    });
    let share = shares[usize::from(first >= second)];
    if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }
}
