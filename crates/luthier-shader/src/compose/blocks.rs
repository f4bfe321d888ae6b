//! Modules of WGSL: the blocks that a set keeps of one.

use crate::compose::features::Features;

/// Starts a line that opens, turns or closes a block; see [`prune`].
const MARK: &str = "//?";

/// The lines of a module whose conditions hold, without the marks.
///
/// A line `//? a, b|c, !d` opens a block. Its lines are kept when the set has `a`, has `b` or `c`, and lacks `d`; those after `//? else`
/// are kept when it does not. `//? end` closes the block. Blocks nest.
///
/// # Panics
/// On marks that do not pair, or that follow code on their line.
pub(crate) fn prune(module: &str, features: &Features) -> String {
    let mut out = String::with_capacity(module.len());
    // Of every open block: its opening line, whether its condition holds, whether `else` has turned it.
    let mut open: Vec<(usize, bool, bool)> = Vec::new();
    for (number, line) in (1..).zip(module.lines()) {
        let Some((before, mark)) = line.split_once(MARK) else {
            // What was left out may leave two blank lines behind.
            let is_doubled = line.is_empty() && (out.is_empty() || out.ends_with("\n\n"));
            if !is_doubled && open.iter().all(|&(_, holds, is_turned)| holds != is_turned) {
                out.push_str(line);
                out.push('\n');
            }
            continue;
        };
        assert!(before.trim().is_empty(), "line {number}: a mark stands on a line of its own: {line}");
        match (mark.trim(), open.last_mut()) {
            ("end", Some(_)) => drop(open.pop()),
            ("else", Some((_, _, is_turned @ false))) => *is_turned = true,
            ("end" | "else", _) => panic!("line {number}: `{}` has no block", line.trim()),
            (condition, _) => open.push((number, holds(condition, features), false)),
        }
    }
    assert!(open.is_empty(), "line {}: a block without `{MARK} end`", open.last().map_or(0, |block| block.0));
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

fn holds(condition: &str, features: &Features) -> bool {
    condition.split(',').all(|alternatives| {
        alternatives.split('|').any(|word| match word.trim().strip_prefix('!') {
            Some(word) => !features.has(word),
            None => features.has(word.trim()),
        })
    })
}

/// Every module, with its file.
#[cfg(test)]
pub(crate) fn modules() -> Vec<(std::path::PathBuf, String)> {
    let mut folders = vec![std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/wgsl")];
    let mut modules = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match std::fs::read_to_string(&path) {
                Ok(text) => modules.push((path, text)),
                Err(_) => folders.push(path),
            }
        }
    }
    modules
}

/// Every word that the conditions of a module name.
#[cfg(test)]
pub(crate) fn features_named(module: &str) -> impl Iterator<Item = &str> {
    module
        .lines()
        .filter_map(|line| line.split_once(MARK))
        .flat_map(|(_, condition)| condition.split([',', '|']))
        .map(|word| word.trim().trim_start_matches('!'))
        .filter(|word| !matches!(*word, "else" | "end"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Form, MaterialSet};

    fn none() -> Features {
        Features::of(&MaterialSet::new(&[], Vec::new()), Form::Baked)
    }

    #[test]
    fn conditions_are_ands_of_ors() {
        let block = |condition: &str| format!("//? {condition}\n{condition}\n//? end\n");
        let module = "all\n".to_owned() + &["a", "a, b", "!a, !b", "c|b"].map(block).concat();
        assert_eq!(prune(&module, &none()), "all\n!a, !b\n");
        assert_eq!(prune(&module, &none().with("b", true)), "all\nc|b\n");
        assert_eq!(prune(&module, &none().with("a", true).with("b", true)), "all\na\na, b\nc|b\n");
    }

    #[test]
    fn blocks_nest_and_turn() {
        let module =
            "//? a\na\n  //? b\n  both\n  //? else\n  only a\n  //? end\nagain\n//? else\nno a\n//? end\nall\n";
        let a = none().with("a", true);
        assert_eq!(prune(module, &a.with("b", true)), "a\n  both\nagain\nall\n");
        assert_eq!(prune(module, &a), "a\n  only a\nagain\nall\n");
        assert_eq!(prune(module, &none().with("b", true)), "no a\nall\n");
    }

    #[test]
    fn marks_that_do_not_pair_are_refused_with_their_line() {
        for (module, expected) in [
            ("x\n//? a\n//? b\nx\n//? end\n", "line 2: a block without `//? end`"),
            ("x\n//? end\n", "line 2: `//? end` has no block"),
            ("//? else\n//? end\n", "line 1: `//? else` has no block"),
            ("//? a\n//? else\n//? else\n//? end\n", "line 3: `//? else` has no block"),
            ("x //? a\n", "line 1: a mark stands on a line of its own: x //? a"),
        ] {
            let refusal = std::panic::catch_unwind(|| prune(module, &none())).unwrap_err();
            assert_eq!(refusal.downcast_ref::<String>().unwrap(), expected);
        }
    }
}
