//! `textured`.

use crate::workshop::Workshop;

/// A table of the page by its first column.
fn cells<'a>(page: &'a str, heading: &str, material: &str) -> Vec<&'a str> {
    let part = page.split(heading).nth(1).unwrap_or_else(|| panic!("no {heading}: {page}"));
    let row = part.lines().find(|line| line.starts_with(&format!("| {material} |")));
    row.unwrap_or_else(|| panic!("{material}: {page}")).split('|').map(str::trim).collect()
}

/// Two maps at once, in the model that stacks have by default: the shader is what its rows are, and these are the simulated stack. Thickness with albedo, whose light
/// depends on both; and roughness with albedo, where light has to vanish at the horizon.
#[test]
fn shader_rows_and_simulation_agree_where_two_maps_vary() {
    let workshop = Workshop::with(&[]);
    for material in ["roughness-albedo", "thickness-albedo"] {
        let only = ["--only", material, "--pairs", "400", "--places", "3", "--noise", "0.04", "--samples", "65536"];
        let run = workshop.run(&[&["textured"][..], &only].concat());
        if run.lacks_adapter() {
            return;
        }
        let page = run.exits(0).stdout;
        let shader = cells(&page, "## Shader against rows", material);
        assert!(shader[2] == "`lobes`" && shader[4].parse::<f64>().unwrap() <= 0.01 && shader[6] == "0", "{shader:?}");
        let rows = cells(&page, "## Rows against the simulation", material);
        assert!(rows[2] == "27" && rows[6] == "0", "{page}");
    }
}

/// Maps of base colour and metal, and of tangents, in families of lobes: the f64 of the rows has the metal of the place, as the shader does.
#[test]
fn energies_in_tables_are_those_of_the_metal_of_a_place() {
    let workshop = Workshop::with(&[]);
    for material in ["base-color-metallic-roughness", "coated-base-color-metallic", "tangent", "coated-tangent"] {
        let run = workshop.run(&["textured", "--only", material, "--pairs", "400"]);
        if run.lacks_adapter() {
            return;
        }
        let page = run.exits(0).stdout;
        let shader = cells(&page, "## Shader against rows", material);
        assert!(shader[2] == "`lobes`" && shader[6] == "0", "{shader:?}");
        assert!(shader[4].parse::<f64>().unwrap() <= 1e-4, "{shader:?}");
    }
}

/// Materials that are the same everywhere are left out, and a file that names another model than it has by default is shown in both.
#[test]
fn what_is_the_same_everywhere_is_left_out() {
    let root = luthier_workshop::root();
    let [plain, patina] =
        ["red-lacquer", "chromium-car-paint"].map(|name| root.join(format!("materials/papers/{name}.toml")));
    let files = [plain.to_str().unwrap(), patina.to_str().unwrap()];
    let workshop = Workshop::with(&[]);
    let rest = ["--no-generated", "--pairs", "64", "--places", "1", "--noise", "0.1", "--samples", "4096"];
    let run = workshop.run(&[&["textured"][..], &files, &rest].concat());
    if run.lacks_adapter() {
        return;
    }
    let page = run.exits(0).stdout;
    assert!(!page.contains("| red-lacquer"), "{page}");
    assert!(cells(&page, "## Shader against rows", "chromium-car-paint")[2] == "`elek`", "{page}");
}
