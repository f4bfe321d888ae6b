//! Errors of a bake: materials that do not go together, capacities, budgets.

use luthier_lut::{TableKind, TexelFormat};
use luthier_manifest::{BUFFER_WORDS_MAX, SIDE_MAX};
use luthier_material::Diagnostic;
use thiserror::Error;

/// Why a set of materials cannot be baked.
///
/// ```
/// # let text = "schema = 1\nname = \"glass\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n";
/// # let read = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// # let glass = luthier_material::parse("glass.toml", text, &read).unwrap().material;
/// let errors = luthier_bake::check(&[glass.clone(), glass], &Default::default()).unwrap_err();
/// assert!(errors[0].to_string().starts_with("two materials are named `glass`"));
/// assert_eq!(errors[0].place(), Some((1, "name")));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The observer cancelled the bake.
    #[error("the bake was cancelled")]
    Cancelled,
    /// A bake without materials.
    #[error("no materials to bake")]
    Empty,
    /// Two materials of one name.
    #[error("two materials are named `{name}`: {first} and {second}; names must be unique in a bake")]
    DuplicateName {
        /// Number of the second material.
        material: usize,
        /// The name.
        name: String,
        /// File and line of the first.
        first: String,
        /// File and line of the second.
        second: String,
    },
    /// Two materials ask for different tables where the set shares one.
    #[error(
        "{setting} is {first_value} in {first} but {second_value} in {second}: the materials of a bake share one table of \
         each kind; make them agree, or bake them into different folders"
    )]
    Conflict {
        /// Number of the second material.
        material: usize,
        /// The key, as in the file.
        setting: &'static str,
        /// File and line of the first.
        first: String,
        /// Value that the first material asks for.
        first_value: String,
        /// File and line of the second.
        second: String,
        /// Value that the second material asks for.
        second_value: String,
    },
    /// A side that blocks of texels do not fill.
    #[error("{setting} {side} with format {format}: write a multiple of {}", format.block_side())]
    Blocks {
        /// Number of the material that asks for the side or for the format.
        material: usize,
        /// The key, as in the file.
        setting: &'static str,
        /// The format whose blocks they are.
        format: TexelFormat,
        /// The side.
        side: u32,
    },
    /// More tiles of one kind than a texture holds.
    #[error(
        "{tiles} tiles of {} x {} texels in the {} table: a texture of {SIDE_MAX} x {SIDE_MAX}, the largest of core WebGPU, holds \
         {most}; {hint}",
        tile[0], tile[1], kind.name()
    )]
    TooManyTiles {
        /// The table.
        kind: TableKind,
        /// Tiles needed.
        tiles: u32,
        /// Texels of one.
        tile: [u32; 2],
        /// Tiles that the largest texture holds.
        most: u32,
        /// Advice to the user.
        hint: String,
    },
    /// More layers than the material buffer holds.
    #[error(
        "{materials} materials of {layers} layers together take {words} words of the material buffer, which holds \
         {BUFFER_WORDS_MAX}; bake them into several folders"
    )]
    TooManyLayers {
        /// Materials.
        materials: usize,
        /// Layers of these materials together.
        layers: usize,
        /// Words of 16 bytes that these take.
        words: usize,
    },
    /// A budget that no tables hold.
    #[error("the budget cannot be met: {reason}; `{hint}` would do")]
    Budget {
        /// Words on the material that breaks it, on the limit, and on the candidate that comes nearest.
        reason: String,
        /// The limit that would be met.
        hint: String,
        /// Marks the material that breaks the limit, or that states it: at the key of the limit, else at the layer.
        /// Empty for limits on the whole bake that come from options alone.
        diagnostics: Vec<Diagnostic>,
    },
    /// A limit that means nothing.
    #[error("a budget of {name} = {value} means nothing: write a positive number, such as `{name} = {example}`")]
    BudgetValue {
        /// The limit.
        name: &'static str,
        /// Value given for the limit.
        value: f64,
        /// Value that could be met, as text.
        example: &'static str,
    },
    /// A limit on fitted lobes where no material has any.
    #[error(
        "`{name}` limits the model lobes, which no material of this bake has: leave the limit out, or add `--model lobes`"
    )]
    NoLobes {
        /// The limit.
        name: &'static str,
    },
    /// An image that a material names cannot be used.
    #[error("{material}: cannot use the thickness map {path}: {reason}")]
    Map {
        /// The material file.
        material: String,
        /// The image.
        path: String,
        /// Why it cannot be used.
        reason: String,
    },
}

impl BakeError {
    /// Number of the material at fault, and the key in its file, as in [`luthier_material::Places`].
    pub fn place(&self) -> Option<(usize, &str)> {
        match self {
            Self::DuplicateName { material, .. } => Some((*material, "name")),
            Self::Conflict { material, setting, .. } | Self::Blocks { material, setting, .. } => {
                Some((*material, setting))
            }
            Self::Cancelled
            | Self::Empty
            | Self::TooManyTiles { .. }
            | Self::TooManyLayers { .. }
            | Self::Budget { .. }
            | Self::BudgetValue { .. }
            | Self::NoLobes { .. }
            | Self::Map { .. } => None,
        }
    }
}
