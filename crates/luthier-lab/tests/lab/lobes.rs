//! `lobes`.

use luthier_workshop::material_texts::matte;

use crate::workshop::Workshop;

/// A brushed metal.
const BRUSHED: &str = r#"
schema = 1
name = "brushed"

[[layer]]
type = "conductor"
ior = "al"
alpha_x = 0.1
alpha_y = 0.4
"#;

/// Lambert's surface needs no lobe; a brushed surface has rows over the azimuth.
#[test]
fn lobes_are_fitted_to_materials_and_to_random_stacks() {
    let workshop = Workshop::with(&[("m.toml", &matte("m")), ("brushed.toml", BRUSHED)]);
    let args =
        ["lobes", "m.toml", "brushed.toml", "--random", "1", "--samples", "2000", "--paths", "4000", "--rows", "4"];
    let page = workshop.run(&args).exits(0).stdout;
    let parts = [
        "# Lobes\n",
        "## Materials",
        "## Twins",
        "## Random stacks",
        "| 0 beckmann: ",
        "**95th percentile**",
        "## The worst, and why",
        "\n| brushed | ",
    ];
    for part in parts {
        assert!(page.contains(part), "no {part} in {page}");
    }
    let row = page.lines().find(|line| line.starts_with("| m |")).unwrap();
    let figures: Vec<f64> = row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    let [belcour, _, noise, albedo, ..] = figures[..] else { panic!("{row}") };
    let fit: Option<f64> = row.split('|').find_map(|cell| cell.trim().strip_suffix(" (0)")?.parse().ok());
    // Paths that all have the weight of the albedo.
    assert!(fit.unwrap() < 2.0 * noise && belcour < 2.0 * noise && albedo < 2e-3, "{row}");
    assert_eq!(workshop.run(&args).exits(0).stdout, page, "again");
}
