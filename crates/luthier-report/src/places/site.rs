//! A material at a place: the rows that ship, and the layers that its file means there.

use glam::DVec3;
use luthier_layers::models::lobes::Mix;
use luthier_layers::references::layered_mc::ColorPaths;
use luthier_layers::twins::shaded::Place;
use luthier_manifest::{MaterialEntry, PlaceValues};
use luthier_optics::Rgb;
use luthier_optics::stack::Stack;

use super::{Rows, rows};
use crate::error::ReportError;
use crate::measure::references::bare_stack;
use crate::measure::subject::{Subject, color};
use crate::measure::table_terms::Weights;

/// A material at a place, by its model and by the simulation of its layers.
///
/// The layers are a mix by area of uniform stacks: below a coat with a weight and bare, metal and plastic. Patina that scatters is no such mix and is left out.
#[derive(Debug)]
pub struct Site<'a> {
    rows: Rows<'a>,
    mixed: Vec<(f64, ColorPaths)>,
}

/// A mean of simulated paths, RGB, and its standard error.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Mean {
    pub(super) mean: Rgb,
    pub(super) std_err: Rgb,
}

impl<'a> Site<'a> {
    /// A material, by its number, at a place.
    ///
    /// # Errors
    /// As [`Rows::new`].
    pub fn new(subject: &'a Subject<'_>, material: usize, values: &PlaceValues) -> Result<Self, ReportError> {
        let entry = &subject.manifest.materials[material];
        let place = rows::place(values, entry);
        let rows = Rows::at(subject, material, &place, Weights::Exact)?;
        let color = color(entry);
        let mixed = mixed(&subject.stacks[material], &place, entry).into_iter();
        Ok(Self { rows, mixed: mixed.map(|(share, stack)| (share, ColorPaths::new(&stack.bent(), &color))).collect() })
    }

    /// `f cos_theta_i` of the model, RGB, of unit directions to the light and to the eye.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        self.rows.eval(wi, wo)
    }

    /// Follows about `count` paths of light from the eye, and shows to `visit` the direction of each that leaves upward, with its share of the light that is
    /// seen: light is the sum over the paths of share times radiance. Every part of the mix has its share of the paths, at least one.
    pub fn trace(&self, seed: u64, count: u64, wo: DVec3, mut visit: impl FnMut(DVec3, Rgb)) {
        for (share, paths) in &self.mixed {
            let count = part_of(count, *share);
            paths.trace(seed, count, wo, |path| visit(path.wi, path.weight.map(|w| w * share / count as f64)));
        }
    }

    /// The directional albedo by simulation.
    pub(super) fn simulated(&self, seed: u64, count: u64, wo: DVec3) -> Mean {
        let mut all = Mean::default();
        let mut variance = [0.0; 3];
        for (share, paths) in &self.mixed {
            let count = part_of(count, *share);
            let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
            paths.trace(seed, count, wo, |path| {
                for (c, weight) in path.weight.into_iter().enumerate() {
                    sums[c] += weight;
                    squares[c] += weight * weight;
                }
            });
            let n = count as f64;
            for (c, sum) in sums.into_iter().enumerate() {
                let mean = sum / n;
                all.mean[c] += share * mean;
                variance[c] += share * share * (squares[c] / n - mean * mean).max(0.0) / n;
            }
        }
        all.std_err = variance.map(f64::sqrt);
        all
    }
}

/// The share of a number of paths.
fn part_of(count: u64, share: f64) -> u64 {
    ((count as f64 * share).ceil() as u64).max(1)
}

/// The stacks that a place is a mix of, each with its share of the area.
fn mixed(stack: &Stack, place: &Place, entry: &MaterialEntry) -> Vec<(f64, Stack)> {
    let is_mix = |metallic: f64| place.metal.map(|mix| Place { metal: Some(Mix { metallic, ..mix }), ..place.clone() });
    let sides = match (place.metal, is_mix(1.0), is_mix(0.0)) {
        (Some(mix), Some(metal), Some(plastic)) => vec![(mix.metallic, metal), (1.0 - mix.metallic, plastic)],
        _ => vec![(1.0, place.clone())],
    };
    let weight = entry.constants.bare().and(place.patina).map_or(1.0, |growth| growth.amount);
    let mut out = Vec::new();
    for (share, side) in sides {
        let whole = side.stack(stack);
        if weight < 1.0 {
            out.push((share * (1.0 - weight), bare_stack(entry, &whole)));
        }
        out.push((share * weight, whole));
    }
    out.retain(|(share, _)| *share > 0.0);
    out
}
