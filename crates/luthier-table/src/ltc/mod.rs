//! Area lights by linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed
//! Cosines").

mod fibres;
mod fit;
mod judge;
mod lobe;
mod sheen;
mod simplex;
mod sphere;
mod table;
mod target;

pub use judge::{IrradianceError, LtcError, PlacedError};
pub use lobe::Lobe;
pub use sheen::SheenTable;
pub use sphere::clipped_sphere_form_factor;
pub use table::{LtcTable, LtcTexels};
