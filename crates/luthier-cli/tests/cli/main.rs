//! The `luthier` command as a stranger meets it: every verb through the binary, judged by files, streams and exit codes.

mod audit;
mod bake;
mod bake_refusals;
#[cfg(feature = "gpu")]
mod bench;
mod check;
#[cfg(feature = "gpu")]
mod compare;
mod containers;
mod cost;
mod crate_graph;
mod eval;
mod eval_furnace;
mod eval_inputs;
mod eval_polarised;
#[cfg(feature = "gpu")]
mod eval_twin;
mod failures;
#[cfg(feature = "gpu")]
mod figures;
mod fluorescence;
mod folder;
#[cfg(feature = "gpu")]
mod gallery;
mod help;
mod hostile;
mod ior;
#[path = "../../../luthier-material/examples/library/library.rs"]
mod library;
mod many;
// Runs shaders without a GPU.
#[expect(clippy::disallowed_methods, reason = "an oracle decides no bytes")]
#[path = "../../../luthier-shader/tests/shader/machine.rs"]
mod machine;
mod maps;
mod material_texts;
mod misses;
mod model_judge;
mod models;
mod outdated;
#[cfg(feature = "gpu")]
mod parity;
mod pipes;
mod plain;
#[cfg(feature = "gpu")]
mod preview;
mod refusals;
mod report;
mod report_page;
mod scenes;
mod schema;
mod shader;
#[cfg(feature = "gpu")]
mod stability;
mod tables;
mod thickness_map;
#[cfg(feature = "view")]
mod view;
mod workshop;
