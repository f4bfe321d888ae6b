//! Judges tables of linearly transformed cosines: rows of Markdown, of the baked ones and of one in a file.
//!
//! `judge_ltc [NAME FILE]`: a file of 2 x 64 x 64 x 4 little-endian floats, matrices and then norms, in the layout of engines. Columns: the error
//! of energy between texels (median, 95 % below, largest) and that of the light of rectangles.

#![expect(clippy::print_stdout, reason = "an example speaks on the terminal")]

use luthier_lut::Image;
use luthier_optics::stack::Distribution;
use luthier_table::{LtcTable, LtcTexels};

/// Lowest cosine and alpha that count.
const FROM: [f64; 2] = [0.02, 0.002];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ggx = LtcTable::of_engines(Distribution::Ggx);
    if let [_, name, path] = std::env::args().collect::<Vec<_>>().as_slice() {
        let bytes = std::fs::read(path)?;
        let values: Vec<f32> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        let image =
            |data: &[f32]| ggx.stored.quantise(&Image { width: 64, height: 64, channels: 4, data: data.to_vec() });
        let (matrices, norms) = values.split_at(64 * 64 * 4);
        row(name, &ggx, &LtcTexels { matrices: image(matrices), norms: image(norms) });
    }
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        let table = LtcTable::of_engines(distribution);
        row(&format!("luthier, {distribution:?}"), &table, &table.bake());
    }
    Ok(())
}

fn row(name: &str, table: &LtcTable, texels: &LtcTexels) {
    let energy = table.error_between_texels(texels, FROM[0], FROM[1]);
    let light = table.irradiance_error(texels).absolute;
    let cells = [energy, light].map(|e| format!("{:.4} | {:.4} | {:.4}", e.median, e.p95, e.max.error));
    println!("| {name} | {} |", cells.join(" | "));
}
