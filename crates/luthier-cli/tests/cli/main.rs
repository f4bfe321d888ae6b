//! The `luthier` command as a stranger meets it: every verb through the binary, judged by files, streams and exit codes.

mod bake;
mod book;
mod check;
mod command;
mod eval;
#[path = "../../../luthier-material/examples/library/library.rs"]
mod library;
// Runs shaders without a GPU.
#[expect(clippy::disallowed_methods, reason = "an oracle decides no bytes")]
#[path = "../../../luthier-shader/tests/shader/machine.rs"]
mod machine;
#[cfg(feature = "gpu")]
mod papers;
#[cfg(feature = "gpu")]
mod pictures;
mod pipeline;
mod report;
mod shader;
mod workshop;
