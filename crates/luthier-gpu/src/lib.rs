//! The runtime: loads what a bake wrote, and nothing else, binds the emitted shader on a wgpu device, evaluates it
//! for arrays of directions, reads its tables, and renders a preview ball.
//!
//! ```no_run
//! # fn main() -> Result<(), luthier_gpu::GpuError> {
//! let artefacts = luthier_gpu::Artefacts::load(std::path::Path::new("out"))?;
//! let gpu = luthier_gpu::Gpu::open()?;
//! let scene = gpu.scene(&artefacts, "baked")?;
//! let up = [0.0, 0.0, 1.0];
//! let rgb = scene.evaluate(0, &[(up, up)])?;
//! # Ok(()) }
//! ```
//!
//! Every call blocks until the device has answered. Group 0 is the shader's, as the manifest lists it; group 1
//! belongs to the kernels of this crate (`src/wgsl`), which are appended to the text of the shader.
//!
//! Simplifications: one device at a time, compute passes only (the ball is a compute kernel, so that it runs wherever
//! evaluation does), and a timeout per submission in place of cancellation.
//!
//! Out of scope: windows, tone mapping, encoding pictures, the models themselves (the shader brings them).

mod artefacts;
mod ball;
mod bindings;
mod context;
mod error;
mod evaluate;
mod gpu;
mod lookup;
mod scene;
mod sky;

pub use artefacts::{Artefacts, TableTexels, WgslShader};
pub use ball::BallSettings;
pub use error::GpuError;
pub use gpu::Gpu;
pub use scene::Scene;
pub use sky::{Sky, SoftLight};
