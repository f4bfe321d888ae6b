//! Diagnostics: a message, its place in the file, and a hint.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// The file is not a material.
    Error,
    /// The file is a material, but perhaps not the one that was meant.
    Warning,
}

impl Severity {
    /// `error` or `warning`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }
}

/// A message about a place in a material file.
///
/// ```
/// let text = "schema = 1\nname = \"gilding\"\nlayer = 3\n";
/// let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let mistakes = luthier_material::parse("gilding.toml", text, &no_files).unwrap_err();
/// assert!(mistakes[0].is_error() && mistakes[0].to_string().starts_with("gilding.toml:3:9: error: "));
/// assert!(mistakes[0].render(text).contains("layer = 3"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// Label of the file, as given to [`parse`](crate::parse).
    pub label: String,
    /// Line of the start of the span, from 1.
    pub line: usize,
    /// Column of the start of the span in characters, from 1.
    pub column: usize,
    /// Bytes of the text that it is about.
    pub span: Range<usize>,
    /// Description of the problem.
    pub message: String,
    /// Advice on the problem.
    pub hint: Option<String>,
    /// Number of diagnostics that this one stands for: 1, but for the last of a file that has too many to list.
    pub count: usize,
}

/// Number of errors, and of warnings, that are listed. A file with more of them is of another kind, and not a material with mistakes.
const LISTED: usize = 20;

/// Characters of a message or a hint: what they quote may be as long as the file.
const MESSAGE_CHARS: usize = 600;

/// One line: place, severity, message, and the hint in parentheses.
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { label, line, column, message, .. } = self;
        write!(f, "{label}:{line}:{column}: {}: {message}", self.severity.name())?;
        self.hint.as_ref().map_or(Ok(()), |hint| write!(f, " ({hint})"))
    }
}

impl Diagnostic {
    /// Whether it makes the file unusable.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// The diagnostic with the lines that it is about, as plain text. `text` is what was parsed.
    pub fn render(&self, text: &str) -> String {
        self.render_with(text, &Renderer::plain())
    }

    /// The text of [`render`](Self::render) with the ANSI escapes of a colour terminal.
    pub fn render_coloured(&self, text: &str) -> String {
        self.render_with(text, &Renderer::styled())
    }

    fn render_with(&self, text: &str, renderer: &Renderer) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        // A label that is not of this text must not bring the renderer down.
        let span = clamp_to_text(text, self.span.clone());
        let snippet = Snippet::source(text).path(&self.label).annotation(AnnotationKind::Primary.span(span));
        let mut group = level.primary_title(&self.message).element(snippet);
        if let Some(hint) = &self.hint {
            group = group.element(Level::HELP.message(hint));
        }
        renderer.render(&[group])
    }
}

/// Collects diagnostics of one text.
pub(crate) struct Sink<'t> {
    label: &'t str,
    text: &'t str,
    diagnostics: Vec<Diagnostic>,
    /// Errors and warnings so far, listed or not.
    counts: [usize; 2],
}

impl<'t> Sink<'t> {
    pub(crate) fn new(label: &'t str, text: &'t str) -> Self {
        Self { label, text, diagnostics: Vec::new(), counts: [0; 2] }
    }

    pub(crate) fn error(&mut self, span: Range<usize>, message: impl Into<String>, hint: Option<String>) {
        self.push(Severity::Error, span, message.into(), hint);
    }

    pub(crate) fn warn(&mut self, span: Range<usize>, message: impl Into<String>, hint: Option<String>) {
        self.push(Severity::Warning, span, message.into(), hint);
    }

    pub(crate) fn has_errors(&self) -> bool {
        self.counts[Severity::Error as usize] > 0
    }

    /// Whether another error is counted, but no longer listed: its words are not needed.
    pub(crate) fn is_full(&self) -> bool {
        self.counts[Severity::Error as usize] >= LISTED
    }

    /// Whether an error about a part of the span is reported already.
    pub(crate) fn has_error_in(&self, span: &Range<usize>) -> bool {
        self.diagnostics.iter().any(|d| d.is_error() && span.start <= d.span.start && d.span.end <= span.end)
    }

    /// The diagnostics in the order of the text, and how many more there are.
    pub(crate) fn into_diagnostics(mut self) -> Vec<Diagnostic> {
        let mut diagnostics = std::mem::take(&mut self.diagnostics);
        diagnostics.sort_by_key(|d| (d.span.start, d.span.end));
        let end = self.text.len();
        for severity in [Severity::Error, Severity::Warning] {
            let more = self.counts[severity as usize].saturating_sub(LISTED);
            if more > 0 {
                let (message, hint) =
                    (format!("and {more} more {}s", severity.name()), "mend those above first".to_owned());
                let last = self.diagnostic(severity, end..end, message, Some(hint));
                diagnostics.push(Diagnostic { count: more, ..last });
            }
        }
        diagnostics
    }

    /// One diagnostic of a text.
    pub(crate) fn one(
        label: &'t str,
        text: &'t str,
        severity: Severity,
        span: Range<usize>,
        message: String,
        hint: Option<String>,
    ) -> Diagnostic {
        Self::new(label, text).diagnostic(severity, span, message, hint)
    }

    fn push(&mut self, severity: Severity, span: Range<usize>, message: String, hint: Option<String>) {
        let count = &mut self.counts[severity as usize];
        *count += 1;
        if *count <= LISTED {
            let diagnostic = self.diagnostic(severity, span, message, hint);
            self.diagnostics.push(diagnostic);
        }
    }

    fn diagnostic(&self, severity: Severity, span: Range<usize>, message: String, hint: Option<String>) -> Diagnostic {
        let span = clamp_to_text(self.text, span);
        let before = &self.text[..span.start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Diagnostic {
            severity,
            label: self.label.to_owned(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            span,
            message: clipped(message),
            hint: hint.map(clipped),
            count: 1,
        }
    }
}

fn clipped(text: String) -> String {
    match text.char_indices().nth(MESSAGE_CHARS) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}

fn clamp_to_text(text: &str, span: Range<usize>) -> Range<usize> {
    let start = text.floor_char_boundary(span.start);
    start..text.ceil_char_boundary(span.end.max(start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_characters_from_one() {
        let text = "a = 1\nü = 2\n";
        let mut sink = Sink::new("x.toml", text);
        sink.error(11..12, "later", None);
        sink.warn(0..1, "first", None);
        let diagnostics = sink.into_diagnostics();
        assert_eq!((diagnostics[0].line, diagnostics[0].column), (1, 1));
        assert_eq!((diagnostics[1].line, diagnostics[1].column), (2, 5));
    }

    #[test]
    fn rendering_shows_place_line_and_hint() {
        let text = "alpha = 3\n";
        let mut sink = Sink::new("x.toml", text);
        sink.error(8..9, "`alpha` must be from 0 to 1, found 3", Some("write `alpha = 1`".to_owned()));
        let rendered = sink.into_diagnostics()[0].render(text);
        for part in ["error: `alpha` must be from 0 to 1, found 3", "x.toml:1:9", "1 | alpha = 3", "write `alpha = 1`"]
        {
            assert!(rendered.contains(part), "{rendered}");
        }
    }

    #[test]
    fn spans_outside_the_text_are_clamped() {
        let mut sink = Sink::new("x.toml", "ü");
        sink.error(1..9, "m", None);
        let d = sink.into_diagnostics().remove(0);
        assert_eq!(d.span, 0..2);
        let _ = d.render("");
    }
}
