//! Simulated light of one view in cells of slopes.
//!
//! Cells are rings and sectors around the mirror direction, in the half vectors of a medium; rings grow geometrically. An isotropic stack
//! is its own mirror image in the plane of the eye, so that both halves count together. Cells of an anisotropic one are stretched as its lobes are.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use luthier_optics::Rgb;

use super::Shape;
use super::half_vector::{outside, refracted, slope};

const RINGS: usize = 20;
/// Sectors of half a turn, for isotropic stacks: both halves count together.
const SECTORS: usize = 12;
/// Sectors of a whole turn, for anisotropic stacks.
const SECTORS_OF_TURN: usize = 16;
/// Eighths of a turn.
const EIGHTHS: usize = 8;
/// Rings of points in the innermost disc.
const INNER: usize = 6;
/// Points of a cell along either side.
const POINTS: usize = 2;
/// Outer edge of the outermost ring, a slope; steeper light is counted in that ring.
const STEEPEST: f64 = 12.0;

/// Cells in the half vectors of a medium.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    /// Relative index of the medium.
    pub(super) index: f64,
    /// Outer edge of the innermost disc.
    least: f64,
    /// Logarithm of the ratio of two edges.
    step: f64,
    /// Ellipse of slopes that cells see as a circle; `None` for isotropic stacks, whose halves count together.
    stretch: Option<Shape>,
}

/// A point of a cell, with the area and the solid angle that it stands for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) cell: usize,
    pub(super) slope: [f64; 2],
    /// Area of slopes.
    pub(super) area: f64,
    /// Cosine of the light.
    pub(super) cos_theta: f64,
    /// Solid angle of the light.
    pub(super) solid_angle: f64,
}

impl Cells {
    /// Cells for isotropic lobes of slope parameters down to `alpha`.
    pub(super) fn new(index: f64, alpha: f64) -> Self {
        let least = 0.25 * alpha;
        Self { index, least, step: libm::log(STEEPEST / least) / RINGS as f64, stretch: None }
    }

    /// Cells for lobes that are about as wide as a shape.
    pub(super) fn stretched(index: f64, shape: Shape) -> Self {
        let (least, most) = (0.25, STEEPEST / shape.width[0].min(shape.width[1]));
        Self { index, least, step: libm::log(most / least) / RINGS as f64, stretch: Some(shape) }
    }

    /// Number of cells.
    pub(super) fn count(&self) -> usize {
        1 + RINGS * self.sectors()
    }

    /// Means of values over the rings and sectors around each cell.
    pub(super) fn smoothed(&self, values: &[f64]) -> Vec<f64> {
        let sectors = self.sectors();
        let means = (0..values.len()).map(|cell| {
            // The innermost disc has no neighbours of its size.
            let Some(number) = cell.checked_sub(1) else { return values[0] };
            let (ring, sector) = (number / sectors, number % sectors);
            let around = match self.stretch {
                None => [sector.saturating_sub(1), sector, (sector + 1).min(sectors - 1)],
                Some(_) => [(sector + sectors - 1) % sectors, sector, (sector + 1) % sectors],
            };
            let rings = ring.saturating_sub(1)..(ring + 2).min(RINGS);
            let count = 3 * rings.len();
            let sum: f64 = rings.flat_map(|ring| around.map(|sector| values[1 + ring * sectors + sector])).sum();
            sum / count as f64
        });
        means.collect()
    }

    fn sectors(&self) -> usize {
        if self.stretch.is_some() { SECTORS_OF_TURN } else { SECTORS }
    }

    /// The number of the wider cell that a cell is in; wider cells have eighths of a turn as sectors.
    pub(super) fn wider(&self, cell: usize) -> usize {
        let Some(number) = cell.checked_sub(1) else { return 0 };
        let sectors = self.sectors();
        let eighths = if self.stretch.is_some() { EIGHTHS } else { EIGHTHS / 2 };
        1 + number / sectors * eighths + number % sectors * eighths / sectors
    }

    /// The cell of light from `wi` seen from `wo`. If both halves count together, `wo` has to be in the plane of x and z.
    pub(super) fn cell(&self, wi: DVec3, wo: DVec3) -> usize {
        let (at, _) = slope(wi, refracted(wi, self.index), refracted(wo, self.index), self.index);
        let ([x, y], least_angle, turn) = match &self.stretch {
            None => ([at[0], at[1].abs()], 0.0, PI),
            Some(shape) => (shape.scaled(at), PI, TAU),
        };
        let radius = libm::hypot(x, y);
        if radius < self.least {
            return 0;
        }
        let ring = ((libm::log(radius / self.least) / self.step) as usize).min(RINGS - 1);
        let sectors = self.sectors();
        let sector = (((libm::atan2(y, x) + least_angle) * (sectors as f64 / turn)) as usize).min(sectors - 1);
        1 + ring * sectors + sector
    }

