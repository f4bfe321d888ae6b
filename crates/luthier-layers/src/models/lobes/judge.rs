//! Errors of lobes against paths that no fit has seen, at views between their rows.

use std::f64::consts::FRAC_2_PI;

use glam::DVec3;
use luthier_model::Masking;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{FilmThickness, Stack};

use super::fit::{Covariance, cells, covariances, indices};
use super::tally::Cells;
use super::{
    Axes, Below, Curve, Family, FirstInterface, FitSettings, Lobes, Mix, Paint, Slopes, Varied, Varying, ViewAxis,
    base_below, patina, shown,
};
use crate::references::layered_mc::ColorPaths;

/// Views, and paths of each.
const VIEWS: usize = 5;
const PATHS: u64 = 65_536;

/// Views are judged from half a step above this row. Without a critical angle, flatter views are beyond 86 degrees.
const FIRST_ROW: usize = 2;

/// Families of random numbers of a judge begin here, so that no fit has them.
const SEEDS: u64 = 1 << 40;

/// Errors of lobes against the simulated stack: the largest of a few views, which lie half way between rows, and between nodes of a factor or
/// azimuths. They include the noise of the judge's paths.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FitError {
    /// Lobe error of the worst channel: half the sum of the absolute differences between energies in cells, over the albedo. Cells are rings and
    /// eighths of a turn around the mirror direction.
    pub lobe: f64,
    /// The lobe error that noise alone makes on average.
    pub lobe_noise: f64,
    /// Absolute error of the directional albedo, the largest channel.
    pub albedo: f64,
    /// Standard error of the judge's albedo.
    pub albedo_noise: f64,
}

impl FitError {
    /// The larger of each.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self {
            lobe: self.lobe.max(other.lobe),
            lobe_noise: self.lobe_noise.max(other.lobe_noise),
            albedo: self.albedo.max(other.albedo),
            albedo_noise: self.albedo_noise.max(other.albedo_noise),
        }
    }
}

/// Light of a stack at a few views, as many paths show it.
#[derive(Debug)]
pub struct Judge {
    first: Option<FirstInterface>,
    axes: Option<Axes>,
    views: Vec<View>,
}

/// Light of one view.
#[derive(Debug)]
struct View {
    /// The factor on what varies.
    factor: f64,
    /// Slope parameters and colours in place of a factor.
    place: Option<([Slopes; 2], Paint)>,
    wo: DVec3,
    /// The light in the cells of each medium: those of one are blind at some views, see [`super::Simulation`].
    counted: Vec<Counted>,
    first_facet: Rgb,
}

/// Light of a view in the cells of a medium, without that of one facet of the first interface.
#[derive(Debug)]
struct Counted {
    cells: Cells,
    /// Energy by wider cell and channel.
    energies: Vec<Rgb>,
    /// Sum of the squared energies of the paths by wider cell, means of the channels.
    squares: Vec<f64>,
}

impl Judge {
    /// Traces the paths.
    pub fn new(stack: &Stack, color: &Color, varying: Option<Varying>) -> Self {
        let (stack, axes) = (shown(stack), Varying::axes(varying, stack));
        let varying = varying.filter(|_| axes.is_none());
        let cells_of = |rough: &[Covariance], axes| -> Vec<Cells> {
            indices(&stack).into_iter().map(|index| cells(index, rough, axes)).collect()
        };
        let axis = ViewAxis::of(&stack, FitSettings::default().rows);
        let views = (0..VIEWS).map(|number| {
            let share = number as f64 / (VIEWS - 1) as f64;
            // Half way between two rows, and between two azimuths.
            let [row, azimuth] = [(FIRST_ROW, axis.size() - 1), (0, Axes::TILES - 1)]
                .map(|(first, steps)| first as f64 + libm::floor(share * (steps - 1 - first) as f64) + 0.5);
            let (sin, cos) = libm::sincos(libm::acos(axis.cos_theta(row)));
            let azimuth = axes.map_or([1.0, 0.0], |axes| axes.azimuth(azimuth));
            let inside = DVec3::new(sin * azimuth[0], sin * azimuth[1], cos);
            let wo = axes.map_or(inside, |axes| axes.outside(inside));
            // Factors go in another order than views, so that neither follows the other.
            let seed = SEEDS + number as u64;
            if let Some(Varying::Family(family)) = varying {
                let (slopes, paint, here) = in_colors(family, &stack, number);
                let cells = cells_of(&covariances(&here, None), None);
                return View { place: Some((slopes, paint)), ..View::new(&here, color, seed, (1.0, wo), cells, None) };
            }
            let factor = varying.map_or(1.0, |varying| {
                // Light is linear between the ends of a patina, so ends alone are judged: all layers without the patina's scattering, which no path
                // shows, and the bare layers, unless they are a diffuse base, which has a closed form.
                if matches!(varying, Varying::Patina(_)) {
                    let has_lobes = FirstInterface::of(&patina::bare(&stack), color).is_some();
                    let last = (varying.nodes() - 1) as f64;
                    return varying.factor(if has_lobes && number % 2 == 1 { last } else { 0.0 });
                }
                let steps = varying.nodes() - 1;
                varying.factor(((2 * number) % VIEWS * (steps - 1) / (VIEWS - 1)) as f64 + 0.5)
            });
            let here = varying.map_or_else(|| stack.clone(), |varying| varying.apply(&stack, factor));
            View::new(&here, color, seed, (factor, wo), cells_of(&covariances(&stack, axes), axes), axes)
        });
        Self { first: FirstInterface::of(&stack, color), axes, views: views.collect() }
    }

