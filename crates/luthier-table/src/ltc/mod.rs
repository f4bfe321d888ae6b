//! Area lights by linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed
//! Cosines").
//!
//! A [`Lobe`] is a clamped cosine behind a matrix. A [`LtcTable`] holds the lobe of each view and roughness of a rough
//! metal, with its albedo; a [`SheenTable`] holds the lobes of a layer of fibres.
//!
//! # Errors
//!
//! A difference of energy is half the integral of |lobe - reflection| over the albedo. No light of radiance 1 errs by
//! more.
//!
//! Measured with half floats, 64 x 64, half-way between texels, for cosines from 0.02 and alphas from 0.002 on: GGX has
//! a median of 0.020, 95 of 100 places below 0.124, and 0.37 at worst. Beckmann has 0.165, 0.206 and 0.47: no lobe of
//! this kind has its tails. The table of three.js and Bevy (GGX) has 0.031, 0.212 and 0.38.
//!
//! Rectangles of [`LtcTable::irradiance_error`] err by 0.0025 in the median and 0.044 of the albedo at worst; with the
//! table of three.js and Bevy by 0.0061 and 0.19. That table's albedo was sampled, and is too low by up to 0.046 near
//! the surface (roughness 24/63, cosine 0.03). The example `judge_ltc` measures all of these.
//!
//! Simplifications: a lobe is fitted without Fresnel, which engines bring in by the norms. The part of a lobe below the
//! surface is lost or leaks, as engines clip. A texel has one matrix, so reads of small alphas between texels err where
//! the matrix bends.

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
