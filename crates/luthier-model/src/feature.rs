//! Features of a material that a model may leave out.

/// A feature that a material file can ask for and a model can leave out.
///
/// ```
/// use luthier_model::{Feature, Form, ShadingModel};
///
/// // Models that show tilted tangents also show anisotropy.
/// let turned = ShadingModel::ALL.into_iter().filter(|model| model.honours(Feature::Tangents, Form::Baked));
/// assert!(turned.clone().all(|model| model.honours(Feature::Anisotropy, Form::Baked)));
/// assert_eq!(turned.map(ShadingModel::name).collect::<Vec<_>>(), ["weidlich-wilkie", "yamaguchi", "microfacet"]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// Dielectrics and conductors below the first layer.
    InnerInterface,
    /// The diffuse base below the first layer.
    Base,
    /// Absorption by slabs of the light of interfaces below.
    Absorption,
    /// Absorption by slabs of the light of the diffuse base.
    BaseAbsorption,
    /// The first film of an interface.
    Films,
    /// Films below the first one of an interface.
    InnerFilms,
    /// A film whose thickness varies over the surface.
    FilmVariation,
    /// Slopes of a diffuse base: Oren and Nayar's model in place of Lambert's.
    DiffuseSlopes,
    /// Different slope parameters along two axes, and where these point.
    Anisotropy,
    /// Beckmann's distribution of slopes in place of GGX.
    Beckmann,
    /// A normal map.
    NormalMap,
    /// A roughness map.
    RoughnessMap,
    /// A map of the thickness of the first slab.
    ThicknessMap,
    /// A normal map of one layer alone.
    Bumps,
    /// A map of the slope parameters of one layer.
    LayerAlpha,
    /// A map of the tangents of one layer.
    Tangents,
    /// A map of the thickness of a slab below the first.
    InnerThickness,
    /// A map of the albedo of the diffuse base.
    AlbedoMap,
    /// Maps of base colour and metal of a metallic-roughness surface.
    MetallicMap,
    /// Flakes below the first interface.
    Flakes,
    /// Patina: a first layer that covers the others in places only.
    Patina,
    /// Glitter: particles that are tilted.
    Glitter,
    /// Fluorescence: a base that moves light to other wavelengths.
    Reradiation,
    /// A distribution of slopes that has no walks in closed form: `blinn`, `abc`, `sgd`.
    Distribution,
}

impl Feature {
    /// All features.
    pub const ALL: [Self; 24] = [
        Self::InnerInterface,
        Self::Base,
        Self::Absorption,
        Self::BaseAbsorption,
        Self::Films,
        Self::InnerFilms,
        Self::FilmVariation,
        Self::DiffuseSlopes,
        Self::Anisotropy,
        Self::Beckmann,
        Self::NormalMap,
        Self::RoughnessMap,
        Self::ThicknessMap,
        Self::Bumps,
        Self::LayerAlpha,
        Self::Tangents,
        Self::InnerThickness,
        Self::AlbedoMap,
        Self::MetallicMap,
        Self::Flakes,
        Self::Patina,
        Self::Glitter,
        Self::Reradiation,
        Self::Distribution,
    ];

    /// The name in messages and manifests.
    pub fn name(self) -> &'static str {
        match self {
            Self::InnerInterface => "layers below the first",
            Self::Base => "the diffuse base",
            Self::Absorption => "absorption",
            Self::BaseAbsorption => "absorption above the diffuse base",
            Self::Films => "films",
            Self::InnerFilms => "films below the first of an interface",
            Self::FilmVariation => "variation of a film's thickness",
            Self::DiffuseSlopes => "diffuse slopes",
            Self::Anisotropy => "anisotropy",
            Self::Beckmann => "Beckmann's distribution",
            Self::NormalMap => "the normal map",
            Self::RoughnessMap => "the roughness map",
            Self::ThicknessMap => "the thickness map",
            Self::Bumps => "the bumps of one layer",
            Self::LayerAlpha => "the alpha map of one layer",
            Self::Tangents => "the tangent map",
            Self::InnerThickness => "the thickness map of an inner slab",
            Self::AlbedoMap => "the albedo map",
            Self::MetallicMap => "maps of base colour and metal",
            Self::Flakes => "flakes",
            Self::Patina => "patina",
            Self::Glitter => "glitter",
            Self::Reradiation => "re-radiation",
            Self::Distribution => "the distribution of slopes",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Form, ShadingModel};

    /// One column for each of [`Feature::ALL`]: `#` where both forms show the feature, `b` the baked one only, `f` the full one only.
    #[test]
    fn what_models_leave_out_is_as_written_here() {
        let shown = |model: ShadingModel| -> String {
            let column = |feature: Feature| match [Form::Baked, Form::Full].map(|form| model.honours(feature, form)) {
                [true, true] => '#',
                [true, false] => 'b',
                [false, true] => 'f',
                [false, false] => '.',
            };
            Feature::ALL.into_iter().map(column).collect()
        };
        for (model, expected) in [
            (ShadingModel::Elek, "#####b##.######.########"),
            (ShadingModel::WeidlichWilkie, "#####b##################"),
            (ShadingModel::Belcour, "#####bf#..###.#.###..#.."),
            (ShadingModel::Yamaguchi, "#####bf##.###.#####..#.."),
            (ShadingModel::GranierHeidrich, ".#..#.#...##..#..#...#.."),
            (ShadingModel::Phong, "###.##....##.........#.."),
            (ShadingModel::Microfacet, "....#b######..##.##..#.#"),
            (ShadingModel::Lobes, "#############....#.###.."),
        ] {
            assert_eq!(shown(model), expected, "{model}");
        }
    }

    #[test]
    fn names_of_features_differ() {
        let names: std::collections::BTreeSet<&str> = Feature::ALL.into_iter().map(Feature::name).collect();
        assert_eq!(names.len(), Feature::ALL.len());
        assert!(names.iter().all(|name| name.len() > 4), "{names:?}");
    }
}
