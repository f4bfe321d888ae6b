//! Tools of the tests of the luthier commands: a folder in which a command runs, its output, and small materials.
//!
#![doc = include_str!("../README.md")]

pub mod material_texts;
mod patience;
mod places;
mod run;
mod terminal;
mod workshop;

pub use patience::{LOOK, Patience};
pub use places::{file_name, is_installed, material_files, root, sha256};
pub use run::Run;
pub use terminal::{has_colours, on_terminal};
pub use workshop::{Program, Workshop};
