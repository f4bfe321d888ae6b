//! Writes a library of plausible materials: `cargo run --example library -- COUNT FOLDER [SEED]`.

mod library;

use anyhow::{Context, Result};

use library::Library;

/// Indices of coats: two decimals between 1.3 and 1.8. Thicknesses of films: whole tens of nm.
const VARIETY: u32 = 50;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let usage = "usage: library COUNT FOLDER [SEED]";
    let count: u32 = arguments.next().context(usage)?.parse().context("COUNT")?;
    let folder = std::path::PathBuf::from(arguments.next().context(usage)?);
    let seed = arguments.next().map_or(Ok(1), |seed| seed.parse()).context("SEED")?;
    let library = Library { seed, variety: VARIETY };
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    for number in 0..count {
        let path = folder.join(format!("material-{number:05}.toml"));
        std::fs::write(&path, library.material(number)).with_context(|| path.display().to_string())?;
    }
    Ok(())
}
