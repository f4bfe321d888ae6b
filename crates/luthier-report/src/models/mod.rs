//! The judge of models: how far every reflectance model is from the reference of whole stacks, for every material.
//!
//! A model is seen from a few directions at the three wavelengths of a material. For each of these *views* the energy that it
//! sends into each of the cells of the hemisphere is compared with that of `layered-mc`, whose paths walk between the
//! facets of rough interfaces:
//!
//! - *albedo error*: `|a - a_ref|`, a being the sum over the cells;
//! - *lobe error*: `1/2 sum |e_k - r_k| / a_ref` over the cells' energies e and r: the share of the reference's light that has to
//!   move, appear or vanish. It is 0 for equal lobes, and 1 for two lobes of equal energy that do not overlap.
//!
//! Cells are drawn around the mirror direction, over half vectors, and the smallest is a disc about it. The disc makes mirrors comparable: the
//! reference sends their light into one direction, a model into a lobe of its smallest roughness, and both lie in the disc.
//!
//! Two rows of the comparison are no models. The reference with one facet per interface event shows the effect of the mode alone; the reference with
//! other random numbers shows the effect of noise alone.
//!
//! Out of scope: single glints and maps (a model is judged as it is registered), colour, speed.

mod cells;
pub(crate) mod colored;
mod compare;
mod energies;
mod page;
mod paths;
mod reference;
mod report;
mod shading;
mod views;

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use luthier_layers::model::{Input, Kind, Model, ModelInfo};
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::registry::models;
use luthier_optics::stack::Stack;
use rayon::prelude::*;

pub use colored::{CellDifferences, ColorView};
use compare::compare;
use energies::Energies;
pub use reference::{Reference, ReferenceSettings, Shown};
pub use report::{MaterialModels, ModelErrors, ModelsReport, Quantity, ViewError, Worst};
pub use shading::{AgainstReference, judge_shading_models};
use views::View;

/// Angles of the eye against the normal, degrees.
pub(crate) const THETAS_DEG: [f64; 4] = [0.0, 30.0, 60.0, 80.0];

/// Azimuth of the eye, degrees: along no axis of an anisotropic surface.
pub const PHI_DEG: f64 = 30.0;

/// Name of the row that shows the noise.
pub(crate) const CONTROL: &str = "layered-mc, other seed";

/// Ratio of the paths of the reference to those of rows that are paths themselves.
pub(crate) const FEWER: u32 = 4;

/// A material to judge models on.
#[derive(Debug, Clone)]
pub struct ModelSubject {
    /// Its name.
    pub name: String,
    /// Stack of the material.
    pub stack: Stack,
    /// Its wavelengths, one for each colour channel of its absorption and diffuse albedo.
    pub wavelengths_nm: [f64; 3],
}

/// Settings of the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModelSettings {
    /// Paths of the reference per view.
    pub samples: NonZeroU32,
    /// Family of random numbers.
    pub seed: u64,
}

/// Judges all models of layers, and two of single surfaces beside them, on all materials. `progress` is told how many materials of how many are done.
///
/// The result depends on subjects and settings only, not on the number of threads.
pub fn judge_models(
    subjects: &[ModelSubject],
    settings: ModelSettings,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> ModelsReport {
    judge_rows(rows, subjects, settings, progress)
}

/// `rows` makes new rows for each material, because models cache results of a stack that are useless for others.
fn judge_rows(
    rows: fn() -> Vec<Row>,
    subjects: &[ModelSubject],
    settings: ModelSettings,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> ModelsReport {
    let done = AtomicUsize::new(0);
    let judged: Vec<Vec<Vec<ViewError>>> = subjects
        .par_iter()
        .map(|subject| {
            let views = judge_material(&rows(), subject, settings);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, subjects.len());
            views
        })
        .collect();
    ModelsReport::new(subjects, settings, &rows(), judged)
}

/// Row that is compared with the reference.
enum Row {
    Model(Box<dyn Model>),
    /// Paths, in a mode, from another family of random numbers than the reference's.
    Paths(InterfaceMode),
}

impl Row {
    fn name(&self) -> &'static str {
        match self {
            Self::Model(model) => model.info().name,
            Self::Paths(InterfaceMode::SmithWalk) => CONTROL,
            Self::Paths(mode) => LayeredMc::new(*mode).info().name,
        }
    }
}

