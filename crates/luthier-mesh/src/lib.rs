//! Triangles for pictures of materials.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`soup`] reads a glTF file. [`Mesh::new`] prepares its triangles for rays: fitted into the unit sphere, with
//! tangents, a tree of boxes and the openness of each vertex. [`model`] is a mesh of the project's own.
//!
//! [`Asset`] opens a glTF file for what it says of materials and pictures.
//!
//! Simplifications of triangles: textures, materials, lights and cameras of a file are not read, except the colour of parts with a
//! material named `plain`. Openness is a number of a vertex, and linear between vertices.
//!
//! # Rooms
//!
//! Each room uses those above it, none below.
//!
//! - `vector`, `error`, `soup`, `bvh`: vectors, refusals, triangles, and a tree of boxes around them.
//! - `normals`, `tangents`, `openness`: what vertices lack.
//! - `mesh`, `gltf`: triangles ready for rays, and files of triangles.
//! - [`model`]: the project's own mesh.

mod bvh;
mod error;
mod gltf;
mod mesh;
pub mod model;
mod normals;
mod openness;
mod soup;
mod tangents;
mod vector;

pub use bvh::{Bvh, Meeting, Node};
pub use error::MeshError;
pub use gltf::{Asset, File, PICTURE_BYTES_MAX, scene, soup};
pub use mesh::Mesh;
pub use soup::{Soup, TRIANGLES_MAX, Triangle, Vertex};
