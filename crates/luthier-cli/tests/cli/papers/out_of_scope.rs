//! Elements that luthier does not mean to have, as `tests/papers/out-of-scope.toml` lists them.
//!
//! | key | content |
//! |---|---|
//! | `name`, `where` | the element, and its place in the paper |
//! | `paper` | the name of the file of that paper's elements |
//! | `reason` | why it is left out |

use std::fmt::Write as _;

use luthier_workshop::root;
use toml_edit::DocumentMut;

use super::element::FILES;

/// Names of the papers, in the order of their files.
const NAMES: [&str; 5] = ["Elek", "Granier and Heidrich", "Yamaguchi", "lecture", "course"];

/// The section of the page, a row for each element, in the order of the papers.
pub(super) fn section() -> String {
    let path = root().join("tests/papers/out-of-scope.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let document: DocumentMut = text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let tables = document["left_out"].as_array_of_tables().unwrap();
    let mut section =
        "\n## Out of scope\n\nThe documents name or show these, and luthier does not mean to have them.\n\n\
                       | element | paper | where | why not |\n|---|---|---|---|\n"
            .to_owned();
    let mut last = 0;
    for table in tables {
        let mut cells = ["name", "paper", "where", "reason"].map(|key| {
            let text = table.get(key).and_then(|item| item.as_str()).unwrap_or_default().trim();
            assert!(!text.is_empty(), "{}: `{key}` is empty:\n{table}", path.display());
            text
        });
        assert_eq!(table.len(), cells.len(), "{}: keys that nothing reads:\n{table}", path.display());
        let place = FILES.iter().position(|file| *file == cells[1]);
        let place = place.unwrap_or_else(|| panic!("{}: `{}` is no paper", path.display(), cells[1]));
        assert!(place >= last, "{}: `{}` is after a later paper", path.display(), cells[0]);
        last = place;
        cells[1] = NAMES[place];
        writeln!(section, "| {} |", cells.join(" | ")).unwrap();
    }
    section
}
