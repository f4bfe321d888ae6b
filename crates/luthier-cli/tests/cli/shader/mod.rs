//! Shaders: their text, and what they cost.

#[cfg(feature = "gpu")]
mod bench;
#[cfg(feature = "cost")]
mod cost;
mod text;
