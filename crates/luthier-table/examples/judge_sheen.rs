//! Bakes the table of sheen by linearly transformed cosines, and judges it beside that of a file.
//!
//! `judge_sheen [FILE]`: a file of 32 x 32 x 3 little-endian floats, in the layout of engines.

#![expect(clippy::print_stdout, reason = "an example speaks on the terminal")]

use std::time::Instant;

use luthier_lut::Image;
use luthier_table::{LtcError, SheenTable};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let table = SheenTable::of_engines();
    let start = Instant::now();
    let texels = table.bake();
    println!("baked in {:.1} s", start.elapsed().as_secs_f64());
    report(&table, &texels);
    if let Some(path) = std::env::args().nth(1) {
        let bytes = std::fs::read(path)?;
        let data = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        let file = Image { width: 32, height: 32, channels: 3, data };
        println!("the file");
        report(&table, &file);
        for y in [4, 8, 16, 24, 31] {
            for x in [0, 4, 16, 31] {
                println!("  texel {x} {y}: ours {:?}, the file's {:?}", texels.texel(x, y), file.texel(x, y));
            }
        }
    }
    Ok(())
}

fn report(table: &SheenTable, texels: &Image) {
    for min_albedo in [1e-4, 0.01, 0.1] {
        let at = table.error_at_texels(texels, min_albedo);
        let between = table.error_between_texels(texels, min_albedo);
        for (name, [difference, albedo]) in [("at texels", at), ("between", between)] {
            line(&format!("{name}, albedo >= {min_albedo}, energy"), difference);
            line(&format!("{name}, albedo >= {min_albedo}, albedo"), albedo);
        }
    }
}

fn line(what: &str, error: LtcError) {
    let LtcError { median, p95, max } = error;
    let (place, worst) = (format!("cos {:.4} cross section {:.5}", max.cos_theta_o, max.alpha), max.error);
    println!("  {what}: median {median:.5}, p95 {p95:.5}, max {worst:.5} at {place}");
}
