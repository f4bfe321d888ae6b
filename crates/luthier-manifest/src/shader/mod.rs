//! Shaders of a bake: groups of functions that are asked for, the declarations that they have, and the judges that they passed.

mod check;
mod functions;
mod interface;

pub use check::Check;
pub use functions::{FunctionGroup, Functions};
pub use interface::{FunctionEntry, Interface, StructureEntry};