/// Whether a model has a row.
fn is_judged(info: &ModelInfo) -> bool {
    match info.kind {
        Kind::Surface => info.shading().is_some(),
        Kind::Layered => true,
        Kind::Place => !info.inputs.contains(&Input::OtherStack),
        Kind::Density | Kind::Reference => false,
    }
}

/// All rows, in the order of listings: models of layers, models of places (with the parameters that they are registered with), and surfaces of one
/// layer that shaders have. Models over two stacks are left out, because a material has one.
fn rows() -> Vec<Row> {
    let judged = models().into_iter().filter(|model| is_judged(&model.info())).map(Row::Model);
    judged.chain([Row::Paths(InterfaceMode::OneFacet), Row::Paths(InterfaceMode::SmithWalk)]).collect()
}

/// Errors per row and view.
fn judge_material(rows: &[Row], subject: &ModelSubject, settings: ModelSettings) -> Vec<Vec<ViewError>> {
    let mut judged: Vec<Vec<ViewError>> = rows.iter().map(|_| Vec::new()).collect();
    for channel in 0..3 {
        for theta_deg in THETAS_DEG {
            let view = View::new(subject, channel, theta_deg);
            let samples = settings.samples.get();
            let reference = view.trace(InterfaceMode::SmithWalk, 0, samples, settings.seed);
            let fewer = samples.div_ceil(FEWER);
            for (row, found) in rows.iter().zip(&mut judged) {
                let energies = match row {
                    Row::Model(model) => Energies::of(model.as_ref(), &view.stack, &view.cells),
                    Row::Paths(mode @ InterfaceMode::SmithWalk) => view.trace(*mode, 1, fewer, settings.seed).into(),
                    Row::Paths(mode @ InterfaceMode::OneFacet) => view.trace(*mode, 2, fewer, settings.seed).into(),
                };
                found.push(compare(&energies, &reference, view.wavelength_nm, theta_deg));
            }
        }
    }
    judged
}

