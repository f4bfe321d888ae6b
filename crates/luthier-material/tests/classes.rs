//! The starting files of `docs/classes.md` are those that `luthier new` writes of the class that they stand under.

use std::path::Path;

use luthier_material::{SurfaceClass, Template};

#[test]
fn starting_files_are_the_templates() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/classes.md");
    let page = std::fs::read_to_string(path).unwrap();
    for (class, template) in SurfaceClass::ALL.into_iter().zip(Template::CLASSES) {
        let letter = if class.is_layered() { format!("{} ", class.symbol()) } else { String::new() };
        let heading = format!("\n## {letter}{}\n", class.name());
        let (_, section) = page.split_once(&heading).unwrap_or_else(|| panic!("no section `{heading}`"));
        let (_, rest) = section.split_once("```toml\n").unwrap();
        let (text, _) = rest.split_once("```").unwrap();
        assert_eq!(text, template.text, "{heading}");
        // The questions lead to each class by its name; h is said below them.
        let leaf = format!("[{letter}{}](#", class.name());
        assert!(class == SurfaceClass::H || page.contains(&leaf), "{leaf}");
    }
}
