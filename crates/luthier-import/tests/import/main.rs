//! Imports of whole files.

mod gltf;
