//! Keys without a picture, and why.

/// Keys that show nothing by themselves.
pub(crate) struct Unseen {
    /// Why there is nothing to see.
    pub(crate) why: &'static str,
    /// The keys, as `table.key`; `table.*` is all of a table.
    pub(crate) keys: &'static [&'static str],
}

/// All of them.
pub(crate) static UNSEEN: [Unseen; 8] = [
    Unseen {
        why: "names and texts, which no shader reads",
        keys: &[
            "material.schema",
            "material.name",
            "material.description",
            "material.references",
            "surface.surface",
            "surface.name",
            "surface.description",
        ],
    },
    Unseen {
        why: "a table, whose keys have pictures",
        keys: &[
            "material.effects",
            "material.bake",
            "dielectric.abc",
            "dielectric.sgd",
            "dielectric.maps",
            "thin-film.maps",
            "conductor.maps",
            "diffuse.maps",
            "metallic-roughness.maps",
            "dielectric.live",
            "conductor.live",
            "diffuse.live",
            "metallic-roughness.live",
            "effects.flakes",
            "effects.patina",
            "effects.glitter",
            "flakes.height_map",
            "map.noise",
            "picture.transform",
            "bake.granier-heidrich",
            "surface.cells",
            "surface.glitter",
            "surface.switch",
            "surface-switch.noise",
            "surface-switch.tiles",
            "surface-switch.cells",
        ],
    },
    Unseen {
        why: "the type says which keys the table has",
        keys: &["dielectric.type", "thin-film.type", "conductor.type", "diffuse.type", "metallic-roughness.type"],
    },
    Unseen {
        why: "a number that a program sets: a picture shows that of the file",
        keys: &["dielectric-live.*", "conductor-live.*", "diffuse-live.*", "metallic-live.*"],
    },
    Unseen { why: "a limit, within which tables look alike", keys: &["material.budget", "budget.*"] },
    Unseen { why: "it adds tables that the shader does not read", keys: &["bake.tables"] },
    Unseen {
        why: "it decides the size and the error of a table, in the last bits of a picture",
        keys: &[
            "bake.fresnel",
            "bake.distribution",
            "bake.fgd",
            "bake.phase",
            "bake.thickness",
            "fresnel-table.*",
            "distribution-table.*",
            "fgd-table.*",
            "phase-table.*",
            "thickness-table.*",
        ],
    },
    Unseen {
        why: "it says what a scene looks like, by which models are chosen",
        keys: &[
            "scene.*",
            "scene-material.*",
            "directional.*",
            "point.*",
            "environment.*",
            "view.*",
            "target.*",
            "scene-budget.*",
        ],
    },
];
