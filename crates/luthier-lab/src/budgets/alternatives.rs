//! Tables that no search takes unless a target is known, and tables that none takes at all.

use std::fmt::Write as _;

use luthier_bake::goals::{Goals, Parameters, SharedGoal};
use luthier_lut::Mapping;
use luthier_manifest::{Candidate, CandidateForm};

/// Tiles and rows in blocks.
pub(super) fn blocks(out: &mut String, goals: &Goals) {
    out.push_str(
        "\n## Blocks: BC6H\n\n\
         BC6H (`bc6h-rgb-ufloat`) stores 4 x 4 texels of three half floats without sign in 16 bytes. The baker uses its modes with one line through the \
         colours of a block, and fits the line to the smallest largest error. The sides of tiles are multiples of 4, so that no two tiles share a block. \
         The format has no channel A; albedo tiles of other formats use it, but no shader of luthier reads it. The table has the smallest tile whose \
         error, as sampled, is within `max_abs` for all tiles of `materials/`:\n\n\
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
        "\nBlocks make albedo tiles of bare interfaces smaller where the budget is loose. They do not help films: colours of films leave the gamut, \
         blocks turn their negative values into 0, and the colours of fringes within a block do not lie on a line.\n",
    );
    out.push_str(
        "\nRows are one texel high. So four rows share a block, in the order of their atlas, or one row is repeated four times. The table has the fewest \
         bytes of a row whose error is within `max_abs` for all rows of `materials/`. The columns with `over` are for blocks that store the difference \
         from Schlick's form; 24 bytes for its coefficients are added. `-` means that more than 128 texels are needed:\n\n\
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
         The course (section 3.4.1) considers a texture of three axes for all interfaces, which a shader reads once for each channel; it then prefers rows. \
         The table measures such textures for the {} interfaces of `materials/` without films. The axes cover the smallest ranges that contain them. \
         The cosine is mapped by u, u^2 or u^3, whichever has the smallest error. Filtering is trilinear, with weights of 8 bits. The axes `n, k` are \
         uniform, as in the course. `amplitude` stands for the magnitude and the phase of (n + ik - 1)/(n + ik + 1), also uniform. The column \
         `three wavelengths` is the error against the function at three wavelengths; such a table can hold nothing else. The column `colours` is the error \
         against the colours that rows hold, integrated over the spectrum. `row` is the fewest bytes of a row for values at three wavelengths that has neither \
         a larger error nor a higher cost. `interfaces` is the number of interfaces from which the table is smaller than such rows.\n\n\
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
        "\nThe table of three axes pays from {} interfaces without films, if an error of {:.1e} suffices, and only for values at three wavelengths. The {} \
         interfaces of `materials/` take {} bytes as rows of that error. Against spectral colours its smallest error is {colors:.1e}.",
        even(&first).unwrap_or_default(),
        first.table.three_wavelengths,
        goals.bare,
        u64::from(first.row_bytes.unwrap_or_default()) * u64::from(goals.bare),
    );
    if let Some(Ok(rows)) = goals.steps.iter().find(|step| step.max_abs == 5e-4).map(|step| &step.chosen) {
        let (count, bytes, cost, error) = (goals.rows.len(), rows.bytes, rows.cost, rows.error.max_abs);
        let _ = write!(
            out,
            " The rows that the search chooses under `max_abs = 5e-4` (see above), {count} with those of films, take {bytes} bytes, have a cost of {cost:.0} and an error of {error:.1e}."
        );
    }
    out.push('\n');
}
