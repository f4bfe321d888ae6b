//! A thin film on the base of a family that is metallic in places.
//!
//! Rows of the family are those without the film: reflectances by Schlick's formula, energies in closed form in the F0. One facet of a film on the first interface has
//! its own reflectance, a function of the angle, of the thickness and of the F0 at the place. For all other light the film is an F0 of equal reflectance, by channel: at
//! the angle at which the eye sees the facets for the light that leaves, and in the mean over all directions for light between facets and from the base. Below a coat
//! it is an F0 for all light: at the angles at which light of one visit meets the facets, and at those of more, some of which a film that is thinner than the coat reflects
//! totally.

use std::f64::consts::PI;

use luthier_optics::Rgb;
use luthier_optics::color::{Color, GRANIER_WAVELENGTHS_NM, WavelengthNode};
use luthier_optics::film_over_f0::{FilmOverF0, WAVES_MAX, interference};
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::ior::Ior;
use luthier_optics::schlick::{DIELECTRIC_F0, schlick, schlick_average};
use luthier_optics::stack::Stack;

use super::paint::{ALL_MIN, dimmed, edge};
use super::{Family, Paint};
use crate::models::lobes::Row;

/// Gauss's nodes and weights for means over the hemisphere, `2 mu` being the density of the cosine; last the standard deviations of the squared sines that they
/// stand for, which are even.
const MEANS: [(f64, f64, f64); 2] = [
    (0.355_051_025_721_682, 0.363_917_236_512_047, 0.105_054),
    (0.844_948_974_278_318, 0.636_082_763_487_953, 0.183_621),
];

/// Standard deviation of the squared sines at which light of more visits meets facets, over the greatest that no film reflects totally.
const MORE_SPREAD: f64 = 0.4;

/// Most that both squared sines which stand for others are apart from their mean, over what it lacks of 1: none is beyond 1.
const FLAT_SHARE: f64 = 0.9;

const ROOT_HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Reflectances of a film at a place, as a row of a family sees them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmLight {
    /// In the mean over the facets that the eye sees, of the metal and of the dielectric; below a coat as an F0 for light of one visit.
    pub seen: [Rgb; 2],
    /// F0 of interfaces that reflect as much of diffuse light, of the metal and of the dielectric; below a coat of light of more visits.
    pub mean: [Rgb; 2],
}

impl FilmLight {
    /// The film of a place for a row of a family, from reflectances of the metal and of the dielectric: at a cosine, and in the mean over squared sines of a standard
    /// deviation. `ior` is its index over that of the medium above.
    pub fn new(family: Family, row: &Row, ior: f64, reflected: impl Fn(f64, f64) -> [Rgb; 2]) -> Self {
        // A mean over squared sines is one of two, half the variance apart, whose echoes fade by the other half.
        let mean_of = |square: f64, spread: f64, of: &dyn Fn(f64, f64) -> [Rgb; 2]| {
            let faded = ROOT_HALF * spread;
            let apart = faded.min(FLAT_SHARE * (1.0 - square));
            let ends = [square - apart, square + apart].map(|square| {
                let cos_theta = (1.0 - square).clamp(FLATTEST, 1.0).sqrt();
                of(cos_theta, faded)
            });
            [0, 1].map(|i: usize| [0, 1, 2].map(|c: usize| 0.5 * (ends[0][i][c] + ends[1][i][c])))
        };
        let equal = |cos_theta: f64, spread: f64| {
            let power = schlick(0.0, cos_theta);
            reflected(cos_theta, spread).map(|rgb| rgb.map(|found| ((found - power) / (1.0 - power)).clamp(0.0, 1.0)))
        };
        if family.is_coated() {
            let ([_, square, spread], base) = (row.wide, row.base.unwrap_or_default());
            let [beyond, within] = [base.energy[2], base.internal[2]];
            let steepest = (ior * ior).min(1.0);
            let mut mean = mean_of(within, MORE_SPREAD * steepest, &equal);
            if beyond > 0.0 {
                let flat = equal((0.5 - 0.5 * steepest).max(FLATTEST).sqrt(), 0.0);
                for (mean, flat) in mean.iter_mut().zip(flat) {
                    (0..3).for_each(|c| mean[c] += beyond * (flat[c] - mean[c]));
                }
            }
            return Self { seen: mean_of(square, spread, &equal), mean };
        }
        let [facet, square, spread] = row.albedo_dir;
        // Rows know the mean of Schlick's power, which two angles do not have at flat views.
        let slope = row.lobes.first().map_or(0.0, |lobe| lobe.strength[1]);
        let power = |cos_theta: f64, _: f64| [[schlick(0.0, cos_theta); 3]; 2];
        let steep = facet / (facet + slope).max(ALL_MIN);
        let passing = (1.0 - steep) / (1.0 - mean_of(square, spread, &power)[0][0]).max(ENTERING_MIN);
        let passed = |found: f64| 1.0 - ((1.0 - found) * passing).max(0.0);
        let seen = mean_of(square, spread, &reflected).map(|rgb| rgb.map(passed));
        let mut mean = [[0.0; 3]; 2];
        for (cos_theta, weight, spread) in MEANS {
            let power = schlick(0.0, cos_theta);
            for (mean, found) in mean.iter_mut().zip(reflected(cos_theta, spread)) {
                (0..3).for_each(|c| mean[c] += weight * (found[c] - power) / (1.0 - power));
            }
        }
        Self { seen, mean: mean.map(|rgb| rgb.map(|f0| f0.clamp(0.0, 1.0))) }
    }

