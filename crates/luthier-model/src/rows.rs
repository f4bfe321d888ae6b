//! The rows of facts, one for each model, and the models that they are rows of.

use luthier_lut::TableKind;
use serde::{Deserialize, Serialize};

use crate::domain::{BETWEEN_ROWS, BRIGHT, FEW_NODES, ONE_SURFACE};
use crate::facts::{Facts, Family, Reach, ReadWhen, Shows, TableRead};
use crate::tolerance::{
    BEAMS_IN_F32, ENERGY_TABLE, FILTERED_BELOW_A_COAT, FILTERED_BY_HARDWARE, LAYERS_IN_F32, LOBE_READ, LOBE_TABLE,
    LOBES_IN_F32, PHASE_TABLE, PHONG_IN_F32, ROW_TABLE, STATISTICS_IN_F32, Tolerance, Tolerances,
};
use crate::{DefaultFor, Feature, Feature::*, Form, ModelPart};

const fn read(kind: TableKind, when: ReadWhen) -> TableRead {
    TableRead { kind, when }
}

/// Tables of models that take the facets of interfaces as they are.
const FACET_TABLES: &[TableRead] = &[
    read(TableKind::Fresnel, ReadWhen::Steady),
    read(TableKind::Film, ReadWhen::Varying),
    read(TableKind::Thickness, ReadWhen::FirstVarying),
    read(TableKind::Distribution, ReadWhen::Always),
];

/// Tables of models that follow statistics of lobes.
const STATISTICS_TABLES: &[TableRead] =
    &[read(TableKind::Fgd, ReadWhen::Tabled), read(TableKind::Escape, ReadWhen::DenserCoat)];

/// Layers below the first, and what slabs absorb.
const STACK: &[Feature] = &[InnerInterface, Base, Absorption, BaseAbsorption];
/// Facets of an interface, in the light of its film.
const FACETS: &[Feature] = &[Films, FilmVariation, DiffuseSlopes, Beckmann, Distribution];
/// Axes of a surface.
const AXES: &[Feature] = &[Anisotropy, Tangents];
/// Maps of normals, slopes and thicknesses.
const MAPS: &[Feature] =
    &[NormalMap, RoughnessMap, ThicknessMap, AbsorptionMap, LayerAlpha, InnerThickness, InnerAbsorptionMap];
/// Maps of colour.
const COLOR: &[Feature] = &[AlbedoMap, MetallicMap];
/// Effects of layers that are there in places.
const EFFECTS: &[Feature] = &[Flakes, Patina, Weight, FilmWeight, Glitter];

/// Headings that models share.
const ONE_LAYER: &str = "One layer";
const ELEK_AND_GRANIER: &str = "Elek, Granier and Heidrich";
const STATISTICS: &str = "Statistics of light";

/// Parts of models that go down a path, and one of its own.
const fn path_parts(own: ModelPart) -> [ModelPart; 7] {
    [
        ModelPart::Reflectance,
        ModelPart::InternalReflection,
        ModelPart::LowerReflectance,
        ModelPart::CavityMasking,
        ModelPart::LowerFacets,
        ModelPart::DiffusePart,
        own,
    ]
}

/// Tolerances of models that go down a path.
const PATH_TOLERANCES: Tolerances =
    Tolerances { table: LOBE_TABLE, baked: LOBE_READ, full: LAYERS_IN_F32, filtered: FILTERED_BELOW_A_COAT };

/// Tolerances of models that follow statistics of lobes.
const STATISTICS_TOLERANCES: Tolerances = Tolerances {
    table: ENERGY_TABLE,
    baked: STATISTICS_IN_F32,
    full: STATISTICS_IN_F32,
    filtered: FILTERED_BY_HARDWARE,
};

/// A path with one slope parameter per interface, and Elek's clamp.
const ELEK: Facts = Facts {
    title: "elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010)",
    heading: ELEK_AND_GRANIER,
    beside: &["flakes", "patina"],
    family: Family::Path,
    reach: Reach::All,
    is_isotropic: true,
    forms: &[Form::Baked, Form::Full],
    // Records have one film of an interface; tables are made of all.
    shows: Shows {
        always: &[STACK, FACETS, MAPS, COLOR, EFFECTS, &[Bumps, Reradiation]],
        baked: &[InnerFilms],
        full: &[],
    },
    tables: FACET_TABLES,
    parts: &path_parts(ModelPart::LowerCosine),
    domain: &[BRIGHT],
    tolerances: PATH_TOLERANCES,
    default_for: &[(DefaultFor::Closed, 0)],
};

