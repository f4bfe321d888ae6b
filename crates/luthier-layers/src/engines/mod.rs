//! Formulas that engines draw materials of exchange formats by, to compare with. They are no models of layers, and the registry has none of them.

pub mod gltf;
