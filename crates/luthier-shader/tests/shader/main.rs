//! Emission, validation by others, and arithmetic of the shaders.

mod arithmetic;
mod emission;
mod golden;
mod judges;
mod machine;
mod paper;
mod scenes;