/// A path with both slope parameters.
const WEIDLICH_WILKIE: Facts = Facts {
    title: "weidlich-wilkie (A. Weidlich, A. Wilkie, Arbitrarily layered micro-facet surfaces, GRAPHITE 2007)",
    heading: "Weidlich and Wilkie",
    beside: &["fluorescence"],
    family: Family::Path,
    reach: Reach::All,
    is_isotropic: false,
    forms: &[Form::Baked, Form::Full],
    shows: Shows {
        always: &[STACK, FACETS, AXES, MAPS, COLOR, EFFECTS, &[Bumps, Reradiation]],
        baked: &[InnerFilms],
        full: &[],
    },
    tables: FACET_TABLES,
    parts: &path_parts(ModelPart::LowerAlpha),
    domain: &[BRIGHT],
    tolerances: PATH_TOLERANCES,
    default_for: &[(DefaultFor::Closed, 1)],
};

/// Beams of one film over a base.
const GRANIER_HEIDRICH: Facts = Facts {
    title: "granier-heidrich (X. Granier, W. Heidrich, A Simple Layered RGB BRDF Model, Graphical Models 2003)",
    heading: ELEK_AND_GRANIER,
    beside: &[],
    family: Family::Beams,
    reach: Reach::FirstAndBase,
    is_isotropic: true,
    forms: &[Form::Baked, Form::Full],
    shows: Shows {
        always: &[&[Base, Films, FilmVariation, NormalMap, RoughnessMap, LayerAlpha, AlbedoMap, Glitter, LeanMap]],
        baked: &[],
        full: &[],
    },
    tables: &[
        // Transparent interfaces without a film are Schlick's form.
        read(TableKind::Phase, ReadWhen::Filmed),
        read(TableKind::Thickness, ReadWhen::Filmed),
        read(TableKind::Fresnel, ReadWhen::BareConductor),
    ],
    parts: &[ModelPart::Beams],
    domain: &[ONE_SURFACE, FEW_NODES],
    tolerances: Tolerances {
        table: PHASE_TABLE,
        baked: BEAMS_IN_F32,
        full: BEAMS_IN_F32,
        filtered: FILTERED_BY_HARDWARE,
    },
    default_for: &[],
};

/// Statistics with one variance.
const BELCOUR: Facts = Facts {
    title: "belcour (L. Belcour, Efficient Rendering of Layered Materials, SIGGRAPH 2018)",
    heading: STATISTICS,
    beside: &[],
    family: Family::Statistics,
    reach: Reach::All,
    is_isotropic: true,
    forms: &[Form::Baked, Form::Full],
    // Albedos are tabulated at the nominal thickness of a film.
    shows: Shows {
        always: &[STACK, MAPS, COLOR, &[Films, DiffuseSlopes, Glitter]],
        baked: &[InnerFilms],
        full: &[FilmVariation],
    },
    tables: STATISTICS_TABLES,
    parts: &[ModelPart::Reflectance],
    domain: &[],
    tolerances: STATISTICS_TOLERANCES,
    default_for: &[(DefaultFor::Stack, 1)],
};

/// Statistics with a matrix of covariances.
const YAMAGUCHI: Facts = Facts {
    title: "yamaguchi (T. Yamaguchi et al., Layered Materials with Anisotropic Normal Distributions, SIGGRAPH Asia 2019)",
    heading: STATISTICS,
    beside: &[],
    family: Family::Statistics,
    reach: Reach::All,
    is_isotropic: false,
    forms: &[Form::Baked, Form::Full],
    shows: Shows {
        always: &[STACK, AXES, MAPS, COLOR, &[Films, DiffuseSlopes, Glitter]],
        baked: &[InnerFilms],
        full: &[FilmVariation],
    },
    tables: STATISTICS_TABLES,
    parts: &[ModelPart::Reflectance],
    domain: &[],
    tolerances: STATISTICS_TOLERANCES,
    default_for: &[(DefaultFor::Stack, 2)],
};

/// One lobe of a power over one diffuse term.
const PHONG: Facts = Facts {
    title: "phong (B. T. Phong, Illumination for computer generated pictures, 1975)",
    heading: ONE_LAYER,
    beside: &[],
    family: Family::Coefficients,
    reach: Reach::None,
    is_isotropic: false,
    forms: &[Form::Baked, Form::Full],
    // Coefficients are computed from the stack at normal incidence: what changes these is not left out. The diffuse one is the albedo of
    // the base, less what interfaces reflect.
    shows: Shows {
        always: &[&[InnerInterface, Base, Absorption, Films, InnerFilms, NormalMap, RoughnessMap, Glitter]],
        baked: &[],
        full: &[],
    },
    tables: &[],
    parts: &[],
    domain: &[],
    tolerances: Tolerances {
        table: Tolerance::NO_TABLE,
        baked: PHONG_IN_F32,
        full: PHONG_IN_F32,
        filtered: PHONG_IN_F32,
    },
    default_for: &[],
};

