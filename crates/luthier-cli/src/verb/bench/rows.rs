//! Rows of a result: one shader and its time.

use luthier_lut::RowLayout;
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_report::Spread;
use luthier_shader::{Form, Yardstick};
use serde::Serialize;

use super::subjects::{Subject, Timed};

/// Nanoseconds per evaluation of one shader for a number of lights. An evaluation is of one light.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Row {
    pub(crate) material: String,
    /// Model that the shader evaluates; absent of a yardstick.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) model: Option<ShadingModel>,
    /// Name of the yardstick; absent of a model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) yardstick: Option<&'static str>,
    pub(crate) form: Form,
    pub(crate) closed: bool,
    /// Layout of rows of lobes; absent of a model without such rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) layout: Option<&'static str>,
    /// Lights on each prepared view.
    pub(crate) lights: u32,
    /// Median, all included.
    pub(crate) median_ns: f64,
    /// Median absolute deviation from it.
    pub(crate) mad_ns: f64,
    /// Tenth and ninetieth percentile.
    pub(crate) p10_ns: f64,
    pub(crate) p90_ns: f64,
    /// Median of the same kernel without an evaluation.
    pub(crate) harness_ns: f64,
    /// Median less that.
    pub(crate) net_ns: f64,
    /// Net over that of Phong's model for as many lights.
    pub(crate) of_phong: f64,
    /// Net over that of the full form of the same model for as many lights.
    pub(crate) of_full: f64,
    /// Net over that of glTF's clearcoat for as many lights.
    pub(crate) of_gltf_clearcoat: f64,
}

impl Row {
    /// Name of the model or yardstick.
    pub(crate) fn shader(&self) -> &'static str {
        self.model.map_or(self.yardstick.unwrap_or_default(), ShadingModel::name)
    }
}

/// The rows of one material for a number of lights, from the times of an empty kernel and of every shader.
pub(super) fn rows_of(material: &Material, subjects: &[Subject], lights: u32, times: &[Vec<f64>]) -> Vec<Row> {
    let mut spreads = times.iter().map(|times| Spread::of(times));
    let harness = spreads.next().map_or(0.0, |spread| spread.median);
    let spreads: Vec<Spread> = spreads.collect();
    let net: Vec<f64> = spreads.iter().map(|spread| spread.median - harness).collect();
    let of = |wanted: &dyn Fn(&Subject) -> bool| subjects.iter().position(wanted).map_or(f64::NAN, |i| net[i]);
    let phong = of(&|s| s.shader == Timed::Model(ShadingModel::Phong));
    let clearcoat = of(&|s| s.shader == Timed::Yardstick(Yardstick::GltfClearcoat));
    let mut rows = Vec::new();
    for (i, subject) in subjects.iter().enumerate() {
        let Spread { median, mad, p10, p90 } = spreads[i];
        let full = of(&|s| s.shader == subject.shader && s.form == Form::Full);
        let (model, yardstick) = match subject.shader {
            Timed::Model(model) => (Some(model), None),
            Timed::Yardstick(yardstick) => (None, Some(yardstick.name())),
        };
        rows.push(Row {
            material: material.name.clone(),
            model,
            yardstick,
            form: subject.form,
            closed: subject.closed,
            layout: subject.layout.map(RowLayout::name),
            lights,
            median_ns: median,
            mad_ns: mad,
            p10_ns: p10,
            p90_ns: p90,
            harness_ns: harness,
            net_ns: net[i],
            of_phong: net[i] / phong,
            of_full: net[i] / full,
            of_gltf_clearcoat: net[i] / clearcoat,
        });
    }
    rows
}
