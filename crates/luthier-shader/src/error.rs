//! Errors of this crate.

use luthier_lut::TableKind;
use luthier_manifest::ShadingModel;
use thiserror::Error;

use crate::{Form, Target};

/// Reason why a set or a module has no shader.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ShaderError {
    /// The set has no materials.
    #[error("no materials: a shader needs at least one")]
    NoMaterials,
    /// A shader of constants was asked for, and the set has not exactly one material.
    #[error("{0} materials: only one can be made of constants")]
    NotOne(usize),
    /// A material has no layers.
    #[error("material `{0}` has no layers")]
    NoLayers(String),
    /// No identifier can be made of a name.
    #[error("`{0}` makes no shader identifier: names are letters, digits, hyphens and underscores")]
    Name(String),
    /// Two names make the same identifier.
    #[error("`{first}` and `{second}` are both `{constant}` in a shader; rename one")]
    NameClash {
        /// The earlier material.
        first: String,
        /// The later material.
        second: String,
        /// The identifier.
        constant: String,
    },
    /// Names or places that no program has; see [`luthier_manifest::Names::check`].
    #[error("{0}")]
    Names(String),
    /// A word of the shader begins with the prefix of its names.
    #[error("a shader has the word `{word}`, which begins as names with the prefix `{prefix}` do; take another prefix")]
    Prefix {
        /// The prefix.
        prefix: String,
        /// The word.
        word: String,
    },
    /// Cells of a surface choose among no material, or among too many.
    #[error("cells of the surface `{surface}` take 1 to {limit} materials")]
    Choices {
        /// The surface.
        surface: String,
        /// The most.
        limit: usize,
    },
    /// A surface names a material that the set lacks.
    #[error("the surface `{surface}` has material {material}, and there are {count}")]
    NoMaterial {
        /// The surface.
        surface: String,
        /// The number.
        material: u32,
        /// Materials of the set.
        count: u32,
    },
    /// The model of a material lacks the form.
    #[error(
        "`{material}` has no `{form}` shader: its model `{model}` is read from tables; ask for the `baked` form, or for another model"
    )]
    NoForm {
        /// The material.
        material: String,
        /// Its model.
        model: ShadingModel,
        /// The form.
        form: Form,
    },
    /// The baked form needs a tile that the layer lacks.
    #[error("layer {layer} of `{material}` has no tile of the {} table, which the baked form reads", table.name())]
    NoTile {
        /// The material.
        material: String,
        /// The layer, 0 at the top.
        layer: usize,
        /// The table.
        table: TableKind,
    },
    /// A layer points at a table or tile that the set lacks.
    #[error("layer {layer} of `{material}` reads tile {tile} of the {} table, which has {tiles} tiles", table.name())]
    TileOutOfRange {
        /// The material.
        material: String,
        /// The layer, 0 at the top.
        layer: usize,
        /// The table.
        table: TableKind,
        /// The tile wanted.
        tile: u32,
        /// Tiles of the table; 0 without it.
        tiles: u32,
    },
    /// No look-up can be written for the layout of a table.
    #[error("the {} table cannot be read by the shader: {reason}", table.name())]
    Layout {
        /// The table.
        table: TableKind,
        /// Fault of the layout.
        reason: String,
    },
    /// The material buffer would be longer than shaders can count.
    #[error("the materials take {words} vec4 words of the material buffer, which holds {limit}; emit fewer materials")]
    BufferTooLarge {
        /// Words needed.
        words: usize,
        /// [`luthier_manifest::BUFFER_WORDS_MAX`].
        limit: usize,
    },
    /// A text is not valid WGSL. The message shows the place.
    #[error("not valid WGSL:\n{0}")]
    Invalid(String),
    /// naga cannot translate the module, or gave text of an unexpected shape.
    #[error("no {target} for this shader: {reason}")]
    Untranslatable {
        /// The language.
        target: Target,
        /// Obstacle in the way.
        reason: String,
    },
    /// Operations of a text cannot be counted.
    #[error("the operations of this text cannot be counted: {0}")]
    Uncounted(String),
    /// SPIR-V was asked for as text.
    #[error("SPIR-V is no text")]
    NotText,
}

impl ShaderError {
    pub(crate) fn layout(table: TableKind, reason: impl Into<String>) -> Self {
        Self::Layout { table, reason: reason.into() }
    }

    pub(crate) fn untranslatable(target: Target, reason: impl ToString) -> Self {
        Self::Untranslatable { target, reason: reason.to_string() }
    }
}
