//! Formulas that models share: facets and their reflectance, refraction, diffuse bases, and plane stacks.

pub mod facets;
pub mod interface_fresnel;
pub mod normals;
pub mod oren_nayar;
pub mod plane_stack;
pub mod refraction;
pub mod transfer_matrix;
