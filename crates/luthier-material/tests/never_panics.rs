//! Whatever the text, `parse` returns: a material that keeps its promises, or errors that can be shown.

use std::fs;
use std::io;
use std::path::Path;

use luthier_material::parse;
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
            for d in diagnostics {
                assert!(text.get(d.span.clone()).is_some());
                assert!(d.line >= 1 && d.column >= 1 && d.line <= text.matches('\n').count() + 1);
                assert!(!d.render(text).is_empty() && !d.render_coloured(text).is_empty());
            }
        }
    }
}

/// The shipped materials: text in which a few changes get far into the decoder.
fn shipped() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../materials");
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
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
