//! Conditions in modules of WGSL: a set keeps the blocks whose conditions hold.

use crate::compose::feature::Feature;
use crate::compose::features::Features;

/// Starts a line with a condition; see [`prune`].
const MARK: &str = "//?";

/// The lines of a module whose conditions hold, without the marks.
///
/// A mark `//? a, b|c, !d, ~e` keeps what follows if the set has `a`, has `b` or `c`, and lacks `d`, and if `e` holds for some of its materials and not for
/// others; `!~e` keeps it elsewhere. It governs a declaration, a member, a statement,
/// or a block whose braces stand on lines of their own; these braces are removed. A mark `//? else` behind it governs what follows if the
/// condition fails. Marks may be nested.
///
/// # Panics
/// On marks that follow code on their line, or that nothing follows.
pub(crate) fn prune(module: &str, features: &Features) -> String {
    let lines: Vec<&str> = module.lines().collect();
    let mut module = Module { lines: &lines, at: 0, features, out: String::with_capacity(module.len()) };
    while module.at < lines.len() {
        module.step(true, 0);
    }
    let Module { mut out, .. } = module;
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

/// A module, read line by line.
struct Module<'m> {
    lines: &'m [&'m str],
    /// The line that comes next.
    at: usize,
    features: &'m Features,
    out: String,
}

impl<'m> Module<'m> {
    fn next(&mut self) -> &'m str {
        let line = self.lines.get(self.at).unwrap_or_else(|| panic!("line {}: nothing follows a mark", self.at));
        self.at += 1;
        line
    }

    /// The text of the mark that comes next.
    fn mark(&self) -> Option<&'m str> {
        let (before, mark) = self.lines.get(self.at)?.split_once(MARK)?;
        assert!(before.trim().is_empty(), "line {}: a mark stands on a line of its own", self.at + 1);
        Some(mark.trim())
    }

    /// Reads a line, or a mark with the lines that it governs.
    fn step(&mut self, is_kept: bool, depth: usize) {
        let Some(condition) = self.mark() else {
            let line = self.next();
            return self.push(line, is_kept, depth);
        };
        assert!(condition != "else", "line {}: `else` follows nothing", self.at + 1);
        self.at += 1;
        let holds = holds(condition, self.features);
        self.governed(is_kept && holds, depth);
        if self.mark() == Some("else") {
            self.at += 1;
            self.governed(is_kept && !holds, depth);
        }
    }

    /// Reads one declaration, member, statement or block, with the comments above it.
    fn governed(&mut self, is_kept: bool, depth: usize) {
        while self.mark().is_none() && self.lines.get(self.at).is_some_and(|line| line.trim().starts_with("//")) {
            let line = self.next();
            self.push(line, is_kept, depth);
        }
        if self.mark().is_some() {
            return self.step(is_kept, depth);
        }
        if self.lines.get(self.at).is_some_and(|line| line.trim() == "{") {
            let open = self.next();
            let close = open.replace('{', "}");
            while self.lines.get(self.at) != Some(&close.as_str()) {
                self.step(is_kept, depth + 1);
            }
            self.at += 1;
            return;
        }
        let mut nesting = 0;
        loop {
            if self.mark().is_some() {
                self.step(is_kept, depth);
                continue;
            }
            let line = self.next();
            self.push(line, is_kept, depth);
            let code = line.split("//").next().unwrap_or_default().trim();
            nesting += code.matches(['{', '(']).count() as isize - code.matches(['}', ')']).count() as isize;
            if nesting == 0 && (code.ends_with([';', ',', '}']) || code.starts_with('$')) {
                return;
            }
        }
    }

    /// Writes a line that lies in this many blocks, less their indentation.
    fn push(&mut self, line: &str, is_kept: bool, depth: usize) {
        // Left-out lines may leave two blank lines behind.
        let is_doubled = line.is_empty() && (self.out.is_empty() || self.out.ends_with("\n\n"));
        if is_kept && !is_doubled {
            self.out.push_str(line.get(4 * depth..).unwrap_or_default());
            self.out.push('\n');
        }
    }
}

fn holds(condition: &str, features: &Features) -> bool {
    condition.split(',').all(|alternatives| {
        alternatives.split('|').any(|word| match word.trim() {
            word if word.starts_with("!~") => !features.are_mixed_in(named(&word[2..])),
            word if word.starts_with('!') => !features.has(named(&word[1..])),
            word if word.starts_with('~') => features.are_mixed_in(named(&word[1..])),
            word => features.has(named(word)),
        })
    })
}

/// The feature of a word.
fn named(word: &str) -> Feature {
    Feature::from_name(word).unwrap_or_else(|| panic!("`{word}` is no feature"))
}

/// Every module, with its file.
#[cfg(test)]
pub(crate) fn modules() -> Vec<(std::path::PathBuf, String)> {
    let crates = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut folders = vec![crates.join("luthier-shader/src/wgsl"), crates.join("luthier-layers/src/models")];
    let mut modules = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.extension() {
                Some(ending) if ending == "wgsl" => {
                    let text = std::fs::read_to_string(&path).unwrap();
                    modules.push((path, text));
                }
                Some(_) => {}
                None => folders.push(path),
            }
        }
    }
    modules
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
        let block = |condition: &str| format!("//? {condition}\n// {condition}\nx;\n");
        let module = "all\n".to_owned() + &["bent", "bent, below", "!bent, !below", "film|below"].map(block).concat();
        assert_eq!(prune(&module, &none()), "all\n// !bent, !below\nx;\n");
        let below = none().with(Feature::Below, true);
        assert_eq!(prune(&module, &below), "all\n// film|below\nx;\n");
        let both = below.with(Feature::Bent, true);
        assert_eq!(prune(&module, &both), "all\n// bent\nx;\n// bent, below\nx;\n// film|below\nx;\n");
        // No material has it: it holds for the set, and not for all.
        assert_eq!(prune("//? ~bent\nx;\n//? ~below\ny;\n", &none().with(Feature::Bent, true)), "x;\n");
    }

    #[test]
    fn a_mark_governs_one_thing() {
        let module = "//? bent\nfn f(\n    a: u32,\n) {\n    //? below\n    {\n        both;\n        again;\n    }\n    //? else\n    \
                      if only {\n        bent;\n    }\n}\n//? else\n//? below\n$below\nall\n";
        let bent = none().with(Feature::Bent, true);
        let both = bent.with(Feature::Below, true);
        assert_eq!(prune(module, &both), "fn f(\n    a: u32,\n) {\n    both;\n    again;\n}\nall\n");
        assert_eq!(prune(module, &bent), "fn f(\n    a: u32,\n) {\n    if only {\n        bent;\n    }\n}\nall\n");
        assert_eq!(prune(module, &none().with(Feature::Below, true)), "$below\nall\n");
        assert_eq!(prune(module, &none()), "all\n");
    }

    #[test]
    fn marks_that_govern_nothing_are_refused_with_their_line() {
        for (module, expected) in [
            ("x;\n//? bent\n", "line 2: nothing follows a mark"),
            ("x;\n//? else\nx;\n", "line 2: `else` follows nothing"),
            ("x; //? bent\n", "line 1: a mark stands on a line of its own"),
            ("//? blent\nx;\n", "`blent` is no feature"),
        ] {
            let refusal = std::panic::catch_unwind(|| prune(module, &none())).unwrap_err();
            assert_eq!(refusal.downcast_ref::<String>().unwrap(), expected);
        }
    }
}
