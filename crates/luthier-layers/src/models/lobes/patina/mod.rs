//! Lobes of a stack whose first layer is a patina that has grown over the others in places.
//!
//! Half-grown patina covers half of a place's area, and the other half is bare. So light is linear in the amount, and both ends are simulated. Each
//! end has its own lobes in a row; both ends share the shapes of all lobes and differ in energies. Lines between rows are then lines of light.

#[cfg(test)]
mod tests;

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Stack, Surface};

use super::fit::{Simulation, indices};
use super::{FirstInterface, FitSettings, Lobe, Lobes, Row, ViewAxis, Wide};
use crate::layers::ALPHA_MIN;
use crate::least_squares::solve;

/// A patina that has grown fully.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cover {
    /// Share of the entering light that scattering in the patina sends back, as wide light.
    pub diffuse_albedo: Rgb,
    /// Slope parameter of the layer below the patina; `None` leaves that layer unchanged.
    pub base_alpha: Option<f64>,
    /// Factor on the light from the layers below the patina.
    pub tarnish: Rgb,
}

impl Cover {
    /// A first layer that is there, and nothing else: that of a coat with a weight.
    pub const PLAIN: Self = Self { diffuse_albedo: [0.0; 3], base_alpha: None, tarnish: [1.0; 3] };

    /// Whether all three parameters change nothing.
    pub fn is_plain(&self) -> bool {
        *self == Self::PLAIN
    }

    /// Number of nodes: all layers without these parameters, all layers with them if they change anything, and the bare layers.
    pub fn nodes(&self) -> usize {
        if self.is_plain() { 2 } else { 3 }
    }

    /// The stack with the slope parameter below the fully grown patina.
    pub(super) fn grown(&self, stack: &Stack) -> Stack {
        let mut grown = stack.clone();
        let base = grown.layers.get_mut(1).filter(|layer| !matches!(layer.base, Base::Diffuse(_)));
        if let (Some(alpha), Some(layer)) = (self.base_alpha, base) {
            layer.surface = Surface::isotropic(layer.surface.distribution, alpha.clamp(ALPHA_MIN, 1.0));
        }
        grown
    }

    /// Coefficients of the remainder of a grown patina: a mean of the fitted ones and of those of light scattered in the patina, weighed by energies.
    /// Scattered light often outshines the fitted remainder, whose shape may then be odd.
    fn falloff(&self, lobes: &Lobes) -> [f64; 2] {
        let own = lobes.frame.wide.falloff();
        let Some(first) = &lobes.first else { return own };
        let row = &lobes.rows[lobes.rows.len() / 2];
        let facet = row.first_facet();
        let scattered: f64 = (0..3).map(|c| self.diffuse_albedo[c] * (1.0 - facet[c])).sum();
        let share = scattered / (scattered + row.wide.iter().sum::<f64>()).max(f64::MIN_POSITIVE);
        let passed = of_transmitted(first, lobes.axis);
        [0, 1].map(|k: usize| own[k] + share * (passed[k] - own[k]))
    }

    /// A row with the light that the patina scatters. A share of the entering light comes back wide, and the rest reaches the layers below. The albedo
    /// stays at or below 1 if the row's own does.
    fn dimmed(&self, mut row: Row) -> Row {
        let first = row.first_facet();
        let dull = [0, 1, 2].map(|c: usize| self.tarnish[c] * (1.0 - self.diffuse_albedo[c]));
        for c in 0..3 {
            row.lobes.iter_mut().for_each(|lobe| lobe.strength[c] *= dull[c]);
            let entering = (1.0 - first[c]).max(0.0);
            row.wide[c] = dull[c] * row.wide[c] + self.diffuse_albedo[c] * entering;
            let below: f64 = row.lobes.iter().map(|lobe| lobe.strength[c] * lobe.share).sum();
            row.albedo_dir[c] = first[c] + row.wide[c] + below;
        }
        row
    }
}

