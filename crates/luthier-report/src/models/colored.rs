//! The reference of one view in the colour of a material, and the errors of functions against it.

use std::f64::consts::TAU;

use glam::DVec3;
use luthier_layers::references::layered_mc::ColorPaths;
use luthier_layers::twins::real_time::Twin;
use luthier_layers::twins::terms::Exact;
use luthier_manifest::ShadingModel;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::quadrature::gauss_legendre;
use luthier_optics::stack::{Base, Stack};

use super::cells::{CELLS, Cells, mirrored};
use super::compare::energy_that_noise_moves;
use super::energies::Energies;
use super::reference::{ReferenceSettings, is_isotropic};
use super::{PHI_DEG, direction};

/// Cosine below which light is *grazing*: beyond 87.1 degrees.
pub(crate) const GRAZING_COS: f64 = 0.05;

/// Least cosine of an eye whose grazing light is compared: 78.5 degrees.
const STEEP_COS: f64 = 4.0 * GRAZING_COS;

/// Share of the brightest channel's albedo that lobe errors of fainter ones count against.
const FAINT: f64 = 0.05;

/// Paths of a family. The spread of families measures the noise.
const FAMILY: u64 = 2048;

/// Families before the first look at the noise.
const FIRST_FAMILIES: u64 = 8;

/// Light of a stack towards an eye at one angle, in the colour of a material.
///
/// Its cells are those of [`crate::judge_models`]: half vectors around the mirror direction.
#[derive(Debug)]
pub struct ColorView {
    cells: Cells,
    is_symmetric: bool,
    /// Simulated energies of each family by cell, then that of grazing light, without the light that met one facet of the first interface alone.
    families: Vec<Vec<Rgb>>,
    /// Energies of the light that met one facet of the first interface alone, in the same order: a closed form without noise.
    single: Vec<Rgb>,
}

/// A function beside the light of a stack, cell by cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellDifferences {
    /// Energies of the function less those of the stack, by cell.
    pub differences: Vec<Rgb>,
    /// Directional albedo of the function.
    pub albedo: Rgb,
    /// Directional albedo of the stack.
    pub expected: Rgb,
    /// Standard error of that of the stack.
    pub std_err: Rgb,
    /// Lobe error by channel: half the absolute differences over the albedo of the stack, or over a twentieth of that of the brightest channel, where that is more. Colours
    /// beyond Rec.709 have channels below 0.
    pub lobe: Rgb,
    /// Lobe error that noise alone causes on average.
    pub lobe_floor: Rgb,
}

/// Errors of a function at a view, each with the noise of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ViewErrors {
    /// Lobe error of the worst channel, and the lobe error that noise alone causes on average.
    pub(crate) lobe: [f64; 2],
    /// Absolute error of the directional albedo in the worst channel, and the standard error there.
    pub(crate) albedo: [f64; 2],
    /// Albedo of the function and of the reference in the channel of that error.
    pub(crate) albedos: [f64; 2],
    /// Error of the mean of `f cos_theta_i` over grazing light in the worst channel, relative to max(the mean, a floor), and the standard error there. 0 for
    /// an eye flatter than [`STEEP_COS`].
    pub(crate) grazing: [f64; 2],
    /// Paths that were traced.
    pub(crate) paths: u64,
}

