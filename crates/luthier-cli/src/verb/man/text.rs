//! Texts behind the options of a verb, in the parts that pages set apart.

/// A part of a text.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Block<'t> {
    /// A title of few words, without its colon, such as `Examples`.
    Title(&'t str),
    /// Lines of prose that belong together, as one.
    Paragraph(String),
    /// Indented lines, kept as they are.
    Lines(Vec<&'t str>),
}

/// Longest title, in words: a longer line with a colon is a sentence.
const TITLE_WORDS: usize = 3;

/// The parts of a text whose examples and lists are indented.
pub(super) fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut is_open = false;
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let was_open = std::mem::replace(&mut is_open, !line.trim().is_empty());
        if line.trim().is_empty() {
            continue;
        }
        let indented = line.starts_with("  ");
        let title = line.strip_suffix(':').filter(|_| lines.peek().is_some_and(|next| next.starts_with("  ")));
        let title = title.filter(|title| title.split_whitespace().count() <= TITLE_WORDS);
        match (blocks.last_mut(), title) {
            (Some(Block::Lines(kept)), _) if was_open && indented => kept.push(&line[2..]),
            (_, _) if indented => blocks.push(Block::Lines(vec![&line[2..]])),
            (_, Some(title)) => blocks.push(Block::Title(title)),
            (Some(Block::Paragraph(prose)), None) if was_open => {
                prose.push(' ');
                prose.push_str(line);
            }
            (_, None) => blocks.push(Block::Paragraph(line.to_owned())),
        }
    }
    blocks
}

/// A text as a sentence, with a full stop.
pub(super) fn sentence(text: &str) -> String {
    let text = text.trim();
    if text.ends_with(['.', ':', '?', '!']) { text.to_owned() } else { format!("{text}.") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_falls_into_parts() {
        let text = "One sentence\nover two lines.\n\nExit codes:\n  0  success\n  1    none\nAs JSON:\n{\nOf these lines the last says it all:\n  luthier";
        let expected = [
            Block::Paragraph("One sentence over two lines.".to_owned()),
            Block::Title("Exit codes"),
            Block::Lines(vec!["0  success", "1    none"]),
            Block::Paragraph("As JSON: { Of these lines the last says it all:".to_owned()),
            Block::Lines(vec!["luthier"]),
        ];
        assert_eq!(blocks(text), expected);
        assert_eq!(sentence(" A file "), "A file.");
        assert_eq!(sentence("A file."), "A file.");
    }
}
