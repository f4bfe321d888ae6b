//! Features of a material that a model may leave out.

luthier_lut::named! {
    /// A feature that a material file can ask for and a model can leave out.
    ///
    /// ```
    /// use luthier_model::{Feature, Form, ShadingModel};
    ///
    /// // Models that show tilted tangents also show anisotropy.
    /// let turned = ShadingModel::ALL.into_iter().filter(|model| model.honours(Feature::Tangents, Form::Baked));
    /// assert!(turned.clone().all(|model| model.honours(Feature::Anisotropy, Form::Baked)));
    /// assert_eq!(turned.map(ShadingModel::name).collect::<Vec<_>>(), ["weidlich-wilkie", "yamaguchi", "microfacet", "lobes"]);
    /// ```
    pub enum Feature("feature") {
        /// Dielectrics and conductors below the first layer.
        InnerInterface = "layers below the first",
        /// The diffuse base below the first layer.
        Base = "the diffuse base",
        /// Absorption by slabs of the light of interfaces below.
        Absorption = "absorption",
        /// Absorption by slabs of the light of the diffuse base.
        BaseAbsorption = "absorption above the diffuse base",
        /// The first film of an interface.
        Films = "films",
        /// Films below the first one of an interface.
        InnerFilms = "films below the first of an interface",
        /// A film whose thickness varies over the surface.
        FilmVariation = "variation of a film's thickness",
        /// Slopes of a diffuse base: Oren and Nayar's model in place of Lambert's.
        DiffuseSlopes = "diffuse slopes",
        /// Different slope parameters along two axes, and where these point.
        Anisotropy = "anisotropy",
        /// Beckmann's distribution of slopes in place of GGX.
        Beckmann = "Beckmann's distribution",
        /// A normal map.
        NormalMap = "the normal map",
        /// A roughness map.
        RoughnessMap = "the roughness map",
        /// A map of the thickness of the first slab.
        ThicknessMap = "the thickness map",
        /// A normal map of one layer alone.
        Bumps = "the bumps of one layer",
        /// A map of the slope parameters of one layer.
        LayerAlpha = "the alpha map of one layer",
        /// A map of the tangents of one layer.
        Tangents = "the tangent map",
        /// A map of the thickness of a slab below the first.
        InnerThickness = "the thickness map of an inner slab",
        /// A map of what the first slab absorbs, by channel.
        AbsorptionMap = "the absorption map",
        /// Such a map of a slab below the first.
        InnerAbsorptionMap = "the absorption map of an inner slab",
        /// A map of the albedo of the diffuse base.
        AlbedoMap = "the albedo map",
        /// Maps of base colour and metal of a metallic-roughness surface, and of the F0 of interfaces.
        MetallicMap = "maps of base colour, metal and F0",
        /// Flakes below the first interface.
        Flakes = "flakes",
        /// Patina: a first layer that covers the others in places only.
        Patina = "patina",
        /// A coat whose weight is below 1 or in a map: a first layer that covers a share of the others.
        Weight = "the weight of a coat",
        /// A film covers a share of the surface, by a number or a map.
        FilmWeight = "the weight of a film",
        /// Glitter: particles that are tilted.
        Glitter = "glitter",
        /// Fluorescence: a base that moves light to other wavelengths.
        Reradiation = "re-radiation",
        /// A distribution of slopes that has no walks in closed form: `blinn`, `abc`, `sgd`.
        Distribution = "the distribution of slopes",
        /// A map of the lean of a film's inner boundary.
        LeanMap = "the lean map",
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
            (ShadingModel::Elek, "#####b##.######.############."),
            (ShadingModel::WeidlichWilkie, "#####b######################."),
            (ShadingModel::Belcour, "#####bf#..###.#.#####....#..."),
            (ShadingModel::Yamaguchi, "#####bf##.###.#######....#..."),
            (ShadingModel::GranierHeidrich, ".#..#.#...##..#....#.....#..#"),
            (ShadingModel::Phong, "###.##....##.............#..."),
            (ShadingModel::Microfacet, "....#b######..##...##....#.#."),
            (ShadingModel::Lobes, "################.#.#######..."),
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
