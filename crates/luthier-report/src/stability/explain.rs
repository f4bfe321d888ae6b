//! Reasons why methods do not hold, each with a limit on the error that it explains.

use super::{Cell, Fault, Level, Verdict};

/// A reason, and the cells that it is for.
#[derive(Debug, Clone, Copy)]
pub struct Explanation {
    /// Its name.
    pub name: &'static str,
    /// Levels.
    pub levels: &'static [Level],
    /// Names of methods; one that ends or begins with `*` stands for all that begin or end so, and a model for all its tables.
    pub methods: &'static [&'static str],
    /// Identifiers of cases, likewise.
    pub cases: &'static [&'static str],
    /// Faults.
    pub faults: &'static [Fault],
    /// Largest error that it explains.
    pub limit: f64,
    /// The reason.
    pub reason: &'static str,
}

/// Stacks with something to see below a coat.
const COATS: &[&str] = &[
    "index-*",
    "layers-*",
    "depth-*",
    "matched",
    "furnace-*",
    "frosted-*",
    "q-zero",
    "rough-high",
    "from-inside",
    "tunnel",
    "soap",
    "grazing-*",
    "mirror-*",
];

/// Cases of one interface.
const METALS: &[&str] = &[
    "alpha-*",
    "film-*",
    "k-*",
    "furnace-1",
    "lossless-metal",
    "index-tiny",
    "gold",
    "brushed",
    "beckmann-*",
    "grazing-metal",
    "mirror-metal",
];

