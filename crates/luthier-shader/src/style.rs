//! Styles of the shader of a model: D read or computed, numbers read or written into the code.

use luthier_lut::TableKind;
use luthier_manifest::{Form, ShadingModel};

use crate::MaterialSet;

impl MaterialSet<'_> {
    /// The set without its table of D: shaders then compute D in closed form.
    #[must_use]
    pub fn with_closed_distribution(mut self) -> Self {
        self.tables.retain(|table| table.kind != TableKind::Distribution);
        self
    }
}

/// The style of a shader in words: `baked, closed D, constants`.
pub fn style_name(model: ShadingModel, form: Form, closed: bool, constant: bool) -> String {
    let d = if form == Form::Baked && closed && model.reads_some(TableKind::Distribution) { ", closed D" } else { "" };
    let numbers = if constant { ", constants" } else { "" };
    format!("{form}{d}{numbers}")
}
