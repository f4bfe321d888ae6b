//! Inputs of the benchmarks: fixed pseudo-random directions, so that neither branches nor cached results are foreseen.

use std::f64::consts::PI;

use divan::{Bencher, black_box};
use glam::DVec3;

/// Number of inputs; a sample of an evaluation of some nanoseconds goes through them once.
pub(crate) const INPUTS: u32 = 1024;

/// Size of a sample of slower evaluations: long for the clock, short for the scheduler of the machine.
pub(crate) const SOME: u32 = 64;

/// Number of samples of slower evaluations, which go through the inputs eight times.
pub(crate) const SAMPLES: u32 = 8 * INPUTS / SOME;

/// Light, eye, and three numbers in 0..1.
#[derive(Clone, Copy)]
pub(crate) struct Draw {
    pub(crate) wi: DVec3,
    pub(crate) wo: DVec3,
    pub(crate) u: [f64; 3],
}

/// Inputs whose directions are both uniform on the hemisphere and independent.
pub(crate) fn draws() -> Vec<Draw> {
    (0..INPUTS)
        .map(|i| {
            let number = |k| random(i * 7 + k);
            let (wi, wo) = (direction(number(0), number(1)), direction(number(2), number(3)));
            Draw { wi, wo, u: [number(4), number(5), number(6)] }
        })
        .collect()
}

/// The angles of a pair of directions and their half vector.
#[derive(Clone, Copy)]
pub(crate) struct Angles {
    pub(crate) wh: DVec3,
    pub(crate) cos_theta_i: f64,
    pub(crate) cos_theta_o: f64,
    pub(crate) cos_theta_h: f64,
    pub(crate) sin_theta_h_sq: f64,
    pub(crate) cos_theta_d: f64,
}

pub(crate) fn angles() -> Vec<Angles> {
    draws()
        .iter()
        .map(|draw| {
            let wh = (draw.wi + draw.wo).normalize();
            Angles {
                wh,
                cos_theta_i: draw.wi.z,
                cos_theta_o: draw.wo.z,
                cos_theta_h: wh.z,
                sin_theta_h_sq: wh.x * wh.x + wh.y * wh.y,
                cos_theta_d: wh.dot(draw.wo),
            }
        })
        .collect()
}

/// Times `f` of one input after the other. The loop itself is timed by the `loop` row of the optics bench.
pub(crate) fn each<I, O>(bencher: Bencher<'_, '_>, inputs: &[I], f: impl Fn(&I) -> O) {
    let mut next = 0;
    bencher.bench_local(|| {
        let input = &inputs[next];
        next = if next + 1 == inputs.len() { 0 } else { next + 1 };
        f(black_box(input))
    });
}

fn direction(u: f64, v: f64) -> DVec3 {
    // The horizon itself is left out.
    let cos = 1.0 - u;
    let sin = libm::sqrt((1.0 - cos * cos).max(0.0));
    DVec3::new(sin * libm::cos(2.0 * PI * v), sin * libm::sin(2.0 * PI * v), cos)
}

/// The output of SplitMix64 (Steele, Lea and Flood 2014) for a state, in 0..1.
fn random(state: u32) -> f64 {
    let mut z = u64::from(state).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
