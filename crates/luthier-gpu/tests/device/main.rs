//! Package made by hand, on whatever adapter there is. One test binary: a device is opened once per test, and
//! linking wgpu is slow.

#![expect(clippy::disallowed_methods, reason = "an oracle decides no bytes")]

mod adapter;
mod bake_by_hand;
mod effects;
mod environment;
mod evaluate;
mod loading;
mod lobes;
mod lookup;
mod many;
mod mesh;
mod record_terms;
mod refusal;
mod render;
mod reuse;
mod simulate;
mod yardstick;
