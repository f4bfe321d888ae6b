//! `parse` returns whatever the text: a material that keeps its promises, or errors that can be shown.

use std::fs;
use std::io;
use std::path::Path;

use luthier_material::{Diagnostic, parse};
use luthier_optics::stack::Base;
use proptest::prelude::*;

fn check(text: &str) {
    match parse("p.toml", text, &|_| Err(io::Error::other("none"))) {
        Ok(parsed) => {
            let stack = &parsed.material.stack;
            assert!(!stack.layers.is_empty());
            assert_eq!(stack.layers.len(), parsed.material.layers.len());
            assert!(stack.exterior.samples().iter().all(|s| s.k == 0.0));
            for (i, layer) in stack.layers.iter().enumerate() {
                for alpha in [layer.surface.alpha_x, layer.surface.alpha_y] {
                    assert!((0.0..=1.0).contains(&alpha));
                }
                assert!(layer.films.iter().all(|f| f.thickness.min_nm <= f.thickness.max_nm));
                assert!(matches!(layer.base, Base::Dielectric { .. }) || i + 1 == stack.layers.len());
            }
            parsed.warnings.iter().for_each(|d| assert!(!d.render(text).is_empty()));
        }
        Err(diagnostics) => {
            assert!(!diagnostics.is_empty());
            // Twenty errors and twenty warnings, and how many more there are of each.
            assert!(diagnostics.len() <= 42);
            for d in diagnostics {
                assert!(
                    d.message.chars().count() < 700 && !offers_nonsense(d.hint.as_deref().unwrap_or_default()),
                    "{d:?}"
                );
                assert!(text.get(d.span.clone()).is_some());
                assert!(d.line >= 1 && d.column >= 1 && d.line <= text.matches('\n').count() + 1);
                assert!(!d.render(text).is_empty() && !d.render_coloured(text).is_empty());
            }
        }
    }
}

/// Whether a hint has a value in backquotes that is no number of TOML that a key could have.
fn offers_nonsense(hint: &str) -> bool {
    let quoted = hint.split('`').skip(1).step_by(2);
    let mut values = quoted.filter_map(|code| code.rsplit_once('=')).map(|(_, value)| value.trim());
    values.any(|value| value.parse::<f64>().is_ok_and(|number| !number.is_finite()))
}

/// The shipped materials: text in which a few changes get far into the decoder.
fn shipped() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../materials");
    let folders = [folder.join("papers"), folder];
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
        .iter()
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .map(|p| fs::read_to_string(p).unwrap())
        .collect()
}

/// One edit: characters from a place on are replaced by something that means something in such files.
fn edit() -> impl Strategy<Value = (prop::sample::Index, usize, String)> {
    let pieces = prop_oneof![
        "\\PC{0,3}",
        prop::sample::select(vec![
            "",
            "\n",
            "0",
            "-1",
            "1e400",
            "nan",
            "-inf",
            "0x10",
            "true",
            "\"\"",
            "\"au\"",
            "\"x.csv\"",
            "[]",
            "[1, 2, 3]",
            "[[layer]]\n",
            "[layer]\n",
            "{}",
            "{ n = 1 }",
            "type = \"conductor\"",
            "smooth = false",
            "alpha_x = 0.5",
            "= ",
            "#",
            "1979-05-27",
            "9223372036854775808",
            "1e19",
            "inf",
            "1e300",
            "-1e-300",
            "[1e300, nan, inf]",
            "{ n = [1, 2], wavelengths_nm = [1000, 2000] }",
            "extent = nan",
            "thickness_nm = { min = inf, max = 1, extent_um = 1, map = { noise = { frequency = 1e19 } } }",
            "maps = { normal = \"n.png\" }",
            "a.b.c = 1",
            "é",
            "\t",
            "\r\n",
            "[effects.patina]\n",
            "'''",
        ])
        .prop_map(str::to_owned),
    ];
    (any::<prop::sample::Index>(), 0_usize..12, pieces)
}

fn apply(text: &mut String, (place, len, piece): &(prop::sample::Index, usize, String)) {
    let start = text.floor_char_boundary(place.index(text.len() + 1));
    let end = text.ceil_char_boundary((start + len).min(text.len()));
    text.replace_range(start..end, piece);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn on_arbitrary_text(text in "(?s).{0,200}") {
        check(&text);
    }

    #[test]
    fn on_lines_that_look_like_toml(lines in prop::collection::vec("(\\[\\[?layer\\]?\\]|[a-z_]{1,9} = (\"[a-z]{0,5}\"|-?[0-9.e]{1,5}|\\[[0-9, ]{0,9}\\]|\\{ n = 1 \\}))", 0..20)) {
        check(&lines.join("\n"));
    }

    #[test]
    fn on_mutated_materials(which in any::<prop::sample::Index>(), edits in prop::collection::vec(edit(), 1..5)) {
        let shipped = shipped();
        let mut text = shipped[which.index(shipped.len())].clone();
        for edit in &edits {
            apply(&mut text, edit);
        }
        check(&text);
    }

    /// Lines lost, doubled or moved, the text still well formed.
    #[test]
    fn on_shuffled_lines(which in any::<prop::sample::Index>(), moves in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..3), 1..6)) {
        let shipped = shipped();
        let mut lines: Vec<&str> = shipped[which.index(shipped.len())].lines().collect();
        for (from, to, how) in moves {
            let (from, to) = (from.index(lines.len()), to.index(lines.len()));
            match how {
                0 => lines.swap(from, to),
                1 => lines.insert(to, lines[from]),
                _ if lines.len() > 1 => drop(lines.remove(from)),
                _ => {}
            }
        }
        check(&lines.join("\n"));
    }
}