pub(crate) fn direction(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let (sin_theta, cos_theta) = libm::sincos(theta_deg.to_radians());
    let (sin_phi, cos_phi) = libm::sincos(phi_deg.to_radians());
    DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_manifest::ShadingModel;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Surface};

    /// Lambert's surface, a gold-like mirror, a coated rough metal.
    fn subjects() -> Vec<ModelSubject> {
        let layer = |surface, base| Layer { films: Vec::new(), surface, base };
        let matte = vec![layer(Surface::smooth(), Base::Diffuse(Diffuse { albedo: [0.6, 0.3, 0.1], sigma: 0.0 }))];
        let metal = || Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() };
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.0, 0.3, 0.6] };
        let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let rough = Surface::isotropic(Distribution::Ggx, 0.2);
        let coated = vec![layer(Surface::smooth(), coat), layer(rough, metal())];
        let subject = |name: &str, layers| ModelSubject {
            name: name.to_owned(),
            stack: Stack { exterior: Ior::vacuum(), layers },
            wavelengths_nm: [645.0, 525.0, 445.0],
        };
        vec![
            subject("matte", matte),
            subject("mirror", vec![layer(Surface::smooth(), metal())]),
            subject("coated", coated),
        ]
    }

    fn judged(samples: u32, seed: u64) -> ModelsReport {
        let samples = NonZeroU32::new(samples).unwrap();
        judge_rows(quick_rows, &subjects(), ModelSettings { samples, seed }, &|_, _| {})
    }

    /// All but the slowest: the mean over 256 flakes.
    fn quick_rows() -> Vec<Row> {
        rows().into_iter().filter(|row| row.name() != "flakes").collect()
    }

    /// Oracles: Lambert's surface and a mirror are what these models evaluate exactly.
    #[test]
    fn models_that_are_right_are_found_right() {
        let report = judged(4000, 1);
        let errors = |material: usize, name: &str| {
            report.materials[material].models.iter().find(|m| m.name == name).unwrap().clone()
        };
        for (material, names) in
            [(0, &["elek", "weidlich-wilkie", "belcour"][..]), (1, &["microfacet", "belcour", "elek"])]
        {
            for name in names {
                let found = errors(material, name);
                assert!(found.albedo.quantity.error < 2e-3, "{name}: {:?}", found.albedo);
                for view in &found.views {
                    // A floor is a mean. The mirror has none, but Elek's lobe of alpha = 0.001 has 1.3% outside the first
                    // cell: alpha^2 / (alpha^2 + tan^2 0.5 degrees).
                    assert!(view.lobe.error < 1.5 * view.lobe_floor + 0.0135, "{name}: {view:?}");
                }
            }
        }
        // A metal without its coat is not the coated one.
        assert!(errors(2, "microfacet").lobe.quantity.error > 0.3);
        let control = errors(2, CONTROL);
        assert!(!control.is_model && control.views.len() == 12);
        for view in &control.views {
            assert!(
                view.albedo.error < 4.5 * view.albedo.std_err && view.lobe.error < 1.5 * view.lobe_floor,
                "{view:?}"
            );
        }
    }

    /// A bare mirror is what Belcour's model shows; Phong's reflects a little too much at grazing angles.
    #[test]
    fn shading_models_are_judged_as_the_others() {
        let settings = ModelSettings { samples: NonZeroU32::new(2000).unwrap(), seed: 1 };
        let judged = judge_shading_models(&subjects()[1], settings);
        assert_eq!(judged.iter().map(|j| j.model).collect::<Vec<_>>(), ShadingModel::ALL);
        let of = |model| judged.iter().find(|j| j.model == model).unwrap();
        let all = super::tests::judged(2000, 1);
        for (model, name) in [(ShadingModel::Belcour, "belcour"), (ShadingModel::Phong, "phong")] {
            let same = all.materials[1].models.iter().find(|m| m.name == name).unwrap();
            assert_eq!(of(model).lobe_err, same.lobe.quantity.error, "{name}");
            assert_eq!(of(model).by_angle.iter().map(|p| p.1).fold(0.0, f64::max), of(model).lobe_err);
        }
        assert!(of(ShadingModel::Belcour).delta_e < 0.2, "{judged:?}");
        // Schlick's form instead of Fresnel's, at 80 degrees.
        assert!(of(ShadingModel::Phong).delta_e > 0.3 && of(ShadingModel::Phong).worst_theta_deg == 80.0, "{judged:?}");
    }

    #[test]
    fn the_report_is_of_its_inputs_only() {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| judged(200, 1)).to_json().unwrap()
        };
        let one = on(1);
        assert_eq!(one, on(3));
        assert_ne!(one, judged(200, 2).to_json().unwrap());
    }

    #[test]
    fn the_page_has_a_column_for_every_row_and_no_empty_cell_in_errors() {
        let report = judged(50, 1);
        let page = report.to_markdown("luthier-lab judge somewhere");
        assert!(page.contains("\n    luthier-lab judge somewhere\n"));
        for kind in ["## Albedo error", "## Lobe error"] {
            let section = page.split(&format!("\n{kind}\n")).nth(1).unwrap().split("\n## ").next().unwrap();
            let heads: Vec<&str> = section.lines().filter(|line| line.starts_with("| material")).collect();
            let columns: Vec<&str> = heads.iter().flat_map(|head| head.split('|').map(str::trim)).collect();
            for model in &report.materials[0].models {
                assert_eq!(columns.iter().filter(|c| **c == model.name).count(), 1, "{kind}: {}", model.name);
            }
            assert_eq!(section.matches("\n| mirror |").count(), heads.len());
            assert!(!section.contains("|  |") && !section.contains("NaN"), "{section}");
        }
    }
}