impl ColorView {
    /// Traces a stack with an interface, from an angle against the normal, until the noise is within the settings or the paths are spent.
    pub fn new(stack: &Stack, color: &Color, nm: [f64; 3], theta_deg: f64, settings: ReferenceSettings) -> Self {
        let cells = Cells::new(direction(theta_deg, PHI_DEG));
        let is_symmetric = is_isotropic(stack);
        let paths = ColorPaths::new(stack, color);
        let mut view = Self { cells, is_symmetric, families: Vec::new(), single: single(stack, color, nm, &cells) };
        let mut wanted = FIRST_FAMILIES;
        let most = (settings.most / FAMILY).max(2);
        loop {
            for family in view.families.len() as u64..wanted.min(most) {
                let mut sums = vec![[0.0; 3]; CELLS + 1];
                let mut add =
                    |cell: usize, weight: Rgb| (0..3).for_each(|c| sums[cell][c] += weight[c] / FAMILY as f64);
                paths.trace(settings.seed.wrapping_add(family), FAMILY, cells.wo, |path| {
                    if path.is_first_facet {
                        return;
                    }
                    let cell = cells.cell(path.wi);
                    if is_symmetric {
                        let half = path.weight.map(|weight| 0.5 * weight);
                        add(cell, half);
                        add(mirrored(cell), half);
                    } else {
                        add(cell, path.weight);
                    }
                    if path.wi.z < GRAZING_COS {
                        add(CELLS, path.weight);
                    }
                });
                view.families.push(sums);
            }
            let channels = (0..3).filter(|c| view.albedo(*c) > 0.0);
            let lobe = channels.clone().map(|c| view.lobe_floor(c) / settings.noise);
            let albedo = channels.map(|c| view.deviation(c, |_| 1.0) / settings.albedo_std_err);
            let lack = lobe.chain(albedo).fold(0.0, f64::max);
            if lack <= 1.0 || wanted >= most {
                return view;
            }
            wanted = ((wanted as f64 * (1.1 * lack * lack).clamp(1.2, 4.0)) as u64).clamp(wanted + 1, most);
        }
    }

    /// Traces a surface that is each stack on a share of itself, such as one whose coat leaves it bare in places. Shares sum to 1; `None` without stacks.
    pub fn blended(
        parts: &[(f64, Stack)],
        color: &Color,
        nm: [f64; 3],
        theta_deg: f64,
        settings: ReferenceSettings,
    ) -> Option<Self> {
        let mut views = parts.iter().map(|(share, stack)| (*share, Self::new(stack, color, nm, theta_deg, settings)));
        let (share, mut all) = views.next()?;
        scale(&mut all.single, share);
        all.families.iter_mut().for_each(|family| scale(family, share));
        for (share, mut view) in views {
            all.is_symmetric &= view.is_symmetric;
            all.families.truncate(view.families.len());
            scale(&mut view.single, share);
            add(&mut all.single, &view.single);
            for (sum, mut family) in all.families.iter_mut().zip(view.families) {
                scale(&mut family, share);
                add(sum, &family);
            }
        }
        Some(all)
    }

    /// A function `f cos_theta_i` of the directions to the light and to the eye beside this light.
    pub fn compared(&self, values: impl Fn(DVec3, DVec3) -> Rgb) -> CellDifferences {
        let found = Energies::of_values(|wi| values(wi, self.cells.wo), &self.cells, self.is_symmetric);
        let difference = |cell: usize| [0, 1, 2].map(|c: usize| found[c].energies[cell] - self.energy(cell, c));
        let differences: Vec<Rgb> = (0..CELLS).map(difference).collect();
        let expected = [0, 1, 2].map(|c: usize| self.albedo(c));
        let least = FAINT * expected.into_iter().fold(0.0, f64::max);
        let over = expected.map(|albedo| albedo.max(least).max(f64::MIN_POSITIVE));
        CellDifferences {
            albedo: [0, 1, 2].map(|c: usize| found[c].energies.iter().sum()),
            expected,
            std_err: [0, 1, 2].map(|c: usize| self.deviation(c, |_| 1.0)),
            lobe: [0, 1, 2].map(|c: usize| {
                let moved: f64 = differences.iter().map(|cell| cell[c].abs()).sum();
                0.5 * moved / over[c]
            }),
            lobe_floor: [0, 1, 2].map(|c: usize| self.noise(c) / over[c]),
            differences,
        }
    }

