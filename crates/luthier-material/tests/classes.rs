//! The starting files of `docs/classes.md` are materials of the class that they stand under.

use std::path::Path;

use luthier_material::{SurfaceClass, parse};

#[test]
fn starting_files_have_their_class() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/classes.md");
    let page = std::fs::read_to_string(path).unwrap();
    for class in SurfaceClass::ALL {
        let letter = if class.is_layered() { format!("{} ", class.symbol()) } else { String::new() };
        let heading = format!("\n## {letter}{}\n", class.name());
        let (_, section) = page.split_once(&heading).unwrap_or_else(|| panic!("no section `{heading}`"));
        let (_, rest) = section.split_once("```toml\n").unwrap();
        let (text, _) = rest.split_once("```").unwrap();
        let parsed = parse("classes.md", text, &|_| Err(std::io::ErrorKind::NotFound.into()));
        let parsed = parsed.unwrap_or_else(|errors| panic!("{heading}: {errors:?}"));
        assert_eq!(parsed.material.class, class, "{heading}");
        assert!(parsed.warnings.is_empty(), "{heading}: {:?}", parsed.warnings);
        // The questions lead to each class by its name; h is said below them.
        let leaf = format!("[{letter}{}](#", class.name());
        assert!(class == SurfaceClass::H || page.contains(&leaf), "{leaf}");
    }
}
