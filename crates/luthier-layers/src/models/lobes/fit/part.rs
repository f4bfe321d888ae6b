//! One lobe for a part of the light of a stack.

use luthier_optics::Rgb;

use super::problem::{Lobed, Problem};
use super::{FIRST_STEPS, Found, LAST_STEPS, REMAINDER_START, SEARCH, START_WIDTHS, Simulation};
use crate::least_squares::Place;
use crate::models::lobes::ellipse::logarithm;
use crate::models::lobes::parameters::{Basis, Start, parameters};
use crate::models::lobes::tally::{Cells, Tally};
use crate::models::lobes::{Lobe, ViewAxis};

impl Simulation {
    /// A part of the light of an isotropic stack, by view: one lobe about `width` wide, and a remainder beside it, or none.
    pub(in crate::models::lobes) fn of_part(
        axis: ViewAxis,
        cells: Cells,
        width: f64,
        views: Vec<Tally>,
        has_remainder: bool,
        base_falloff: Option<[f64; 2]>,
    ) -> Self {
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
            base_falloff,
            has_remainder,
            has_tail: false,
            has_shift: true,
        }
    }

    /// With a lobe that has its middle at the normal.
    #[must_use]
    pub(in crate::models::lobes) fn centred(self) -> Self {
        Self { has_shift: false, ..self }
    }

    /// The lobe of a tail that is nearest to the light at all views. It stays near that of a neighbour, `factor` times as wide as it.
    pub(in crate::models::lobes) fn lobe(&self, tail: f64, beside: Option<(&Found, f64)>) -> Found {
        if let Some((from, factor)) = beside {
            return self.follow(from, factor);
        }
        let problem = Problem::new(self, 0);
        let lobed = Lobed::new(&problem, 1);
        let start = Start::new(Basis::Isotropic, self.starts[0], libm::asin(tail.sqrt()));
        let place = Place::new(parameters(vec![start], self.base_falloff.unwrap_or(REMAINDER_START)), &lobed);
        Found { set: 0, place: SEARCH.descend(place, &lobed, FIRST_STEPS + LAST_STEPS) }
    }

    /// Share of the light at each view that is in the remainder.
    pub(in crate::models::lobes) fn wide_shares(&self, found: &Found) -> Vec<f64> {
        if !self.has_remainder {
            return vec![0.0; self.views.len()];
        }
        let energies = Problem::new(self, 0).energies(&found.place.parameters, 1);
        let shares = energies.iter().map(|parts| {
            let [lobe, wide] = [0, 1].map(|part: usize| parts[part].iter().sum::<f64>().max(0.0));
            if wide > 0.0 { wide / (lobe + wide) } else { 0.0 }
        });
        shares.collect()
    }

    /// The lobe found at each view, with energies.
    pub(in crate::models::lobes) fn with_energies(&self, found: &Found, energies: &[Rgb]) -> Vec<Lobe> {
        let problem = Problem::new(self, 0);
        let views = problem.views.iter().zip(energies);
        views.map(|(view, energy)| view.lobe(&found.place.parameters, 0, self.cells[0].index, *energy)).collect()
    }
}
