use luthier_lut::TexelFormat;
use thiserror::Error;

/// Why a set of materials cannot be baked.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BakeError {
    /// Nothing to do.
    #[error("no materials to bake")]
    Empty,
    /// Two materials of one name.
    #[error("two materials are named `{name}`: {first} and {second}; names must be unique in a bake")]
    DuplicateName {
        /// The name.
        name: String,
        /// One file.
        first: String,
        /// The other.
        second: String,
    },
    /// Two materials ask for different tables where the set shares one.
    #[error(
        "{setting} is {first_value} in {first} but {second_value} in {second}: the materials of a bake share one table of \
         each kind; make them agree, or bake them into different folders"
    )]
    Conflict {
        /// The key, as in the file.
        setting: &'static str,
        /// One file.
        first: String,
        /// What it asks.
        first_value: String,
        /// The other file.
        second: String,
        /// What that one asks.
        second_value: String,
    },
    /// A side that blocks of texels do not fill.
    #[error("{setting} {side} with format {format}: write a multiple of {}", format.block_side())]
    Blocks {
        /// The key, as in the file.
        setting: &'static str,
        /// The format whose blocks they are.
        format: TexelFormat,
        /// The side.
        side: u32,
    },
    /// No tables hold the budget.
    #[error("the budget cannot be met: {reason}; `{hint}` would do")]
    Budget {
        /// What comes nearest.
        reason: String,
        /// The limit that would be met.
        hint: String,
    },
    /// A limit that means nothing.
    #[error("a budget of {name} = {value} means nothing: write a positive number, such as `{name} = {example}`")]
    BudgetValue {
        /// The limit.
        name: &'static str,
        /// What was given.
        value: f64,
        /// One that could be met.
        example: &'static str,
    },
    /// An image that a material names cannot be used.
    #[error("{material}: cannot use the thickness map {path}: {reason}")]
    Map {
        /// The material file.
        material: String,
        /// The image.
        path: String,
        /// What is wrong with it.
        reason: String,
    },
}
