//! Imports of whole files.

mod gltf;
mod odd;