    /// Points of all cells from which light reaches `wo`.
    pub(super) fn points(&self, wo: DVec3) -> Vec<Point> {
        let eye = refracted(wo, self.index);
        let mut points = Vec::new();
        let turn = if self.stretch.is_some() { TAU } else { PI };
        let sectors = self.sectors();
        for sector in 0..sectors {
            let phi = [sector, sector + 1].map(|i| i as f64 * turn / sectors as f64);
            for i in 0..INNER {
                points.extend(self.point(0, [i, i + 1].map(|i| self.least * i as f64 / INNER as f64), phi, eye));
            }
            for ring in 0..RINGS {
                let cell = 1 + ring * sectors + sector;
                for i in 0..POINTS {
                    let radius = [i, i + 1]
                        .map(|i| self.least * libm::exp(self.step * (ring as f64 + i as f64 / POINTS as f64)));
                    for j in 0..POINTS {
                        let phi = [j, j + 1].map(|j| phi[0] + (phi[1] - phi[0]) * j as f64 / POINTS as f64);
                        points.extend(self.point(cell, radius, phi, eye));
                    }
                }
            }
        }
        points
    }

    /// The light that a function `f cos_theta_i` of the light direction sends to `wo`, by cell.
    pub(super) fn light(&self, wo: DVec3, of: impl Fn(DVec3) -> Rgb) -> Vec<Rgb> {
        let eye = refracted(wo, self.index);
        let mut light = vec![[0.0; 3]; self.count()];
        for point in self.points(wo) {
            let Some(wi) = outside(point.slope, eye, self.index) else { continue };
            let value = of(wi);
            (0..3).for_each(|c| light[point.cell][c] += value[c] * point.solid_angle);
        }
        light
    }

    /// The middle of a part of a cell, between two radii and two angles; `None` if light from there does not leave the medium.
    fn point(&self, cell: usize, radius: [f64; 2], phi: [f64; 2], eye: DVec3) -> Option<Point> {
        let mut area = (radius[1] * radius[1] - radius[0] * radius[0]) * (phi[1] - phi[0]);
        // The mean of the squared radius over the area.
        let middle = (0.5 * (radius[0] * radius[0] + radius[1] * radius[1])).sqrt();
        let least_angle = if self.stretch.is_some() { PI } else { 0.0 };
        let (sin, cos) = libm::sincos(0.5 * (phi[0] + phi[1]) - least_angle);
        let mut at = [middle * cos, middle * sin];
        if let Some(shape) = &self.stretch {
            at = shape.unscaled(at);
            // The area above stands for both halves of an isotropic stack; here either half has its own points.
            area *= 0.5 * shape.width[0] * shape.width[1];
        }
        let wi = outside(at, eye, self.index)?;
        let (_, factor) = slope(wi, refracted(wi, self.index), eye, self.index);
        Some(Point { cell, slope: at, area, cos_theta: wi.z, solid_angle: area / factor })
    }
}

/// Mean of the channels.
pub(super) fn mean(rgb: Rgb) -> f64 {
    rgb.iter().sum::<f64>() / 3.0
}

/// Bins of cosines in which the light of a Lambertian base is counted.
pub(super) const COSINES: usize = 64;

/// Light of one view: light of one facet of the first interface, light of a Lambertian base, and the rest in cells.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    /// Energy by cell and channel, for each set of cells.
    pub(super) rest: Vec<Vec<Rgb>>,
    /// Sum of all cells.
    pub(super) total: Rgb,
    /// Energy of the light that met one facet alone, in closed form.
    pub(super) first_facet: Rgb,
    /// Energy of the light that met the diffuse base.
    pub(super) base: Rgb,
    /// Energy of the light that met the diffuse base exactly once.
    pub(super) base_once: Rgb,
    /// Energy of a Lambertian base by the cosine of the light, the mean of the channels; `None` for another base, whose light is in the cells.
    pub(super) by_cosine: Option<[f64; COSINES]>,
    /// Sum of the squared energies of the paths in cells, means of the channels.
    squares: f64,
}

