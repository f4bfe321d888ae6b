//! A tree of boxes about triangles, flat, for rays on the host and on a device.

use crate::vector::{V, along, cross, dot, sub};

/// Triangles of a leaf at most.
const LEAF_MAX: usize = 4;

/// Number of slabs of the box of centres; cuts lie between two of them.
const BINS: usize = 16;

/// A box, in depth-first order: the first child of an inner node follows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Lower corner.
    pub low: [f32; 3],
    /// Upper corner.
    pub high: [f32; 3],
    /// The next node if the ray misses the box, or after a leaf; the number of nodes at the end.
    pub next: u32,
    /// First triangle of a leaf.
    pub first: u32,
    /// Triangles of a leaf; 0 for inner nodes.
    pub count: u32,
}

/// A tree of boxes about triangles.
///
/// A cut is the one of the least surface area (MacDonald and Booth 1990) among sixteen slabs of the widest axis of the
/// centres. The tree depends on its triangles alone.
///
/// ```
/// use luthier_mesh::Bvh;
///
/// let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let (bvh, _) = Bvh::new(&[triangle]);
/// let meeting = bvh.nearest([0.25, 0.25, 2.0], [0.0, 0.0, -1.0], 10.0, |_| Some(triangle)).unwrap();
/// assert!((meeting.t - 2.0).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Bvh {
    nodes: Vec<Node>,
}

/// A triangle that a ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Number of the triangle, in the order of leaves.
    pub triangle: u32,
    /// Weights of its second and third corner.
    pub weights: [f32; 2],
}

#[derive(Clone, Copy)]
struct Bounds {
    low: V,
    high: V,
}

impl Bounds {
    const NONE: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn with(self, other: Self) -> Self {
        Self {
            low: [0, 1, 2].map(|c| self.low[c].min(other.low[c])),
            high: [0, 1, 2].map(|c| self.high[c].max(other.high[c])),
        }
    }

    fn of(points: &[V]) -> Self {
        points.iter().fold(Self::NONE, |sum, &point| sum.with(Self { low: point, high: point }))
    }

    /// Half the surface area.
    fn area(&self) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|c| f64::from(self.high[c]) - f64::from(self.low[c]));
        if x < 0.0 { 0.0 } else { x * y + y * z + z * x }
    }
}

struct Builder<'a> {
    bounds: &'a [Bounds],
    centres: &'a [V],
    nodes: Vec<Node>,
}

impl Bvh {
    /// The tree of triangles, and the order of the triangles in its leaves.
    pub fn new(corners: &[[[f32; 3]; 3]]) -> (Self, Vec<u32>) {
        let bounds: Vec<Bounds> = corners.iter().map(|corners| Bounds::of(corners)).collect();
        let centres: Vec<V> = bounds.iter().map(|b| [0, 1, 2].map(|c| 0.5 * b.low[c] + 0.5 * b.high[c])).collect();
        let mut order: Vec<u32> = (0..corners.len() as u32).collect();
        let mut builder = Builder { bounds: &bounds, centres: &centres, nodes: Vec::new() };
        if !order.is_empty() {
            builder.build(&mut order, 0);
        }
        (Self { nodes: builder.nodes }, order)
    }

    /// The nodes; the first is the root.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The nearest triangle that a ray meets between 0 and `farthest`. `corners` returns the corners of a triangle, or
    /// `None` to let the ray pass through it.
    pub fn nearest(
        &self,
        origin: [f32; 3],
        direction: [f32; 3],
        farthest: f32,
        corners: impl Fn(u32) -> Option<[[f32; 3]; 3]>,
    ) -> Option<Meeting> {
        let inverse = direction.map(|v| 1.0 / if v.abs() < 1e-12 { 1e-12 } else { v });
        let mut best: Option<Meeting> = None;
        let mut at = 0;
        while let Some(node) = self.nodes.get(at as usize) {
            let limit = best.map_or(farthest, |meeting| meeting.t);
            if !meets(node, origin, inverse, limit) {
                at = node.next;
                continue;
            }
            for triangle in node.first..node.first + node.count {
                let limit = best.map_or(farthest, |meeting| meeting.t);
                let Some(corners) = corners(triangle) else { continue };
                if let Some((t, weights)) = meeting(corners, origin, direction).filter(|(t, _)| *t > 0.0 && *t < limit)
                {
                    best = Some(Meeting { t, triangle, weights });
                }
            }
            at = if node.count > 0 { node.next } else { at + 1 };
        }
        best
    }
}

