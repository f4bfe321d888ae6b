//! The reference of a material from angles of the caller's choice: traced once, for all that is compared with it.
//!
//! Four things make it cheap. Wavelengths with equal directions of refraction share their paths ([`JointPaths`]). Light that meets one facet of the
//! first interface alone has a closed form, which is integrated over the cells without noise. If all surfaces are isotropic, the light is its own
//! mirror image in the plane of the eye, so that a cell takes the mean of both sides. Every view has as many paths as its noise requires.

use glam::DVec3;
use luthier_layers::model::Model;
use luthier_layers::models::lobes::Lobes;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::JointPaths;
use luthier_optics::Rgb;
use luthier_optics::stack::{Base, Layer, Stack};
use rayon::prelude::*;

use super::cells::{CELLS, Cells, mirrored};
use super::compare::compare;
use super::energies::Energies;
use super::paths::Histogram;
use super::{ModelSubject, PHI_DEG, ViewError, direction};

/// Settings of a reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReferenceSettings {
    /// Largest lobe error from noise, see [`ViewError::lobe_floor`].
    pub noise: f64,
    /// Largest standard error of albedos.
    pub albedo_std_err: f64,
    /// The most paths of a view, for the wavelengths that share them. A view that needs more keeps its noise.
    pub most: u64,
    /// Family of random numbers.
    pub seed: u64,
}

/// The light of a material, traced.
#[derive(Debug)]
pub struct Reference {
    wavelengths_nm: [f64; 3],
    stacks: [Monochrome; 3],
    /// The stack as models with a shader see it, but for lobes.
    crossed: [Monochrome; 3],
    /// Whether the light is its own mirror image in the plane of the eye.
    is_symmetric: bool,
    views: Vec<TracedView>,
}

#[derive(Debug)]
struct TracedView {
    theta_deg: f64,
    cells: Cells,
    /// By wavelength.
    histograms: [Histogram; 3],
    paths: u64,
}

