//! Samples of surface files.

use super::{Sample, sample};

pub(super) static SAMPLES: [Sample; 8] = [
    sample(
        "surface-cells.seed",
        "cells",
        "cells = { seed = @, frequency = 8, materials = ['%/materials/surfaces/lepidolite/lilac.toml', '%/materials/surfaces/lepidolite/pink.toml', '%/materials/surfaces/lepidolite/violet.toml'] }",
        &["0", "1", "2"],
    ),
    sample(
        "surface-cells.frequency",
        "cells",
        "cells = { frequency = @, materials = ['%/materials/surfaces/lepidolite/lilac.toml', '%/materials/surfaces/lepidolite/pink.toml', '%/materials/surfaces/lepidolite/violet.toml'] }",
        &["4", "12", "40"],
    ),
    sample(
        "surface-cells.materials",
        "cells",
        "cells = { frequency = 8, materials = [@] }",
        &[
            "one|'%/materials/surfaces/lepidolite/lilac.toml'",
            "two|'%/materials/surfaces/lepidolite/lilac.toml', '%/materials/surfaces/lepidolite/violet.toml'",
            "the first three times|'%/materials/surfaces/lepidolite/lilac.toml', '%/materials/surfaces/lepidolite/lilac.toml', '%/materials/surfaces/lepidolite/lilac.toml', '%/materials/surfaces/lepidolite/violet.toml'",
        ],
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
            "silver|'%/materials/surfaces/lepidolite/silver.toml'",
        ],
    ),
];
