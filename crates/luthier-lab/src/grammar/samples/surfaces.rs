//! Samples of surface files.

use super::{Sample, sample};

pub(super) static SAMPLES: [Sample; 15] = [
    sample(
        "surface-cells.seed",
        "cells",
        "cells = { seed = @, frequency = 8, materials = ['%/materials/surfaces/lepidolite/dark-1.toml', '%/materials/surfaces/lepidolite/bright-2.toml', '%/materials/surfaces/lepidolite/marble-1.toml'] }",
        &["0", "1", "2"],
    ),
    sample(
        "surface-cells.frequency",
        "cells",
        "cells = { frequency = @, materials = ['%/materials/surfaces/lepidolite/dark-1.toml', '%/materials/surfaces/lepidolite/bright-2.toml', '%/materials/surfaces/lepidolite/marble-1.toml'] }",
        &["4", "12", "40"],
    ),
    sample(
        "surface-cells.materials",
        "cells",
        "cells = { frequency = 8, materials = [@] }",
        &[
            "one|'%/materials/surfaces/lepidolite/dark-1.toml'",
            "two|'%/materials/surfaces/lepidolite/dark-1.toml', '%/materials/surfaces/lepidolite/marble-1.toml'",
            "the first three times|'%/materials/surfaces/lepidolite/dark-1.toml', '%/materials/surfaces/lepidolite/dark-1.toml', '%/materials/surfaces/lepidolite/dark-1.toml', '%/materials/surfaces/lepidolite/marble-1.toml'",
        ],
    ),
    sample(
        "surface-noise.seed",
        "switch",
        "cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/dark-1.toml'] }\nswitch = [{ noise = { seed = @, frequency = 3, between = [-1, 0] }, cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/bright-2.toml'] } }]",
        &["0", "1", "2"],
    ),
    sample(
        "surface-noise.frequency",
        "switch",
        "cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/dark-1.toml'] }\nswitch = [{ noise = { frequency = @, between = [-1, 0] }, cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/bright-2.toml'] } }]",
        &["2", "4", "10"],
    ),
    sample(
        "surface-noise.octaves",
        "switch",
        "cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/dark-1.toml'] }\nswitch = [{ noise = { frequency = 2, octaves = @, between = [-1, 0] }, cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/bright-2.toml'] } }]",
        &["1", "3", "6"],
    ),
    sample(
        "surface-noise.between",
        "switch",
        "cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/dark-1.toml'] }\nswitch = [{ noise = { frequency = 3, between = @ }, cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/bright-2.toml'] } }]",
        &["[-1, 0]", "[-0.05, 0.05]", "[0.2, 1]"],
    ),
    sample(
        "surface-tiles.seed",
        "switch",
        "cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/dark-1.toml'] }\nswitch = [{ tiles = { seed = @ }, cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/bright-2.toml'] } }]",
        &["0", "1", "2"],
    ),
    sample(
        "surface-tiles.frequency",
        "switch",
        "cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/dark-1.toml'] }\nswitch = [{ tiles = { frequency = @ }, cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/bright-2.toml'] } }]",
        &["3", "6", "12"],
    ),
    sample(
        "surface-tiles.share",
        "switch",
        "cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/dark-1.toml'] }\nswitch = [{ tiles = { share = @ }, cells = { frequency = 40, materials = ['%/materials/surfaces/lepidolite/bright-2.toml'] } }]",
        &["0.1", "0.5", "0.9"],
    ),
    sample(
        "surface-glitter.seed",
        "glitter",
        "cells = { materials = ['%/materials/surfaces/sunstone/stone.toml'] }\nglitter = { seed = @, frequency = 16, filled = 0.2, materials = ['%/materials/surfaces/sunstone/copper.toml'] }",
        &["0", "1", "2"],
    ),
    sample(
        "surface-glitter.frequency",
        "glitter",
        "cells = { materials = ['%/materials/surfaces/sunstone/stone.toml'] }\nglitter = { frequency = @, filled = 0.2, materials = ['%/materials/surfaces/sunstone/copper.toml'] }",
        &["8", "24", "80"],
    ),
    sample(
        "surface-glitter.filled",
        "glitter",
        "cells = { materials = ['%/materials/surfaces/sunstone/stone.toml'] }\nglitter = { frequency = 16, filled = @, materials = ['%/materials/surfaces/sunstone/copper.toml'] }",
        &["0.03", "0.2", "0.8"],
    ),
    sample(
        "surface-glitter.tilt_deg",
        "glitter",
        "cells = { materials = ['%/materials/surfaces/sunstone/stone.toml'] }\nglitter = { frequency = 16, filled = 0.2, tilt_deg = @, materials = ['%/materials/surfaces/sunstone/copper.toml'] }",
        &["3", "15", "45"],
    ),
    sample(
        "surface-glitter.materials",
        "glitter",
        "cells = { materials = ['%/materials/surfaces/sunstone/stone.toml'] }\nglitter = { frequency = 16, filled = 0.2, materials = [@] }",
        &[
            "copper|'%/materials/surfaces/sunstone/copper.toml'",
            "pale copper|'%/materials/surfaces/sunstone/pale-copper.toml'",
            "silver|'%/materials/surfaces/lepidolite/dark-silver.toml'",
        ],
    ),
];