/// All reasons; the first that fits counts.
pub const EXPLANATIONS: &[Explanation] = &[
    Explanation {
        name: "INDEX_STORED_AS_10000",
        levels: &[Level::F32],
        methods: &["elek", "weidlich-wilkie"],
        cases: &["index-huge"],
        faults: &[Fault::Wrong],
        limit: 0.03,
        reason: "An index of 1e30 is stored as 10000, so that single precision can square it twice. Therefore 4e-4 of the light enters the coat, where none should.",
    },
    Explanation {
        name: "KINK_AT_THE_CRITICAL_ANGLE",
        levels: &[Level::Table, Level::Device],
        methods: &["elek", "weidlich-wilkie", "microfacet", "belcour", "yamaguchi"],
        cases: &["index-2.5e-1", "index-5e-1", "index-6.67e-1", "index-9e-1", "from-inside"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "Seen from the denser side, Fresnel's reflectance has a kink at the critical angle. A row or grid with equal steps of the cosine cuts the kink off: the error is up to 0.25 in the interval of the kink, and none elsewhere.",
    },
    Explanation {
        name: "FRINGES_FINER_THAN_THE_ROW",
        levels: &[Level::Table, Level::Device],
        methods: &["elek", "weidlich-wilkie", "microfacet", "belcour", "yamaguchi"],
        cases: &["film-5e3", "film-2e4", "film-spectral-20000"],
        faults: &[Fault::Wrong],
        limit: 0.05,
        reason: "The fringes of a thick film are a few texels wide on the cosine axis: a film of 20 um and index 1.4 has 38 fringes along the row at 445 nm. The baked form at three wavelengths shows them rounded off; the form without tables shows them in full.",
    },
    Explanation {
        name: "FRINGES_FINER_THAN_THE_PHASES",
        levels: &[Level::Table, Level::Device],
        methods: &["granier-heidrich"],
        cases: &["film-5e3", "film-2e4", "film-spectral-20000"],
        faults: &[Fault::Wrong],
        limit: 1.8,
        reason: "The phase row has 256 nodes from a phase of 0 to the phase of the thickest film. At 20 um and 445 nm a period is 2.0 nodes long, and 1.2 nodes at an index of 2.4, so that the value read has nothing to do with the cosine. Films of 5 um and more are outside the domain of the model.",
    },
    Explanation {
        name: "TABLES_ADD_UP",
        levels: &[Level::Table, Level::Device],
        methods: &["belcour", "yamaguchi"],
        cases: &["layers-3.2e1"],
        faults: &[Fault::Wrong],
        limit: 0.03,
        reason: "31 interfaces read their tables one after the other, and the errors add up. With 7 interfaces the sum is below 1%.",
    },
    Explanation {
        name: "RED_CLIPPED_IN_THE_ROW",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rgba8unorm, table of D", "*, rows of rgb10a2unorm"],
        cases: &["gold"],
        faults: &[Fault::Wrong],
        limit: 0.04,
        reason: "The red of gold is 1.0376, and a normalised format stores nothing above 1. By default a search takes rows of 10 bits only where their error is within 5e-4. Schlick rows reach 1.25.",
    },
    Explanation {
        name: "CODES_OF_EIGHT_BITS",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rgba8unorm, table of D"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 0.25,
        reason: "The format rounds a value by up to half a step, 0.002, which is 4% of the highlight of a coat of index 1.5. The errors of many coats add up.",
    },
    Explanation {
        name: "CODES_OF_TEN_BITS",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rgb10a2unorm"],
        cases: &["layers-*", "depth-*", "k-*"],
        faults: &[Fault::Wrong],
        limit: 0.04,
        reason: "The format rounds a value by up to half a step, 5e-4, which is 1% of the highlight of a coat of index 1.5. Interpolation between equal steps of the cosine errs by as much at grazing angles. The errors of many coats add up. A row for light that enters a thinner medium is read at the refracted cosine, and has the same error as the row for the way back.",
    },
    Explanation {
        name: "SIX_BITS_OF_MANTISSA",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rg11b10ufloat, computed phases"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 0.05,
        reason: "The format rounds red and green by at most 0.8% of the value, and blue by 1.6%. A product of two reflectances has twice that error.",
    },
    Explanation {
        name: "SCHLICK_IS_FAR",
        levels: &[Level::Table, Level::Device],
        methods: &["*, Schlick rows of rgba8unorm", "*, Schlick rows of rgb10a2unorm"],
        cases: &["layers-*", "tunnel"],
        faults: &[Fault::Wrong],
        limit: 0.08,
        reason: "Where light meets a thinner medium it is totally reflected at some angles, and Schlick's form is far from that. The differences that Schlick rows store are then as large as the values of plain rows, and are rounded as coarsely. The errors of 3 to 31 interfaces add up.",
    },
    Explanation {
        name: "VARIANCES_OF_ONE_FLOAT",
        levels: &[Level::F32, Level::Device],
        methods: &["yamaguchi"],
        cases: &["brushed"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "A surface of alpha 0.001 along and 1 across, turned by 0.5 rad, has a covariance matrix that mixes variances of 5e-4 and 9e3. Their ratio is about the rounding error of single precision, and the smaller one results from a difference.",
    },
    Explanation {
        name: "WALK_SQUARES",
        levels: &[Level::F64],
        methods: &["layered-mc*", "random-walk"],
        cases: &["k-1e150"],
        faults: &[Fault::NotFinite],
        limit: 0.0,
        reason: "The Fresnel formulas of the simulation take the fourth power of the index, which overflows a double from 1e77 on. No metal has a k above 1e3, and records of layers hold at most 10000.",
    },
    Explanation {
        name: "BETWEEN_THE_ROWS_OF_LOBES",
        levels: &[Level::F64],
        methods: &["lobes"],
        cases: &["index-2.5e-1", "index-5e-1", "index-6.67e-1", "furnace-2", "frosted-0.3-0.01"],
        faults: &[Fault::Gains, Fault::Wrong],
        limit: 0.05,
        reason: "Energies are right at 19 directions of the eye, and the light that lobes send between these is interpolated. It is up to 0.006 too bright for coats \
                 over mirrors. Under a rough interface into a thinner medium the energy from below ends within a few degrees of the critical angle, and the rows on both \
                 sides are up to 7 degrees away.",
    },
    Explanation {
        name: "WEIGHTS_OF_ROWS_OF_LOBES",
        levels: &[Level::Table],
        methods: &["lobes"],
        cases: &["mirror-metal"],
        faults: &[Fault::Wrong],
        limit: 0.03,
        reason: "Samplers weigh two rows in steps of 1/256. For an eye within a degree of the horizon the first two rows differ by a factor of several in the widths \
                 and strengths of lobes, and half a step is up to 1.5% of a value.",
    },
    Explanation {
        name: "MEAN_OF_TWO_SLOPES",
        levels: &[Level::F64],
        methods: &["lobes"],
        cases: &["brushed"],
        faults: &[Fault::Wrong],
        limit: 0.06,
        reason: "Lobes are isotropic. A surface of alpha 0.001 along and 1 across is shown with alpha 0.032.",
    },
    Explanation {
        name: "LAMBERT_FOR_OREN_NAYAR",
        levels: &[Level::F64],
        methods: &["lambert", "phong", "granier-heidrich"],
        cases: &["oren-nayar"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "These models evaluate Lambert's law whatever sigma is. A white Oren-Nayar base with a sigma of 90 degrees reflects 0.73.",
    },
    Explanation {
        name: "MASKING_WITHOUT_AREA",
        levels: &[Level::F64],
        methods: &["microfacet-implicit", "microfacet-kelemen", "microfacet-schlick-smith"],
        cases: METALS,
        faults: &[Fault::Wrong],
        limit: 0.9,
        reason: "These masking functions are not those of any surface: the projected areas of the visible facets do not add up to the cosine of the viewing angle. Energy is lost even by smooth surfaces (implicit), by rough ones (Kelemen) and at grazing angles (Schlick).",
    },
    Explanation {
        name: "FILM_LEFT_OUT",
        levels: &[Level::F64],
        methods: &["microfacet-schlick", "microfacet-complex-f0", "microfacet-lazanyi", "microfacet-f82"],
        cases: &["film-*"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "An approximation that is fitted at one or two angles does not follow the fringes of a film. Complex F0 and Lazanyi's approximation leave the film out.",
    },
    Explanation {
        name: "TWO_BEAMS",
        levels: &[Level::F64],
        methods: &["microfacet-granier-film"],
        cases: METALS,
        faults: &[Fault::Wrong],
        limit: 0.7,
        reason: "The formula adds two beams of a free-standing film with Schlick's reflectance. It leaves out the metal below the film, and the third and all later beams. On a stack without a film, the error is that of one bounce between facets.",
    },
    Explanation {
        name: "FACETS_MEET_LIGHT_ONCE",
        levels: &[Level::F64],
        methods: &[
            "microfacet*",
            "weidlich-wilkie*",
            "elek",
            "belcour*",
            "yamaguchi*",
            "granier-heidrich",
            "layered-mc-one-facet",
            "phong",
        ],
        cases: METALS,
        faults: &[Fault::Wrong],
        limit: 0.72,
        reason: "These models follow one bounce between facets, and light that other facets block is lost: a GGX mirror of alpha 1 reflects 1 - ln 2 = 0.31 at normal incidence. The loss is smaller with Beckmann's distribution and with V-cavities. Belcour's and Yamaguchi's models give their lobes the energy of all bounces, but lose it to masking. They and Phong's model replace a Beckmann distribution by a lobe of another shape.",
    },
    Explanation {
        name: "PHONG_STANDS_IN",
        levels: &[Level::F64],
        methods: &["phong"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 0.8,
        reason: "One lobe and one diffuse term stand for the whole stack. They leave out the change of Fresnel's reflectance with the angle, bounces between layers and most of the absorption.",
    },
    Explanation {
        name: "BEAMS_RETURN_ALL",
        levels: &[Level::F64],
        methods: &["granier-heidrich"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 1.8,
        reason: "The two specular beams together return all light, and up to twice that where they are in phase. The diffuse term of the base comes on top, and absorption is left out. A stack with a base is outside the domain of the model.",
    },
    Explanation {
        name: "NO_INVERSE_SQUARE",
        levels: &[Level::F64],
        methods: &["weidlich-wilkie", "weidlich-wilkie-directions", "weidlich-wilkie-facet", "elek"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 1.4,
        reason: "Equation 3.1 lacks the factor 1/n^2, so that the layers below a coat are up to n^2 times too bright. It also lacks the bounces between layers, which would add light; so the two errors cancel in part. From an index of 2.5 on, and for a rough coat over a smooth mirror, the model adds more light than falls on the surface.",
    },
    Explanation {
        name: "NO_BLUR",
        levels: &[Level::F64],
        methods: &["weidlich-wilkie-corrected"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "The energies are exact for smooth interfaces. A rough interface transmits as if it were smooth, so that it does not blur the base, and its own lobe loses the light that facets block.",
    },
    Explanation {
        name: "LOBES_LOSE_TO_MASKING",
        levels: &[Level::F64],
        methods: &["belcour*", "yamaguchi*"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "The energies of the lobes are right. The lobes are then evaluated as GGX surfaces, which lose energy to masking and below the horizon. The loss grows with roughness and towards grazing angles; both papers state this limit.",
    },
    Explanation {
        name: "ONE_FACET",
        levels: &[Level::F64],
        methods: &["layered-mc-one-facet"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "At every interface the light that a second facet blocks is lost. This mode of the simulation measures the error of that assumption.",
    },
    Explanation {
        name: "SMOOTH_COAT_ONLY",
        levels: &[Level::F64],
        methods: &["fluorescence"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.12,
        reason: "The model is exact for a smooth coat. In this case the coat has alpha 0.1, and its lobe loses the light that facets block.",
    },
];

fn matches(patterns: &[&str], name: &str) -> bool {
    patterns.iter().any(|p| match (p.strip_suffix('*'), p.strip_prefix('*')) {
        (Some(start), _) => name.starts_with(start),
        (None, Some(end)) => name.ends_with(end),
        (None, None) => *p == name,
    })
}

/// Reasons for a model are reasons for it with other tables, too.
fn matches_method(patterns: &[&str], method: &str) -> bool {
    let model = method.split_once(", ").map_or(method, |(model, _)| model);
    matches(patterns, method) || matches(patterns, model)
}

/// The reason for a cell; `None` for a cell that holds, and for one without an explanation.
pub fn explanation(cell: &Cell) -> Option<&'static Explanation> {
    if cell.verdict == Verdict::Holds || (cell.level.ships() && cell.fault == Some(Fault::NotFinite)) {
        return None;
    }
    EXPLANATIONS.iter().find(|e| {
        e.levels.contains(&cell.level)
            && matches_method(e.methods, &cell.method)
            && matches(e.cases, &cell.case)
            && cell.fault.is_some_and(|fault| e.faults.contains(&fault))
            && cell.error <= e.limit
    })
}
