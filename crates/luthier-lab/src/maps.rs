//! Place of the maps of this crate's materials.

use std::path::PathBuf;

/// Variable with the folder of the maps, for a program that runs away from its sources.
const VARIABLE: &str = "LUTHIER_LAB_MAPS";

/// A path in the folder of the maps: that of the variable `LUTHIER_LAB_MAPS`, or `maps/` beside the sources of this crate.
pub(crate) fn maps(name: &str) -> PathBuf {
    let folder = std::env::var_os(VARIABLE)
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/maps")), PathBuf::from);
    folder.join(name)
}

/// The source of a material that finds its maps there.
pub(crate) fn source() -> String {
    maps("material.toml").to_string_lossy().into_owned()
}
