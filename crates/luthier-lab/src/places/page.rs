//! The page of places.

use std::fmt::Write as _;

use super::{BAKED, FULL, Row};

/// The rows as a page in Markdown.
pub(super) fn write(rows: &[Row], generator: &str, adapter: &str, places: usize, pairs: u32) -> String {
    let mut page = format!(
        "# Shaders at places\n\n\
         `luthier-lab places -o docs/pages/places.md` makes this page. It ran on {adapter}, by {generator}.\n\n\
         What varies over a surface reaches a shader as a *place*: values of textures, and of functions of the shader such as `luthier_patina_amount`. The page compares \
         `luthier_eval_at`, or the function of the row, with its f64 twin at {places} places of each kind, for {pairs} pairs of directions at each: half all over the hemisphere, half \
         near the mirrored one. An error is over the brightest channel, or over 0.1/pi where that is larger. Colours are at three wavelengths, so that both forms mean one \
         value. The form `full` differs by arithmetic in single precision. The form `baked` is compared with exact terms, so that its errors are those of tables: \
         [parity.md](parity.md) tells both apart. `belcour` and `yamaguchi` have no column `full`, because that form takes facets as level. *Made* is the largest \
         difference that the places make: the error of a shader that ignored them.\n\n\
         `lobes` fits its light for each factor: [varying.md](varying.md) compares it. No error may exceed {FULL:.0e} in the form `full`, nor {BAKED:.0e} in the form `baked`.\n\n\
         | what varies | at a place | model | full, largest | median | baked, largest | median | made |\n\
         |---|---|---|--:|--:|--:|--:|--:|\n"
    );
    for row in rows {
        let [full, baked] = row.errors.map(|error| match error {
            Some([max, median]) => format!("{max:.1e} | {median:.1e}"),
            None => "– | –".to_owned(),
        });
        // Writing to a string cannot fail.
        let _ = writeln!(
            page,
            "| {} | `{}` | `{}` | {full} | {baked} | {:.1} |",
            row.name,
            row.key,
            row.model.name(),
            row.made
        );
    }
    page
}
