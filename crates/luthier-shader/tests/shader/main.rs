//! Emission, validation by others, and arithmetic of the shaders.

#![expect(clippy::disallowed_methods, reason = "an oracle decides no bytes")]

mod arithmetic;
mod effects;
mod emission;
mod examples;
mod face;
mod features;
mod fluorescent;
mod golden;
mod interface;
mod judges;
mod library;
mod lobes;
mod machine;
mod manual;
mod names;
mod packages;
mod pages;
mod paper;
mod scenes;
mod statistics;