    /// The errors of lobes of the stack, over the same factor.
    pub fn error(&self, varied: &Varied) -> FitError {
        let errors = self.views.iter().map(|view| {
            let painted = view.place.as_ref().and_then(|(slopes, paint)| varied.painted(*slopes, paint));
            self.error_at(view, &painted.unwrap_or_else(|| varied.at(view.factor)))
        });
        errors.fold(FitError::default(), FitError::max)
    }

    /// The errors of the lobes that a factor has.
    #[cfg(test)]
    pub(super) fn error_of(&self, at: impl Fn(f64) -> Lobes) -> FitError {
        self.views.iter().map(|view| self.error_at(view, &at(view.factor))).fold(FitError::default(), FitError::max)
    }

    /// The largest errors that the cells of any medium show.
    fn error_at(&self, view: &View, lobes: &Lobes) -> FitError {
        let Some(below) = lobes.below(view.wo) else { return FitError::default() };
        let errors = view.counted.iter().map(|counted| self.error_in(counted, view, &below, lobes.frame.curve));
        errors.fold(FitError::default(), FitError::max)
    }

    /// Light of the first interface is known, and not counted. A [`Curve`] is another reflectance of it: what that adds is counted.
    fn error_in(
        &self,
        Counted { cells, energies, squares }: &Counted,
        view: &View,
        below: &Below,
        curve: Option<Curve>,
    ) -> FitError {
        let at = self.axes.map_or(view.wo, |axes| axes.inside(view.wo));
        let mut found = vec![[0.0; 3]; energies.len()];
        let added = |wi| {
            let (first, curve) = (self.first.as_ref()?, curve?);
            let lobe = first.facets.lobe(Masking::Smith, wi, view.wo)?;
            let own = first.reflectance.rgb(lobe.cos_theta_d);
            Some(own.map(|own| lobe.value * (curve.at(lobe.cos_theta_d) - own)))
        };
        let by_cell = cells.light(at, |wi| {
            let wi = self.axes.map_or(wi, |axes| axes.outside(wi));
            let (light, added) = (below.eval(wi), added(wi).unwrap_or_default());
            [0, 1, 2].map(|c: usize| light[c] + added[c])
        });
        for (cell, light) in by_cell.into_iter().enumerate() {
            let wider = &mut found[cells.wider(cell)];
            (0..3).for_each(|c| wider[c] += light[c]);
        }
        let stated = below.row().albedo_dir;
        let channels = [0, 1, 2].map(|c: usize| {
            let albedo = view.first_facet[c] + energies.iter().map(|rgb| rgb[c]).sum::<f64>();
            let differences = found.iter().zip(energies).map(|(found, energy)| (found[c] - energy[c]).abs());
            (0.5 * differences.sum::<f64>() / albedo.max(f64::MIN_POSITIVE), (stated[c] - albedo).abs(), albedo)
        });
        let mean = channels.iter().map(|(_, _, albedo)| albedo).sum::<f64>() / 3.0;
        // A normal number of deviation d has a mean absolute value of sqrt(2 / pi) d.
        let deviations: f64 = squares.iter().map(|squares| (FRAC_2_PI * squares).sqrt()).sum();
        let rest = mean - view.first_facet.iter().sum::<f64>() / 3.0;
        let variance = squares.iter().sum::<f64>() - rest * rest / PATHS as f64;
        FitError {
            lobe: channels.iter().map(|(lobe, ..)| *lobe).fold(0.0, f64::max),
            lobe_noise: 0.5 * deviations / mean.max(f64::MIN_POSITIVE),
            albedo: channels.iter().map(|(_, albedo, _)| *albedo).fold(0.0, f64::max),
            albedo_noise: variance.max(0.0).sqrt(),
        }
    }
}

