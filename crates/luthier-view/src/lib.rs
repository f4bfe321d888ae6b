//! A window to look at materials and to edit them: [`run`] opens it and returns when it is closed.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Three threads work for the thread of the window, each on its latest order only. One watches files, one bakes the shown material, one renders it
//! and the picture beside it. While something moves the picture is small and coarse; at rest it is rendered again with more samples. A simulated
//! picture gathers paths until something changes that it depends on. If a material cannot be used, the last picture stays below the message.
//!
//! Files, bakes and shaders come from a [`Host`]; this crate knows neither paths nor the baker.
//!
//! Simplifications: the renderer has a device of its own, and its pixels travel through memory to the window's, so that
//! neither can bring down the other and both may use different adapters. Edits live in the window, which can copy them as a
//! text; nothing writes them to a file, and a change on disk replaces them and their history. On Linux the window speaks X11, which Wayland desktops understand.
//!
//! # Rooms
//!
//! Each uses only those above it.
//!
//! - `error`, `host`, `keys`, `look`, `orbit`, `parameter`, `theme`, `clipboard`, `history`, `shots`: words, numbers and orders of the window.
//! - `work`, `comparison`, `files`, `canvas`, `options`: threads and their results, comparisons, open files, textures, options.
//! - `app`, with `edits` and `sides`: the state of the window, its orders and their results.
//! - `panel`, `picture`, `frame`: one frame of it.
//! - `window`: the loop that runs it.

mod app;
mod canvas;
mod clipboard;
mod comparison;
mod edits;
mod error;
mod files;
mod frame;
mod history;
mod host;
mod keys;
mod look;
mod options;
mod orbit;
mod panel;
mod parameter;
mod picture;
mod shots;
mod sides;
mod theme;
mod window;
mod work;

pub use comparison::{Against, Comparison};
pub use error::ViewError;
pub use host::{Differences, Host, MaterialFile, Screenshot};
pub use look::Look;
pub use luthier_manifest::Form;
pub use options::Options;
pub use orbit::Orbit;
pub use parameter::{Group, Handle, Parameter, groups};
pub use shots::Shots;
pub use window::run;
