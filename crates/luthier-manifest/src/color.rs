//! Colour of tables.

use serde::{Deserialize, Serialize};

luthier_lut::named! {
    /// How spectra become colour channels.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum ColorMode("colour") {
        /// Integrated against the CIE 1931 2-degree observer under D65, to linear Rec.709.
        #[default]
        Spectral = "spectral",
        /// The value at three wavelengths, taken for the three channels.
        ThreeWavelengths = "three-wavelengths",
    }
}
