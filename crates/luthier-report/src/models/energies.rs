//! Energies that a model sends into the cells.

use glam::DVec3;
use luthier_layers::model::Model;
use luthier_layers::monochrome::Monochrome;
use luthier_optics::quadrature::gauss_legendre;

use super::cells::{CELLS, Cells, Patch, mirrored};
use super::paths::Histogram;

/// First and last number of points along every interval. Each level doubles it.
const POINTS: [usize; 2] = [2, 32];

/// Change on doubling (half the sum over cells) at which the quadrature stops. The finer of the two rules counts; its error is a small part of the
/// change.
const CONTENT: f64 = 5e-4;

/// Energies per cell, with their uncertainty.
#[derive(Debug, Clone)]
pub(super) struct Energies {
    pub(super) energies: Vec<f64>,
    /// Changes of a quadrature on the last doubling of its points: of the albedo, and half the change of all cells.
    pub(super) change: [f64; 2],
    /// Histogram of the paths, if the energies come from paths.
    pub(super) noise: Option<Histogram>,
}

impl Energies {
    /// The energies of a model at one wavelength, see [`Self::of_values`].
    pub(super) fn of(model: &dyn Model, stack: &Monochrome, cells: &Cells) -> Self {
        let [energies] = Self::of_values(|wi| [model.eval(stack, wi, cells.wo)], cells, false);
        energies
    }

    /// Variance of a sum of the energies with factors; 0 without paths.
    pub(super) fn variance(&self, factor: impl Fn(usize) -> f64) -> f64 {
        self.noise.as_ref().map_or(0.0, |paths| paths.variance(factor))
    }

    /// The energies of several functions `f cos_theta_i` of the light direction at once, by Gauss-Legendre quadrature over every patch. Patches that
    /// change most get twice the points, until half the changes of all patches sum up to at most 5e-4. Functions that are symmetric about the plane of
    /// the eye are integrated over one half.
    pub(super) fn of_values<const N: usize>(
        values: impl Fn(DVec3) -> [f64; N],
        cells: &Cells,
        is_symmetric: bool,
    ) -> [Self; N] {
        let mut rules = Vec::new();
        let mut points = POINTS[0];
        while points <= POINTS[1] {
            rules.push(gauss_legendre(points));
            points *= 2;
        }
        let integrate = |patch: &Patch, level: usize| {
            let mut sum = [0.0; N];
            cells.nodes(patch, &rules[level], |node| {
                sum.iter_mut().zip(values(node.wi)).for_each(|(sum, value)| *sum += node.solid_angle * value);
            });
            sum
        };
        let patches = cells.patches();
        // If every patch changes by no more than its share, the sum is within `CONTENT`: such patches need no more points.
        let share = 2.0 * CONTENT / patches.len() as f64;
        let mut refined: Vec<Refined<N>> = patches
            .into_iter()
            .filter(|patch| !is_symmetric || patch.is_left())
            .map(|patch| {
                let (energy, coarser) = (integrate(&patch, 1), integrate(&patch, 0));
                Refined { patch, level: 1, energy, change: std::array::from_fn(|i| energy[i] - coarser[i]) }
            })
            .collect();
        let copies = if is_symmetric { 2.0 } else { 1.0 };
        loop {
            let moved: [f64; N] =
                std::array::from_fn(|i| copies * refined.iter().map(|r| 0.5 * r.change[i].abs()).sum::<f64>());
            let mut changed = false;
            if moved.iter().any(|moved| *moved > CONTENT) {
                for r in refined.iter_mut().filter(|r| r.level + 1 < rules.len()) {
                    if r.change.iter().any(|c| c.abs() > share) {
                        let finer = integrate(&r.patch, r.level + 1);
                        let change = std::array::from_fn(|i| finer[i] - r.energy[i]);
                        *r = Refined { level: r.level + 1, energy: finer, change, ..*r };
                        changed = true;
                    }
                }
            }
            if !changed {
                return std::array::from_fn(|i| {
                    let mut energies = vec![0.0; CELLS];
                    for r in &refined {
                        energies[r.patch.cell] += r.energy[i];
                        if is_symmetric {
                            energies[mirrored(r.patch.cell)] += r.energy[i];
                        }
                    }
                    let albedo = copies * refined.iter().map(|r| r.change[i]).sum::<f64>();
                    Self { energies, change: [albedo.abs(), moved[i]], noise: None }
                });
            }
        }
    }
}

/// A patch, integrated.
struct Refined<const N: usize> {
    patch: Patch,
    /// Number of the rule.
    level: usize,
    energy: [f64; N],
    /// Change of the energy from the rule before.
    change: [f64; N],
}

impl From<Histogram> for Energies {
    fn from(paths: Histogram) -> Self {
        Self { energies: paths.energies.clone(), change: [0.0; 2], noise: Some(paths) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::{THETAS_DEG, direction};
    use luthier_layers::directional_albedo::directional_albedo;
    use luthier_layers::models::elek::Elek;
    use luthier_layers::models::microfacet::{Components, Microfacet};
    use luthier_layers::models::phong::Phong;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Distribution, Layer, Stack, Surface};

    fn metal(surface: Surface) -> Monochrome {
        let base = Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() };
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![Layer { films: Vec::new(), surface, base }] };
        Monochrome::new(&stack, 550.0, 1)
    }

    /// Oracle: the quadrature of the layers crate, which has other coordinates.
    #[test]
    fn albedos_are_those_of_another_quadrature() {
        let brushed = Surface { distribution: Distribution::Beckmann, alpha_x: 0.4, alpha_y: 0.1, rotation: 0.3 };
        let surfaces = [brushed, Surface::isotropic(Distribution::Ggx, 0.3)];
        let models: [&dyn Model; 3] = [&Microfacet::new(Components::PLAIN), &Elek::default(), &Phong];
        for stack in surfaces.map(metal) {
            for theta_deg in THETAS_DEG {
                let cells = Cells::new(direction(theta_deg, 30.0));
                for model in models {
                    let found = Energies::of(model, &stack, &cells);
                    let other = directional_albedo(model, &stack, cells.wo);
                    let difference = found.energies.iter().sum::<f64>() - other.value;
                    let name = model.info().name;
                    assert!(difference.abs() < 2e-3 + other.error, "{name} {theta_deg}: {difference} {other:?}");
                    assert!(found.change[1] < 2.0 * CONTENT, "{name} {theta_deg}: {:?}", found.change);
                }
            }
        }
    }

    /// A mirror shown as a lobe of the smallest roughness: all in the first cell, and as much as Fresnel's formula says.
    #[test]
    fn mirrors_fill_the_first_cell() {
        let stack = metal(Surface::smooth());
        for theta_deg in THETAS_DEG {
            let cells = Cells::new(direction(theta_deg, 30.0));
            let found = Energies::of(&Microfacet::new(Components::PLAIN), &stack, &cells).energies;
            let expected = stack.layers[0].reflectance(cells.wo.z);
            assert!((found[0] - expected).abs() < 1e-3, "{theta_deg}: {} {expected}", found[0]);
            assert!(found[1..].iter().sum::<f64>() < 1e-3, "{theta_deg}");
        }
    }
}