    /// Errors of a function `f cos_theta_i` of the direction to the light. `floor` is the least divisor of the error of grazing light.
    pub(crate) fn errors(&self, values: impl Fn(DVec3) -> Rgb, floor: f64) -> ViewErrors {
        let found = Energies::of_values(&values, &self.cells, self.is_symmetric);
        let grazing = grazing(&values);
        let solid_angle = TAU * GRAZING_COS;
        let mut errors = ViewErrors {
            lobe: [0.0; 2],
            albedo: [0.0; 2],
            albedos: [0.0; 2],
            grazing: [0.0; 2],
            paths: FAMILY * self.families.len() as u64,
        };
        for c in 0..3 {
            let energies = &found[c].energies;
            let (stated, expected) = (energies.iter().sum::<f64>(), self.albedo(c));
            let moved: f64 = (0..CELLS).map(|cell| (energies[cell] - self.energy(cell, c)).abs()).sum();
            let lobe = 0.5 * moved / expected.max(f64::MIN_POSITIVE);
            if lobe > errors.lobe[0] {
                errors.lobe = [lobe, self.lobe_floor(c)];
            }
            if (stated - expected).abs() > errors.albedo[0] {
                errors.albedo = [(stated - expected).abs(), self.deviation(c, |_| 1.0)];
                errors.albedos = [stated, expected];
            }
            // A flat eye has its highlight in grazing light, and the rest is lost beside it.
            if self.cells.wo.z < STEEP_COS {
                continue;
            }
            let mean = self.energy(CELLS, c) / solid_angle;
            let least = mean.max(floor);
            let error = (grazing[c] / solid_angle - mean).abs() / least;
            if error > errors.grazing[0] {
                errors.grazing = [error, self.variance(|family| family[CELLS][c]).sqrt() / solid_angle / least];
            }
        }
        errors
    }

    fn energy(&self, cell: usize, c: usize) -> f64 {
        let sum: f64 = self.families.iter().map(|family| family[cell][c]).sum();
        self.single[cell][c] + sum / self.families.len() as f64
    }

    fn albedo(&self, c: usize) -> f64 {
        (0..CELLS).map(|cell| self.energy(cell, c)).sum()
    }

    fn lobe_floor(&self, c: usize) -> f64 {
        self.noise(c) / self.albedo(c)
    }

    /// Energy that noise moves.
    fn noise(&self, c: usize) -> f64 {
        energy_that_noise_moves((0..CELLS).map(|cell| self.variance(|family| family[cell][c]).sqrt()).sum())
    }

    /// Standard error of a sum of energies with factors.
    fn deviation(&self, c: usize, factor: impl Fn(usize) -> f64) -> f64 {
        self.variance(|family| (0..CELLS).map(|cell| factor(cell) * family[cell][c]).sum()).sqrt()
    }

    /// Variance of the mean of a value over the families.
    fn variance(&self, value: impl Fn(&[Rgb]) -> f64) -> f64 {
        let values: Vec<f64> = self.families.iter().map(|family| value(family)).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count * (count - 1.0))
    }
}

fn scale(energies: &mut [Rgb], share: f64) {
    energies.iter_mut().flatten().for_each(|energy| *energy *= share);
}

fn add(sums: &mut [Rgb], energies: &[Rgb]) {
    sums.iter_mut().flatten().zip(energies.iter().flatten()).for_each(|(sum, energy)| *sum += energy);
}

/// Energies by cell, then that of grazing light, of the light that meets one facet of the first interface alone. It has a closed form in the colour of
/// the material.
fn single(stack: &Stack, color: &Color, nm: [f64; 3], cells: &Cells) -> Vec<Rgb> {
    let is_interface = stack.layers.first().is_some_and(|layer| !matches!(layer.base, Base::Diffuse(_)));
    if !is_interface {
        return vec![[0.0; 3]; CELLS + 1];
    }
    let twin = Twin::new(ShadingModel::Microfacet, stack, nm, *color);
    let terms = Exact::new(stack, *color);
    let values = |wi: DVec3| twin.eval(&terms, wi, cells.wo);
    let [r, g, b] = Energies::of_values(values, cells, is_isotropic(stack));
    let mut all: Vec<Rgb> = (0..CELLS).map(|cell| [&r, &g, &b].map(|channel| channel.energies[cell])).collect();
    all.push(grazing(values));
    all
}