/// Coefficients of the remainder nearest to the light that an interface lets through, over the cosine.
fn of_transmitted(first: &FirstInterface, axis: ViewAxis) -> [f64; 2] {
    let straight = passed(first, 1.0);
    let shape = Wide::new([0.0; 2], axis);
    let (mut matrix, mut right) = (vec![vec![0.0; 2]; 2], vec![0.0; 2]);
    for i in 0..COSINES {
        let cos_theta = (f64::from(i) + 0.5) / f64::from(COSINES);
        let slopes = shape.slopes(cos_theta);
        let lack = passed(first, cos_theta) / straight - 1.0;
        for j in 0..2 {
            right[j] += cos_theta * slopes[j] * lack;
            (0..2).for_each(|k| matrix[j][k] += cos_theta * slopes[j] * slopes[k]);
        }
    }
    let found = solve(matrix, right);
    [found[0], found[1]]
}

/// Transmittance of an interface, summed over the channels.
fn passed(first: &FirstInterface, cos_theta: f64) -> f64 {
    3.0 - first.reflectance.rgb(cos_theta).iter().sum::<f64>()
}

/// Cosines at which [`of_transmitted`] compares, each with its cosine as weight.
const COSINES: u32 = 64;

/// The stack without its first layer: places without patina.
pub fn bare(stack: &Stack) -> Stack {
    stack.without_first()
}

/// Simulations of a stack with a patina, all in the same cells: all layers, all layers with the slopes below a grown patina if these differ, and last
/// the bare layers.
pub(super) fn simulations(
    cover: &Cover,
    axis: ViewAxis,
    stack: &Stack,
    color: &Color,
    settings: FitSettings,
) -> Vec<Simulation> {
    let mut simulations = vec![Simulation::along(axis, stack, color, settings)];
    simulations.extend(cover.base_alpha.map(|_| Simulation::along(axis, &cover.grown(stack), color, settings)));
    simulations.push(Simulation::within(&indices(stack), axis, &bare(stack), color, settings));
    simulations
}

/// The lobes of a row, without light.
fn unlit(row: &Row) -> impl Iterator<Item = Lobe> + '_ {
    row.lobes.iter().map(|lobe| Lobe { strength: [0.0; 3], ..*lobe })
}

/// The lobes of each node, from all layers to the bare ones, up to `most` in all. They share axis, medium and shape of the remainder.
///
/// Patina and bare layers have one lobe each. Above a bare diffuse base, which has none, the patina has all of them.
pub(super) fn nodes(cover: &Cover, simulations: &[Simulation], most: usize, excess: f64) -> Vec<Lobes> {
    let [simulation, between @ .., without] = simulations else { return Vec::new() };
    let of_cover = if without.first.is_none() { most } else { most.min(1) };
    let found = simulation.fewest(of_cover, excess);
    let falloff = cover.falloff(&simulation.lobes(&found));
    let found = simulation.with_falloff(&found, falloff);
    let whole = simulation.lobes(&found);
    let grown =
        between.first().map_or_else(|| whole.clone(), |rough| rough.lobes(&rough.with_falloff(&found, falloff)));
    let without = without.in_cells(found.set);
    let of_bare = without.fewest(most - of_cover, excess);
    let bare = without.lobes(&without.with_falloff(&of_bare, falloff));

    let mut nodes = vec![whole.clone()];
    if !cover.is_plain() {
        let rows = grown.rows.iter().map(|row| cover.dimmed(row.clone())).collect();
        nodes.push(Lobes { rows, ..grown.clone() });
    }
    for (row, bare) in nodes.iter_mut().flat_map(|node| node.rows.iter_mut().zip(&bare.rows)) {
        row.lobes.extend(unlit(bare));
    }
    let rows = grown
        .rows
        .iter()
        .zip(&bare.rows)
        .map(|(grown, bare)| Row { lobes: unlit(grown).chain(bare.lobes.iter().copied()).collect(), ..bare.clone() });
    let rows = rows.collect();
    nodes.push(Lobes { first: bare.first, frame: whole.frame, axis: whole.axis, rows });
    // Rows cannot recolour a diffuse base: its light is not known for both ends.
    for node in &mut nodes {
        node.frame.base = None;
        node.rows.iter_mut().for_each(|row| row.base = None);
    }
    nodes
}
