//! Samples of effects.

use super::{Sample, sample};

const FLAKES: &str = "effects.flakes";
const PATINA: &str = "effects.patina";
const GLITTER: &str = "effects.glitter";

pub(super) static SAMPLES: [Sample; 21] = [
    sample(
        "flakes.normal_map",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\n@",
        &[
            "no flakes|",
            "'bumps.png'|effects.flakes = { normal_map = 'bumps.png', tiling = 2, fade_start = 1000 }",
            "'ripples.png'|effects.flakes = { normal_map = 'ripples.png', tiling = 2, fade_start = 1000 }",
        ],
    ),
    sample(
        "flakes.tiling",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { cells = { count = 16 }, tiling = @, fade_start = 1000 }",
        &["1", "2", "6"],
    ),
    sample(
        "flakes.scale",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { cells = { count = 16 }, tiling = 2, scale = @, fade_start = 1000 }",
        &["0.3", "1", "3"],
    ),
    sample(
        "flakes.fade_start",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { cells = { count = 16 }, tiling = 2, fade_start = @ }",
        &["0.2", "1", "5"],
    ),
    sample(
        "flake-heights.image",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { height_map = { image = @, height = 0.03 }, tiling = 2, fade_start = 1000 }",
        &["'heights.png'", "'thickness.png'", "'patina.png'"],
    ),
    sample(
        "flake-heights.height",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { height_map = { image = 'heights.png', height = @ }, tiling = 2, fade_start = 1000 }",
        &["0.01", "0.03", "0.1"],
    ),
    sample(
        "flake-cells.seed",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { cells = { seed = @, count = 16 }, tiling = 2, fade_start = 1000 }",
        &["0", "1", "2"],
    ),
    sample(
        "flake-cells.count",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { cells = { count = @ }, tiling = 2, fade_start = 1000 }",
        &["8", "16", "64"],
    ),
    sample(
        "flake-cells.spread_deg",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.flakes = { cells = { count = 16, spread_deg = @ }, tiling = 2, fade_start = 1000 }",
        &["5", "15", "40"],
    ),
    sample(
        "glitter.seed",
        GLITTER,
        "layer = [{ type = 'conductor', ior = 'au', alpha = 0.1 }]\neffects.glitter = { seed = @, frequency = 20, filled = 0.3 }",
        &["0", "1", "2"],
    ),
    sample(
        "glitter.frequency",
        GLITTER,
        "layer = [{ type = 'conductor', ior = 'au', alpha = 0.1 }]\neffects.glitter = { frequency = @, filled = 0.3 }",
        &["10", "30", "100"],
    ),
    sample(
        "glitter.filled",
        GLITTER,
        "layer = [{ type = 'conductor', ior = 'au', alpha = 0.1 }]\neffects.glitter = { frequency = 20, filled = @ }",
        &["0.05", "0.3", "1"],
    ),
    sample(
        "glitter.tilt_deg",
        GLITTER,
        "layer = [{ type = 'conductor', ior = 'au', alpha = 0.1 }]\neffects.glitter = { frequency = 20, filled = 0.3, tilt_deg = @ }",
        &["5", "15", "45"],
    ),
    sample(
        "patina.extent",
        PATINA,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.4, thickness_um = 10, absorption_per_um = [0.1, 0.02, 0.05] }, { type = 'conductor', ior = 'cu', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.patina = { extent = @, transition = 0.1, diffuse_albedo = [0.2, 0.5, 0.4], map = { image = 'patina.png' } }",
        &["0.2", "0.5", "0.8"],
    ),
    sample(
        "patina.transition",
        PATINA,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.4, thickness_um = 10, absorption_per_um = [0.1, 0.02, 0.05] }, { type = 'conductor', ior = 'cu', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.patina = { extent = 0.5, transition = @, diffuse_albedo = [0.2, 0.5, 0.4], map = { image = 'patina.png' } }",
        &["0", "0.2", "1"],
    ),
    sample(
        "patina.map",
        PATINA,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.4, thickness_um = 10, absorption_per_um = [0.1, 0.02, 0.05] }, { type = 'conductor', ior = 'cu', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.patina = { extent = 0.5, transition = 0.1, diffuse_albedo = [0.2, 0.5, 0.4], map = @ }",
        &[
            "noise|{ noise = {} }",
            "'patina.png'|{ image = 'patina.png' }",
            "'thickness.png'|{ image = 'thickness.png' }",
        ],
    ),
    sample(
        "patina.diffuse_albedo",
        PATINA,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.4, thickness_um = 10, absorption_per_um = [0.1, 0.02, 0.05] }, { type = 'conductor', ior = 'cu', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.patina = { extent = 0.5, transition = 0.1, diffuse_albedo = @, map = { image = 'patina.png' } }",
        &["0", "[0.2, 0.5, 0.4]", "0.6"],
    ),
    sample(
        "patina.diffuse_remainder",
        PATINA,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.4, thickness_um = 10, absorption_per_um = [0.1, 0.02, 0.05] }, { type = 'conductor', ior = 'cu', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.patina = { extent = 0.5, transition = 0.1, diffuse_remainder = @, map = { image = 'patina.png' } }",
        &["0.1", "0.4", "0.9"],
    ),
    sample(
        "patina.base_alpha",
        PATINA,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.05 }, { type = 'conductor', ior = 'cu', alpha = 0.05 }]\nbake = { model = 'elek' }\neffects.patina = { extent = 0.5, transition = 0.1, base_alpha = @, map = { image = 'patina.png' } }",
        &["0.05", "0.2", "0.6"],
    ),
    sample(
        "patina.tarnish",
        PATINA,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.3 }, { type = 'conductor', ior = 'cu', alpha = 0.15 }]\nbake = { model = 'elek' }\neffects.patina = { extent = 0.5, transition = 0.1, tarnish = @, map = { image = 'patina.png' } }",
        &["1", "0.4", "[0.1, 0.3, 0.3]"],
    ),
    sample(
        "flakes.cells",
        FLAKES,
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.03 }, { type = 'conductor', ior = 'ag', alpha = 0.15 }]\nbake = { model = 'elek' }\n@",
        &[
            "no flakes|",
            "{ count = 16 }|effects.flakes = { cells = { count = 16 }, tiling = 2, fade_start = 1000 }",
            "{ count = 16, spread_deg = 40 }|effects.flakes = { cells = { count = 16, spread_deg = 40 }, tiling = 2, fade_start = 1000 }",
        ],
    ),
];
