//! Tables that no search takes unless a target is known, and tables that none takes at all.

use std::fmt::Write as _;

use luthier_bake::goals::{Goals, Parameters, SharedGoal};
use luthier_lut::Mapping;
use luthier_manifest::{Candidate, CandidateForm};

/// Tiles and rows in blocks.
pub(super) fn blocks(out: &mut String, goals: &Goals) {
    out.push_str(
        "\n## Blocks: BC6H\n\n\
         16 bytes for 4 x 4 texels of three half floats without sign (`bc6h-rgb-ufloat`), fitted here to the least largest error by the modes of one \
         line through the colours of a block. Tiles have sides of multiples of 4, so that no two share a block. They have no A: what albedo tiles \
         hold there, no shader of luthier reads. The fewest bytes of one tile whose error, as sampled, is \
         within `max_abs` for all tiles of `materials/`:\n\n\
         | tiles | max_abs | core WebGPU | bytes | bc6h-rgb-ufloat | bytes | share |\n|---|---|---|---|---|---|---|\n",
    );
    for step in &goals.blocks {
        let bytes = |c: &Option<Candidate>| c.as_ref().map(|c| c.form.bytes(1));
        let (texels, blocks) = (bytes(&step.texels), bytes(&step.blocks));
        let share = texels.zip(blocks).map_or("-".to_owned(), |(t, b)| format!("{:.2}", b as f64 / t as f64));
        let in_words = |c: &Option<Candidate>| c.as_ref().map_or("none".to_owned(), |c| shape(&c.form));
        let number = |bytes: Option<u64>| bytes.map_or("-".to_owned(), |b| b.to_string());
        let _ = writeln!(
            out,
            "| {} | {:.0e} | {} | {} | {} | {} | {share} |",
            step.group,
            step.max_abs,
            in_words(&step.texels),
            number(texels),
            in_words(&step.blocks),
            number(blocks)
        );
    }
    out.push_str(
        "\nAlbedos of bare interfaces gain, where the budget is loose. Films do not: their colours leave the gamut, what is negative becomes 0, and \
         fringes turn within a block.\n",
    );
    out.push_str(
        "\nRows are one texel high: four of them share a block, or one is repeated four times. The fewest bytes of a row whose error is within \
         `max_abs` for all rows of `materials/`, in the order of their atlas; `over` is what Schlick's form misses in blocks, its coefficients \
         counted as 24 bytes elsewhere. `-` is more than 128 texels:\n\n\
         | max_abs | core WebGPU | four rows | repeated | four rows, over | repeated, over |\n|---|---|---|---|---|---|\n",
    );
    for (row, core) in &goals.row_blocks {
        let number = |bytes: Option<u32>| bytes.map_or("-".to_owned(), |b| b.to_string());
        let [a, b, c, d] = row.bytes.map(number);
        let _ = writeln!(out, "| {:.0e} | {} | {a} | {b} | {c} | {d} |", row.max_abs, number(*core));
    }
}

fn shape(form: &CandidateForm) -> String {
    let CandidateForm::Table { x, y, format, .. } = form else { return "closed form".to_owned() };
    let exponent = |mapping: &Mapping| match mapping {
        Mapping::Power { exponent } => format!("u^{exponent}"),
        _ => "u".to_owned(),
    };
    let [rows, down] =
        y.as_ref().map_or(["1".to_owned(), "-".to_owned()], |y| [y.size.to_string(), exponent(&y.mapping)]);
    format!("{} x {rows} {format}, {}, {down}", x.size, exponent(&x.mapping))
}

/// The table over angle, n and k.
pub(super) fn shared(out: &mut String, goals: &Goals) {
    let _ = write!(
        out,
        "\n## One table over angle, n and k\n\n\
         The course (section 3.4.1) considers a texture of three axes for all interfaces, read once for each channel, and prefers rows. Here for the \
         {} interfaces of `materials/` without films, over the least ranges that hold them; the cosine is mapped by u, u^2 or u^3, whichever errs \
         least; trilinear with weights of 8 bits. Axes `n, k` are uniform, as in the course; `amplitude` stands for magnitude and phase of \
         (n + ik - 1)/(n + ik + 1), also uniform. The first error is that against the function at three \
         wavelengths, which is all that such a table can hold; the second that against the colours that the rows hold, integrated over the \
         spectrum. The last columns: the fewest bytes of a row for values at three wavelengths that neither errs nor costs more, and \
         the number of interfaces from which on the table is smaller than such rows.\n\n\
         | axes | size | format | bytes | cost | three wavelengths | colours | row | interfaces |\n|---|---|---|---|---|---|---|---|---|\n",
        goals.bare
    );
    for goal in &goals.shared {
        let SharedGoal { table, row_bytes } = goal;
        let [x, y, z] = table.size;
        let axes = match table.parameters {
            Parameters::Index => "n, k",
            Parameters::Amplitude => "amplitude",
        };
        let row = row_bytes.map_or("-".to_owned(), |b| b.to_string());
        let even = row_bytes.map_or("-".to_owned(), |b| table.bytes.div_ceil(u64::from(b)).to_string());
        let _ = writeln!(
            out,
            "| {axes}, u^{} | {x} x {y} x {z} | {} | {} | {:.0} | {:.1e} | {:.1e} | {row} | {even} |",
            table.exponent,
            table.format.name(),
            table.bytes,
            table.cost,
            table.three_wavelengths,
            table.colors
        );
    }
    let even = |goal: &&SharedGoal| goal.row_bytes.map(|b| goal.table.bytes.div_ceil(u64::from(b)));
    let Some(first) = goals.shared.iter().filter(|goal| goal.row_bytes.is_some()).min_by_key(even) else { return };
    let colors = goals.shared.iter().map(|goal| goal.table.colors).fold(f64::INFINITY, f64::min);
    let _ = write!(
        out,
        "\nIt is on the front from {} interfaces without films on, if an error of {:.1e} will do, and only for values at three wavelengths. The {} \
         here take {} bytes as rows of that error. From spectral colours it is {colors:.1e} off at best.",
        even(&first).unwrap_or_default(),
        first.table.three_wavelengths,
        goals.bare,
        u64::from(first.row_bytes.unwrap_or_default()) * u64::from(goals.bare),
    );
    if let Some(Ok(rows)) = goals.steps.iter().find(|step| step.max_abs == 5e-4).map(|step| &step.chosen) {
        let (count, bytes, cost, error) = (goals.rows.len(), rows.bytes, rows.cost, rows.error.max_abs);
        let _ = write!(
            out,
            " All rows that `max_abs = 5e-4` chooses above, {count} with films, take {bytes} bytes, cost {cost:.0} and are {error:.1e} off."
        );
    }
    out.push('\n');
}
