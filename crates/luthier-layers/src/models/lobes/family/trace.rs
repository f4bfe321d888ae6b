//! Light of one node of a family, split by how often the base reflected it.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Stack};

use super::Family;
use crate::models::lobes::fit::{Simulation, seen_from};
use crate::models::lobes::tally::{Cells, Tally};
use crate::models::lobes::{FirstInterface, FitSettings, ViewAxis, Wide};
use crate::references::layered_mc::ColorPaths;

/// F0 of the base in the channels of a simulation whose energies are in closed form. A quadratic goes through all three; the middle one is also where the
/// absorption of slabs is measured.
pub(super) const SHADES: Rgb = [0.04, 0.5, 1.0];

/// Albedo of a diffuse base in that simulation.
pub(super) const WHITE: f64 = 0.8;

/// Optical depth of the slab at which lengths of paths are measured.
pub(super) const DEPTH: f64 = 0.5;

/// Light of a node.
pub(super) struct Node {
    /// Light that the base reflected once, and more often; nothing without a coat.
    pub(super) lobes: Vec<Simulation>,
    /// The rest, by view: that of a diffuse base apart from what neither base has sent.
    pub(super) rest: Vec<Rest>,
    /// Coefficients of the remainder.
    pub(super) falloff: Option<[f64; 2]>,
}

/// An F0 between the last two of [`SHADES`], where light of many reflections is far from a line.
pub(super) const BETWEEN: f64 = 0.8;

/// Energies of a view.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rest {
    /// Light that the base reflected once, and more often.
    pub(super) reflected: [Energies; 2],
    /// Light of a diffuse base.
    pub(super) base: Energies,
    /// Light that met the diffuse base exactly once.
    pub(super) base_once: Energies,
    /// Light of facets above alone, without that of one facet.
    pub(super) facets: Energies,
    /// Light of one facet of the first interface.
    pub(super) first_facet: Rgb,
}

/// Energies by channel: without a slab, and below one of [`DEPTH`].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Energies {
    pub(super) clear: Rgb,
    pub(super) dimmed: Rgb,
    /// Without a slab, at an F0 of [`BETWEEN`].
    pub(super) between: f64,
}

impl Energies {
    fn add(&mut self, weight: Rgb, dimmed: f64, between: f64) {
        self.between += between;
        for c in 0..3 {
            self.clear[c] += weight[c];
            self.dimmed[c] += weight[c] * dimmed;
        }
    }
}

/// Weight of a path at an F0 of [`BETWEEN`]. Its reflectances are `f + (1 - f) s` with Schlick's s of each facet; those of equal facets are known from two
/// weights.
fn between([_, half, whole]: Rgb, facets: u32) -> f64 {
    if half <= 0.0 || whole <= 0.0 || facets == 0 {
        return whole;
    }
    let mean = libm::pow(half / whole, 1.0 / f64::from(facets));
    let steep = ((mean - SHADES[1]) / (1.0 - SHADES[1])).clamp(0.0, 1.0);
    whole * libm::pow(BETWEEN + (1.0 - BETWEEN) * steep, f64::from(facets))
}

/// The stack that stands for all colours of a family.
fn in_shades(family: Family, stack: &Stack) -> Stack {
    let mut shaded = stack.clone();
    for (number, layer) in shaded.layers.iter_mut().enumerate() {
        match &mut layer.base {
            Base::Conductor { ior } if number == family.interface => *ior = ior.clone().with_f0(SHADES),
            Base::Dielectric { ior, slab } => {
                if number == family.interface {
                    *ior = ior.clone().with_f0(SHADES);
                }
                if number == 0 {
                    slab.absorption_per_um = [0.0; 3];
                }
            }
            Base::Diffuse(base) => base.albedo = [WHITE; 3],
            Base::Conductor { .. } => {}
        }
    }
    shaded
}

impl Node {
    /// Traces the paths of a node.
    pub(super) fn new(
        family: Family,
        node: usize,
        axis: ViewAxis,
        index: f64,
        stack: &Stack,
        color: &Color,
        settings: FitSettings,
    ) -> Self {
        let alphas = family.alphas(node);
        let here = family.apply(stack, alphas);
        let here = if family.is_colored { in_shades(family, &here) } else { here };
        let spreads = Family::spreads(alphas);
        let cells = spreads.map(|spread| Cells::new(index, spread));
        let paths = ColorPaths::new(&here, color);
        let first = FirstInterface::of(&here, color);
        let has_base = here.layers.len() > family.interface + 1;
        let (mut once, mut more, mut wide, mut rest) = (vec![], vec![], vec![], vec![]);
        for row in 0..axis.size() {
            let wo = seen_from(axis, [1.0, 0.0], row);
            let [mut of_once, mut of_more] = cells.map(|cells| Tally::new(&[cells], false));
            let mut of_rest = Tally::new(&[], true);
            let mut energies = Rest::default();
            // Nodes have families of random numbers of their own.
            let seed = settings.seed.wrapping_add(((node * axis.size() + row) as u64) << 8);
            paths.trace(seed, settings.paths, wo, |path| {
                if path.is_first_facet {
                    return;
                }
                let weight = path.weight.map(|w| w / settings.paths as f64);
                let dimmed = libm::exp(-DEPTH * path.length);
                if path.base_visits > 0 {
                    energies.base.add(weight, dimmed, 0.0);
                    if path.base_visits == 1 {
                        energies.base_once.add(weight, dimmed, 0.0);
                    }
                    of_rest.add(&[], [path.wi, wo], weight, path.base_visits);
                    return;
                }
                match path.reflections {
                    1.. if family.is_coated() => {
                        let more = usize::from(path.reflections > 1);
                        energies.reflected[more].add(weight, dimmed, between(weight, path.facets));
                        let tally = if more == 0 { &mut of_once } else { &mut of_more };
                        tally.add(&cells[more..=more], [path.wi, wo], weight, 0);
                    }
                    _ => {
                        energies.facets.add(weight, 1.0, between(weight, path.facets));
                        // Without a diffuse base this light decides the shape of the remainder.
                        of_rest.add(&[], [path.wi, wo], weight, u32::from(!has_base));
                    }
                }
            });
            energies.first_facet = first.as_ref().map_or([0.0; 3], |first| first.energy(wo));
            once.push(of_once);
            more.push(of_more);
            wide.push(of_rest);
            rest.push(energies);
        }
        let falloff = Wide::falloff_of(axis, &wide);
        let mut lobes = Vec::new();
        if family.is_coated() {
            let [narrow, broad] = cells;
            lobes.push(Simulation::of_part(axis, narrow, spreads[0], once));
            lobes.push(Simulation::of_part(axis, broad, spreads[1], more));
        }
        Self { lobes, rest, falloff }
    }
}
