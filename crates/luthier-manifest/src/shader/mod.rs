//! Shaders of a bake: groups of functions that are asked for, and the declarations that they have.

mod functions;
mod interface;

pub use functions::{FunctionGroup, Functions};
pub use interface::{FunctionEntry, Interface, StructureEntry};
