//! Bakes a material into `OUT_DIR`, where `src/main.rs` includes it: the program needs no folder of a bake.

use std::process::ExitCode;

use luthier_build::Build;

fn main() -> ExitCode {
    Build::of(["../../materials/papers/car-paint.toml"]).run()
}
