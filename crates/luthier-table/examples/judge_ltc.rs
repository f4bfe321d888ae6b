//! Bakes tables of linearly transformed cosines, and judges them beside those of a file.
//!
//! `judge_ltc [FILE]`: a file of 2 x 64 x 64 x 4 little-endian floats, matrices and then norms, in the layout of engines.

#![expect(clippy::print_stdout, reason = "an example speaks on the terminal")]

use std::time::Instant;

use luthier_lut::Image;
use luthier_optics::masking::Correlation;
use luthier_optics::stack::Distribution;
use luthier_table::{LtcError, LtcTable, LtcTexels, Stored};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        let table = LtcTable { stored: Stored::Float, ..LtcTable::of_engines(distribution) };
        let start = Instant::now();
        let texels = table.bake();
        println!("{distribution:?}, baked in {:.1} s", start.elapsed().as_secs_f64());
        report(&table, &texels);
    }
    if let Some(path) = std::env::args().nth(1) {
        let bytes = std::fs::read(path)?;
        let values: Vec<f32> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        let image = |data: &[f32]| Image { width: 64, height: 64, channels: 4, data: data.to_vec() };
        let (matrices, norms) = values.split_at(64 * 64 * 4);
        let texels = LtcTexels { matrices: image(matrices), norms: image(norms) };
        for masking in [Correlation::Height, Correlation::Separable] {
            let table = LtcTable { masking, ..LtcTable::of_engines(Distribution::Ggx) };
            println!("the file as GGX, {masking:?}");
            let own = table.bake();
            for (channel, name) in [(0, "albedo"), (1, "bias"), (3, "sphere")] {
                let pairs = texels.norms.texels().zip(own.norms.texels());
                let off = pairs.map(|(a, b)| (a[channel] - b[channel]).abs());
                let (mean, max) = off.fold((0.0, 0.0f32), |(sum, max), off| (sum + off / 4096.0, max.max(off)));
                println!("  {name} differs from ours by {mean:.5} on average and {max:.5} at most");
            }
            report(&table, &texels);
        }
    }
    Ok(())
}

fn report(table: &LtcTable, texels: &LtcTexels) {
    for stored in [Stored::Float, Stored::Half] {
        let read = LtcTexels { matrices: stored.quantise(&texels.matrices), norms: stored.quantise(&texels.norms) };
        for [cos, alpha] in [[0.0, 0.0], [0.02, 0.002]] {
            let name = stored.name();
            line(
                &format!("{name}, at texels, cos >= {cos}, alpha >= {alpha}"),
                table.error_at_texels(&read, cos, alpha),
            );
            line(
                &format!("{name}, between, cos >= {cos}, alpha >= {alpha}"),
                table.error_between_texels(&read, cos, alpha),
            );
        }
        let light = table.irradiance_error(&read);
        line(&format!("{}, rectangles, absolute", stored.name()), light.absolute);
        line(&format!("{}, rectangles, relative", stored.name()), light.relative);
    }
}

fn line(what: &str, error: LtcError) {
    let LtcError { median, p95, max } = error;
    let (place, worst) = (format!("cos {:.4} alpha {:.5}", max.cos_theta_o, max.alpha), max.error);
    println!("  {what}: median {median:.5}, p95 {p95:.5}, max {worst:.5} at {place}");
}
