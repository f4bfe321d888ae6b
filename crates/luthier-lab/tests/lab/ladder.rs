//! `ladder`: what limits on the errors of lobes take, and the chart of error against time.

use luthier_workshop::material_texts::{lacquer, matte};

use crate::workshop::Workshop;

/// Rows of the first table of a section.
fn rows<'p>(page: &'p str, title: &str) -> Vec<Vec<&'p str>> {
    let section = page.split_once(&format!("# {title}\n")).unwrap_or_else(|| panic!("no {title} in {page}")).1;
    let table = section.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    table.skip(2).map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

fn number(cell: &str) -> f64 {
    cell.split(' ').next().unwrap().parse().unwrap_or_else(|_| panic!("{cell}"))
}

/// Every stack takes one form, looser limits are held by no fewer stacks and cost no more, and each of several lights costs less than one.
#[test]
fn limits_take_cheaper_forms() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer")), ("matte.toml", &matte("matte"))]);
    let page = workshop.run(&["ladder", "lacquer.toml", "matte.toml", "--stacks", "2"]).exits(0).stdout;
    assert!(page.contains("Made by `luthier-lab ladder lacquer.toml matte.toml --stacks 2`"), "{page}");
    // A diffuse base alone has no rows.
    for (title, stacks) in [("Materials", 1.0), ("Twins in the other distribution", 1.0), ("Random stacks", 2.0)] {
        let found = rows(&page, title);
        assert_eq!(
            found.iter().map(|row| row[0]).collect::<Vec<_>>(),
            ["none", "least error", "0.02", "0.03", "0.05", "0.1"]
        );
        for row in &found {
            assert_eq!(row[2..9].iter().map(|cell| number(cell)).sum::<f64>(), stacks, "{row:?}");
            assert!(number(row[9]) <= number(row[11]) && number(row[12]) <= number(row[14]), "{row:?}");
            assert!(number(row[15]) > number(row[16]) && number(row[16]) > number(row[17]), "{row:?}");
        }
        let held = |row: &Vec<&str>| number(row[1]);
        assert!(found[2..].windows(2).all(|pair| held(&pair[0]) <= held(&pair[1])), "{found:?}");
        assert!(held(&found[5]) == stacks && number(found[5][11]) <= 0.1, "{found:?}");
        assert!(number(found[5][15]) <= number(found[1][15]), "{found:?}");
        // No form has a smaller error than the one with the least.
        assert!(found[1..].iter().all(|row| number(row[11]) >= number(found[1][11])), "{found:?}");
    }
    assert!(!page.contains("## Beside") && !page.contains("!["), "{page}");
}

/// Oracle: the page `lobes` judges the fit of a stack, before it became a table; here are the tables that ship, read as shaders read them.
#[test]
fn tables_have_the_errors_of_their_fits() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let precision = ["--noise", "0.02", "--samples", "65536"];
    let chart = ["ladder", "lacquer.toml", "--stacks", "1", "--coats", "1", "--chart", "made.svg"];
    let page = workshop.run(&[&chart[..], &precision].concat()).exits(0).stdout;
    assert!(page.contains("](made.svg)"), "{page}");
    let fits = workshop.run(&[&["lobes", "lacquer.toml", "--random", "1"][..], &precision].concat()).exits(0).stdout;
    let fit = fits.lines().find_map(|line| line.strip_prefix("| 0 beckmann: ")).unwrap();
    let fit: Vec<f64> = fit.split('|').filter_map(|cell| cell.trim().split(' ').next()?.parse().ok()).collect();
    let worst = page.split_once("## Aims").unwrap().1;
    let own: Vec<&str> =
        worst.lines().find_map(|line| line.strip_prefix("| 0 beckmann: ")).unwrap().split('|').map(str::trim).collect();
    // The first cell is what is left of the name, and the next the form.
    let [shipped, fitted] = [number(own[5]), fit[1]];
    assert!((shipped - fitted).abs() < 0.003, "{shipped} {fitted}");

    let coats = rows(page.split_once("## Beside models and engines\n").unwrap().1, "Coats of engines");
    let error = |name: &str| {
        let row = coats.iter().find(|row| row[0] == name).unwrap_or_else(|| panic!("no {name} in {coats:?}"));
        number(row[1])
    };
    assert!(error("lobes") < 0.5 * error("belcour") && error("belcour") < error("glTF KHR_materials_clearcoat"));
    let svg = workshop.text("made.svg");
    for text in [
        "glTF clear coat",
        "OpenPBR (Adobe)",
        "Belcour 2018",
        "not counted yet",
        "glTF, base changed",
        "H100",
        "1 random stack",
    ] {
        assert!(svg.contains(text), "no {text} in {svg}");
    }
}
