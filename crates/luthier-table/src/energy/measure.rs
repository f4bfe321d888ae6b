//! Error of reads from a table of energy.

use luthier_lut::{Comparison, ErrorStats, Image, Scan, measure_scan};

use super::{EnergyTable, Place};
use crate::{AxisSpec, slices};

/// Points of a scan along each of one, two or three axes.
const POINTS: [u32; 3] = [512, 48, 20];
/// Points of a scan of averages over the hemisphere. They are few, because each takes a hundred albedos.
const POINTS_OF_AVERAGES: [u32; 2] = [64, 14];
/// Halvings of the climb to the worst error.
const REFINEMENTS: u32 = 6;

/// Domain over which the error of a table of energy is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyDomain {
    /// Least cosine.
    pub min_cos: f64,
    /// Least alpha.
    pub min_alpha: f64,
    /// Least and largest index.
    pub ior: [f64; 2],
}

impl EnergyDomain {
    /// Ends of the coordinate of an axis.
    fn ends(&self, axis: &AxisSpec) -> [f64; 2] {
        match axis.quantity {
            quantity if quantity.is_angle() => axis.ends_from_cosine(self.min_cos),
            quantity if quantity.is_slope() => axis.ends([self.min_alpha, 1.0]),
            _ => axis.ends(self.ior),
        }
    }
}

impl EnergyTable {
    /// The absolute error of reads (linear between the nodes of each axis, weights of 8 bits) from these texels over a
    /// domain, in every channel, against quadrature. Axis values of the worst point are the cosine, alpha and index, as
    /// far as the table has them.
    ///
    /// Points between nodes are scanned, and the worst are climbed from. Over three axes the climb stays in the worst
    /// slice.
    pub fn error(&self, texels: &Image, domain: EnergyDomain) -> ErrorStats {
        let axes = self.layout.axes();
        let ends: Vec<[f64; 2]> = axes.iter().map(|axis| domain.ends(axis)).collect();
        let is_average = !axes.iter().any(|axis| axis.quantity.is_angle());
        let points = if is_average { POINTS_OF_AVERAGES[axes.len() - 1] } else { POINTS[axes.len() - 1] };
        if let &[x, y, z] = ends.as_slice() {
            return slices::measure(points, [x, y, z], REFINEMENTS, |u| self.compare(texels, u), |u| self.named(u));
        }
        let refinements = if is_average { 1 } else { REFINEMENTS };
        let mut scan = Scan { points: [1; 2], from: [0.5; 2], to: [0.5; 2], nodes: [0, 0], refinements };
        for (k, [from, to]) in ends.into_iter().enumerate() {
            (scan.points[k], scan.from[k], scan.to[k]) = (points, from, to);
        }
        measure_scan(&scan, |[x, y]| self.compare(texels, [x, y, 0.5]), |[x, y]| self.named([x, y, 0.5]))
    }

    /// The largest error of all channels of a read at one cosine and alpha, of a table over these two.
    pub fn error_at(&self, texels: &Image, cos_theta: f64, alpha: f64) -> f64 {
        let mut u = [0.5; 3];
        for (u, axis) in u.iter_mut().zip(self.layout.axes()) {
            *u = axis.coordinate(if axis.quantity.is_angle() { libm::acos(cos_theta) } else { alpha });
        }
        let Comparison { expected, sampled } = self.compare(texels, u);
        expected.iter().zip(sampled).fold(0.0, |worst, (a, b)| (a - b).abs().max(worst))
    }

    fn place_of(&self, u: [f64; 3]) -> Place {
        self.layout.place(|k, axis| axis.canonical_of_coordinate(u[k]))
    }

    fn named(&self, u: [f64; 3]) -> Vec<f64> {
        let Place { cos_theta, alpha, ior } = self.place_of(u);
        [cos_theta, Some(alpha), ior].into_iter().flatten().collect()
    }

    fn compare(&self, texels: &Image, u: [f64; 3]) -> Comparison {
        let albedo = self.exact(self.place_of(u));
        let sampled = self.sample(texels, u);
        let mut comparison = Comparison { expected: [0.0; 4], sampled: [0.0; 4] };
        for (c, value) in self.values.iter().enumerate() {
            (comparison.expected[c], comparison.sampled[c]) = (value.of(albedo), sampled[c]);
        }
        comparison
    }

    fn sample(&self, texels: &Image, u: [f64; 3]) -> [f64; 4] {
        let mut position = [0.5; 3];
        for (k, axis) in self.layout.axes().iter().enumerate() {
            position[k] = axis.position(axis.canonical_of_coordinate(u[k]), self.size[k]);
        }
        slices::read(texels, position, self.size)
    }
}
