use luthier_material::Diagnostic;
use serde_json::{Value, json};

use crate::cli::CheckOptions;
use crate::domain;
use crate::failure::{Failure, Outcome};
use crate::materials::{Source, read};
use crate::output::print;

/// Validates files; diagnostics go to standard error, one line per file to standard output.
pub(crate) fn run(options: &CheckOptions) -> Outcome {
    let mut sources = read(&options.sources.paths)?;
    domain::check(&mut sources, None);
    if options.json {
        print(&format!("{:#}", Value::from_iter(sources.iter().map(entry))))?;
    } else {
        let mut lines = String::new();
        for source in &sources {
            source.print_diagnostics();
            lines.push_str(&line(source));
        }
        print(&lines)?;
    }
    if sources.iter().any(|s| s.parsed.is_err()) { Err(Failure::Verdict) } else { Ok(()) }
}

fn line(source: &Source) -> String {
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    match &source.parsed {
        Err(errors) => format!("{}: {}\n", source.label, count(errors.len(), "error")),
        Ok(parsed) => {
            let class = parsed.material.class;
            let warnings = match parsed.warnings.len() {
                0 => String::new(),
                n => format!(", {}", count(n, "warning")),
            };
            format!("{}: ok, class {} ({}){warnings}\n", source.label, class.letter(), class.name())
        }
    }
}

fn entry(source: &Source) -> Value {
    let material = source.parsed.as_ref().ok().map(|parsed| {
        let m = &parsed.material;
        json!({"name": m.name, "class": m.class.letter().to_string(), "class_name": m.class.name()})
    });
    let diagnostics: Vec<Value> = source.diagnostics().iter().map(diagnostic).collect();
    json!({"file": source.label, "material": material, "diagnostics": diagnostics})
}

fn diagnostic(d: &Diagnostic) -> Value {
    json!({
        "severity": d.severity.name(),
        "line": d.line,
        "column": d.column,
        "span": [d.span.start, d.span.end],
        "message": d.message,
        "hint": d.hint,
    })
}
