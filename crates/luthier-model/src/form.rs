//! Forms of an emitted shader.

use serde::{Deserialize, Serialize};

luthier_lut::named! {
    /// How a shader evaluates a material.
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum Form("form") {
        /// Reads the baked tables.
        Baked = "baked",
        /// Computes everything, at three wavelengths; binds the material buffer only.
        Full = "full",
    }
}
