//! The model at a view: values, samples, densities.

mod facet;
mod gaussian;
mod lobe;
mod wide;

use glam::DVec3;
use luthier_model::Masking;
use luthier_optics::Rgb;

use self::facet::FacetDraw;
pub(super) use self::lobe::LobeDraw;
use self::wide::WideDraw;
use super::tally::mean;
use super::{Below, Lobes};

/// Share of the draws of the first facet that the wide remainder gets: of smooth surfaces, facets far from the mirror direction reflect many times as much as
/// those near it, and there is next to no chance for them.
const SPILL: f64 = 0.04;

/// Factor on the energy of the first facet for its chance, about a bound on the weights of facets alone: what is drawn of all parts is then bounded alike.
const FACETS: f64 = 1.3;

/// The model as seen from a direction.
#[derive(Debug, Clone)]
pub struct Prepared<'a> {
    lobes: &'a Lobes,
    wo: DVec3,
    below: Below,
    /// Draws of the first facet, of each lobe, and of the wide remainder.
    facet: Option<FacetDraw>,
    draws: Vec<LobeDraw>,
    wide: WideDraw,
    /// Probabilities of the first facet, of each lobe, and of the wide remainder.
    chances: Vec<f64>,
}

/// A direction of light, drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Direction.
    pub wi: DVec3,
    /// `f cos_theta_i` over the density, by channel.
    pub weight: Rgb,
    /// Density in solid angle.
    pub pdf_solid_angle: f64,
    /// The part that it was drawn for: 0 for the first facet, k for lobe k - 1, and last the wide remainder.
    pub part: usize,
}

impl<'a> Prepared<'a> {
    pub(super) fn new(lobes: &'a Lobes, wo: DVec3) -> Option<Self> {
        let below = lobes.below(wo)?;
        let row = below.row();
        let facet = lobes.first.as_ref().map(|first| FacetDraw::new(&first.facets, wo, first.reflectance.rgb(1.0)));
        let draws = below.draws();
        let first = FACETS * mean(row.first_facet()).max(0.0);
        let parts = row.lobes.iter().zip(&draws).map(|(lobe, draw)| mean(lobe.strength).max(0.0) * draw.chance);
        let draw = WideDraw::new(below.wide());
        let wide = mean(row.wide).max(0.0) * draw.chance + SPILL * first;
        let mut chances: Vec<f64> = std::iter::once((1.0 - SPILL) * first).chain(parts).chain([wide]).collect();
        let total: f64 = chances.iter().sum();
        if total > 0.0 {
            chances.iter_mut().for_each(|chance| *chance /= total);
        } else if let Some(wide) = chances.last_mut() {
            *wide = 1.0;
        }
        Some(Self { lobes, wo, below, facet, draws, wide: draw, chances })
    }

    /// Directional albedo by channel.
    pub fn albedo_dir(&self) -> Rgb {
        self.below.row().albedo_dir
    }

    /// `f cos_theta_i` by channel; 0 below the horizon.
    pub fn eval(&self, wi: DVec3) -> Rgb {
        if wi.z <= 0.0 {
            return [0.0; 3];
        }
        let (first, below) = (self.first_facet(wi), self.below.eval(wi));
        [0, 1, 2].map(|c: usize| first[c] + below[c])
    }

    /// Density in solid angle with which [`Self::sample`] draws a direction. Its integral is 1 less the share drawn below the horizon.
    pub fn pdf_solid_angle(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let first = self.facet.as_ref().map_or(0.0, |facet| facet.pdf_solid_angle(wi));
        let densities = std::iter::once(first)
            .chain(self.below.densities(&self.draws, wi))
            .chain([self.wide.pdf_solid_angle(wi.z)]);
        self.chances.iter().zip(densities).filter(|(chance, _)| **chance > 0.0).map(|(c, d)| c * d).sum()
    }

    /// A direction for three numbers that are uniform in 0..1; `None` for one below the horizon.
    pub fn sample(&self, [choice, u, v]: [f64; 3]) -> Option<Sample> {
        let mut rest = choice;
        let wide = self.chances.len() - 1;
        let mut part = wide;
        for (i, chance) in self.chances.iter().enumerate() {
            if rest < *chance {
                part = i;
                break;
            }
            rest -= chance;
        }
        let wi = if part == 0 {
            let wh = self.facet.as_ref()?.sample([rest / self.chances[0], u, v]);
            2.0 * wh.dot(self.wo) * wh - self.wo
        } else if part < wide {
            self.below.sample(self.draws.get(part - 1)?, [u, v])?
        } else {
            let rest = (rest / self.chances[wide]).clamp(0.0, 1.0 - f64::EPSILON);
            self.wide.sample([rest, u, v])
        };
        let pdf_solid_angle = self.pdf_solid_angle(wi);
        (pdf_solid_angle > 0.0).then(|| {
            let value = self.eval(wi);
            Sample { wi, weight: value.map(|value| value / pdf_solid_angle), pdf_solid_angle, part }
        })
    }

    /// One facet of the first interface.
    fn first_facet(&self, wi: DVec3) -> Rgb {
        let value = self.lobes.first.as_ref().and_then(|first| {
            let lobe = first.facets.lobe(Masking::Smith, wi, self.wo)?;
            Some(self.lobes.reflected(lobe.cos_theta_d)?.map(|reflectance| reflectance * lobe.value))
        });
        value.unwrap_or([0.0; 3])
    }
}