/// Integral of a function of the light's direction over grazing light: Gauss and Legendre's rule over the cosine, even azimuths.
fn grazing(values: impl Fn(DVec3) -> Rgb) -> Rgb {
    const AZIMUTHS: u32 = 48;
    let mut sum = [0.0; 3];
    for (share, weight) in gauss_legendre(8) {
        let cos = GRAZING_COS * share;
        let sin = (1.0 - cos * cos).sqrt();
        for azimuth in 0..AZIMUTHS {
            let (y, x) = libm::sincos(TAU * (f64::from(azimuth) + 0.5) / f64::from(AZIMUTHS));
            let value = values(DVec3::new(sin * x, sin * y, cos));
            (0..3).for_each(|c| sum[c] += GRAZING_COS * weight * TAU / f64::from(AZIMUTHS) * value[c]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use luthier_layers::models::lobes::Lobes;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Diffuse, Distribution, Layer, Slab, Surface};

    use super::*;
    use crate::models::{ModelSubject, Reference, Shown};

    /// Oracle: the reference at each wavelength alone, which has paths and noise of its own.
    #[test]
    fn errors_are_those_of_the_reference_at_each_wavelength() {
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.1, 0.3, 0.6] };
        let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let layer = |alpha, base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Ggx, alpha), base };
        let base = Base::Diffuse(Diffuse { albedo: [0.8, 0.5, 0.2], sigma: 0.0 });
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![layer(0.2, coat), layer(0.0, base)] };
        let nm = [645.0, 525.0, 445.0];
        let color = Color::ThreeWavelengths(nm);
        let settings = |seed| ReferenceSettings { noise: 0.015, albedo_std_err: 2e-3, most: 1 << 20, seed };
        let lobes =
            Lobes::with(&stack, &color, luthier_layers::models::lobes::FitSettings { rows: 6, paths: 4096, seed: 3 });
        let view = ColorView::new(&stack, &color, nm, 50.0, settings(1));
        let found = view.errors(|wi| lobes.eval(wi, view.cells.wo), 0.01);
        let subject = ModelSubject { name: "coated".to_owned(), stack, wavelengths_nm: nm };
        let reference = Reference::new(&subject, &[50.0], settings(9));
        let expected = reference.errors(Shown::Lobes(&lobes));
        let most = |of: fn(&crate::models::ViewError) -> f64| expected.iter().map(of).fold(0.0, f64::max);
        let (lobe, albedo) = (most(|view| view.lobe.error), most(|view| view.albedo.error));
        assert!((found.lobe[0] - lobe).abs() < 0.01, "{found:?} {lobe}");
        assert!((found.albedo[0] - albedo).abs() < 4.0 * 1.5 * 2e-3, "{found:?} {albedo}");
        assert!(found.lobe[1] <= 0.015 && found.albedo[1] <= 2e-3, "{found:?}");
        // A function beside the light, cell by cell, has the same errors; halves of two views of one stack are that view.
        let most = |of: Rgb| of.into_iter().fold(0.0, f64::max);
        let both = |stack: &Stack| [(0.5, stack.clone()), (0.5, stack.clone())];
        let halves = ColorView::blended(&both(&subject.stack), &color, nm, 50.0, settings(1)).unwrap();
        for view in [&view, &halves] {
            let beside = view.compared(|wi, wo| lobes.eval(wi, wo));
            assert!((most(beside.lobe) - found.lobe[0]).abs() < 1e-9, "{beside:?} {found:?}");
            let apart = [0, 1, 2].map(|c: usize| (beside.albedo[c] - beside.expected[c]).abs());
            assert!((most(apart) - found.albedo[0]).abs() < 1e-9, "{beside:?} {found:?}");
        }
        // Half a mirror of light below that a black one lacks.
        let mut dark = subject.stack.clone();
        dark.layers[1].base = Base::Diffuse(Diffuse { albedo: [0.0; 3], sigma: 0.0 });
        let mixed =
            ColorView::blended(&[(0.5, subject.stack.clone()), (0.5, dark.clone())], &color, nm, 50.0, settings(1));
        let [whole, mixed, dark] = [Some(view), mixed, Some(ColorView::new(&dark, &color, nm, 50.0, settings(1)))]
            .map(|view| view.unwrap().compared(|_, _| [0.0; 3]).expected);
        for c in [0, 1, 2] {
            assert!((mixed[c] - 0.5 * (whole[c] + dark[c])).abs() < 5e-3, "{whole:?} {mixed:?} {dark:?}");
        }
        let view = ColorView::new(&subject.stack, &color, nm, 50.0, settings(1));
        // Light that is brighter by a tenth of the albedo, and by a value of 1 at grazing angles.
        let brighter = view
            .errors(|wi| lobes.eval(wi, view.cells.wo).map(|v| v + if wi.z < GRAZING_COS { 1.0 } else { 0.0 }), 1.0);
        assert!((brighter.grazing[0] - found.grazing[0] - 1.0).abs() < 0.1, "{found:?} {brighter:?}");
    }
}
