//! Split-sum tables of luthier against those of `forge-ibl-bake`: time and error, as sections of a Markdown page.
//!
//! `scripts/bench-dfg.sh` runs it.

mod errors;
mod times;

use std::env;
use std::error::Error;

use forge_ibl_bake::{BakeParams, bake_brdf_lut};
use luthier_lut::{Image, TexelFormat};
use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_table::{DfgTable, Layout, Nodes, Stored, Value};

/// Texels along either side of the tables that are compared.
const SIDE: u32 = 128;
/// Lowest cosine and lowest alpha that count in errors.
const FROM: [f64; 2] = [0.01, 0.01];
/// Argument before the file into which the texels of `forge-ibl-bake` are written: half floats and nothing else.
const WRITE: &str = "--write";

fn main() -> Result<(), Box<dyn Error>> {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    if env::args().nth(1).as_deref() == Some(times::FIRST) {
        println!("{}", one.install(times::first));
        return Ok(());
    }
    if let [_, option, file] = env::args().collect::<Vec<_>>().as_slice()
        && option == WRITE
    {
        return Ok(std::fs::write(file, forge())?);
    }
    one.install(times::print)?;
    errors::print()
}

/// The default table of `forge-ibl-bake`: half floats from 1,024 samples a texel. Its masking term is Schlick's fit with k = alpha/2
/// (`g_smith` in its `sample.rs`), its axes are those of [`linear`].
fn forge() -> Vec<u8> {
    bake_brdf_lut(&BakeParams { lut_size: SIDE, ..BakeParams::default() })
}

/// What a shader reads from the table of `forge-ibl-bake`.
fn forge_texels() -> Result<Image, Box<dyn Error>> {
    Ok(TexelFormat::Rg16Float.decode(SIDE, SIDE, &forge())?)
}

/// Half floats on the axes that most engines have, nodes at texel centres.
fn linear(masking: Masking, side: u32) -> DfgTable {
    let layout = layout("cos_theta,roughness", Nodes::CENTRES);
    let values = vec![Value::Scale, Value::Bias];
    DfgTable {
        distribution: Distribution::Ggx,
        masking,
        layout,
        values,
        size: [side; 2],
        stored: Stored::Half,
        base: None,
    }
}

/// Half floats on logarithmic axes, whose first and last nodes are their ends.
fn curved(masking: Masking, side: u32) -> DfgTable {
    let [cos, alpha] = FROM;
    let axes = format!("cos_theta={cos}..1@log,alpha={alpha}..1@log");
    DfgTable { layout: layout(&axes, Nodes::Ends), ..linear(masking, side) }
}

fn layout(axes: &str, nodes: Nodes) -> Layout {
    Layout::parse(axes, nodes).unwrap_or_else(|error| unreachable!("{error}"))
}
