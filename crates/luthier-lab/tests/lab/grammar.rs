//! `grammar`.

use std::fs;

use luthier_workshop::root;

use crate::workshop::Workshop;

#[test]
fn the_page_is_up_to_date() {
    let page = Workshop::new().run(&["grammar"]).exits(0).stdout;
    let kept = fs::read_to_string(root().join("docs/grammar.md")).unwrap().replace("\r\n", "\n");
    assert!(
        page.trim_end() == kept.trim_end(),
        "docs/grammar.md is out of date: luthier-lab grammar -o docs/grammar.md"
    );
}

/// No key lacks its sentence, values, unit, default, and pictures with the models that show it, or the reason why there is nothing to see.
#[test]
fn no_key_lacks_anything() {
    let page = fs::read_to_string(root().join("docs/grammar.md")).unwrap().replace("\r\n", "\n");
    let (mut pictures, mut unseen) = (0, 0);
    for section in page.split("\n### ").skip(1) {
        let section = section.split("\n## ").next().unwrap();
        let parts: Vec<&str> = section.trim_end().split("\n\n").collect();
        let [heading, sentence, table, sight @ ..] = parts.as_slice() else { panic!("{section}") };
        assert!(heading.starts_with('`') && sentence.ends_with('.'), "{section}");
        let row = table.lines().nth(2).unwrap();
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        assert!(cells.len() == 3 && cells.iter().all(|cell| !cell.is_empty()), "{section}");
        // A number has a unit, and no other value has.
        let is_number = cells[0].contains("number");
        assert_eq!(cells[1] != "\u{2013}", is_number, "{section}");
        match sight {
            [why] => {
                assert!(why.starts_with("Nothing to see: "), "{section}");
                unseen += 1;
            }
            [picture, values] => {
                let file = picture.strip_suffix(')').unwrap().rsplit_once('(').unwrap().1;
                let image = image::open(root().join("docs").join(file)).unwrap();
                let balls = (image.width() + 4) / (image.height() + 4);
                assert_eq!(balls as usize, values.matches(" \u{b7} ").count() + 1, "{section}");
                // Three values, or all of a choice of two.
                let is_choice_of_two = cells[0].matches('"').count() == 4 || cells[0] == "`true` or `false`";
                assert!(balls == 3 || balls == 2 && is_choice_of_two, "{section}");
                assert!(values.contains("how") || values.contains("the model"), "{section}");
                pictures += 1;
            }
            _ => panic!("{section}"),
        }
    }
    assert!(pictures >= 80 && unseen >= 40, "{pictures} with pictures, {unseen} without");
}
