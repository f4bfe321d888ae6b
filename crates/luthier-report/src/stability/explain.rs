//! Why a method does not hold, and how far each reason goes.

use super::{Cell, Fault, Level, Verdict};

/// A reason, and the cells that it is for.
#[derive(Debug, Clone, Copy)]
pub struct Explanation {
    /// Its name.
    pub name: &'static str,
    /// Levels.
    pub levels: &'static [Level],
    /// Names of methods; one that ends in `*` stands for all that begin so.
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

/// All reasons; the first that fits counts.
pub const EXPLANATIONS: &[Explanation] = &[
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
        cases: &[
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
        ],
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
        cases: &[
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
        ],
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
        cases: &[
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
        ],
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
        cases: &[
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
        ],
        faults: &[Fault::Wrong],
        limit: 1.4,
        reason: "Equation 3.1 lacks 1/n^2, so that what lies below is up to n^2 times too bright, and the bounces between layers, which make up for part of it. From an index of 2.5 on, and for a rough coat over a smooth mirror, more light is added than falls on the surface.",
    },
    Explanation {
        name: "NO_BLUR",
        levels: &[Level::F64],
        methods: &["weidlich-wilkie-corrected"],
        cases: &[
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
        ],
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "Energies are exact for smooth interfaces; a rough one is taken as smooth where it transmits, and its own lobe loses what is blocked. The base is not blurred.",
    },
    Explanation {
        name: "LOBES_LOSE_TO_MASKING",
        levels: &[Level::F64],
        methods: &["belcour*", "yamaguchi*"],
        cases: &[
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
        ],
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "The energies of the lobes are right; evaluated as GGX surfaces they lose to masking and to the horizon again, the more the rougher and the closer to grazing. That is the papers' stated limit.",
    },
    Explanation {
        name: "ONE_FACET",
        levels: &[Level::F64],
        methods: &["layered-mc-one-facet"],
        cases: &[
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
        ],
        faults: &[Fault::Wrong],
        limit: 0.5,
        reason: "What one facet blocks is lost at every interface: the mode shows what that assumption costs.",
    },
    Explanation {
        name: "SMOOTH_COAT_ONLY",
        levels: &[Level::F64],
        methods: &["fluorescence"],
        cases: &[
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
        ],
        faults: &[Fault::Wrong],
        limit: 0.12,
        reason: "It is exact for a smooth coat; here the coat has alpha 0.1, whose lobe loses what is blocked.",
    },
];

fn matches(patterns: &[&str], name: &str) -> bool {
    patterns.iter().any(|p| p.strip_suffix('*').map_or(*p == name, |start| name.starts_with(start)))
}

/// The reason for a cell; `None` for a cell that holds, and for one that nobody can explain.
pub fn explanation(cell: &Cell) -> Option<&'static Explanation> {
    if cell.verdict == Verdict::Holds || (cell.level.ships() && cell.fault == Some(Fault::NotFinite)) {
        return None;
    }
    EXPLANATIONS.iter().find(|e| {
        e.levels.contains(&cell.level)
            && matches(e.methods, &cell.method)
            && matches(e.cases, &cell.case)
            && cell.fault.is_some_and(|fault| e.faults.contains(&fault))
            && cell.error <= e.limit
    })
}
