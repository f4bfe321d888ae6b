//! Views of a shape.

use luthier_gpu::Shape;

use crate::look::Look;
use crate::orbit::Orbit;

/// A view: the shape, its light, and the place of the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    pub(crate) shape: Shape,
    pub(crate) orbit: Orbit,
    pub(crate) look: Look,
    /// Colour behind the shape if the surroundings are not shown.
    pub(crate) backdrop: [f32; 3],
    /// Pixels across and down.
    pub(crate) size: [u32; 2],
    /// Samples along each side of a pixel at rest.
    pub(crate) samples: u32,
    /// Directions of the environment at rest; 0 reads blurred maps where the form can.
    pub(crate) environment_samples: u32,
    /// Whether the mouse is at work.
    pub(crate) moving: bool,
}
