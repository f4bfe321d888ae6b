//! A thin film on the base of a family that is metallic in places, which is the first interface.
//!
//! Rows of the family are those without the film: reflectances by Schlick's formula, energies in closed form in the F0. One facet of the film has its own
//! reflectance, a function of the angle and of the F0 at the place. For all other light the film is an F0 of equal reflectance, by channel: at the angle at
//! which the eye sees the facets for the light that leaves, and in the mean over all directions for light between facets and from the base.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::ior::Ior;
use luthier_optics::schlick::{DIELECTRIC_F0, schlick_average};
use luthier_optics::stack::Stack;

use super::paint::{dimmed, edge};
use super::{Family, Paint};
use crate::models::lobes::Row;

/// Gauss's nodes and weights for means over the hemisphere, `2 mu` being the density of the cosine.
const MEANS: [(f64, f64); 2] =
    [(0.355_051_025_721_682, 0.363_917_236_512_047), (0.844_948_974_278_318, 0.636_082_763_487_953)];

/// Reflectances of a film at a place, as a row of a family sees them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmLight {
    /// In the mean over the facets that the eye sees, of the metal and of the dielectric.
    pub seen: [Rgb; 2],
    /// F0 of interfaces that reflect as much of diffuse light, of the metal and of the dielectric.
    pub mean: [Rgb; 2],
}

impl FilmLight {
    /// The film of a place for a row of a family, from reflectances of the metal and of the dielectric at a cosine.
    pub fn new(row: &Row, reflected: impl Fn(f64) -> [Rgb; 2]) -> Self {
        // Facets are seen at a cosine in the mean, and as far to both sides of it.
        let [_, facing, apart] = row.albedo_dir;
        let [near, far] = [facing - apart, facing + apart].map(|cos_theta| reflected(cos_theta.clamp(0.0, 1.0)));
        let seen = [0, 1].map(|i: usize| [0, 1, 2].map(|c: usize| 0.5 * (near[i][c] + far[i][c])));
        let mut mean = [[0.0; 3]; 2];
        for (cos_theta, weight) in MEANS {
            let away = 1.0 - cos_theta;
            let power = away * away * (away * away) * away;
            for (mean, found) in mean.iter_mut().zip(reflected(cos_theta)) {
                (0..3).for_each(|c| mean[c] += weight * (found[c] - power) / (1.0 - power));
            }
        }
        Self { seen, mean: mean.map(|rgb| rgb.map(|f0| f0.clamp(0.0, 1.0))) }
    }

    /// The interface without a film, where its dielectric has another F0 than that of rows; `None` with that. One facet reflects in proportion to the F0.
    pub(super) fn without(row: &Row, paint: &Paint) -> Option<Self> {
        if paint.dielectric == [DIELECTRIC_F0; 3] {
            return None;
        }
        let [facet, ..] = row.albedo_dir;
        let [_, slope, _] = row.lobes.first()?.strength;
        let [_, dip, first_dip] = row.wide;
        let over_all = 1.0 / (facet + slope).max(ENTERING_MIN);
        let kept = [0, 1, 2].map(|c: usize| edge(paint.metal[c], paint.tint[c]) * first_dip);
        let metal = [0, 1, 2].map(|c: usize| (facet + slope * paint.metal[c] - kept[c]) * over_all);
        let mean = [0, 1, 2].map(|c: usize| dimmed(paint.metal[c], paint.tint[c], dip));
        let dielectric = paint.dielectric.map(|f0| (facet + slope * f0) * over_all);
        Some(Self { seen: [metal, dielectric], mean: [mean, paint.dielectric] })
    }

    /// Light of a channel of a white diffuse base that sends nothing back, and the share of it that is sent back: what facets do not reflect enters. One facet
    /// reflects `all` of light where it is a mirror, and `several` are energies of several facets at the F0 of rows and here.
    pub(super) fn below(&self, c: usize, all: f64, several: [f64; 2], sent_back: f64) -> [f64; 2] {
        let [without, with] = [(DIELECTRIC_F0, several[0]), (self.mean[1][c], several[1])]
            .map(|(f0, several)| (1.0 - all * schlick_average(f0) - several).max(0.0));
        let leaving = with / without.max(ENTERING_MIN) * (1.0 - sent_back);
        [(1.0 - all * self.seen[1][c] - several[1]).max(0.0) * leaving, 1.0 - leaving]
    }
}

/// Share of the light of a diffuse base that is sent back to it below a coat, where the dielectric between has an F0: `sent_back` is it at the F0 that rows know.
///
/// Light that goes up leaves with the share `(1 - f) (1 - k) / (1 - f k)`, where f is the mean reflectance of the dielectric, and k that of the coat from
/// inside.
pub(super) fn sent_back_below_coat(sent_back: f64, f0: f64) -> f64 {
    let known = schlick_average(DIELECTRIC_F0);
    let kept = ((sent_back - known) / (1.0 - known - (1.0 - sent_back) * known)).clamp(0.0, 1.0);
    let passed = |f: f64| (1.0 - f) / (1.0 - f * kept).max(ENTERING_MIN);
    1.0 - passed(schlick_average(f0)) / passed(known) * (1.0 - sent_back)
}

/// Least share of light that enters, by which light is divided.
const ENTERING_MIN: f64 = 0.02;

/// The film on the base of a family, with its exact reflectance.
#[derive(Debug, Clone)]
pub(in crate::models::lobes) struct Filmed {
    /// Its reflectance over the metal of a place, and over the dielectric.
    sampled: [Sampled; 2],
}

impl Filmed {
    /// The film of a stack on the metal of some colours; `None` without a film, or of a family whose energies are those of the film.
    pub(in crate::models::lobes) fn new(stack: &Stack, family: Family, paint: &Paint, color: &Color) -> Option<Self> {
        if !is_filmed(stack, family) {
            return None;
        }
        let interface = Interface::of(stack, 0)?;
        let over = |f0: Rgb| Interface { below: Ior::vacuum().with_f0(f0), ..interface.clone() }.sampled(color);
        Some(Self { sampled: [over(paint.metal), over(paint.dielectric)] })
    }

    /// Reflectances at a cosine, of the metal and of the dielectric.
    pub(in crate::models::lobes) fn reflected(&self, cos_theta: f64) -> [Rgb; 2] {
        self.sampled.each_ref().map(|sampled| sampled.rgb(cos_theta))
    }

    /// The interface of a mix by area.
    pub(in crate::models::lobes) fn mixed(self, metallic: f64) -> Sampled {
        let [metal, plastic] = self.sampled;
        let ends = [(metal, metallic), (plastic, 1.0 - metallic)].into_iter().filter(|(_, share)| *share > 0.0);
        let nodes = ends.flat_map(|(end, share)| {
            end.nodes.into_iter().map(move |(weight, at)| (weight.map(|weight| weight * share), at))
        });
        Sampled { nodes: nodes.collect() }
    }
}

/// Whether a film lies on the base of a family that is metallic in places: rows are those without it.
pub(in crate::models::lobes) fn is_filmed(stack: &Stack, family: Family) -> bool {
    family.is_metallic && !stack.layers[family.interface].films.is_empty()
}
