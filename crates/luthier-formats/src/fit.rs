//! The fit of numbers that have no closed form.
//!
//! Levenberg's and Marquardt's method, at all angles and in all channels at once, in a fixed order: the same material gives the same numbers everywhere. There are two searches: shapes from the energies of the judge's cells alone, and from these and the directional albedo. A
//! formula that is too bright at the edge whatever its numbers widens lobes in the second to lose light; in the first lobes are right, and albedos may not be. Colours then follow from both. The search counts whose largest errors of albedo and lobe have the smaller sum.

use luthier_layers::least_squares::{Column, LeastSquares, Place, Residuals};
use luthier_optics::color::Color;

use crate::light::{Light, worst_albedo, worst_lobe};
use crate::{Format, Numbers, formula};

/// A number that is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Free {
    /// All channels of the base colour.
    Color,
    Roughness,
    CoatRoughness,
    CoatWeight,
}

impl Free {
    /// How many numbers it is.
    pub(crate) fn count(self) -> usize {
        if self == Self::Color { 3 } else { 1 }
    }
}

/// Weight of a difference of albedo beside those of cells: an albedo is off where all cells are to one side.
const ALBEDO: f64 = 2.0;

/// Weight of what a parameter has beyond its range, which holds it there.
const BEYOND: f64 = 4.0;

/// Least albedo that differences count against: darker channels have noise alone.
const DARK: f64 = 0.05;

/// Factors on the first roughness of searches, of which the best counts: lobes that do not overlap draw no roughness to each other.
const STARTS: [f64; 3] = [1.0, 0.7, 1.4];

/// Steps of a search.
const STEPS: u32 = 12;

/// Step of a slope. Smaller ones meet the quadrature of the cells, which is exact to 5e-4.
const STEP: f64 = 0.01;

struct Problem<'p> {
    format: Format,
    numbers: &'p Numbers,
    free: &'p [Free],
    light: &'p Light,
    color: &'p Color,
    /// Weight of differences of albedo beside those of cells.
    albedo: f64,
}

/// The numbers with the free ones fitted to a light.
pub(crate) fn fitted(format: Format, numbers: Numbers, free: &[Free], light: &Light, color: &Color) -> Numbers {
    if free.is_empty() {
        return numbers;
    }
    let method = LeastSquares { longest: 0.3, gain: 1e-4 };
    let descend = |numbers: &Numbers, free: &[Free], albedo: f64| {
        let problem = Problem { format, numbers, free, light, color, albedo };
        let place = method.descend(Place::new(parameters(numbers, free), &problem), &problem, STEPS);
        (place.cost, problem.numbers(&place.parameters))
    };
    let colors: Vec<Free> = free.iter().copied().filter(|free| *free == Free::Color).collect();
    let colored =
        |numbers: &Numbers| if colors.is_empty() { numbers.clone() } else { descend(numbers, &colors, ALBEDO).1 };
    if colors.len() == free.len() {
        return colored(&numbers);
    }
    let starts = if free.contains(&Free::Roughness) { &STARTS[..] } else { &STARTS[..1] };
    // The best start for shapes alone, and for shapes beside albedos.
    let found = [0.0, ALBEDO].into_iter().filter_map(|albedo| {
        let mut best: Option<(f64, Numbers)> = None;
        for factor in starts {
            let mut start = numbers.clone();
            start.roughness = (factor * start.roughness).clamp(0.0, 1.0);
            let found = descend(&colored(&start), free, albedo);
            if best.as_ref().is_none_or(|(cost, _)| found.0 < *cost) {
                best = Some(found);
            }
        }
        best.map(|(_, numbers)| colored(&numbers))
    });
    let found: Vec<Numbers> = found.collect();
    let errors = |numbers: &Numbers| {
        let residuals = light.residuals(&formula::values(format, numbers, color));
        worst_albedo(&residuals) + worst_lobe(&residuals)
    };
    found.into_iter().min_by(|a, b| errors(a).total_cmp(&errors(b))).unwrap_or(numbers)
}

/// The free numbers in one line.
fn parameters(numbers: &Numbers, free: &[Free]) -> Vec<f64> {
    let coat = numbers.coat.as_ref();
    let of = |free: &Free| match free {
        Free::Color => numbers.base_color.to_vec(),
        Free::Roughness => vec![numbers.roughness],
        Free::CoatRoughness => vec![coat.map_or(0.0, |coat| coat.roughness)],
        Free::CoatWeight => vec![coat.map_or(0.0, |coat| coat.weight)],
    };
    free.iter().flat_map(of).collect()
}

impl Problem<'_> {
    fn numbers(&self, parameters: &[f64]) -> Numbers {
        let mut numbers = self.numbers.clone();
        let mut rest = parameters.iter().map(|p| p.clamp(0.0, 1.0));
        let mut next = || rest.next().unwrap_or(0.0);
        for free in self.free {
            match (free, &mut numbers.coat) {
                (Free::Color, _) => numbers.base_color = [0; 3].map(|_: i32| next()),
                (Free::Roughness, _) => numbers.roughness = next(),
                (Free::CoatRoughness, Some(coat)) => coat.roughness = next(),
                (Free::CoatWeight, Some(coat)) => coat.weight = next(),
                (Free::CoatRoughness | Free::CoatWeight, None) => {
                    next();
                }
            }
        }
        numbers
    }
}

impl Residuals for Problem<'_> {
    fn blocks(&self) -> usize {
        1
    }

    fn block(&self, parameters: &[f64], _: usize) -> Vec<f64> {
        let values = formula::values(self.format, &self.numbers(parameters), self.color);
        let mut residuals: Vec<f64> = Vec::new();
        for view in self.light.compared(&values) {
            // Shares of the light of a channel count in the judge's lobe error, and the light itself in that of albedos: half way between both.
            let weight = view.expected.map(|albedo| 1.0 / (albedo.max(0.0) + DARK).sqrt());
            residuals.extend(view.differences.iter().flat_map(|cell| [0, 1, 2].map(|c: usize| weight[c] * cell[c])));
            residuals.extend([0, 1, 2].map(|c: usize| self.albedo * weight[c] * (view.albedo[c] - view.expected[c])));
        }
        residuals.extend(parameters.iter().map(|p| BEYOND * (p - p.clamp(0.0, 1.0))));
        residuals
    }

    fn slopes(&self, parameters: &[f64], block: usize, now: &[f64]) -> Vec<Column> {
        let column = |number: usize| {
            let mut moved = parameters.to_vec();
            // Into the range.
            let step = if moved[number] > 0.5 { -STEP } else { STEP };
            moved[number] += step;
            let there = self.block(&moved, block);
            (number, there.iter().zip(now).map(|(there, now)| (there - now) / step).collect())
        };
        (0..parameters.len()).map(column).collect()
    }
}
