use serde::{Deserialize, Serialize};

/// A reflectance model that shaders evaluate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShadingModel {
    /// O. Elek, "Layered Materials in Real-Time Rendering", CESCG 2010.
    #[default]
    Elek,
    /// A. Weidlich and A. Wilkie, "Arbitrarily layered micro-facet surfaces", GRAPHITE 2007.
    WeidlichWilkie,
    /// X. Granier and W. Heidrich, "A Simple Layered RGB BRDF Model", Graphical Models 2003.
    GranierHeidrich,
    /// L. Belcour, "Efficient Rendering of Layered Materials using an Atomic Decomposition with Statistical Operators", SIGGRAPH
    /// 2018.
    Belcour,
    /// T. Yamaguchi et al., "Real-time Rendering of Layered Materials with Anisotropic Normal Distributions", SIGGRAPH Asia 2019.
    Yamaguchi,
    /// One Phong lobe over one diffuse term.
    Phong,
    /// The first interface alone: K. Torrance and E. Sparrow 1967, with the masking of Heitz 2014, eq. 99.
    Microfacet,
}

impl ShadingModel {
    /// All models, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::Elek,
        Self::WeidlichWilkie,
        Self::GranierHeidrich,
        Self::Belcour,
        Self::Yamaguchi,
        Self::Phong,
        Self::Microfacet,
    ];

    /// The name in files, manifests and on the command line; that of its f64 twin in luthier-layers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Elek => "elek",
            Self::WeidlichWilkie => "weidlich-wilkie",
            Self::GranierHeidrich => "granier-heidrich",
            Self::Belcour => "belcour",
            Self::Yamaguchi => "yamaguchi",
            Self::Phong => "phong",
            Self::Microfacet => "microfacet",
        }
    }

    /// Name and source, for headers and reports.
    pub fn title(self) -> &'static str {
        match self {
            Self::Elek => "elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010)",
            Self::WeidlichWilkie => {
                "weidlich-wilkie (A. Weidlich, A. Wilkie, Arbitrarily layered micro-facet surfaces, GRAPHITE 2007)"
            }
            Self::GranierHeidrich => {
                "granier-heidrich (X. Granier, W. Heidrich, A Simple Layered RGB BRDF Model, Graphical Models 2003)"
            }
            Self::Belcour => "belcour (L. Belcour, Efficient Rendering of Layered Materials, SIGGRAPH 2018)",
            Self::Yamaguchi => {
                "yamaguchi (T. Yamaguchi et al., Layered Materials with Anisotropic Normal Distributions, SIGGRAPH Asia 2019)"
            }
            Self::Phong => "phong (B. T. Phong, Illumination for computer generated pictures, 1975)",
            Self::Microfacet => "microfacet (K. Torrance, E. Sparrow 1967; masking of E. Heitz 2014)",
        }
    }

    /// The model of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == name)
    }

    /// Its number in the material buffer.
    pub fn number(self) -> u32 {
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
            assert_eq!(ShadingModel::from_name(model.name()), Some(model));
            assert_eq!(serde_json::to_string(&model).unwrap(), format!("\"{}\"", model.name()));
        }
        assert_eq!(ShadingModel::from_name("Elek"), None);
    }
}
