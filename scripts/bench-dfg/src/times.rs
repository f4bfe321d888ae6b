//! Time of a table.

use std::env;
use std::hint::black_box;
use std::process::Command;

use luthier_optics::split_sum::Masking;
use luthier_table::DfgTable;
use rustix::time::{ClockId, clock_gettime};

use crate::{SIDE, curved, forge, linear};

/// The argument that asks for [`first`].
pub const FIRST: &str = "--first";
/// Rounds; in each every table is baked once, one after the other.
const ROUNDS: usize = 15;
/// Times as fast that luthier should be.
const TARGET: f64 = 20.0;

/// Seconds of processor time of this thread: those of other work on the machine do not count.
fn seconds(work: impl FnOnce()) -> f64 {
    let now = || {
        let time = clock_gettime(ClockId::ThreadCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    };
    let start = now();
    work();
    now() - start
}

fn seconds_to_bake(table: &DfgTable) -> f64 {
    seconds(|| {
        black_box(table.bake());
    })
}

/// Seconds of the first bake of a process, which makes the rules of quadrature too.
pub fn first() -> f64 {
    seconds_to_bake(&linear(Masking::SchlickHalf, SIDE))
}

fn first_of_a_process() -> Result<f64, String> {
    let program = env::current_exe().map_err(|error| error.to_string())?;
    let said = Command::new(program).arg(FIRST).output().map_err(|error| error.to_string())?;
    String::from_utf8_lossy(&said.stdout).trim().parse().map_err(|error| format!("no time: {error}"))
}

/// Prints the section of times. To be called in a pool of one thread, whose clock counts.
pub fn print() -> Result<(), String> {
    let names = [
        "`forge-ibl-bake`, 1,024 samples a texel",
        "luthier, the same axes and masking",
        "luthier, the same axes and masking, first bake of a process",
        "luthier, the same axes, correlated masking",
        "luthier, other axes, the same masking",
    ];
    let same = linear(Masking::SchlickHalf, SIDE);
    let correlated = linear(Masking::SmithCorrelated, SIDE);
    let other = curved(Masking::SchlickHalf, SIDE);
    same.bake();
    let mut samples: [Vec<f64>; 5] = Default::default();
    for _ in 0..ROUNDS {
        samples[0].push(seconds(|| drop(black_box(forge()))));
        samples[1].push(seconds_to_bake(&same));
        samples[2].push(first_of_a_process()?);
        samples[3].push(seconds_to_bake(&correlated));
        samples[4].push(seconds_to_bake(&other));
    }
    println!("## Time of {SIDE} x {SIDE} texels, half floats\n");
    println!("| table | median ms | fastest ms | times as fast |\n|---|--:|--:|--:|");
    let mut ratios = [0.0; 5];
    for (row, name) in names.into_iter().enumerate() {
        ratios[row] = median(samples[0].iter().zip(&samples[row]).map(|(theirs, ours)| theirs / ours));
        let fastest = samples[row].iter().copied().fold(f64::INFINITY, f64::min);
        let typical = median(samples[row].iter().copied());
        println!("| {name} | {:.2} | {:.2} | {:.1} |", typical * 1e3, fastest * 1e3, ratios[row]);
    }
    let held = |row: usize| if ratios[row] >= TARGET { "held" } else { "missed" };
    println!("\nAt least {TARGET:.0} times as fast: on the same axes {}, on other axes {}.\n", held(1), held(4));
    Ok(())
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