/// The facets of the first interface.
const MICROFACET: Facts = Facts {
    title: "microfacet (K. Torrance, E. Sparrow 1967; masking of E. Heitz 2014)",
    heading: ONE_LAYER,
    beside: &[],
    family: Family::Facets,
    reach: Reach::First,
    is_isotropic: false,
    forms: &[Form::Baked, Form::Full],
    // V-cavities and the other maskings without Smith's Lambda need no more than D of a distribution.
    shows: Shows {
        always: &[FACETS, AXES, COLOR, &[NormalMap, RoughnessMap, LayerAlpha, Glitter]],
        baked: &[InnerFilms],
        full: &[],
    },
    tables: FACET_TABLES,
    parts: &[ModelPart::Masking, ModelPart::Reflectance, ModelPart::DiffuseTerm],
    domain: &[],
    tolerances: Tolerances { table: LOBE_TABLE, baked: LOBE_READ, full: LAYERS_IN_F32, filtered: FILTERED_BY_HARDWARE },
    default_for: &[],
};

/// The facets of the first interface over rows of lobes.
const LOBES: Facts = Facts {
    title: "lobes (luthier's own: lobes fitted to a simulation of the stack)",
    heading: "Lobes fitted to the reference",
    beside: &[],
    family: Family::Lobes,
    reach: Reach::First,
    is_isotropic: false,
    forms: &[Form::Baked],
    // Rows are over azimuths against axes that stay, or over slope parameters of coat and base; the light of a base, which is in proportion to its
    // albedo, is a part of its own.
    shows: Shows {
        always: &[
            STACK,
            EFFECTS,
            &[
                Films,
                InnerFilms,
                FilmVariation,
                DiffuseSlopes,
                Anisotropy,
                Beckmann,
                NormalMap,
                RoughnessMap,
                ThicknessMap,
                AbsorptionMap,
                Bumps,
                Tangents,
                AlbedoMap,
                LayerAlpha,
                MetallicMap,
            ],
        ],
        baked: &[],
        full: &[],
    },
    tables: &[
        read(TableKind::Fresnel, ReadWhen::Steady),
        read(TableKind::Film, ReadWhen::Varying),
        read(TableKind::Thickness, ReadWhen::FirstVarying),
        read(TableKind::Distribution, ReadWhen::Always),
        read(TableKind::Phase, ReadWhen::OverF0),
        read(TableKind::Thickness, ReadWhen::VaryingOverF0),
        read(TableKind::Lobes, ReadWhen::Always),
    ],
    parts: &[],
    domain: &[BETWEEN_ROWS],
    tolerances: Tolerances {
        table: ROW_TABLE,
        baked: LOBES_IN_F32,
        full: LOBES_IN_F32,
        filtered: FILTERED_BELOW_A_COAT,
    },
    default_for: &[(DefaultFor::Stack, 0), (DefaultFor::Facets, 0)],
};

macro_rules! models {
    ($($(#[$about:meta])* $model:ident = $name:literal: $facts:expr,)*) => {
        luthier_lut::named! {
            /// A reflectance model that shaders evaluate.
            #[derive(Default, Serialize, Deserialize)]
            #[serde(into = "&'static str", try_from = "String")]
            pub enum ShadingModel("model") {
                $($(#[$about])* $model = $name,)*
            }
        }

        /// The row of a model.
        pub(crate) const fn row(model: ShadingModel) -> &'static Facts {
            match model {
                $(ShadingModel::$model => &$facts,)*
            }
        }
    };
}

// A model's number in the material buffer is its place here: new ones come last.
models! {
    /// O. Elek, "Layered Materials in Real-Time Rendering", CESCG 2010.
    #[default]
    Elek = "elek": ELEK,
    /// A. Weidlich and A. Wilkie, "Arbitrarily layered micro-facet surfaces", GRAPHITE 2007.
    WeidlichWilkie = "weidlich-wilkie": WEIDLICH_WILKIE,
    /// X. Granier and W. Heidrich, "A Simple Layered RGB BRDF Model", Graphical Models 2003.
    GranierHeidrich = "granier-heidrich": GRANIER_HEIDRICH,
    /// L. Belcour, "Efficient Rendering of Layered Materials using an Atomic Decomposition with Statistical Operators", SIGGRAPH
    /// 2018.
    Belcour = "belcour": BELCOUR,
    /// T. Yamaguchi et al., "Real-time Rendering of Layered Materials with Anisotropic Normal Distributions", SIGGRAPH Asia 2019.
    Yamaguchi = "yamaguchi": YAMAGUCHI,
    /// One Phong lobe over one diffuse term.
    Phong = "phong": PHONG,
    /// The first interface alone: K. Torrance and E. Sparrow 1967, with the masking of Heitz 2014, eq. 99.
    Microfacet = "microfacet": MICROFACET,
    /// The first interface, and the simulated light from below it in lobes.
    Lobes = "lobes": LOBES,
}
