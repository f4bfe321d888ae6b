//! Lobes of a stack whose first layer is a patina, which has grown over the others in places.
//!
//! A place where patina has half grown is grown on half of its area, and bare on the other: light is linear in the amount. Both ends are simulated.
//! Lobes of the two have places of their own in rows, and their shapes stay the same over the amount; so that what is linear in rows is linear in light.

#[cfg(test)]
mod tests;

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Stack, Surface};

use super::fit::{Simulation, indices};
use super::solve::solve;
use super::{FirstInterface, FitSettings, Lobe, Lobes, Row, ViewAxis, Wide};
use crate::layers::ALPHA_MIN;

/// A patina where it has grown whole.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cover {
    /// Share of the light that enters it which scattering in it sends back, as wide light.
    pub diffuse_albedo: Rgb,
    /// Slope parameter of the layer below it; `None` leaves that layer as it is.
    pub base_alpha: Option<f64>,
    /// Factor on the light from the layers below it.
    pub tarnish: Rgb,
}

impl Cover {
    /// Whether a stack under it is as it is without its numbers.
    fn is_plain(&self) -> bool {
        self.diffuse_albedo == [0.0; 3] && self.base_alpha.is_none() && self.tarnish == [1.0; 3]
    }

    /// Number of nodes: all layers there, without its numbers; grown, where that is something else; bare.
    pub fn nodes(&self) -> usize {
        if self.is_plain() { 2 } else { 3 }
    }

    /// The stack below it and itself.
    pub(super) fn grown(&self, stack: &Stack) -> Stack {
        let mut grown = stack.clone();
        let base = grown.layers.get_mut(1).filter(|layer| !matches!(layer.base, Base::Diffuse(_)));
        if let (Some(alpha), Some(layer)) = (self.base_alpha, base) {
            layer.surface = Surface::isotropic(layer.surface.distribution, alpha.clamp(ALPHA_MIN, 1.0));
        }
        grown
    }

    /// Coefficients of the remainder of lobes under it: those that were fitted, and those of what its interface lets through, each for the energy that it
    /// is the shape of. Scattered light is brighter than the remainder of many a stack, whose shape may be odd.
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

    /// A row of the stack with the light that it scatters: of what enters so much comes back wide, and the rest sees what is below. The sum is no
    /// more than what falls in, where that of the row is not.
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

/// Coefficients of the remainder that are nearest to what an interface lets through, in the units of a cosine.
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

/// Sum of the channels of what an interface lets through.
fn passed(first: &FirstInterface, cos_theta: f64) -> f64 {
    3.0 - first.reflectance.rgb(cos_theta).iter().sum::<f64>()
}

/// Cosines at which that is compared, all weighed by themselves.
const COSINES: u32 = 64;

/// The layers below the first of a stack, where no patina has grown.
pub fn bare(stack: &Stack) -> Stack {
    Stack { layers: stack.layers.iter().skip(1).cloned().collect(), ..stack.clone() }
}

/// The light of a stack under a patina: that of all layers; where the base under it has other slopes, that, too; and last that of the bare layers, in the same
/// cells.
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

/// The lobes of each node, from all layers to the bare ones, so many at most. They have axis, medium and shape of the remainder in common.
///
/// Patina and bare layers have one lobe each; above a diffuse base, which has none, patina has all of them.
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
    // What a base of another colour would change is not known of both ends.
    for node in &mut nodes {
        node.frame.base = None;
        node.rows.iter_mut().for_each(|row| row.base = None);
    }
    nodes
}
