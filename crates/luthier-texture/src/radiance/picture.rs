//! Pictures as read, with notes.

use luthier_lut::Image;

/// A picture of radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Three channels, linear Rec.709.
    pub image: Image,
    /// A sentence for each part of the file that was converted or left out.
    pub notes: Vec<String>,
}