    /// Below a coat: factors on the light of the diffuse base that leaves, and on the share of it that leaves at all, which does so at the angles of light of one visit.
    /// A white base returns what the dielectric does not reflect: `reflected` is that without the film and with it, and `white` the light of such a base.
    pub(super) fn crossed(&self, c: usize, white: f64, [plain, filmed]: [f64; 2]) -> [f64; 2] {
        let staying = (1.0 - self.seen[1][c]) / (1.0 - DIELECTRIC_F0);
        [staying * (1.0 - (filmed - plain) / white.max(ENTERING_MIN)).max(0.0), staying]
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
/// Light that goes up leaves with the share `(1 - f) (1 - k) / (n^2 (1 - f k))`, where f is the mean reflectance of the dielectric from above, n its index over that
/// of the coat, and k the mean reflectance of the coat from inside.
pub(super) fn sent_back_below_coat(sent_back: f64, f0: f64, index: f64) -> f64 {
    let known = schlick_average(DIELECTRIC_F0);
    let left = (1.0 - sent_back) * index * index / (1.0 - known);
    let kept = ((1.0 - left) / (1.0 - left * known)).clamp(0.0, 1.0);
    let passed = |f: f64| (1.0 - f) / (1.0 - f * kept).max(ENTERING_MIN);
    1.0 - passed(schlick_average(f0)) / passed(known) * (1.0 - sent_back)
}

/// Least squared cosine at which light meets facets of the base.
const FLATTEST: f64 = 0.0025;

/// Squared sines at which light meets facets, with weights, as one of them and a standard deviation: as much of an echo remains, and as late, as of these. `late` is
/// how fast the phase of the echo grows over squared sines.
pub(in crate::models::lobes) fn facing(met: &[(f64, f64)], late: f64) -> [f64; 2] {
    let (mut all, mut first) = (0.0, 0.0);
    for (square, weight) in met {
        all += weight;
        first += weight * square;
    }
    if all <= 0.0 {
        return [0.0; 2];
    }
    let mean = first / all;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (square, weight) in met {
        let (s, c) = libm::sincos(late * (square - mean));
        sine += weight * s;
        cosine += weight * c;
    }
    let kept = (libm::hypot(sine, cosine) / all).clamp(LEAST_KEPT, 1.0);
    [(mean + libm::atan2(sine, cosine) / late).clamp(0.0, 1.0), (-2.0 * libm::log(kept)).max(0.0).sqrt() / late]
}

/// Least share of an echo that counts.
const LEAST_KEPT: f64 = 1e-3;

/// Share of squared sines, with weights, that a film of an index over that of the medium above reflects totally, and the mean of the others.
pub(super) fn beyond(met: &[(f64, f64)], ior: f64) -> [f64; 2] {
    let (mut out, mut within, mut first) = (0.0, 0.0, 0.0);
    for (square, weight) in met {
        if *square > ior * ior {
            out += weight;
        } else {
            within += weight;
            first += weight * square;
        }
    }
    let all: f64 = out + within;
    [if all > 0.0 { out / all } else { 0.0 }, if within > 0.0 { first / within } else { 0.0 }]
}

/// Least share of light that enters, by which light is divided.
const ENTERING_MIN: f64 = 0.02;

/// The film on the base of a family.
#[derive(Debug, Clone)]
pub(in crate::models::lobes) struct Filmed {
    /// The film as a series.
    series: FilmOverF0,
    /// Index of the film, and the wavelengths of the colour.
    film: (Ior, Vec<WavelengthNode>, f64),
    /// F0 of the metal of a place.
    metal: Rgb,
    /// Its exact reflectance over that metal, and over the dielectric.
    sampled: [Sampled; 2],
}

impl Filmed {
    /// The film of a stack on the metal of some colours; `None` without a film, or of a family whose energies are those of the film.
    pub(in crate::models::lobes) fn new(stack: &Stack, family: Family, paint: &Paint, color: &Color) -> Option<Self> {
        if !family.is_filmed(stack) {
            return None;
        }
        let mut interface = Interface::of(stack, family.interface)?;
        for film in &mut interface.films {
            film.thickness.min_nm *= paint.film_factor;
            film.thickness.max_nm *= paint.film_factor;
        }
        let over = |f0: Rgb| Interface { below: Ior::vacuum().with_f0(f0), ..interface.clone() }.sampled(color);
        let film = &interface.films[0];
        let wavelengths_nm = match color {
            Color::ThreeWavelengths(wavelengths_nm) => *wavelengths_nm,
            Color::Spectral => GRANIER_WAVELENGTHS_NM,
        };
        let waves = wavelengths_nm.map(|nm| 2.0 * film.ior.at(nm).re * film.thickness.nominal_nm() / nm);
        let middle_nm = wavelengths_nm[1];
        let ior = film.ior.at(middle_nm).re / interface.above.at(middle_nm).re;
        Some(Self {
            series: FilmOverF0 { ior, waves },
            film: (film.ior.clone(), color.nodes(), middle_nm),
            metal: paint.metal,
            sampled: [over(paint.metal), over([DIELECTRIC_F0; 3])],
        })
    }

    /// Its light as a row of the family sees it.
    pub(in crate::models::lobes) fn light(&self, family: Family, row: &Row) -> FilmLight {
        let (film, nodes, middle_nm) = &self.film;
        FilmLight::new(family, row, self.series.ior, |cos_theta, spread| {
            let over = |f0: Rgb| {
                let late = |waves: f64| interference(film, nodes, *middle_nm, waves.min(WAVES_MAX));
                self.series.reflectance(f0, cos_theta, spread, late)
            };
            [over(self.metal), over([DIELECTRIC_F0; 3])]
        })
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

/// Index of the film on the base of a family over that of the medium above, and how fast the phase of its first echo grows over squared sines where it is thickest.
pub(super) fn film_on(stack: &Stack, family: Family) -> Option<(f64, f64)> {
    let interface = Interface::of(stack, family.interface).filter(|_| family.is_filmed(stack))?;
    let [_, middle_nm, _] = GRANIER_WAVELENGTHS_NM;
    let film = interface.films.first()?;
    let (index, above) = (film.ior.at(middle_nm).re, interface.above.at(middle_nm).re);
    let (ior, waves) = (index / above, 2.0 * index * film.thickness.max_nm / middle_nm);
    Some((ior, (PI * waves / (ior * ior)).clamp(LATE[0], LATE[1])))
}

/// Range of phases over squared sines, by which the spread of directions is measured.
const LATE: [f64; 2] = [1.0, 16.0];

impl Family {
    /// Whether a film lies on the base of a stack that is metallic in places: rows are those without it.
    pub fn is_filmed(self, stack: &Stack) -> bool {
        self.is_metallic && !stack.layers[self.interface].films.is_empty()
    }
}
