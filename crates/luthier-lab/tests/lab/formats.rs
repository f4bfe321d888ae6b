//! `formats`.

use crate::workshop::Workshop;

/// A rough metal by its index is all but the same in each format; a glossy base that absorbs in its coat is not in glTF, and the page says why.
#[test]
fn formats_are_compared() {
    let workshop = Workshop::new();
    let materials = ["brushed-aluminium", "car-paint"];
    let paths = materials.map(|name| luthier_workshop::root().join(format!("materials/{name}.toml")));
    let [metal, paint] = paths.each_ref().map(|path| path.to_str().unwrap());
    let page = workshop.run(&["formats", metal, paint, "--noise", "0.05"]).exits(0).stdout;
    let row = |name: &str| -> Vec<f64> {
        let row = page.lines().find(|line| line.starts_with(&format!("| {name} |"))).unwrap();
        row.split('|').skip(2).filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    let [metal, paint] = materials.map(row);
    assert_eq!([metal.len(), paint.len()], [7, 7], "{page}");
    assert!(metal[..6].iter().all(|error| *error < 0.1), "{page}");
    assert!(paint[1] > 2.0 * metal[1], "{page}");
    assert!(page.contains("| coat: absorption | approximated: ") && page.contains("car-paint |"), "{page}");
}
