//! What a split sum of GGX costs at each error, over cosines and alphas from 0.01 on: as a table, as a table beside a closed form, as a closed form.

#![expect(clippy::print_stdout, reason = "an example speaks on the terminal")]

use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_table::{ClosedForm, Cost, Found, search, search_beside_form};

const LOWEST: [f64; 2] = [0.01; 2];
/// Limits of the tables beside forms, bytes.
const BYTES: [usize; 3] = [512, 1024, 2048];

fn row(name: &str, bytes: usize, size: [u32; 2], cost: Cost, max_abs_err: f64, held: bool) {
    let holds = if held { "" } else { "  (does not hold)" };
    println!(
        "  {name:<20} {bytes:>6} bytes {:>3} x {:<3} {:>3} slots, errs by {max_abs_err:.2e}{holds}",
        size[0],
        size[1],
        cost.slots()
    );
}

fn table_row(name: &str, found: &Found) {
    let table = &found.table;
    let cost = table.cost().unwrap_or_default();
    row(name, table.bytes(), table.size, cost, found.error.max_abs_err, found.held);
    println!("{:22}{}", "", table.layout);
}

fn main() {
    let (distribution, masking) = (Distribution::Ggx, Masking::SmithCorrelated);
    for max_abs in [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4] {
        println!("{max_abs}");
        table_row("table", &search(distribution, masking, max_abs, LOWEST[0], LOWEST[1]));
        for bytes in BYTES {
            let found = search_beside_form(distribution, masking, max_abs, LOWEST, bytes);
            table_row(&format!("form, table <= {bytes}"), &found);
        }
        let found = ClosedForm::fit(distribution, masking, max_abs, LOWEST[0], LOWEST[1]);
        row("form", 0, [0, 0], found.form.cost(), found.error.max_abs_err, found.held);
    }
}
