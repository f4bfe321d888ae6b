//! `five-ways`.

use crate::workshop::Workshop;

/// The lobes of a textured coat are nearer to the simulation than elek and belcour, and have its light. Oracle: the simulation.
#[test]
fn lobes_are_the_nearest_to_the_simulation() {
    let workshop = Workshop::with(&[]);
    let oak = luthier_workshop::root().join("materials/textured/board/varnished-oak.toml");
    let run = workshop.run(&["five-ways", oak.to_str().unwrap(), "--size", "16", "--picture", "five.png"]);
    let page = run.exits(0).stdout;
    let [lobes, belcour, elek] = ["lobes", "belcour", "elek"].map(|way| {
        let row = page.lines().find(|line| line.starts_with(&format!("| varnished-oak | {way} |")));
        let cells = row.unwrap_or_else(|| panic!("no {way}: {page}")).split('|').skip(3).take(2);
        cells.map(|cell| cell.trim().parse::<f64>().unwrap()).collect::<Vec<_>>()
    });
    assert!(lobes[0].abs() < 0.03 && lobes[1] < 0.2, "{page}");
    assert!(2.0 * lobes[1] < belcour[1] && 2.0 * lobes[1] < elek[1], "{page}");
    let picture = image::open(workshop.path("five.png")).unwrap().into_rgb8();
    assert!(picture.width() > 5 * 16 && picture.pixels().any(|pixel| pixel.0[0] > 60), "{:?}", picture.dimensions());
}