/// Colours of the base in which families are judged, one for each view, and whether it is metal. None is one that fits see.
const COLORS: [(Rgb, bool); VIEWS] = [
    ([0.95, 0.64, 0.25], true),
    ([0.75, 0.3, 0.06], false),
    ([0.3, 0.2, 0.12], true),
    ([0.55, 0.7, 0.95], true),
    ([0.2, 0.6, 0.9], false),
];

/// Edge tint in which families with one are judged; none that fits see.
const TINT: Rgb = [0.3, 0.6, 0.9];

/// Gives the film on the base of a family, if that varies, another thickness at each view, and returns its factor.
fn thicken(stack: &mut Stack, family: Family, number: usize) -> f64 {
    let Some(film) = stack.layers[family.interface].films.first_mut().filter(|film| film.varies()) else { return 1.0 };
    let FilmThickness { min_nm, max_nm } = film.thickness;
    let nominal = film.thickness.nominal_nm();
    let nm = min_nm + (max_nm - min_nm) * (number % VIEWS) as f64 / (VIEWS - 1) as f64;
    film.thickness = FilmThickness { min_nm: nm, max_nm: nm };
    nm / nominal
}

/// Slope parameters half way between nodes, and the stack with these in other colours, for a view of a judge by number. Anisotropic interfaces keep the ratio of
/// theirs; views have different azimuths to them.
fn in_colors(family: Family, stack: &Stack, number: usize) -> ([Slopes; 2], Paint, Stack) {
    let own = family.slopes(stack);
    let (sin, cos) = libm::sincos(number as f64 * AZIMUTH_STEP);
    // Both axes go in orders that follow neither each other nor the views.
    let slopes = [(family.coat, 3), (family.base, 2)].map(|(axis, stride)| {
        let place = (stride * number) % VIEWS * axis.nodes.saturating_sub(2) / (VIEWS - 1);
        axis.alpha(if axis.nodes > 1 { place as f64 + 0.5 } else { 0.0 })
    });
    let slopes = [0, 1].map(|i: usize| {
        let Slopes { turn: [c, s], along } = own[i];
        if along[0] == along[1] {
            return slopes[i].into();
        }
        own[i].scaled(slopes[i] / own[i].mean()).turned([cos * c - sin * s, sin * c + cos * s])
    });
    let mut here = family.apply(stack, slopes);
    if !family.is_metallic {
        return (slopes, Paint::of(&here), here);
    }
    let (color, is_metal) = COLORS[number % VIEWS];
    let is_metal = is_metal || base_below(stack).is_none();
    let tint = if family.is_tinted { TINT } else { [1.0; 3] };
    let film_factor = thicken(&mut here, family, number);
    let (plain, metallic) = (Paint { film_factor, ..Paint::of(&here) }, if is_metal { 1.0 } else { 0.0 });
    let paint = plain.mixed(Mix { metal: color, tint, dielectric: plain.dielectric, matt: color, metallic });
    let here = if is_metal { paint.metal_of(&here) } else { paint.plastic_of(&here) };
    (slopes, paint, here)
}

/// Angle by which anisotropic interfaces of a family are turned from view to view, radians.
const AZIMUTH_STEP: f64 = 0.7;

