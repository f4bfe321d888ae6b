//! Page for browsers on what became of each property.

use std::fmt::{self, Write as _};

use luthier_gallery::escape;
use luthier_import::{Fate, Imported, Line};

use super::{Source, counts};

const STYLE: &str = "body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 sans-serif; color: #222; background: #fff }
table { border-collapse: collapse; width: 100% }
th, td { text-align: left; vertical-align: top; padding: .25rem .75rem .25rem 0; border-bottom: 1px solid #ddd }
td:nth-child(1) { width: 32% } td:nth-child(2) { width: 8rem; white-space: nowrap }
summary { cursor: pointer; font-size: 1.1rem; margin-top: 1rem }
small { color: #666 } .kept, .host { color: #666 } .approximated { color: #8a5a00 } .dropped { color: #b00020; font-weight: bold }
@media (prefers-color-scheme: dark) { body { color: #ddd; background: #181818 } th, td { border-color: #444 } small, .kept, .host { color: #999 } .approximated { color: #e0b050 } .dropped { color: #ff7080 } }
";

/// The page: for each file its materials, and for each of these its properties. Materials that lost something are open.
pub(super) fn page(read: &[Source]) -> String {
    let mut out = String::new();
    // Writing to a String does not fail.
    let _ = write(&mut out, read);
    out
}

fn write(out: &mut String, read: &[Source]) -> fmt::Result {
    let labels: Vec<&str> = read.iter().map(|read| read.label.as_str()).collect();
    let title = escape(&format!("Import of {}", labels.join(", ")));
    writeln!(out, "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">")?;
    writeln!(out, "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>")?;
    writeln!(out, "<style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>")?;
    writeln!(out, "<p>{}</p>", escape(&counts(read.iter().flat_map(lines))))?;
    for Source { label, import } in read {
        writeln!(out, "<h2>{}</h2>", escape(label))?;
        if !import.lines.is_empty() {
            table(out, &import.lines)?;
        }
        for material in &import.materials {
            section(out, material)?;
        }
    }
    writeln!(out, "</body>\n</html>")
}

fn lines(read: &Source) -> impl Iterator<Item = &Line> {
    read.import.lines.iter().chain(read.import.materials.iter().flat_map(|material| &material.lines))
}

fn section(out: &mut String, Imported { name, source_name, lines, .. }: &Imported) -> fmt::Result {
    let is_less = lines.iter().any(|line| matches!(line.fate, Fate::Approximated | Fate::Dropped));
    let open = if is_less { " open" } else { "" };
    let source = if source_name.is_empty() { String::new() } else { format!(" from “{source_name}”") };
    writeln!(
        out,
        "<details{open}>\n<summary>{}.toml<small>{}: {}</small></summary>",
        escape(name),
        escape(&source),
        escape(&counts(lines))
    )?;
    table(out, lines)?;
    writeln!(out, "</details>")
}

fn table(out: &mut String, lines: &[Line]) -> fmt::Result {
    writeln!(out, "<table>\n<tr><th>property</th><th>became</th><th></th></tr>")?;
    for Line { property, fate, note } in lines {
        let class = match fate {
            Fate::Kept | Fate::ClosedForm => "kept",
            Fate::Approximated => "approximated",
            Fate::Dropped => "dropped",
            Fate::Host => "host",
        };
        let [property, fate, note] = [property, fate.name(), note].map(escape);
        writeln!(out, "<tr><td><code>{property}</code></td><td class=\"{class}\">{fate}</td><td>{note}</td></tr>")?;
    }
    writeln!(out, "</table>")
}

#[cfg(test)]
mod tests {
    use luthier_import::Import;

    use super::*;

    fn line(property: &str, fate: Fate, note: &str) -> Line {
        Line { property: property.to_owned(), fate, note: note.to_owned() }
    }

    /// Names and notes are those of strangers.
    #[test]
    fn texts_of_files_are_no_markup() {
        let material = |name: &str, fate| Imported {
            name: name.to_owned(),
            source_name: "<b>Paint</b> & \"co\"".to_owned(),
            text: String::new(),
            lines: vec![line("<script>", fate, "a & b"), line("baseColorFactor", Fate::Kept, "")],
        };
        let materials = vec![material("lost", Fate::Dropped), material("whole", Fate::ClosedForm)];
        let import = Import { materials, lines: vec![line("lights", Fate::Host, "")], ..Import::default() };
        let page = page(&[Source { label: "<a>.gltf".to_owned(), import }]);
        assert!(!page.contains("<script>") && !page.contains("<b>") && !page.contains("<a>"), "{page}");
        assert!(page.contains("&lt;script&gt;") && page.contains("a &amp; b"), "{page}");
        assert!(page.contains("<p>2 kept, 1 closed form, 1 dropped, 1 the host's</p>"), "{page}");
        // What lost something is seen at once.
        assert_eq!((page.matches("<details open>").count(), page.matches("<details>").count()), (1, 1));
        assert_eq!(page.matches("<tr><td>").count(), 5);
    }
}
