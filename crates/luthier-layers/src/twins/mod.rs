//! Twins in f64 of the emitted shaders, with the terms that tables stand in for.

pub mod real_time;
pub mod shaded;
pub mod terms;
