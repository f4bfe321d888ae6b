//! Area lights by linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed
//! Cosines").
//!
//! A lobe is a clamped cosine behind a matrix: [`Lobe`]. A [`LtcTable`] holds the lobe of each view and roughness, with its albedo; a [`SheenTable`] that of a
//! layer of fibres.
//!
//! # Errors
//!
//! A difference of energy is half the integral of |lobe - reflection| over the albedo: the most that any light of radiance 1 errs by. Half floats, 64 x 64,
//! half-way between texels, cosines from 0.02 and alphas from 0.002 on: median 0.020, 95 of 100 below 0.124, worst 0.37 for GGX; 0.165, 0.206 and 0.47
//! for Beckmann, whose tails no lobe of this kind has. The table that three.js and Bevy hold: 0.031, 0.212 and 0.38. Rectangles of
//! [`LtcTable::irradiance_error`]: median 0.0025, worst 0.044 of the albedo; that table 0.0061 and 0.19. Its albedo was sampled,
//! and is too low by up to 0.046 near the surface (roughness 24/63, cosine 0.03). The example `judge_ltc` measures all of these.
//!
//! Simplifications: a lobe is fitted without Fresnel, which the norms bring in as engines have it; what lies of a lobe below the surface is lost or
//! leaks, as engines clip; one matrix for a texel, so that reads of small alphas between texels err where the matrix bends.

mod fibres;
mod fit;
mod judge;
mod lobe;
mod matrix;
mod sheen;
mod simplex;
mod sphere;
mod table;
mod target;

pub use judge::{IrradianceError, LtcError, PlacedError};
pub use lobe::Lobe;
pub use sheen::SheenTable;
pub use sphere::clipped_sphere_form_factor;
pub use table::{LtcTable, LtcTexels};
