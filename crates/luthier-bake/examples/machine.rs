//! Limits of one core, as one line of JSON: what `scripts/jobs.sh` compares jobs with. Each is the best of seven runs.
//!
//! `hertz` is the clock: a chain of products of integers, each with an or, takes four cycles a step on x86-64 processors of the last ten years. `flops`
//! are products and sums of f64, and `divisions` and `roots` of f64, each per second in independent chains, with the instructions that the
//! compiler may use by default. `bytes` per second are read from memory, in one pass over 256 MiB.

#![expect(clippy::print_stdout, reason = "an example speaks on the terminal")]

use std::hint::black_box;
use std::time::Instant;

use serde_json::json;

/// Numbers that are worked on side by side: fourteen registers of two f64, which leaves two for the constants.
const LANES: usize = 28;

const RUNS: u32 = 7;

fn main() {
    let steps = 20_000_000_u64;
    let hertz = fastest(4 * steps, || {
        let mut x = black_box(3_u64);
        for _ in 0..steps {
            x = x.wrapping_mul(x | 1);
        }
        black_box(x);
    });
    let flops = chains(2, |x, a| x * a + 1e-3);
    let divisions = chains(1, |x, a| a / x);
    let roots = chains(1, |x, _| x.sqrt());
    let memory = vec![1_u64; 1 << 25];
    let bytes = fastest(8 * memory.len() as u64, || {
        black_box(black_box(&memory).iter().fold(0_u64, |sum, x| sum.wrapping_add(*x)));
    });
    println!("{}", json!({ "hertz": hertz, "flops": flops, "divisions": divisions, "roots": roots, "bytes": bytes }));
}

/// Operations per second of a step of independent chains that has so many.
fn chains(operations: u64, step: impl Fn(f64, f64) -> f64) -> f64 {
    let steps = 2_000_000;
    fastest(operations * LANES as u64 * steps, || {
        let mut lanes = black_box([1.5_f64; LANES]);
        let a = black_box(0.9);
        for _ in 0..steps {
            for lane in &mut lanes {
                *lane = step(*lane, a);
            }
        }
        black_box(lanes);
    })
}

/// Operations per second of the fastest of some runs.
fn fastest(operations: u64, mut run: impl FnMut()) -> f64 {
    let best = (0..RUNS).map(|_| {
        let started = Instant::now();
        run();
        started.elapsed().as_secs_f64()
    });
    operations as f64 / best.fold(f64::INFINITY, f64::min)
}
