//! Formulas that engines draw materials of exchange formats by, to compare with and to fit. They are no models of layers, and the registry has none of them.

pub mod facets;
pub mod gltf;
pub mod materialx;
pub mod open_pbr;
pub mod standard_surface;
