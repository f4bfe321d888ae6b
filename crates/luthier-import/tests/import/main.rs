//! Imports of whole files.

mod gltf;
mod materialx;
mod odd;
mod physically_based;