fn meets(node: &Node, origin: V, inverse: V, limit: f32) -> bool {
    let (mut near, mut far) = (0.0f32, limit);
    for c in 0..3 {
        let (a, b) = ((node.low[c] - origin[c]) * inverse[c], (node.high[c] - origin[c]) * inverse[c]);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    // Rounding may make slabs too small: a little more, so that no ray slips through.
    near <= far * 1.000_001 + 1e-9
}

/// Distance and weights at the meeting of a line and a triangle.
///
/// The corners are seen across the line. Edges that triangles share have areas that differ in sign alone, so no line
/// slips through between them (Woop et al. 2013).
fn meeting(corners: [V; 3], origin: V, direction: V) -> Option<(f32, [f32; 2])> {
    let length_sq = dot(direction, direction);
    let places = corners.map(|corner| {
        let to = sub(corner, origin);
        let t = dot(to, direction) / length_sq;
        (along(to, -t, direction), t)
    });
    let areas = [[2, 1], [0, 2], [1, 0]].map(|[i, j]: [usize; 2]| dot(direction, cross(places[i].0, places[j].0)));
    let sum: f32 = areas.iter().sum();
    let is_inside = areas.iter().all(|area| area / sum >= -2e-6);
    if !is_inside || sum == 0.0 {
        return None;
    }
    let t = (0..3).map(|i| areas[i] * places[i].1).sum::<f32>() / sum;
    Some((t, [areas[1] / sum, areas[2] / sum]))
}

impl Builder<'_> {
    /// Appends the nodes of some triangles. `first` is the number of the first one in the order of leaves.
    fn build(&mut self, order: &mut [u32], first: u32) {
        let bounds = order.iter().fold(Bounds::NONE, |sum, &i| sum.with(self.bounds[i as usize]));
        let place = self.nodes.len();
        let Bounds { low, high } = bounds;
        self.nodes.push(Node { low, high, next: 0, first, count: order.len() as u32 });
        if order.len() > LEAF_MAX {
            let middle = self.cut(order);
            self.nodes[place] = Node { first: 0, count: 0, ..self.nodes[place] };
            let (left, right) = order.split_at_mut(middle);
            self.build(left, first);
            self.build(right, first + middle as u32);
        }
        self.nodes[place].next = self.nodes.len() as u32;
    }

    /// Parts triangles in two, and returns the number of those in the first part.
    fn cut(&self, order: &mut [u32]) -> usize {
        let half = order.len() / 2;
        let centres = order.iter().fold(Bounds::NONE, |sum, &i| {
            let at = self.centres[i as usize];
            sum.with(Bounds { low: at, high: at })
        });
        let extent = sub(centres.high, centres.low);
        let axis = (1..3).fold(0, |widest, c| if extent[c] > extent[widest] { c } else { widest });
        if extent[axis] <= 0.0 || !extent[axis].is_finite() {
            return half;
        }
        let mut bins = [(Bounds::NONE, 0usize); BINS];
        for &i in order.iter() {
            let (bounds, count) = &mut bins[self.bin(i, &centres, axis)];
            (*bounds, *count) = (bounds.with(self.bounds[i as usize]), *count + 1);
        }
        let costs = (1..BINS).filter_map(|at| Some((at, cost(&bins[..at])? + cost(&bins[at..])?)));
        let Some((at, _)) = costs.min_by(|a, b| a.1.total_cmp(&b.1)) else { return half };
        // A stable sort: the order of the file decides among equals.
        order.sort_by_key(|&i| self.bin(i, &centres, axis) >= at);
        order.iter().filter(|&&i| self.bin(i, &centres, axis) < at).count()
    }

    /// The slab that has the centre of a triangle, along an axis of the box of centres.
    fn bin(&self, triangle: u32, centres: &Bounds, axis: usize) -> usize {
        let extent = centres.high[axis] - centres.low[axis];
        let share = (self.centres[triangle as usize][axis] - centres.low[axis]) / extent;
        ((share * BINS as f32) as usize).min(BINS - 1)
    }
}

/// Half the area around the triangles of some slabs, times their number; none without triangles.
fn cost(bins: &[(Bounds, usize)]) -> Option<f64> {
    let all = bins.iter().fold((Bounds::NONE, 0), |(b, n), (bounds, count)| (b.with(*bounds), n + count));
    (all.1 > 0).then(|| all.0.area() * all.1 as f64)
}