/// A model, lobes or a function to compare with a reference.
#[derive(Clone, Copy)]
pub enum Shown<'a> {
    /// A model, given the stack at each wavelength.
    Model(&'a dyn Model),
    /// Lobes that were fitted to the stack, in its colour.
    Lobes(&'a Lobes),
    /// `f cos_theta_i` by wavelength, for directions to the light and to the eye.
    Values(&'a (dyn Fn(DVec3, DVec3) -> Rgb + Sync)),
}

/// Families of paths, whose spread is the noise.
const FAMILIES: u64 = 16;

/// Paths of a family before the first look at the noise.
const FIRST_PATHS: u64 = 1024;

/// Least and largest factor on the number of paths between two looks at the noise.
const GROWTH: [f64; 2] = [1.2, 4.0];

impl Reference {
    /// Traces a material from angles against the normal. The result does not depend on the number of threads.
    pub fn new(subject: &ModelSubject, thetas_deg: &[f64], settings: ReferenceSettings) -> Self {
        let of = |stack: &Stack| [0, 1, 2].map(|c: usize| Monochrome::new(stack, subject.wavelengths_nm[c], c));
        let (stacks, crossed) = (of(&subject.stack), of(&subject.stack.crossed_once()));
        let is_symmetric = is_isotropic(&subject.stack);
        let sets = JointPaths::new(&stacks);
        let views = thetas_deg.par_iter().map(|&theta_deg| {
            let cells = Cells::new(direction(theta_deg, PHI_DEG));
            let (histograms, paths) = trace(&sets, &cells, is_symmetric, settings);
            TracedView { theta_deg, cells, histograms, paths }
        });
        let views = views.collect();
        Self { wavelengths_nm: subject.wavelengths_nm, stacks, crossed, is_symmetric, views }
    }

    /// Errors at all views: angle by angle, and within an angle wavelength by wavelength.
    pub fn errors(&self, shown: Shown<'_>) -> Vec<ViewError> {
        let errors = self.views.par_iter().map(|view| {
            let found = self.energies(shown, &view.cells);
            [0, 1, 2].map(|c: usize| compare(&found[c], &view.histograms[c], self.wavelengths_nm[c], view.theta_deg))
        });
        errors.collect::<Vec<[ViewError; 3]>>().into_iter().flatten().collect()
    }

    /// Paths that were traced, of all views.
    pub fn paths(&self) -> u64 {
        self.views.iter().map(|view| view.paths).sum()
    }

    fn energies(&self, shown: Shown<'_>, cells: &Cells) -> [Energies; 3] {
        match shown {
            Shown::Model(model) => {
                let stacks = if model.info().shading().is_some() { &self.crossed } else { &self.stacks };
                let values = |wi| [0, 1, 2].map(|c: usize| model.eval(&stacks[c], wi, cells.wo));
                Energies::of_values(values, cells, self.is_symmetric)
            }
            Shown::Values(values) => Energies::of_values(|wi| values(wi, cells.wo), cells, self.is_symmetric),
            Shown::Lobes(lobes) => Energies::of_values(lobes.seen(&self.stacks, cells.wo), cells, self.is_symmetric),
        }
    }
}

/// Whether all surfaces are isotropic.
pub(super) fn is_isotropic(stack: &Stack) -> bool {
    let mut layers = stack.layers.iter();
    layers.all(|Layer { base, surface, .. }| matches!(base, Base::Diffuse(_)) || surface.alpha_x == surface.alpha_y)
}

/// Light by cell and wavelength, from one direction, and the number of paths.
fn trace(sets: &[JointPaths], cells: &Cells, is_symmetric: bool, settings: ReferenceSettings) -> ([Histogram; 3], u64) {
    let single = first_facets(sets, cells, is_symmetric);
    let mut histograms: [Option<Histogram>; 3] = [None, None, None];
    let mut total = 0;
    for paths in sets {
        let mut sums = vec![vec![[0.0; 3]; CELLS]; FAMILIES as usize];
        let (mut traced, mut wanted) = (0, FIRST_PATHS.min(settings.most.div_ceil(FAMILIES)));
        loop {
            for (family, sums) in (0..).zip(&mut sums) {
                paths.trace(settings.seed.wrapping_add(family), traced..wanted, cells.wo, |path| {
                    if !path.is_first_facet {
                        let sum = &mut sums[cells.cell(path.wi)];
                        (0..3).for_each(|c| sum[c] += path.weight[c]);
                    }
                });
            }
            traced = wanted;
            let channels = paths.channels();
            let found = [0, 1, 2].map(|c: usize| {
                let families = sums.iter().map(|sums| {
                    let energies = (0..CELLS).map(|cell| {
                        let (own, opposite) = (sums[cell][c], sums[mirrored(cell)][c]);
                        let sum = if is_symmetric { 0.5 * (own + opposite) } else { own };
                        single[cell][c] + sum / traced as f64
                    });
                    energies.collect()
                });
                channels[c].then(|| Histogram::of_families(families.collect(), (traced * FAMILIES) as f64))
            });
            // Noise over the limit. Paths have to grow by its square.
            let lack = found.iter().flatten().map(|histogram| {
                let lobe = histogram.lobe_floor() / settings.noise;
                let albedo = histogram.variance(|_| 1.0).sqrt() / settings.albedo_std_err;
                lobe.max(albedo)
            });
            let lack = lack.fold(0.0, f64::max);
            let most = settings.most.div_ceil(FAMILIES);
            if lack <= 1.0 || traced >= most {
                total += traced * FAMILIES;
                found.into_iter().zip(&mut histograms).for_each(|(found, all)| *all = found.or(all.take()));
                break;
            }
            let growth = (1.1 * lack * lack).clamp(GROWTH[0], GROWTH[1]);
            wanted = ((traced as f64 * growth) as u64).clamp(traced + 1, most);
        }
    }
    let histograms = histograms.map(|found| found.unwrap_or_else(|| unreachable!("each wavelength is in a set")));
    (histograms, total)
}

/// Energy by cell of the light that meets one facet of the first interface alone.
fn first_facets(sets: &[JointPaths], cells: &Cells, is_symmetric: bool) -> Vec<Rgb> {
    let rough =
        Energies::of_values(|wi| sum(sets.iter().map(|set| set.first_facet(wi, cells.wo))), cells, is_symmetric);
    let mirrored = sum(sets.iter().map(|paths| paths.mirrored(cells.wo)));
    let energies = (0..CELLS)
        .map(|cell| [0, 1, 2].map(|c: usize| rough[c].energies[cell] + if cell == 0 { mirrored[c] } else { 0.0 }));
    energies.collect()
}

fn sum(colors: impl Iterator<Item = Rgb>) -> Rgb {
    colors.fold([0.0; 3], |sum, rgb| [0, 1, 2].map(|c: usize| sum[c] + rgb[c]))
}

#[cfg(test)]
mod tests {
    use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
    use luthier_layers::registry::model;
    use luthier_optics::ior::{Ior, IorSample};
    use luthier_optics::stack::{Diffuse, Distribution, Film, FilmThickness, Slab, Surface};

    use super::*;

    /// A tinted coat with a film, of a slope parameter, over a diffuse base. Its index hangs on the wavelength or does not.
    fn coated(surface: Surface, is_dispersive: bool) -> ModelSubject {
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.1, 0.3, 0.6] };
        let sample = |wavelength_nm, n| IorSample { wavelength_nm, n, k: 0.0 };
        let glass = if is_dispersive {
            Ior::sampled(vec![sample(400.0, 1.54), sample(700.0, 1.50)])
        } else {
            Ior::constant(1.5, 0.0)
        };
        let film =
            Film { ior: Ior::constant(2.2, 0.0).unwrap(), thickness: FilmThickness { min_nm: 150.0, max_nm: 150.0 } };
        let coat = Layer { films: vec![film], surface, base: Base::Dielectric { ior: glass.unwrap(), slab } };
        let diffuse = Base::Diffuse(Diffuse { albedo: [0.8, 0.5, 0.2], sigma: 0.0 });
        let base = Layer { films: Vec::new(), surface: Surface::smooth(), base: diffuse };
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![coat, base] };
        ModelSubject { name: "coated".to_owned(), stack, wavelengths_nm: [645.0, 525.0, 445.0] }
    }

    fn settings(noise: f64, seed: u64) -> ReferenceSettings {
        ReferenceSettings { noise, albedo_std_err: 1.0, most: 1 << 24, seed }
    }

    /// Oracle: independent paths at one wavelength, every light of theirs, on both sides of the plane of the eye.
    #[test]
    fn cells_have_the_light_of_plain_paths() {
        let brushed = Surface { distribution: Distribution::Ggx, alpha_x: 0.3, alpha_y: 0.15, rotation: 0.4 };
        let round = Surface::isotropic(Distribution::Beckmann, 0.2);
        for (surface, is_dispersive) in [(round, false), (brushed, false), (round, true), (Surface::smooth(), false)] {
            let subject = coated(surface, is_dispersive);
            let reference = Reference::new(&subject, &[50.0], settings(0.02, 1));
            assert_eq!(reference.is_symmetric, surface.alpha_x == surface.alpha_y);
            let view = &reference.views[0];
            for (c, stack) in reference.stacks.iter().enumerate() {
                let estimator = LayeredMc { mode: InterfaceMode::SmithWalk, samples: 60_000, seed: 5 };
                let plain = Histogram::trace(estimator, stack, &view.cells);
                let own = &view.histograms[c];
                for cell in 0..CELLS {
                    let variance = plain.cell_variance(cell).max(plain.albedo() / 60_000.0 * 1e-2);
                    let deviation = (variance + own.cell_variance(cell)).sqrt();
                    let apart = own.energies[cell] - plain.energies[cell];
                    // Of a thousand cells the farthest is likely beyond three deviations; spreads of sixteen families have tails.
                    assert!(apart.abs() < 5.0 * deviation, "{is_dispersive} {c} {cell}: {apart} {deviation}");
                }
                let deviation = (plain.variance(|_| 1.0) + own.variance(|_| 1.0)).sqrt();
                let apart = own.albedo() - plain.albedo();
                assert!(apart.abs() < 4.0 * deviation, "{is_dispersive} {c}: {apart} {deviation}");
            }
        }
    }

    /// Oracle: the spread over references of other seeds, about their mean.
    #[test]
    fn noise_is_that_of_repetition() {
        let subject = coated(Surface::isotropic(Distribution::Ggx, 0.2), false);
        let runs = 24;
        let references: Vec<Reference> =
            (0..runs).map(|run| Reference::new(&subject, &[40.0], settings(0.02, 1000 * run))).collect();
        let histograms: Vec<&Histogram> =
            references.iter().map(|reference| &reference.views[0].histograms[1]).collect();
        let mean = |of: &dyn Fn(&Histogram) -> f64| histograms.iter().map(|h| of(h)).sum::<f64>() / runs as f64;
        let albedo = mean(&Histogram::albedo);
        let cells: Vec<f64> = (0..CELLS).map(|cell| mean(&|h| h.energies[cell])).collect();
        let apart = |h: &Histogram| h.energies.iter().zip(&cells).map(|(a, b)| (a - b).abs()).sum::<f64>();
        // The mean of all has a part of the noise of each.
        let unbiased = (runs as f64 / (runs as f64 - 1.0)).sqrt();
        let lobe = mean(&|h| 0.5 * apart(h) / albedo) * unbiased;
        let stated = mean(&Histogram::lobe_floor);
        assert!((lobe / stated - 1.0).abs() < 0.1, "{lobe} {stated}");
        let variance = mean(&|h| (h.albedo() - albedo) * (h.albedo() - albedo)) * unbiased * unbiased;
        let stated = mean(&|h| h.variance(|_| 1.0));
        // A variance from 24 runs is off by 30 % or so.
        assert!(variance < 2.0 * stated && variance > 0.4 * stated, "{variance} {stated}");
    }

    /// Every view has the noise that was asked for, unless its paths come to an end.
    #[test]
    fn paths_are_traced_until_the_noise_is_small() {
        let subject = coated(Surface::isotropic(Distribution::Ggx, 0.2), true);
        let elek = model("elek").unwrap();
        let noise = |settings: ReferenceSettings| {
            let reference = Reference::new(&subject, &[0.0, 70.0], settings);
            let views = reference.errors(Shown::Model(elek.as_ref()));
            let most = |of: fn(&ViewError) -> f64| views.iter().map(of).fold(0.0, f64::max);
            (most(|view| view.lobe_floor), most(|view| view.albedo.std_err), reference.paths())
        };
        let rough = noise(settings(0.03, 1));
        let fine = noise(settings(0.008, 1));
        assert!(rough.0 <= 0.03 && fine.0 <= 0.008 && fine.2 > 2 * rough.2, "{rough:?} {fine:?}");
        let even = noise(ReferenceSettings { albedo_std_err: 5e-4, ..settings(0.03, 1) });
        assert!(even.1 <= 5e-4 && rough.1 > 5e-4, "{rough:?} {even:?}");
        let short = noise(ReferenceSettings { most: 20_000, ..settings(0.001, 1) });
        assert!(short.0 > 0.001 && short.2 == 6 * 20_000, "{short:?}");
    }

    /// Functions that are their own mirror image have the same energies from one half as from both; views do not hang on threads.
    #[test]
    fn halves_and_threads_do_not_count() {
        let subject = coated(Surface::isotropic(Distribution::Ggx, 0.2), false);
        let elek = model("elek").unwrap();
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                Reference::new(&subject, &[0.0, 60.0], settings(0.03, 1)).errors(Shown::Model(elek.as_ref()))
            })
        };
        assert_eq!(on(1), on(3));
        let cells = Cells::new(direction(60.0, PHI_DEG));
        let stack = Monochrome::new(&subject.stack, 525.0, 1);
        let [half] = Energies::of_values(|wi| [elek.eval(&stack, wi, cells.wo)], &cells, true);
        let whole = Energies::of(elek.as_ref(), &stack, &cells);
        assert!(half.energies.iter().zip(&whole.energies).all(|(a, b)| (a - b).abs() < 1e-9));
        assert!((half.change[1] - whole.change[1]).abs() < 1e-9 && (half.change[0] - whole.change[0]).abs() < 1e-9);
    }
}
