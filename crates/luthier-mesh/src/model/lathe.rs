//! Curves turned about the vertical axis.

use std::f64::consts::PI;

/// Radius of the ball.
pub(super) const OUTER: f64 = 0.8;

/// Length along a curve after which texture coordinates repeat: half a turn over the ball.
const REPEAT: f64 = PI * OUTER;

/// A point of a half section: distance from the axis and height.
type Point = [f64; 2];

/// A smooth piece of a half section: points, normals, and lengths along it. Outside is to the right of its course.
pub(super) struct Curve {
    points: Vec<(Point, Point, f64)>,
}

impl Curve {
    pub(super) fn line(from: Point, to: Point) -> Self {
        let [dr, dy] = [to[0] - from[0], to[1] - from[1]];
        let length = libm::sqrt(dr * dr + dy * dy);
        let normal = [dy / length, -dr / length];
        Self { points: vec![(from, normal, 0.0), (to, normal, length)] }
    }

    /// Part of a circle. Angles count from the outside up. Falling angles make a hollow curve.
    pub(super) fn arc(centre: Point, radius: f64, [from, to]: [f64; 2], rows: u32) -> Self {
        let sign = if to > from { 1.0 } else { -1.0 };
        let points = (0..=rows).map(|i| {
            let angle = from + (to - from) * f64::from(i) / f64::from(rows);
            let (sin, cos) = libm::sincos(angle);
            // Poles are on the axis, not beside it.
            let r = centre[0] + radius * cos;
            let r = if r.abs() < 1e-9 { 0.0 } else { r };
            ([r, centre[1] + radius * sin], [sign * cos, sign * sin], radius * (angle - from).abs())
        });
        Self { points: points.collect() }
    }

    /// The other side.
    pub(super) fn reversed(self) -> Self {
        let length = self.points.last().map_or(0.0, |point| point.2);
        Self { points: self.points.into_iter().rev().map(|(at, n, s)| (at, n.map(|v| -v), length - s)).collect() }
    }
}

/// Vertices and triangles of one material.
#[derive(Default)]
pub(super) struct Part {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) tangents: Vec<[f32; 4]>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Part {
    fn push(&mut self, position: [f64; 3], normal: [f64; 3], tangent: [f64; 4], uv: [f64; 2]) -> u32 {
        self.positions.push(position.map(|v| v as f32));
        self.normals.push(normal.map(|v| v as f32));
        self.tangents.push(tangent.map(|v| v as f32));
        self.uvs.push(uv.map(|v| v as f32));
        self.positions.len() as u32 - 1
    }

    /// Adds the surface that curves sweep between two azimuths, which count from +z towards +x. `u` is the azimuth, `v`
    /// falls upwards along the curves.
    pub(super) fn turned(&mut self, curves: &[Curve], [from, to]: [f64; 2], columns: u32) {
        let mut start = 0.0;
        for curve in curves {
            let rows = curve.points.len() as u32;
            let first = self.positions.len() as u32;
            for column in 0..=columns {
                let azimuth = from + (to - from) * f64::from(column) / f64::from(columns);
                let (sin, cos) = libm::sincos(azimuth);
                for &([r, y], [nr, ny], s) in &curve.points {
                    let uv = [0.5 + azimuth / (2.0 * PI), 1.0 - (start + s) / REPEAT];
                    self.push([r * sin, y, r * cos], [nr * sin, ny, nr * cos], [cos, 0.0, -sin, 1.0], uv);
                }
            }
            for (column, row) in (0..columns).flat_map(|column| (0..rows - 1).map(move |row| (column, row))) {
                let [a, b, c, d] =
                    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[dc, dr]| first + (column + dc) * rows + row + dr);
                if curve.points[row as usize].0[0] != 0.0 {
                    self.triangles.push([a, b, c]);
                }
                if curve.points[row as usize + 1].0[0] != 0.0 {
                    self.triangles.push([a, c, d]);
                }
            }
            start += curve.points.last().map_or(0.0, |point| point.2);
        }
    }

    /// Adds the flat face between two curves at an azimuth. Forward is the direction of growing azimuths. Tangents lead
    /// away from the axis.
    pub(super) fn face(&mut self, outer: &Curve, inner: &Curve, azimuth: f64, faces_forward: bool) {
        let (sin, cos) = libm::sincos(azimuth);
        let sign = if faces_forward { 1.0 } else { -1.0 };
        let first = self.positions.len() as u32;
        for ((outer, ..), (inner, ..)) in outer.points.iter().zip(&inner.points) {
            for &[r, y] in [outer, inner] {
                // Seen from in front, the axis is on the right of a face that looks forward; the picture stays upright.
                let uv = [-sign * r / REPEAT, 1.0 - y / REPEAT];
                let tangent = [-sign * sin, 0.0, -sign * cos, 1.0];
                self.push([r * sin, y, r * cos], [sign * cos, 0.0, -sign * sin], tangent, uv);
            }
        }
        for row in 0..outer.points.len() as u32 - 1 {
            let [a, b, c, d] = [0, 1, 3, 2].map(|corner| first + 2 * row + corner);
            let quad = if faces_forward { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
            self.triangles.extend(quad);
        }
    }
}
