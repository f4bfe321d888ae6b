//! The `luthier` command as a stranger meets it: every verb through the binary, judged by files, streams and exit codes.

mod audit;
mod bake;
mod bake_refusals;
#[cfg(feature = "gpu")]
mod bench;
mod check;
#[cfg(feature = "gpu")]
mod compare;
mod cost;
mod crate_graph;
mod eval;
mod eval_furnace;
mod eval_inputs;
#[cfg(feature = "gpu")]
mod figures;
mod fluorescence;
#[cfg(feature = "gpu")]
mod gallery;
mod help;
mod ior;
mod maps;
mod material_texts;
mod model_judge;
mod models;
mod outdated;
#[cfg(feature = "gpu")]
mod parity;
mod pipes;
#[cfg(feature = "gpu")]
mod preview;
mod report;
mod report_page;
mod scenes;
mod schema;
mod shader;
#[cfg(feature = "gpu")]
mod stability;
mod thickness_map;
#[cfg(feature = "view")]
mod view;
mod workshop;
