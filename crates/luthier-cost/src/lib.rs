//! Costs of shaders on real GPU instruction sets, without a GPU.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Mesa's RADV driver offers a device without hardware if a variable names a family of chips. Its compiler then runs in full, and reports
//! instructions, registers, and cycles by its own model of the pipeline ([`Counts`]). The numbers depend on the kernels and the version
//! of the driver only. Nothing can run on such a device.
//!
//! The driver reads its environment once, when the Vulkan loader loads: [`compile`] is for a process that was started with
//! [`Family::environment`], one per family. [`compile_apart`] starts one, of a program whose `main` begins with [`answer`].
//! [`CostReport`] holds the counts of many shaders, and writes them as JSON and as a page.
//!
//! Simplifications: a texture read counts as issued, without cache misses. All branches of a kernel count, taken or not, so that a set of several
//! models costs their sum. Uniform registers and interpolation are free.
//!
//! Out of scope: files, arguments, time on a real device (`luthier-gpu`).

#[cfg(feature = "radv")]
mod apart;
#[cfg(feature = "radv")]
mod code;
mod counts;
mod device;
mod error;
mod family;
mod fit;
mod kernel;
#[cfg(feature = "radv")]
mod radv;
mod report;

#[cfg(feature = "radv")]
pub use apart::{answer, assembly_apart, compile_apart};
pub use counts::{Compiled, Counts};
pub use device::{Coefficients, CostUnit, DEFAULT_DEVICE, DeviceCost, FitSource};
pub use error::CostError;
pub use family::{FOREIGN_VARIABLES, Family};
pub use fit::{FitQuality, Misfit, Timing, misfit};
pub use kernel::{Binding, Harness, Kernel, Resource, Style, shader_text};
pub use luthier_shader::StaticCounts;
#[cfg(feature = "radv")]
pub use radv::{assembly, compile};
pub use report::{CostReport, CostRow, FamilyCost};