impl View {
    fn new(
        stack: &Stack,
        color: &Color,
        seed: u64,
        (factor, wo): (f64, DVec3),
        cells: Vec<Cells>,
        axes: Option<Axes>,
    ) -> Self {
        let empty = cells.into_iter().map(|cells| {
            let count = cells.wider(cells.count() - 1) + 1;
            Counted { cells, energies: vec![[0.0; 3]; count], squares: vec![0.0; count] }
        });
        let mut counted: Vec<Counted> = empty.collect();
        let at = axes.map_or(wo, |axes| axes.inside(wo));
        ColorPaths::new(stack, color).trace(seed, PATHS, wo, |path| {
            if path.is_first_facet {
                return;
            }
            let wi = axes.map_or(path.wi, |axes| axes.inside(path.wi));
            let weight = path.weight.map(|weight| weight / PATHS as f64);
            let mean = weight.iter().sum::<f64>() / 3.0;
            for Counted { cells, energies, squares } in &mut counted {
                let cell = cells.wider(cells.cell(wi, at));
                (0..3).for_each(|c| energies[cell][c] += weight[c]);
                squares[cell] += mean * mean;
            }
        });
        let first_facet = FirstInterface::of(stack, color).map_or([0.0; 3], |first| first.energy(wo));
        Self { factor, place: None, wo, counted, first_facet }
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Distribution, Layer, Slab, Surface};

    use super::super::{LOBES, Simulation, Traced};
    use super::*;

    const COLOR: Color = Color::ThreeWavelengths([650.0, 550.0, 450.0]);

    fn lacquered(absorption_per_um: [f64; 3], [alpha_x, alpha_y]: [f64; 2]) -> Stack {
        let slab = Slab { thickness_um: 1.0, absorption_per_um };
        let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let metal = Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() };
        let layer = |alpha_x, alpha_y, base| Layer {
            films: vec![],
            surface: Surface { alpha_x, alpha_y, rotation: 0.3, ..Surface::isotropic(Distribution::Ggx, 0.0) },
            base,
        };
        Stack { exterior: Ior::vacuum(), layers: vec![layer(0.1, 0.1, coat), layer(alpha_x, alpha_y, metal)] }
    }

    /// Lobes of another number, with an energy that is off, or of other rows have the errors that they must.
    #[test]
    fn errors_are_those_that_were_made() {
        for (alphas, varying) in [([0.2; 2], None), ([0.2; 2], Some(Varying::Slab)), ([0.1, 0.3], None)] {
            let stack = lacquered([0.1, 0.2, 0.6], alphas);
            let judge = Judge::new(&stack, &COLOR, varying);
            let settings = FitSettings { paths: 8192, ..FitSettings::default() };
            let traced = Traced::new(&stack, &COLOR, varying, settings);
            let good = traced.fit(LOBES, 0.0);
            let error = judge.error(&good);
            // Noise of the fit and of the judge.
            assert!(error.lobe < 0.06 && error.albedo < 0.02, "{alphas:?} {error:?}");
            assert!(error.lobe_noise < 0.02 && error.albedo_noise < 2e-3 && error.lobe > 0.5 * error.lobe_noise);
            assert!(judge.error(&traced.fit(0, 0.0)).lobe > 0.2);
            let mut dark = good.clone();
            dark.nodes.iter_mut().flat_map(|node| &mut node.rows).for_each(|row| {
                row.lobes.iter_mut().for_each(|lobe| lobe.strength[0] *= 0.8);
                row.albedo_dir[0] -= 0.1;
            });
            let off = judge.error(&dark);
            assert!(off.lobe > 0.05 && (0.08..0.12).contains(&off.albedo), "{alphas:?} {off:?}");
            // Three rows: energies between them are off.
            assert!(judge.error(&good.thinned(9)).albedo > error.albedo);
        }
    }

    /// In the half vectors of a steep medium all light of a flat view is in a few cells, so that lobes may be off by much and seem near.
    #[test]
    fn flat_views_of_steep_media_are_seen() {
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.3; 3] };
        let coat = Base::Dielectric { ior: Ior::constant(2.22, 0.0).unwrap(), slab };
        let metal = Base::Conductor { ior: Ior::constant(2.0, 2.9).unwrap() };
        let layer =
            |alpha, base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Beckmann, alpha), base };
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![layer(0.115, coat), layer(0.157, metal)] };
        let simulation = Simulation::new(&stack, &COLOR, FitSettings::default());
        let judge = Judge::new(&stack, &COLOR, None);
        let inside = simulation.in_cells(1).fit(LOBES);
        let view = &judge.views[0];
        let [outside, own] = [0, 1].map(|medium: usize| {
            judge.error_in(&view.counted[medium], view, &inside.below(view.wo).unwrap(), None).lobe
        });
        assert!(own < 0.02 && outside > 0.04, "{own} {outside}");
        assert!(judge.error_of(|_| inside.clone()).lobe > 0.04);
    }
}
