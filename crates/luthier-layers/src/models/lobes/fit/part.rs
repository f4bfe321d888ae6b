//! One lobe for a part of the light of a stack, which has no remainder.

use luthier_optics::Rgb;

use super::problem::{Lobed, Problem};
use super::{FIRST_STEPS, Found, LAST_STEPS, SEARCH, START_WIDTHS, Simulation, TAIL_STARTS};
use crate::least_squares::Place;
use crate::models::lobes::ellipse::logarithm;
use crate::models::lobes::parameters::{Basis, Start, parameters};
use crate::models::lobes::tally::{Cells, Tally};
use crate::models::lobes::{Lobe, ViewAxis};

impl Simulation {
    /// A part of the light of an isotropic stack, by view; its lobe is about `width` wide.
    pub(in crate::models::lobes) fn of_part(axis: ViewAxis, cells: Cells, width: f64, views: Vec<Tally>) -> Self {
        Self {
            first: None,
            axis,
            seen: axis,
            axes: None,
            cells: vec![cells],
            starts: vec![logarithm([width * width, width * width, 0.0], START_WIDTHS)],
            widths: Vec::new(),
            views,
            base: None,
            base_falloff: None,
            has_remainder: false,
        }
    }

    /// The lobe that is nearest to the light at all views. It stays near that of a neighbour, `factor` times as wide as it.
    pub(in crate::models::lobes) fn lobe(&self, beside: Option<(&Found, f64)>) -> Found {
        let problem = Problem::new(self, 0);
        if let Some((from, factor)) = beside {
            return self.follow(from, factor);
        }
        let starts = TAIL_STARTS.map(|tail| {
            let lobed = Lobed::new(&problem, 1);
            let start = Start::new(Basis::Isotropic, self.starts[0], tail);
            let place = Place::new(parameters(vec![start], [0.0; 2]), &lobed);
            SEARCH.descend(SEARCH.descend(place, &lobed, FIRST_STEPS), &lobed, LAST_STEPS)
        });
        let best = starts.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        Found { set: 0, place: best.unwrap_or_else(|| unreachable!("there are starts")) }
    }

    /// The lobe found at each view, with energies.
    pub(in crate::models::lobes) fn with_energies(&self, found: &Found, energies: &[Rgb]) -> Vec<Lobe> {
        let problem = Problem::new(self, 0);
        let views = problem.views.iter().zip(energies);
        views.map(|(view, energy)| view.lobe(&found.place.parameters, 0, self.cells[0].index, *energy)).collect()
    }
}
