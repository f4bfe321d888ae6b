//! Rows of a result: one shader and its time.

use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_report::Spread;
use luthier_shader::Form;
use serde::Serialize;

use super::subjects::Subject;

/// Nanoseconds per evaluation of one shader.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    pub(super) material: String,
    pub(super) model: ShadingModel,
    pub(super) form: Form,
    pub(super) closed: bool,
    /// Median, all included.
    pub(super) median_ns: f64,
    /// Median absolute deviation from it.
    pub(super) mad_ns: f64,
    /// Tenth and ninetieth percentile.
    pub(super) p10_ns: f64,
    pub(super) p90_ns: f64,
    /// Median of the same kernel without an evaluation.
    pub(super) harness_ns: f64,
    /// Median less that.
    pub(super) net_ns: f64,
    /// Net over that of Phong's model.
    pub(super) of_phong: f64,
    /// Net over that of the full form of the same model.
    pub(super) of_full: f64,
}

/// The rows of one material, from the times of an empty kernel and of every shader.
pub(super) fn rows_of(material: &Material, subjects: &[Subject], times: &[Vec<f64>]) -> Vec<Row> {
    let mut spreads = times.iter().map(|times| Spread::of(times));
    let harness = spreads.next().map_or(0.0, |spread| spread.median);
    let spreads: Vec<Spread> = spreads.collect();
    let net: Vec<f64> = spreads.iter().map(|spread| spread.median - harness).collect();
    let of = |wanted: &dyn Fn(&Subject) -> bool| subjects.iter().position(wanted).map_or(f64::NAN, |i| net[i]);
    let phong = of(&|s| s.model == ShadingModel::Phong);
    let mut rows = Vec::new();
    for (i, subject) in subjects.iter().enumerate() {
        let Spread { median, mad, p10, p90 } = spreads[i];
        let full = of(&|s| s.model == subject.model && s.form == Form::Full);
        rows.push(Row {
            material: material.name.clone(),
            model: subject.model,
            form: subject.form,
            closed: subject.closed,
            median_ns: median,
            mad_ns: mad,
            p10_ns: p10,
            p90_ns: p90,
            harness_ns: harness,
            net_ns: net[i],
            of_phong: net[i] / phong,
            of_full: net[i] / full,
        });
    }
    rows
}
