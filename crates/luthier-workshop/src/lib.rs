//! What tests of the luthier commands have in common: a folder in which a command runs, its output, and small materials. Of tests only.
//!
//! A crate of tests says once which command it is about:
//!
//! ```text
//! struct Luthier;
//!
//! impl Program for Luthier {
//!     const NAME: &'static str = "luthier";
//!     const PATH: &'static str = env!("CARGO_BIN_EXE_luthier");
//! }
//!
//! type Workshop = luthier_workshop::Workshop<Luthier>;
//! ```

pub mod material_texts;
mod places;
mod run;
mod terminal;
mod workshop;

pub use places::{file_name, is_installed, material_files, root, sha256};
pub use run::Run;
pub use terminal::{has_colours, on_terminal};
pub use workshop::{Program, Workshop};
