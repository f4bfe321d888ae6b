//! Voronoi cells around one random point per square of a lattice.

use glam::DVec2;

use super::hash;

/// Voronoi cells of one random point per square of a lattice (Worley 1996).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Voronoi {
    /// Seed of the points.
    pub seed: u32,
    /// Squares per unit of length.
    pub frequency: f64,
}

/// A cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Its point.
    pub site: DVec2,
    word: u32,
}

impl Cell {
    /// Random numbers of the cell by index, each in 0..1.
    pub fn number(&self, index: u32) -> f64 {
        hash::unit(self.word, index.wrapping_add(2))
    }
}

impl Voronoi {
    /// The cell at a place. Exact: the nearest point is in one of the 25 squares around.
    pub fn cell(&self, uv: DVec2) -> Cell {
        let p = uv * self.frequency;
        let (x, y) = (hash::floor(p.x), hash::floor(p.y));
        let mut nearest = self.site(x, y);
        let mut least = nearest.site.distance_squared(p);
        for j in -2..=2 {
            for i in -2..=2 {
                let candidate = self.site(x.saturating_add(i), y.saturating_add(j));
                let distance = candidate.site.distance_squared(p);
                if distance < least {
                    (nearest, least) = (candidate, distance);
                }
            }
        }
        Cell { site: nearest.site / self.frequency, word: nearest.word }
    }

    /// The point of a square, in units of squares.
    fn site(&self, x: i64, y: i64) -> Cell {
        let word = hash::cell(self.seed, x, y);
        Cell { site: DVec2::new(x as f64 + hash::unit(word, 0), y as f64 + hash::unit(word, 1)), word }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: all points of a wide neighbourhood.
    #[test]
    fn the_cell_is_that_of_the_nearest_point() {
        let map = Voronoi { seed: 9, frequency: 1.0 };
        let sites: Vec<Cell> = (-8..16).flat_map(|x| (-8..16).map(move |y| map.site(x, y))).collect();
        for i in 0..4000 {
            let p = DVec2::new(hash::unit(i, 0), hash::unit(i, 1)) * 8.0;
            let nearest =
                sites.iter().min_by(|a, b| a.site.distance_squared(p).total_cmp(&b.site.distance_squared(p))).unwrap();
            assert_eq!(map.cell(p), *nearest);
        }
    }
}
