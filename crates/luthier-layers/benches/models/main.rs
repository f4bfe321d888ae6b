//! Time of every model of the registry, on one thread: `cargo bench -p luthier-layers`. `scripts/bench-table.sh` makes a table of it.
//!
//! Models that are functions (`functions`) are timed per value at one wavelength, estimates (`estimates`) per value at the
//! number of samples that they are registered with, and `spectral` per colour: the function at each of the 95
//! wavelengths, once per channel. Preparation that a model keeps (Belcour, Yamaguchi) happens before the clock starts and
//! has rows of its own in `parts`.

mod estimates;
mod functions;
#[path = "../../../luthier-optics/benches/optics/inputs.rs"]
#[expect(dead_code, reason = "shared with the bench of luthier-optics, which uses all of it")]
mod inputs;
mod parts;
mod spectral;
mod stacks;

use luthier_layers::model::Model;
use luthier_layers::registry;

fn main() {
    divan::main();
}

/// Names of the registered models that are functions of the directions, or of those that are estimates.
fn names(estimates: bool) -> Vec<&'static str> {
    let models = registry::models();
    let wanted = models.iter().filter(|model| model.estimator().is_some() == estimates);
    wanted.map(|model| model.info().name).collect()
}

fn model(name: &str) -> Box<dyn Model> {
    registry::model(name).expect("a name from the registry")
}
