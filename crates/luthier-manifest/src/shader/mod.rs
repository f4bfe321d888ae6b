//! Shaders of a bake: groups of functions that are asked for, the declarations and names that they have, and the judges that they passed.

mod check;
mod functions;
mod interface;
mod names;

pub use check::Check;
pub use functions::{FunctionGroup, Functions};
pub use interface::{FunctionEntry, Interface, StructureEntry};
pub use names::Names;
