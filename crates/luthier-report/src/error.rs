//! Errors of a judgement: a bake that cannot be judged.

use luthier_lut::TableKind;
use luthier_manifest::ShadingModel;
use thiserror::Error;

use luthier_manifest::Form;

/// Failure to judge a bake.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The number of stacks is not that of the materials in the manifest.
    #[error("the manifest has {manifest} materials, {stacks} stacks were given; bake and report from the same files")]
    MaterialCount {
        /// Number of materials in the manifest.
        manifest: usize,
        /// Given.
        stacks: usize,
    },
    /// A stack and its record differ in their layers.
    #[error(
        "material `{material}`: layer {layer} of the manifest is not layer {layer} of the material file; bake again"
    )]
    Layers {
        /// Name of the material.
        material: String,
        /// First layer that differs, from 0.
        layer: usize,
    },
    /// A texture that the manifest lists was not given.
    #[error("no texels for the {} table", .0.name())]
    MissingTexture(TableKind),
    /// Texels that do not fit the layout.
    #[error("the {} table is {found_width} x {found_height}, its layout needs {width} x {height}", .kind.name())]
    TextureSize {
        /// Kind of the table.
        kind: TableKind,
        /// Width needed.
        width: u32,
        /// Height needed.
        height: u32,
        /// Width given.
        found_width: u32,
        /// Height given.
        found_height: u32,
    },
    /// A layout that describes no texture: no tile, no column, an axis with fewer than two nodes or without extent.
    #[error("the layout of the {} table is not usable: {reason}", .kind.name())]
    Layout {
        /// Kind of the table.
        kind: TableKind,
        /// Fault of the layout.
        reason: &'static str,
    },
    /// A layer that needs a table has no tile in it.
    #[error("material `{material}`: layer {layer} has no tile in the {} table", .kind.name())]
    MissingTile {
        /// Name of the material.
        material: String,
        /// Layer, from 0.
        layer: usize,
        /// Kind of the table.
        kind: TableKind,
    },
    /// The judge has no reference for the model of a material.
    #[error("the shaders evaluate `{material}` with the model `{}`, which has no reference here", model.name())]
    Model {
        /// The material.
        material: String,
        /// Its model.
        model: ShadingModel,
    },
    /// No direction pairs were asked for.
    #[error("at least one pair of directions per set is needed")]
    NoPairs,
    /// The device refused.
    #[error("the {form} shader failed on material {material}: {message}")]
    Device {
        /// Form of the shader.
        form: Form,
        /// Number of the material.
        material: u32,
        /// Message of the device.
        message: String,
    },
    /// The device answered with another number of values than it was asked for.
    #[error("the {form} shader gave {found} values for {asked} pairs of directions of material {material}")]
    DeviceCount {
        /// Form of the shader.
        form: Form,
        /// Number of the material.
        material: u32,
        /// Pairs asked.
        asked: usize,
        /// Values given.
        found: usize,
    },
    /// Pictures that cannot be compared: width, height and channels of each.
    #[error("pictures of {} x {} with {} channels and {} x {} with {}; both must be RGB of one size", a.0, a.1, a.2, b.0, b.1, b.2)]
    Pictures {
        /// The first.
        a: (u32, u32, u32),
        /// The second.
        b: (u32, u32, u32),
    },
    /// The report is not JSON of the documented shape.
    #[error("not a luthier report: {0}")]
    Json(#[from] serde_json::Error),
}