const COAT: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n";
const BASE: &str = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";

fn document(body: &str) -> String {
    format!("schema = 1\nname = \"x\"\n{body}")
}

fn errors(text: &str) -> Vec<Diagnostic> {
    check(text);
    parse("p.toml", text, &|_| Err(io::Error::other("none"))).unwrap_err()
}

/// A file full of mistakes: the first are told with all that belongs to them, the others are counted.
#[test]
fn many_mistakes_are_counted_not_told() {
    let unknown: String = (0..100_000).map(|i| format!("kye_{i} = 0\n")).collect();
    let layers = |count: usize| COAT.repeat(count - 1) + BASE;
    let wrong = format!("references = [{}]\n", "1, ".repeat(50_000));
    for (text, expected) in [
        (document(&(unknown + &layers(2))), 100_000),
        (document(&(wrong + &layers(2))), 50_000),
        (document(&layers(2).replace("smooth = true\n", &"smooth = true\n".repeat(30))), 1),
    ] {
        let found = errors(&text);
        let total: usize = found.iter().map(|d| d.count).sum();
        assert!(total >= expected, "{total} of {expected}");
        assert!(found.len() <= 42);
        if let (true, Some(last)) = (total > 20, found.last()) {
            assert_eq!((last.count, last.message.clone()), (total - 20, format!("and {} more errors", total - 20)));
        }
    }
}

#[test]
fn layers_are_counted() {
    let layers = |count: usize| document(&(COAT.repeat(count - 1) + BASE));
    check(&layers(64));
    assert!(parse("p.toml", &layers(64), &|_| Err(io::Error::other("none"))).is_ok());
    for count in [65, 20_000] {
        let found = errors(&layers(count));
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].message, format!("{count} times [[layer]]: at most 64 are read"));
        assert_eq!(found[0].line, 3 + 64 * 4);
    }
}

/// One value far outside what there is, and what is said of it.
#[test]
fn values_beyond_all_use_are_refused() {
    let film = |nm: &str| format!("[[layer]]\ntype = \"thin-film\"\nior = 1.4\nthickness_nm = {nm}\n{COAT}{BASE}");
    let patina = |rest: &str| format!("{COAT}{BASE}[effects.patina]\nmap = {{ noise = {{}} }}\n{rest}\n");
    let ior = |ior: &str| format!("{}{BASE}", COAT.replace("1.5", ior));
    for (body, message, hint) in [
        (
            film("{ min = 1, max = 9, extent_um = 1, map = { noise = { frequency = 1e19 } } }"),
            "at most 65536",
            "`frequency = 65536`",
        ),
        (film("{ min = inf, max = 9, extent_um = 1, map = { noise = {} } }"), "`min` must be", ""),
        (ior("1e300"), "at most 1000000, found 1e300", "`ior = 1000000`"),
        (ior("{ n = 1.5, k = 1e300 }"), "found 1e300", "`k = 1000000`"),
        (ior("{ n = [1, 2], wavelengths_nm = [1000, 2000] }"), "no sample of this index is visible", "360 to 830"),
        (ior("{ n = [1, 2], wavelengths_nm = [200, 300] }"), "no sample of this index is visible", "360 to 830"),
        (patina("extent = nan\ntransition = 0.5"), "`extent` must be a finite number", ""),
        (patina("extent = 0.5\ntransition = nan"), "`transition` must be", ""),
        (patina("extent = 1e300\ntransition = 0.5"), "`extent` runs from", "`extent = 1.5`"),
        (format!("{COAT}thickness_um = 1e300\n{BASE}"), "from 0 to 1e12", "`thickness_um = 1e12`"),
    ] {
        let found = errors(&document(&body));
        assert_eq!(found.len(), 1, "{body}\n{found:?}");
        assert!(found[0].message.contains(message), "{found:?}");
        assert!(found[0].hint.clone().unwrap_or_default().contains(hint), "{found:?}");
    }
}

/// Files and shaders are named after materials: file systems take names of 255 bytes.
#[test]
fn names_and_paths_have_a_length() {
    let named = |name: &str| format!("schema = 1\nname = \"{name}\"\n{COAT}{BASE}");
    check(&named(&"n".repeat(100)));
    assert!(parse("p.toml", &named(&"n".repeat(100)), &|_| Err(io::Error::other("none"))).is_ok());
    let found = errors(&named(&"n".repeat(101)));
    assert!(found.len() == 1 && found[0].message.contains("101 characters"), "{found:?}");
    assert!(found[0].hint.as_deref().is_some_and(|hint| hint.contains("100")), "{found:?}");
    let mapped = |path: &str| document(&format!("{COAT}maps = {{ normal = \"{path}\" }}\n{BASE}"));
    let found = errors(&mapped(&format!("maps/{}.png", "n".repeat(252))));
    assert!(found.len() == 1 && found[0].message.contains("256 bytes"), "{found:?}");
    assert!(
        parse("p.toml", &mapped(&format!("maps/{}.png", "n".repeat(251))), &|_| Err(io::Error::other("none"))).is_ok()
    );
    errors(&mapped(&"m/".repeat(5000)));
}

/// Texts that would take a parser's stack.
#[test]
fn deep_texts_end() {
    for text in [
        "[".repeat(100_000),
        "a = ".to_owned() + &"[".repeat(100_000),
        format!("a{} = 1", ".a".repeat(100_000)),
        "{".repeat(100_000),
    ] {
        errors(&text);
    }
}
