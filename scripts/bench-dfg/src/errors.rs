//! Errors of tables: of their values, and as sampled.

use std::error::Error;

use forge_ibl_bake::sample::integrate_brdf;
use luthier_lut::{ErrorStats, Image};
use luthier_optics::split_sum::{Masking, SplitSum, SplitSumSurface, split_sum};
use luthier_optics::stack::Distribution;
use luthier_table::{DfgTable, Preset, SPLIT_SUM, search, search_beside_form};

use crate::{FROM, SIDE, curved, forge_texels, linear};

/// Times less that luthier's table should err.
const TARGET: f64 = 10.0;
/// Largest error that small tables may have.
const LIMIT: f64 = 5e-4;
/// Most bytes of the smallest table that holds [`LIMIT`].
const BYTES: usize = 2048;

/// Prints the sections of errors.
pub fn print() -> Result<(), Box<dyn Error>> {
    values();
    println!("## Error as sampled of {SIDE} x {SIDE} texels, half floats\n");
    println!("| table | axes | max | p99 | rms | worst at cos_theta, alpha |\n|---|---|--:|--:|--:|---|");
    let forge = linear(Masking::SchlickHalf, SIDE);
    let (same, other) = (forge.clone(), curved(Masking::SchlickHalf, SIDE));
    let theirs = row("`forge-ibl-bake`", &forge, &forge_texels()?);
    row("luthier, the same statement", &same, &same.bake());
    let ours = row("luthier, other axes", &other, &other.bake());
    let ratio = theirs.max_abs_err / ours.max_abs_err;
    println!(
        "\nAt most a tenth of the largest error of `forge-ibl-bake`: {}, {ratio:.1} times less.\n",
        held(ratio >= TARGET)
    );

    println!("## Smaller tables, and those of engines\n");
    println!(
        "All are baked by luthier with Smith's correlated masking, except `godot` and `unreal`. Errors are those of the split sum; some engines"
    );
    println!("keep other functions in channels of their own.\n");
    println!("| table | axes | texels | bytes | max | p99 | rms | worst at cos_theta, alpha |");
    println!("|---|---|--:|--:|--:|--:|--:|---|");
    let square = curved(Masking::SmithCorrelated, 64);
    let of_square = sized_row("64 x 64", &square, &square.bake());
    let found = search(Distribution::Ggx, Masking::SmithCorrelated, &SPLIT_SUM, LIMIT, FROM[0], FROM[1]);
    sized_row("fewest texels of the search", &found.table, &found.texels);
    let beside = search_beside_form(Distribution::Ggx, Masking::SmithCorrelated, LIMIT, FROM, BYTES);
    let (error, bytes) = sized_row("beside a closed form", &beside.table, &beside.texels);
    for preset in Preset::ALL {
        let table = preset.table();
        sized_row(&format!("preset `{}`", preset.name), &table, &table.bake());
    }
    println!("\n64 x 64 half floats within {LIMIT:.0e}: {}.", held(of_square.0.max_abs_err <= LIMIT));
    println!(
        "{LIMIT:.0e} in {BYTES} bytes: {}, {bytes} bytes beside a closed form; no table alone, which takes {} bytes.",
        held(error.max_abs_err <= LIMIT && bytes <= BYTES),
        found.table.bytes()
    );
    Ok(())
}

/// The values that texels are made of, before anything is rounded.
fn values() {
    let masking = Masking::SchlickHalf;
    let surface = SplitSumSurface::new(Distribution::Ggx, masking);
    let (mut theirs, mut ours) = (Deviation::default(), Deviation::default());
    for y in 0..SIDE {
        let roughness = (f64::from(y) + 0.5) / f64::from(SIDE);
        let row = surface.row(roughness * roughness);
        for x in 0..SIDE {
            let cos = (f64::from(x) + 0.5) / f64::from(SIDE);
            let exact = split_sum(Distribution::Ggx, masking, roughness * roughness, cos);
            let (scale, bias) = integrate_brdf(cos as f32, roughness as f32, 1024);
            theirs.add(SplitSum { scale: f64::from(scale), bias: f64::from(bias) }, exact);
            ours.add(row.at(cos), exact);
        }
    }
    println!("## Error of {SIDE} x {SIDE} values, before rounding\n");
    println!("Against quadrature, of which tests show that it is within 1e-6.\n");
    println!("| values | max | rms |\n|---|--:|--:|");
    for (name, deviation) in [("`forge-ibl-bake`", theirs), ("luthier", ours)] {
        println!("| {name} | {:.2e} | {:.2e} |", deviation.max, (deviation.squares / deviation.count).sqrt());
    }
    println!();
}

#[derive(Default)]
struct Deviation {
    max: f64,
    squares: f64,
    count: f64,
}

impl Deviation {
    fn add(&mut self, found: SplitSum, exact: SplitSum) {
        for off in [found.scale - exact.scale, found.bias - exact.bias] {
            self.max = self.max.max(off.abs());
            self.squares += off * off;
            self.count += 1.0;
        }
    }
}

fn row(name: &str, table: &DfgTable, texels: &Image) -> ErrorStats {
    let error = table.error(texels, FROM[0], FROM[1]);
    println!("| {name} | `{}` | {} |", table.layout, figures(&error));
    error
}

/// The error counts in channels of the split sum: what engines keep beside it is another function. Bytes are of all channels.
fn sized_row(name: &str, table: &DfgTable, texels: &Image) -> (ErrorStats, usize) {
    let counts: Vec<usize> = (0..table.values.len()).filter(|&channel| table.values[channel].is_split_sum()).collect();
    let values = counts.iter().map(|&channel| table.values[channel]).collect();
    let data = texels.texels().flat_map(|texel| counts.iter().map(|&channel| texel[channel])).collect();
    let split_sums = Image { channels: counts.len() as u32, data, ..*texels };
    let error = DfgTable { values, ..table.clone() }.error(&split_sums, FROM[0], FROM[1]);
    let [width, height] = table.size;
    let bytes = table.bytes();
    let stored = table.stored.name();
    println!("| {name} | `{}` | {width} x {height} {stored} | {bytes} | {} |", table.layout, figures(&error));
    (error, bytes)
}

fn figures(error: &ErrorStats) -> String {
    let at: Vec<String> = error.worst.at.iter().map(|value| format!("{value:.3}")).collect();
    format!("{:.2e} | {:.2e} | {:.2e} | {}", error.max_abs_err, error.p99_abs_err, error.rms_err, at.join(", "))
}

fn held(held: bool) -> &'static str {
    if held { "held" } else { "missed" }
}
