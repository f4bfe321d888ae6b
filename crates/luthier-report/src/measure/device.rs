//! Interface to a device that runs the emitted shaders.

use luthier_manifest::{Form, PlaceValues};

use crate::Pair;

/// A runner of the emitted shaders.
pub trait Device {
    /// Name of the adapter, as the report shows it.
    fn name(&self) -> String;

    /// All that decides its values but the numbers and texels of a material: the adapter, its driver, the text of the shaders. Results are kept under it.
    fn identity(&self) -> String;

    /// `f cos_theta_i`, linear RGB, of a material for pairs `(wi, wo)` of unit directions: one value per pair, in
    /// order.
    ///
    /// # Errors
    /// The failure, in words for the user.
    fn evaluate(&self, form: Form, material: u32, pairs: &[Pair]) -> Result<Vec<[f32; 3]>, String>;

    /// [`Self::evaluate`] with a place of the surface for each pair.
    ///
    /// # Errors
    /// The failure, in words for the user.
    fn evaluate_at(&self, form: Form, material: u32, spots: &[(PlaceValues, Pair)]) -> Result<Vec<[f32; 3]>, String>;
}
