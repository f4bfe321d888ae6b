//! Refusals of materials and doubts about them that need no bake. `bake` and `check` share them.
//!
//! Each function looks at materials only and returns diagnostics: errors refuse, warnings doubt.

mod beams;
mod energy;
mod misses;
mod model;
mod parts;
mod pictures;
mod set;

pub(crate) use energy::of_kept_energy;
pub use energy::{Returned, of_energy, returned};
pub use misses::{foreseen_misses, misses};
pub use model::{of_domain, of_model};
pub use parts::{of_function, of_parts, of_scene, parts_of};
pub use pictures::of_pictures;
pub use set::{of_set, too_many};
