//! Containers: KTX2 for shipped texels, EXR for unquantised values, PNG to look at. Files of other programs are read
//! too: pictures of radiance ([`radiance`]), maps ([`picture`]: PNG, JPEG, WebP) and tables ([`table`]: DDS, KTX2, EXR,
//! PNG, raw). The bytes of a file depend on its content only; no function reads a clock or starts a thread.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Every reader takes untrusted bytes. Sizes are checked against [`MAX_SIDE`] and [`MAX_BYTES`] before memory is
//! allocated for them, and memory grows with the data found, not with the data promised.
//!
//! The codecs come from the crates `ktx2`, `ruzstd`, `exr`, `png` and `image`. Radiance HDR and the headers of OpenEXR
//! are read here, since their attributes and lines change values and places.
//!
//! Simplifications: written textures have one layer; written EXR files are single-part scan-line images of 32-bit
//! floats.
//!
//! # Rooms
//!
//! Each room uses those above it, none below.
//!
//! - `limits`, `error`, `size`: limits, refusals, and sizes that are checked.
//! - `metadata`, `srgb`, `texels`, `texture`, `zstd`: texels with their notes, and how they are stored.
//! - [`ktx2`], [`exr`], [`png`], [`picture`], `dds`, [`radiance`]: one container each.
//! - [`table`]: tables of any of these.

mod dds;
mod error;
pub mod exr;
pub mod ktx2;
mod limits;
mod metadata;
pub mod picture;
pub mod png;
pub mod radiance;
mod size;
mod srgb;
pub mod table;
mod texels;
mod texture;
mod zstd;

pub use error::{Container, TextureError};
pub use limits::{MAX_BYTES, MAX_SIDE};
pub use metadata::Metadata;
pub use texels::Samples;
pub use texture::Texture;
