use crate::features::Features;

/// Marks a line that is kept under a condition only; see [`prune`].
const MARK: &str = "//?";

/// The lines of a module whose conditions hold, without the conditions.
///
/// A line may end in `//? a, b|c, !d`: it is kept when the set has `a`, has `b` or `c`, and lacks `d`. With all its lines
/// a module is plain WGSL, but for the `$` places of the look-ups.
pub(crate) fn prune(module: &str, features: &Features) -> String {
    let mut out = String::with_capacity(module.len());
    for line in module.lines() {
        let (text, keep) = match line.split_once(MARK) {
            Some((text, condition)) => (text.trim_end(), holds(condition, features)),
            None => (line, true),
        };
        // What was left out may leave two blank lines behind.
        let is_doubled = text.is_empty() && (out.is_empty() || out.ends_with("\n\n"));
        if keep && !is_doubled {
            out.push_str(text);
            out.push('\n');
        }
    }
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

/// Every word that the conditions of a module name.
#[cfg(test)]
pub(crate) fn words(module: &str) -> impl Iterator<Item = &str> {
    module
        .lines()
        .filter_map(|line| line.split_once(MARK))
        .flat_map(|(_, condition)| condition.split([',', '|']))
        .map(|word| word.trim().trim_start_matches('!'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Form, MaterialSet};

    #[test]
    fn conditions_are_ands_of_ors() {
        let none = Features::of(&MaterialSet { materials: &[], tables: Vec::new() }, Form::Baked);
        let both = none.with("a", true).with("b", true);
        let module = "all\na //? a\nboth //? a, b\nneither //? !a, !b\neither //? c|b\n";
        assert_eq!(prune(module, &none), "all\nneither\n");
        assert_eq!(prune(module, &none.with("b", true)), "all\neither\n");
        assert_eq!(prune(module, &both), "all\na\nboth\neither\n");
    }
}
