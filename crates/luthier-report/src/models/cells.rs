//! The hemisphere of light directions in cells around the mirror direction.
//!
//! The half vector between light and eye gives the coordinates of a light direction: theta_h, its polar angle against the normal, which is 0
//! for the mirror direction, and phi_h, its azimuth against the plane of the eye. Rings of theta_h grow by the square root of two, so that lobes of
//! every width fall into several rings. The innermost ring is a disc; each other ring has eight sectors of phi_h. In these coordinates a lobe looks
//! much alike at all angles.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

/// Outer edges of the rings of theta_h, degrees.
pub(super) const RINGS_DEG: [f64; 16] =
    [0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0, 22.0, 32.0, 45.0, 64.0, 90.0];

/// Sectors of a ring; the first is centred on the azimuth of the eye.
pub(super) const SECTORS: usize = 8;

/// Number of cells.
pub(super) const CELLS: usize = 1 + (RINGS_DEG.len() - 1) * SECTORS;

/// Edges inside the innermost ring, for integration only. They resolve the narrowest lobes (5e-5 rad is 0.003 degrees).
const INNER_DEG: [f64; 6] = [0.0, 5e-4, 2e-3, 8e-3, 0.03, 0.125];

/// The cells for an eye above the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    pub(super) wo: DVec3,
    cos_phi: f64,
    sin_phi: f64,
    /// Light is above the horizon at every phi_h up to the first of these theta_h, and at no phi_h beyond the second.
    horizon: [f64; 2],
}

/// A piece of a cell: intervals of theta_h and phi_h, radians.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    pub(super) cell: usize,
    theta: [f64; 2],
    phi: [f64; 2],
}

/// A point of the hemisphere of light directions, with its share of the solid angle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) wi: DVec3,
    pub(super) solid_angle: f64,
}

impl Patch {
    /// Whether the patch is on the left of the plane of the eye. The right side has its mirror image.
    pub(super) fn is_left(&self) -> bool {
        self.phi[0] >= 0.0
    }
}

impl Cells {
    pub(super) fn new(wo: DVec3) -> Self {
        let sin = libm::hypot(wo.x, wo.y);
        let (cos_phi, sin_phi) = if sin > 0.0 { (wo.x / sin, wo.y / sin) } else { (1.0, 0.0) };
        let theta_o = libm::atan2(sin, wo.z);
        Self { wo, cos_phi, sin_phi, horizon: [0.5 * (FRAC_PI_2 - theta_o), 0.5 * (FRAC_PI_2 + theta_o)] }
    }

    /// The cell of an upward light direction.
    pub(super) fn cell(&self, wi: DVec3) -> usize {
        let bisector = wi + self.wo;
        let x = self.cos_phi * bisector.x + self.sin_phi * bisector.y;
        let y = self.cos_phi * bisector.y - self.sin_phi * bisector.x;
        let theta_h = libm::atan2(libm::hypot(x, y), bisector.z).to_degrees();
        let ring = RINGS_DEG.partition_point(|edge| *edge <= theta_h).min(RINGS_DEG.len() - 1);
        let sector = libm::floor(libm::atan2(y, x) * (SECTORS as f64 / TAU) + 0.5);
        index(ring, sector)
    }

    /// The hemisphere in pieces for integration. Each piece lies in one cell; pieces of the innermost ring shrink towards the mirror direction.
    pub(super) fn patches(&self) -> Vec<Patch> {
        let mut edges: Vec<f64> = INNER_DEG.iter().chain(&RINGS_DEG).map(|deg| deg.to_radians()).collect();
        edges.extend(self.horizon);
        edges.retain(|edge| *edge <= self.horizon[1]);
        edges.sort_by(f64::total_cmp);
        let mut patches = Vec::new();
        for pair in edges.windows(2).filter(|pair| pair[1] > pair[0]) {
            let middle = (0.5 * (pair[0] + pair[1])).to_degrees();
            let ring = RINGS_DEG.partition_point(|edge| *edge <= middle);
            for half in -(SECTORS as i32)..SECTORS as i32 {
                let cell = index(ring, f64::from((half + 1).div_euclid(2)));
                let phi = [half, half + 1].map(|i| f64::from(i) * PI / SECTORS as f64);
                patches.push(Patch { cell, theta: [pair[0], pair[1]], phi });
            }
        }
        patches
    }

