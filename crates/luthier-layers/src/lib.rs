//! Evaluation of layer stacks: the real-time models, each in f64 as the twin of its shader.
//!
//! Every model takes directions in the local frame (+z is the normal, both point away from the surface) and returns
//! `f cos_theta_i`, the BRDF times the cosine of the incident direction: that stays finite where the BRDF alone does
//! not.
//!
//! Out of scope: reading material files, tables, devices.

pub mod elek;
pub mod oren_nayar;
pub mod terms;
