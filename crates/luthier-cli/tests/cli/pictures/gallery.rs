//! `gallery`.

use luthier_workshop::material_texts::{gold, lacquer, matte};

use crate::workshop::Workshop;

#[test]
fn a_sheet_of_a_folder() {
    let workshop = Workshop::with(&[
        ("shelf/a.toml", &matte("ash")),
        ("shelf/b.toml", &gold("gold")),
        ("shelf/c.toml", &lacquer("lacquer")),
    ]);
    let run =
        workshop.run(&["gallery", "shelf", "-o", "sheet.png", "--size", "32", "--samples", "1", "--columns", "3"]);
    if run.lacks_adapter() {
        return;
    }
    assert_eq!(run.exits(0).stdout, "");
    let sheet = image::open(workshop.path("sheet.png")).unwrap().into_rgb8();
    // Three cells of 32 and their gaps of 8; 16 for the names.
    assert_eq!(sheet.dimensions(), (3 * 40 + 8, 32 + 16 + 8 + 8));
    let middles = [24, 64, 104].map(|x| sheet.get_pixel(x, 24).0);
    assert!(middles[0] != middles[1] && middles[1] != middles[2], "{middles:?}");
    let paper = sheet.get_pixel(0, 0).0;
    let inked = |x: u32| (40..56).any(|y| (x..x + 32).any(|x| sheet.get_pixel(x, y).0 != paper));
    assert!([8, 48, 88].into_iter().all(inked));
    assert_eq!(workshop.files("."), ["sheet.png", "shelf/a.toml", "shelf/b.toml", "shelf/c.toml"]);
}

#[test]
fn what_a_gallery_cannot_show() {
    let workshop = Workshop::with(&[("a.toml", &matte("ash")), ("broken.toml", "schema = 1\n")]);
    workshop.run(&["gallery", "a.toml", "-o", "no.png", "--shape", "grid"]).fails(1, &["grid"]);
    workshop.run(&["gallery", "a.toml", "-o", "no.jpeg"]).fails(1, &["no.jpeg"]);
    workshop.run(&["gallery", "a.toml", "broken.toml", "-o", "no.png"]).exits(1).says(&["broken.toml"]);
    workshop.run(&["gallery", "missing.toml", "-o", "no.png"]).fails(3, &["missing.toml"]);
    assert!(!workshop.path("no.png").exists());
}
