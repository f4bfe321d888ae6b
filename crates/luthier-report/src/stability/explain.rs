//! Why a method does not hold, and how far each reason goes.

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
        reason: "An index of 1e30 is stored as 10000, which single precision can square twice: 4e-4 of the light goes through, where nothing should.",
    },
    Explanation {
        name: "KINK_AT_THE_CRITICAL_ANGLE",
        levels: &[Level::Table, Level::Device],
        methods: &["elek", "weidlich-wilkie", "microfacet", "belcour", "yamaguchi"],
        cases: &["index-2.5e-1", "index-5e-1", "index-6.67e-1", "index-9e-1", "from-inside"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "Seen from the denser side Fresnel's reflectance has a kink at the critical angle, and a row or grid of equal steps of the cosine cuts it: off by up to 0.25 in that interval, and by nothing beyond it.",
    },
    Explanation {
        name: "FRINGES_FINER_THAN_THE_ROW",
        levels: &[Level::Table, Level::Device],
        methods: &["elek", "weidlich-wilkie", "microfacet", "belcour", "yamaguchi"],
        cases: &["film-5e3", "film-2e4", "film-spectral-20000"],
        faults: &[Fault::Wrong],
        limit: 0.05,
        reason: "The fringes of a thick film are a few texels wide on the cosine axis: 20 um of index 1.4 have 38 over the row at 445 nm. The baked form at three wavelengths shows them rounded off; the form without tables has them.",
    },
    Explanation {
        name: "FRINGES_FINER_THAN_THE_PHASES",
        levels: &[Level::Table, Level::Device],
        methods: &["granier-heidrich"],
        cases: &["film-5e3", "film-2e4", "film-spectral-20000"],
        faults: &[Fault::Wrong],
        limit: 1.8,
        reason: "The phase row has 256 nodes between no phase and that of the thickest film: at 20 um and 445 nm a period is 2.0 nodes, at an index of 2.4 1.2, so that what is read has nothing to do with the cosine. Outside the domain from 5 um on.",
    },
    Explanation {
        name: "TABLES_ADD_UP",
        levels: &[Level::Table, Level::Device],
        methods: &["belcour", "yamaguchi"],
        cases: &["layers-3.2e1"],
        faults: &[Fault::Wrong],
        limit: 0.03,
        reason: "31 interfaces read their tables one after the other, and the errors add up; with 7 they are below 1%.",
    },
    Explanation {
        name: "RED_CLIPPED_IN_THE_ROW",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rgba8unorm, table of D", "*, rows of rgb10a2unorm"],
        cases: &["gold"],
        faults: &[Fault::Wrong],
        limit: 0.04,
        reason: "The red of gold is 1.0376, and no code of a normalised row is above 1. By default a search takes rows of 10 bits only where that is within 5e-4; rows over Schlick's form reach 1.25.",
    },
    Explanation {
        name: "CODES_OF_EIGHT_BITS",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rgba8unorm, table of D"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 0.25,
        reason: "Half a step of a row is 0.002, 4% of the highlight of a coat of index 1.5; below many coats the steps add up.",
    },
    Explanation {
        name: "CODES_OF_TEN_BITS",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rgb10a2unorm"],
        cases: &["layers-*", "depth-*", "k-*"],
        faults: &[Fault::Wrong],
        limit: 0.04,
        reason: "Half a step of a row is 5e-4, 1% of the highlight of a coat of index 1.5; equal steps of the cosine miss as much at grazing angles; below many coats both add up, and a row down in index, over the refracted cosine, errs as the row up does.",
    },
    Explanation {
        name: "SIX_BITS_OF_MANTISSA",
        levels: &[Level::Table, Level::Device],
        methods: &["*, rows of rg11b10ufloat, computed phases"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 0.05,
        reason: "Half a step of red and green is 0.8% of the value at most, of blue 1.6%; where two bounces multiply, twice that.",
    },
    Explanation {
        name: "SCHLICK_IS_FAR",
        levels: &[Level::Table, Level::Device],
        methods: &["*, Schlick rows of rgba8unorm", "*, Schlick rows of rgb10a2unorm"],
        cases: &["layers-*", "tunnel"],
        faults: &[Fault::Wrong],
        limit: 0.08,
        reason: "Where light meets the thinner medium there is total reflection, to which Schlick's form is not near: texels hold as much as those of plain rows, in as coarse codes, and 3 to 31 interfaces add up.",
    },
    Explanation {
        name: "VARIANCES_OF_ONE_FLOAT",
        levels: &[Level::F32, Level::Device],
        methods: &["yamaguchi"],
        cases: &["brushed"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "The covariance of a surface of alpha 0.001 along and 1 across, turned by 0.5 rad, mixes variances of 5e-4 and 9e3, whose ratio is about the rounding of single precision: the smaller comes out of a difference.",
    },
    Explanation {
        name: "WALK_SQUARES",
        levels: &[Level::F64],
        methods: &["layered-mc*", "random-walk"],
        cases: &["k-1e150"],
        faults: &[Fault::NotFinite],
        limit: 0.0,
        reason: "The reference's own optics take the fourth power of the index, which is no double from 1e77 on. No metal has a k above 1e3; records hold at most 10000.",
    },
    Explanation {
        name: "LAMBERT_FOR_OREN_NAYAR",
        levels: &[Level::F64],
        methods: &["lambert", "phong", "granier-heidrich"],
        cases: &["oren-nayar"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "They evaluate Lambert's surface whatever the sigma; at 90 degrees a white Oren-Nayar base reflects 0.73.",
    },
    Explanation {
        name: "MASKING_WITHOUT_AREA",
        levels: &[Level::F64],
        methods: &["microfacet-implicit", "microfacet-kelemen", "microfacet-schlick-smith"],
        cases: METALS,
        faults: &[Fault::Wrong],
        limit: 0.9,
        reason: "Their masking is not that of a surface: the projected area of the facets seen is not the cosine of the eye, so that energy is lost even from smooth surfaces (implicit), with roughness (Kelemen) and at grazing angles (Schlick).",
    },
    Explanation {
        name: "FILM_LEFT_OUT",
        levels: &[Level::F64],
        methods: &["microfacet-schlick", "microfacet-complex-f0", "microfacet-lazanyi", "microfacet-f82"],
        cases: &["film-*"],
        faults: &[Fault::Wrong],
        limit: 0.3,
        reason: "An approximation through one or two angles does not follow the fringes of a film; complex F0 and Lazanyi's leave it out.",
    },
    Explanation {
        name: "TWO_BEAMS",
        levels: &[Level::F64],
        methods: &["microfacet-granier-film"],
        cases: METALS,
        faults: &[Fault::Wrong],
        limit: 0.7,
        reason: "Two beams of a film that stands free, in Schlick's reflectance: the metal below it is left out, and three beams and more. Without a film, one bounce between facets.",
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
        reason: "One bounce per facet: what is blocked is lost, 1 - ln 2 = 0.31 is left of a mirror of alpha 1 at normal incidence. With Beckmann less, with V-cavities less. Belcour and Yamaguchi give their lobes the energy of all bounces, and lose it to masking again; they and Phong show Beckmann as another lobe.",
    },
    Explanation {
        name: "PHONG_STANDS_IN",
        levels: &[Level::F64],
        methods: &["phong"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 0.8,
        reason: "One lobe and one diffuse term stand for any stack: Fresnel at other angles, bounces and most of the absorption are left out.",
    },
    Explanation {
        name: "BEAMS_RETURN_ALL",
        levels: &[Level::F64],
        methods: &["granier-heidrich"],
        cases: &["*"],
        faults: &[Fault::Wrong],
        limit: 1.8,
        reason: "The specular beams return all light, in phase up to twice that; the diffuse term of the base comes on top, and absorption is left out. Where a stack has a base, the model is outside its domain.",
    },
    Explanation {
        name: "NO_INVERSE_SQUARE",
        levels: &[Level::F64],
        methods: &["weidlich-wilkie", "weidlich-wilkie-directions", "weidlich-wilkie-facet", "elek"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 1.4,
        reason: "Equation 3.1 lacks 1/n^2, so that what lies below is up to n^2 times too bright, and the bounces between layers, which make up for part of it. From an index of 2.5 on, and for a rough coat over a smooth mirror, more light is added than falls on the surface.",
    },
    Explanation {
        name: "NO_BLUR",
        levels: &[Level::F64],
        methods: &["weidlich-wilkie-corrected"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "Energies are exact for smooth interfaces; a rough one is taken as smooth where it transmits, and its own lobe loses what is blocked. The base is not blurred.",
    },
    Explanation {
        name: "LOBES_LOSE_TO_MASKING",
        levels: &[Level::F64],
        methods: &["belcour*", "yamaguchi*"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "The energies of the lobes are right; evaluated as GGX surfaces they lose to masking and to the horizon again, the more the rougher and the closer to grazing. That is the papers' stated limit.",
    },
    Explanation {
        name: "ONE_FACET",
        levels: &[Level::F64],
        methods: &["layered-mc-one-facet"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "What one facet blocks is lost at every interface: the mode shows what that assumption costs.",
    },
    Explanation {
        name: "SMOOTH_COAT_ONLY",
        levels: &[Level::F64],
        methods: &["fluorescence"],
        cases: COATS,
        faults: &[Fault::Wrong],
        limit: 0.12,
        reason: "It is exact for a smooth coat; here the coat has alpha 0.1, whose lobe loses what is blocked.",
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
