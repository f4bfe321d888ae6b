//! Features: the words that conditions in the modules may name.

luthier_lut::named! {
    /// A feature that the materials of a set use. One material is enough.
    pub enum Feature("feature") {
        /// A layer that its model reads is a dielectric or a conductor.
        Interface = "interface",
        /// A model meets a diffuse base.
        Diffuse = "diffuse",
        /// A dielectric lies above another layer that the model reads.
        Below = "below",
        /// A dielectric above another layer absorbs.
        Absorption = "absorption",
        /// Conductors need code of their own.
        Conductor = "conductor",
        /// An interface has no film.
        Bare = "bare",
        /// An interface has a film.
        Film = "film",
        /// An interface has an F0 in place of an index.
        Schlick = "schlick",
        /// An interface with an F0 has an edge tint.
        EdgeTint = "edge_tint",
        /// Light is totally reflected at an interface.
        TotalReflection = "total_reflection",
        /// The shader refracts directions.
        Bent = "bent",
        /// A layer has two slope parameters, and its model shows them.
        Anisotropic = "anisotropic",
        /// A layer has the slopes of Beckmann.
        Beckmann = "beckmann",
        /// A layer has the slopes of GGX.
        Ggx = "ggx",
        /// A layer has the slopes of Blinn.
        Blinn = "blinn",
        /// A layer has the slopes of ABC.
        Abc = "abc",
        /// A layer has the slopes of SGD.
        Sgd = "sgd",
        /// The set has more than one distribution of slopes.
        SeveralSlopes = "several_slopes",
        /// The set has `blinn`, `abc` or `sgd`.
        FreeSlopes = "free_slopes",
        /// A base has slopes.
        OrenNayar = "oren_nayar",
        /// A base moves light to other channels, and its model shows it.
        Fluorescent = "fluorescent",
        /// At some depth one material has an interface and another a base.
        Mixed = "mixed",
        /// The form is `full`.
        Full = "full",
        /// D is computed for some layer.
        Closed = "closed",
        /// A layer takes its reflectance from rows.
        Tabled = "tabled",
        /// A layer takes its reflectance from Fresnel's equations.
        Exact = "exact",
        /// A layer takes its reflectance from a curve.
        Fitted = "fitted",
        /// The curve of some reflectance has a correction.
        Lazanyi = "lazanyi",
        /// Some reflectance is read.
        Rows = "rows",
        /// Some reflectance is computed.
        Computed = "computed",
        /// An interface whose reflectance is computed has another index in each channel, or absorbs.
        ComplexIndex = "complex_index",
        /// Reflectances come from more than one source.
        SeveralReflectances = "several_reflectances",
        /// A material chooses a masking.
        Masked = "masked",
        /// The set has several maskings.
        SeveralMaskings = "several_maskings",
        /// A material has the masking of Smith.
        MaskSmith = "mask_smith",
        /// A material has the masking of Smith for each direction.
        MaskSmithSeparable = "mask_smith_separable",
        /// A material has the masking of Schlick.
        MaskSchlickSmith = "mask_schlick_smith",
        /// A material has the masking of V-cavities.
        MaskVCavity = "mask_v_cavity",
        /// A material has the masking of Kelemen and Szirmay-Kalos.
        MaskKelemen = "mask_kelemen",
        /// A material has the implicit masking.
        MaskImplicit = "mask_implicit",
        /// Records have choices of parts.
        Packed = "packed",
        /// A material chooses the term of internal reflection.
        Internal = "internal",
        /// A material chooses transmission at the angles of the directions.
        OwnAngles = "own_angles",
        /// A material chooses the cosine of the refracted direction for lower interfaces.
        InnerCosine = "inner_cosine",
        /// A material of a path chooses Kelemen's masking.
        KelemenCavities = "kelemen_cavities",
        /// A material chooses lobes of a power for lower interfaces.
        PowerFacets = "power_facets",
        /// A material chooses slope parameters of lower interfaces that are at least those above.
        RougherBelow = "rougher_below",
        /// Words of a layer have parts beyond its internal reflection.
        Beyond = "beyond",
        /// A table has a format that no sampler filters.
        Bilinear = "bilinear",
        /// The axis of a look-up is an angle.
        ThetaAxis = "theta_axis",
        /// A look-up reads D as a root.
        SplitRoot = "split_root",
        /// A look-up reads a difference to Schlick's form.
        SchlickBase = "schlick_base",
        /// The shader reads rows of reflectance.
        Fresnel = "fresnel",
        /// The shader reads D.
        Distribution = "distribution",
        /// The shader reads albedos of interfaces.
        Fgd = "fgd",
        /// The shader reads phases of films.
        Phase = "phase",
        /// The shader reads thicknesses of films.
        Thickness = "thickness",
        /// The shader reads shares of lobes that escape total reflection.
        Escape = "escape",
        /// The shader reads rows of lobes.
        Lobes = "lobes",
        /// The shader reads reflectances of films that vary.
        FilmTable = "film_table",
        /// A path of `elek` or `weidlich-wilkie` meets an interface.
        Chain = "chain",
        /// A path of `elek` or `weidlich-wilkie` meets a base.
        ChainDiffuse = "chain_diffuse",
        /// A path of `elek` or `weidlich-wilkie` meets patina.
        ChainPatina = "chain_patina",
        /// Elek's clamp of slope parameters can act.
        Clamped = "clamped",
        /// A material of `belcour` or `yamaguchi` has an interface.
        Statistics = "statistics",
        /// A set with interfaces of `belcour` or `yamaguchi` has a base of the same model.
        StatisticsBase = "statistics_base",
        /// A material of `microfacet` has an interface.
        Smith = "smith",
        /// A material of `microfacet` is a base alone.
        MicrofacetDiffuse = "microfacet_diffuse",
        /// A material of `microfacet` adds the light of its base.
        MicrofacetBase = "microfacet_base",
        /// A material has the model `phong`.
        Phong = "phong",
        /// A material has the model `granier-heidrich`.
        Granier = "granier",
        /// A material of `granier-heidrich` has a film.
        GranierFilm = "granier_film",
        /// A material of `granier-heidrich` is transparent.
        GranierTransparent = "granier_transparent",
        /// A material of `granier-heidrich` is a bare metal.
        GranierBare = "granier_bare",
        /// A material of `granier-heidrich` has an F0.
        GranierSchlick = "granier_schlick",
        /// A material of `granier-heidrich` has a base.
        GranierBase = "granier_base",
        /// A material of `granier-heidrich` states its own numbers.
        GranierOwn = "granier_own",
        /// The inner boundary of a material of `granier-heidrich` leans.
        GranierTilted = "granier_tilted",
        /// Lobes of a material of `granier-heidrich` have height one.
        GranierHeight = "granier_height",
        /// A material of `lobes` has an interface.
        Coat = "coat",
        /// A material of `lobes` is a base alone.
        LobesDiffuse = "lobes_diffuse",
        /// Facets of a material of `belcour` or `yamaguchi` count as level.
        Level = "level",
        /// No material of the set has more than one lobe.
        OneLobe = "one_lobe",
        /// A first interface above lobes reflects by a polynomial.
        LobesCurve = "lobes_curve",
        /// A material has a short lobe.
        LobesShort = "lobes_short",
        /// A material has one lobe of one width.
        LobesOneWidth = "lobes_one_width",
        /// Materials of the set have two lobes or more.
        TwoLobes = "two_lobes",
        /// Materials of the set have three lobes.
        ThreeLobes = "three_lobes",
        /// Materials of the set differ in the number of their lobes.
        LobesMixed = "lobes_mixed",
        /// Rows of lobes are over something beside the view.
        LobesRows = "lobes_rows",
        /// Rows of lobes are over azimuths.
        LobesAxes = "lobes_axes",
        /// Rows of lobes are over the thickness of a film.
        LobesFilm = "lobes_film",
        /// Rows of lobes are over patina, or over the weight of a coat.
        LobesPatina = "lobes_patina",
        /// Such rows are there, and bare places show a base.
        LobesBareBase = "lobes_bare_base",
        /// A coat with a weight lies over layers with lobes of their own.
        LobesSides = "lobes_sides",
        /// Such layers have rows.
        LobesSideRows = "lobes_side_rows",
        /// Such layers are a diffuse base alone.
        LobesSideBases = "lobes_side_bases",
        /// Either side of such a coat has a frame of its own, by the normals of its layers.
        LobesSideFrames = "lobes_side_frames",
        /// Lobes have the light of a base as a part.
        LobesBase = "lobes_base",
        /// Rows of lobes are those of a family: over slope parameters of single layers, with colours in closed form.
        LobesFamily = "lobes_family",
        /// Rows of a family are over the slope parameters of both coat and base.
        LobesCoats = "lobes_coats",
        /// The coat of a family has other slope parameters than the one of its layer.
        LobesCoatSlopes = "lobes_coat_slopes",
        /// The base of a family is metallic in places.
        LobesMetallic = "lobes_metallic",
        /// Light of such a family is absorbed below the coat.
        LobesTinted = "lobes_tinted",
        /// Such a slab varies above a base that keeps its colours.
        LobesLengths = "lobes_lengths",
        /// Lobes of a family have other tails than GGX.
        LobesTails = "lobes_tails",
        /// Maps of what the first slab absorbs give each channel a tile of rows over its thickness.
        LobesTints = "lobes_tints",
        /// Flakes, or own normals of interfaces, tilt lobes.
        LobesTilted = "lobes_tilted",
        /// A material of `lobes` has normals of single layers.
        LobesBumps = "lobes_bumps",
        /// Such a material has a diffuse base below interfaces, whose light is a part of the rows.
        LobesLean = "lobes_lean",
        /// Lobes have a critical angle of the view.
        CriticalView = "critical_view",
        /// A material varies over its surface, or the set has surfaces.
        Place = "place",
        /// The set has surfaces.
        Picks = "picks",
        /// A surface has particles.
        Particles = "particles",
        /// A surface has switches by noise.
        Noise = "noise",
        /// Single layers have maps.
        Layered = "layered",
        /// A map of a layer has normals.
        OwnNormals = "own_normals",
        /// A map of a layer has slope parameters.
        OwnAlphas = "own_alphas",
        /// A map of a layer has slope parameters along one direction.
        OwnWidths = "own_widths",
        /// A map of a layer has thicknesses.
        OwnSlabs = "own_slabs",
        /// A map of a layer has colours that its slab absorbs.
        OwnTints = "own_tints",
        /// Maps of a layer have base colours and metal, or an F0.
        OwnF0 = "own_f0",
        /// Facets of an interface have the F0 of such a place: not those of a coat in `lobes`.
        FacetsF0 = "facets_f0",
        /// The dielectric of a base has another F0 than 0.04, by a map or by the file.
        DielectricF0 = "dielectric_f0",
        /// A film lies on the base of such a material.
        FilmF0 = "film_f0",
        /// Such a metal has an edge tint.
        OwnEdge = "own_edge",
        /// Such base colours are brighter below a coat that does not darken them.
        Brightened = "brightened",
        /// A map of a layer has tangents.
        Tangents = "tangents",
        /// The base has a map.
        BaseColor = "base_color",
        /// A material has flakes, and its model shows them.
        Flakes = "flakes",
        /// A material has patina, and its model shows it.
        Patina = "patina",
        /// A material has a coat with a weight, and its model shows it.
        Weight = "weight",
        /// Such a coat is a film, in a model of paths.
        WeightFilm = "weight_film",
        /// A material has glitter.
        Glitter = "glitter",
        /// The function group `surface` was asked for.
        Surface = "surface",
        /// The shader has functions beside `luthier_eval`.
        Face = "face",
        /// Parts are drawn by visible normals.
        Visible = "visible",
        /// Parts are drawn by visible normals of V-cavities.
        Cavities = "cavities",
        /// Parts are drawn by powers of a cosine.
        Powers = "powers",
        /// Parts lie below boundaries.
        Media = "media",
        /// Parts lie below tilted boundaries.
        Tilted = "tilted",
        /// Draws that do not leave are folded back.
        Folded = "folded",
        /// The set has more than one model.
        Several = "several",
        /// The function group `environment` was asked for.
        Environment = "environment",
    }
}