impl Tally {
    /// A tally without light, for a stack with or without a Lambertian base.
    pub(super) fn new(sets: &[Cells], is_lambertian: bool) -> Self {
        let rest = sets.iter().map(|cells| vec![[0.0; 3]; cells.count()]).collect();
        let (none, by_cosine) = ([0.0; 3], is_lambertian.then_some([0.0; COSINES]));
        Self { rest, total: none, first_facet: none, base: none, base_once: none, by_cosine, squares: 0.0 }
    }

    /// Counts light that has met more than one facet or interface. `base_visits` says how often it met a diffuse base.
    pub(super) fn add(&mut self, cells: &[Cells], [wi, wo]: [DVec3; 2], weight: Rgb, base_visits: u32) {
        let mean = mean(weight);
        if base_visits > 0 {
            self.base = plus(self.base, weight);
        }
        if base_visits == 1 {
            self.base_once = plus(self.base_once, weight);
        }
        if let Some(by_cosine) = self.by_cosine.as_mut().filter(|_| base_visits > 0) {
            by_cosine[((wi.z * COSINES as f64) as usize).min(COSINES - 1)] += mean;
            return;
        }
        self.total = plus(self.total, weight);
        self.squares += mean * mean;
        for (cells, rest) in cells.iter().zip(&mut self.rest) {
            let cell = &mut rest[cells.cell(wi, wo)];
            *cell = plus(*cell, weight);
        }
    }

    /// Energy of a Lambertian base, which is in no cell.
    pub(super) fn of_lambertian(&self) -> Rgb {
        if self.by_cosine.is_some() { self.base } else { [0.0; 3] }
    }

    /// Effective number of paths in cells: so many equal paths would have the noise of their sum.
    pub(super) fn paths(&self) -> f64 {
        let total = mean(self.total);
        if self.squares > 0.0 { total * total / self.squares } else { 0.0 }
    }
}

fn plus(a: Rgb, b: Rgb) -> Rgb {
    [0, 1, 2].map(|c: usize| a[c] + b[c])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_smoothed_over_those_around_them() {
        let round = Shape { middle: [0.0; 2], width: [0.3; 2], turn: [1.0, 0.0], tail: 0.0 };
        for cells in [Cells::new(1.0, 0.2), Cells::stretched(1.0, round)] {
            let sectors = cells.sectors();
            let mut values = vec![0.0; cells.count()];
            values[1 + 4 * sectors] = 9.0;
            let smoothed = cells.smoothed(&values);
            // Where both halves count together, the first sector is its own neighbour.
            let (own, behind) = if cells.stretch.is_none() { (2.0, 0.0) } else { (1.0, 1.0) };
            let at = |ring: usize, sector: usize| smoothed[1 + ring * sectors + sector];
            assert_eq!([at(4, 0), at(3, 0), at(5, 1), at(4, sectors - 1), at(6, 0)], [own, own, 1.0, behind, 0.0]);
            assert_eq!(cells.smoothed(&vec![2.0; cells.count()]), vec![2.0; cells.count()]);
        }
    }

    /// Oracle: the solid angle and the projected area of the hemisphere.
    #[test]
    fn points_cover_the_hemisphere() {
        let long = Shape { middle: [0.0; 2], width: [0.6, 0.1], turn: [0.8, 0.6], tail: 0.0 };
        for cells in [1.0, 1.6].into_iter().flat_map(|n| [Cells::new(n, 0.2), Cells::stretched(n, long)]) {
            let index = cells.index;
            for cos_theta in [1.0, 0.7, 0.2] {
                let wo = DVec3::new(f64::sqrt(1.0 - cos_theta * cos_theta), 0.0, cos_theta);
                let points = cells.points(wo);
                let projected: f64 = points.iter().map(|p| p.solid_angle * p.cos_theta).sum();
                // Points of cells that the critical angle cuts are in or out: a few hundredths of the wide remainder.
                assert!((projected / PI - 1.0).abs() < 0.06, "{cells:?} {cos_theta}: {projected}");
                assert!(points.iter().all(|p| p.cell < cells.count() && p.area > 0.0 && p.solid_angle > 0.0));
                // The point of a cell is found there again.
                for point in &points {
                    let wi = outside(point.slope, refracted(wo, index), index).unwrap();
                    assert_eq!(cells.cell(wi, wo), point.cell);
                }
            }
        }
    }
}