    /// The nodes of a patch for a quadrature `rule` (nodes and weights on 0..=1) along both theta_h and phi_h.
    ///
    /// `d omega_i = 4 (wo.wh) d omega_h` (Torrance and Sparrow 1967). Light is above the horizon where
    /// `cos phi_h > -cot theta_o cot 2 theta_h`: the patch ends there.
    pub(super) fn nodes(&self, patch: &Patch, rule: &[(f64, f64)], mut visit: impl FnMut(Node)) {
        let [start, end] = patch.theta;
        for (t, weight) in rule {
            let theta_h = start + (end - start) * t;
            let d_theta = (end - start) * weight;
            let phi_max = if theta_h <= self.horizon[0] {
                PI
            } else {
                let tan_o = libm::hypot(self.wo.x, self.wo.y) / self.wo.z;
                libm::acos((-1.0 / (tan_o * libm::tan(2.0 * theta_h))).clamp(-1.0, 1.0))
            };
            let [low, high] = patch.phi.map(|phi| phi.clamp(-phi_max, phi_max));
            if low >= high {
                continue;
            }
            let (sin, cos) = libm::sincos(theta_h);
            for (t, weight) in rule {
                let (sin_phi, cos_phi) = libm::sincos(low + (high - low) * t);
                let x = sin * (self.cos_phi * cos_phi - self.sin_phi * sin_phi);
                let y = sin * (self.sin_phi * cos_phi + self.cos_phi * sin_phi);
                let wh = DVec3::new(x, y, cos);
                let cos_theta_d = wh.dot(self.wo);
                let wi = (2.0 * cos_theta_d * wh - self.wo).normalize();
                visit(Node { wi, solid_angle: 4.0 * cos_theta_d * sin * d_theta * (high - low) * weight });
            }
        }
    }
}

/// The cell on the other side of the plane of the eye.
pub(super) fn mirrored(cell: usize) -> usize {
    let Some(place) = cell.checked_sub(1) else { return 0 };
    index(1 + place / SECTORS, -((place % SECTORS) as f64))
}

/// Number of a cell. Sectors may be negative or exceed a turn.
fn index(ring: usize, sector: f64) -> usize {
    if ring == 0 { 0 } else { 1 + (ring - 1) * SECTORS + (sector as i32).rem_euclid(SECTORS as i32) as usize }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::direction;
    use luthier_optics::quadrature::gauss_legendre;

    #[test]
    fn nodes_lie_in_their_cells_and_cover_the_hemisphere() {
        let rule = gauss_legendre(8);
        // None whose horizon lies on the edge of a ring, where cells are a matter of rounding.
        for theta_deg in [0.0, 30.0, 60.0, 80.0, 87.0] {
            let cells = Cells::new(direction(theta_deg, 30.0));
            let (mut solid_angle, mut projected) = (0.0, 0.0);
            for patch in cells.patches() {
                cells.nodes(&patch, &rule, |node| {
                    assert_eq!(cells.cell(node.wi), patch.cell, "{theta_deg}: {}", node.wi);
                    assert!(node.wi.z > 0.0 && node.solid_angle > 0.0);
                    solid_angle += node.solid_angle;
                    projected += node.wi.z * node.solid_angle;
                });
            }
            // Oracle: the areas of hemisphere and disc. The first does not vanish at the horizon, so it converges less well.
            assert!((solid_angle / TAU - 1.0).abs() < 2e-3, "{theta_deg}: {solid_angle}");
            assert!((projected / PI - 1.0).abs() < 1e-4, "{theta_deg}: {projected}");
        }
    }

    #[test]
    fn the_mirror_direction_is_in_the_middle_of_the_first_cell() {
        for theta_deg in [0.0, 45.0, 89.9] {
            let wo = direction(theta_deg, 200.0);
            let cells = Cells::new(wo);
            assert_eq!(cells.cell(DVec3::new(-wo.x, -wo.y, wo.z)), 0);
        }
        // Off the mirror direction in the plane of the eye, towards it and away.
        let cells = Cells::new(direction(20.0, 0.0));
        assert_eq!(cells.cell(direction(20.0, 0.0)), index(11, 0.0));
        assert_eq!(cells.cell(direction(60.0, 180.0)), index(11, 4.0));
    }
}
