//! Imports of whole files.

mod gltf;
mod odd;
mod physically_based;
