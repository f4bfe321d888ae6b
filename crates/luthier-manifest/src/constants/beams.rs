//! Numbers of the model `granier-heidrich` that a material gives beside its layers.

use luthier_model::LobeHeight;
use serde::{Deserialize, Serialize};

/// Numbers of the model `granier-heidrich` that belong to no layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BeamsRecord {
    /// Slope parameter of the inner boundary over that of the outer one, `sqrt((e0 + 2) / (e1 + 2))`; the exponent of either is `2 / alpha^2 - 2`.
    pub inner_alpha_ratio: f64,
    /// Weight of the specular part (section 7 of their paper).
    pub specular_weight: f64,
    /// Weight of the diffuse part, beside the albedo of the base.
    pub diffuse_weight: f64,
    /// Normal of the inner boundary, unit, in the frame of the surface.
    pub inner_normal: [f64; 3],
    /// Height of both lobes; left out where it is the default.
    #[serde(default, skip_serializing_if = "is_scaled")]
    pub lobe_height: LobeHeight,
}

fn is_scaled(height: &LobeHeight) -> bool {
    *height == LobeHeight::Scaled
}

impl BeamsRecord {
    /// Parallel boundaries that are alike, and both parts at full weight: a material without numbers of its own.
    pub const PLAIN: Self = Self {
        inner_alpha_ratio: 1.0,
        specular_weight: 1.0,
        diffuse_weight: 1.0,
        inner_normal: [0.0, 0.0, 1.0],
        lobe_height: LobeHeight::Scaled,
    };

    /// Words 1 and 2 of the header, as [`crate::MaterialConstants::words`] has them. The last number is 1; that of a material without a record is 0.
    pub(crate) fn words(&self) -> [[f32; 4]; 2] {
        let [x, y, z] = self.inner_normal.map(|c| c as f32);
        let ratio = self.inner_alpha_ratio as f32;
        let height = self.lobe_height.number() as f32;
        [[ratio, self.specular_weight as f32, self.diffuse_weight as f32, height], [x, y, z, 1.0]]
    }
}
