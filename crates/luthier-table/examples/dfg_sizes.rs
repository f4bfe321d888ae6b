//! Costs of a split sum of GGX at each error, over cosines and alphas from 0.01 on, as rows of Markdown: a table, a table beside a closed form, a
//! closed form.

#![expect(clippy::print_stdout, reason = "an example speaks on the terminal")]

use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_table::{ClosedForm, Found, SPLIT_SUM, search, search_beside_form};

const LOWEST: [f64; 2] = [0.01; 2];
/// Limits of the tables beside forms, bytes.
const BYTES: [usize; 3] = [512, 1024, 2048];

fn main() {
    let (distribution, masking) = (Distribution::Ggx, Masking::SmithCorrelated);
    for max_abs in [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4] {
        let plain = cell(&search(distribution, masking, &SPLIT_SUM, max_abs, LOWEST[0], LOWEST[1]));
        let beside = BYTES.map(|bytes| cell(&search_beside_form(distribution, masking, max_abs, LOWEST, bytes)));
        let closed = ClosedForm::fit(distribution, masking, max_abs, LOWEST[0], LOWEST[1]);
        let form = if closed.held { closed.form.cost().slots().to_string() } else { "–".to_owned() };
        println!("| {max_abs} | {plain} | {} | {form} |", beside.join(" | "));
    }
}

/// Bytes and operations, where the error holds.
fn cell(Found { table, held, .. }: &Found) -> String {
    let slots = table.cost().map_or(0, |cost| cost.slots());
    if *held {
        format!("{} x {}, {} B, {slots}", table.size[0], table.size[1], table.bytes())
    } else {
        "–".to_owned()
    }
}
