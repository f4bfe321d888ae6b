//! Time of every evaluation in f64 on one thread: `cargo bench -p luthier-optics`. `scripts/bench-table.sh` makes a table of it.

mod distributions;
mod films;
mod inputs;
mod interfaces;
mod masking;
mod samplers;
mod table_nodes;
mod walks;

use divan::Bencher;

fn main() {
    divan::main();
}

/// The cost that all rows contain: fetching an input and keeping the result.
#[divan::bench(name = "loop", sample_size = inputs::INPUTS)]
fn empty(bencher: Bencher<'_, '_>) {
    inputs::each(bencher, &inputs::draws(), |draw| draw.wi.z);
}
