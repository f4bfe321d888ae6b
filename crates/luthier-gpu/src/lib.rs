//! The runtime: it takes the package of a bake, and nothing else. It binds the emitted shader on a wgpu device, evaluates it
//! for arrays of directions, reads its tables, renders pictures, and simulates the layers that the package records.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Every call blocks until the device has answered. Group 0 is the shader's, as the manifest lists it; group 1
//! belongs to the kernels of this crate (`src/wgsl`), which are appended to the text of the shader.
//!
//! Modules, each on those above it: `error`; `context`, `light`, `shape`, `tone`; `surroundings`, `bindings`, `floor`, `mesh`; `scene`, a package on a
//! device; `gpu`, `evaluate`, `shown`, `maps`; `places`, `lookup`, `time`; `render`, `simulate`.
//!
//! Simplifications: one device at a time, compute passes only (the renderer is a compute kernel, so that it runs wherever
//! evaluation does), shapes that rays meet in closed form without shadows, meshes with shadows and with little light between their parts, and a
//! timeout per submission in place of cancellation.

mod bindings;
mod context;
mod error;
mod evaluate;
mod floor;
mod gpu;
mod light;
mod lookup;
mod maps;
mod mesh;
mod places;
mod render;
mod scene;
mod shape;
mod shown;
mod simulate;
mod surroundings;
mod time;
mod tone;

pub use error::GpuError;
pub use gpu::Gpu;
pub use light::Light;
pub use luthier_environment::{Blur, Environment, EnvironmentError, Scenery, Sky, SoftLight};
pub use luthier_export::{Map, Package, PackageError, Shader, Table};
pub use luthier_manifest::{LayerValues, PlaceValues};
pub use luthier_mesh::{Mesh, MeshError, model, scene, soup};
pub use places::Spot;
pub use render::{Backdrop, RenderSettings};
pub use scene::{LiveValue, Scene};
pub use shape::{Camera, GRID_SIDE, Shape};
pub use shown::Shown;
pub use simulate::{Facets, Simulated, Simulation, SimulationSettings};
pub use time::{Stopwatch, Threads, Workload};
pub use tone::ToneMapping;
