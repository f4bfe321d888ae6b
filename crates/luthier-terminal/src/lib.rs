//! Terminal code that the commands of this workspace share.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! - [`Failure`]: reasons to end with another exit code than 0, and the codes. A verb returns an [`Outcome`];
//! - [`print()`], [`deliver`], [`complain`], [`tell`]: the standard streams, whose readers may be gone. With `--events` standard error has lines of JSON only;
//! - [`Bar`]: progress of work that takes longer than a second;
//! - [`valid`]: the materials of files, with their diagnostics printed;
//! - [`Sources`], [`named`]: options that many verbs have; [`parse`] reads a command line;
//! - [`Shaders`], with the feature `gpu`: the graphics adapter as the judge sees it.
//!
//! # Rooms
//!
//! Each uses only those above it.
//!
//! - `failure`, `output`, `end`: failures, standard streams, and the end of a command.
//! - `command_line`, `device`, `materials`, `options`, `progress`: code that verbs share.

mod command_line;
#[cfg(feature = "gpu")]
mod device;
mod end;
mod failure;
mod materials;
mod options;
mod output;
mod progress;

pub use command_line::parse;
#[cfg(feature = "gpu")]
pub use device::{Shaders, adapter_json, adapter_label, open, surface_maps, without_display};
pub use failure::{Broken, Failure, Outcome, diagnostic, files};
pub use materials::{print_diagnostics, valid};
pub use options::{Sources, named};
pub use output::{
    STDOUT, bytes, complain, counted, deliver, has_colour, has_cursor, has_events, print, print_bytes, tell,
};
pub use progress::Bar;
