//! Reflectance models that shaders evaluate.

use serde::{Deserialize, Serialize};

luthier_lut::named! {
    /// A reflectance model that shaders evaluate.
    #[derive(Default, Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum ShadingModel("model") {
        /// O. Elek, "Layered Materials in Real-Time Rendering", CESCG 2010.
        #[default]
        Elek = "elek",
        /// A. Weidlich and A. Wilkie, "Arbitrarily layered micro-facet surfaces", GRAPHITE 2007.
        WeidlichWilkie = "weidlich-wilkie",
        /// X. Granier and W. Heidrich, "A Simple Layered RGB BRDF Model", Graphical Models 2003.
        GranierHeidrich = "granier-heidrich",
        /// L. Belcour, "Efficient Rendering of Layered Materials using an Atomic Decomposition with Statistical Operators", SIGGRAPH
        /// 2018.
        Belcour = "belcour",
        /// T. Yamaguchi et al., "Real-time Rendering of Layered Materials with Anisotropic Normal Distributions", SIGGRAPH Asia 2019.
        Yamaguchi = "yamaguchi",
        /// One Phong lobe over one diffuse term.
        Phong = "phong",
        /// The first interface alone: K. Torrance and E. Sparrow 1967, with the masking of Heitz 2014, eq. 99.
        Microfacet = "microfacet",
        /// The first interface, and the simulated light from below it in lobes.
        Lobes = "lobes",
    }
}

impl ShadingModel {
    /// Its number in the material buffer.
    pub const fn number(self) -> u32 {
        self as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_those_of_files_and_buffers() {
        for (i, model) in ShadingModel::ALL.into_iter().enumerate() {
            assert_eq!(model.number() as usize, i);
            assert!(model.title().starts_with(model.name()), "{model}");
            assert_eq!(ShadingModel::from_name(model.name()), Some(model));
            assert_eq!(serde_json::to_string(&model).unwrap(), format!("\"{}\"", model.name()));
        }
        assert_eq!(ShadingModel::from_name("Elek"), None);
    }
}
