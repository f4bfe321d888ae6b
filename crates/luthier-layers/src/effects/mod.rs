//! Surfaces that vary from place to place, and light that changes its wavelength.

pub mod flakes;
pub mod fluorescence;
pub mod heterogeneous;
pub mod layer_sample;
pub mod patina;
pub mod textured;
