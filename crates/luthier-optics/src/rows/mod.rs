//! Rows of tables of numbers, as spreadsheets and instruments write them: CSV with commas, semicolons or tabs, or columns apart by spaces.
//!
//! Lines end in LF, CR LF or CR. A byte order mark, blank lines, empty cells at the end of a row and lines that begin with `#` do not count.
//! Cells may be quoted; a quoted cell ends with its line. Beside semicolons and tabs a comma in a number is a decimal comma.

use csv_core::{ReadRecordResult, Reader, ReaderBuilder};
use thiserror::Error;

/// Cells of the longest row that is read: more than the bins of any matrix in a text of bounded size.
pub const CELLS_MAX: usize = 8192;

/// A row: its line in the text, from 1, and its cells without the white space around them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Line of the text, from 1.
    pub line: usize,
    /// The cells.
    pub cells: Vec<String>,
    /// Whether a comma in a number is a decimal comma.
    pub has_decimal_commas: bool,
}

/// A row has more cells than are read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("more than {CELLS_MAX} cells in a row")]
pub struct TooManyCells {
    /// Line of the text, from 1.
    pub line: usize,
}

impl Row {
    /// The finite number of a cell; `None` for any other text, and for a missing cell.
    pub fn number(&self, cell: usize) -> Option<f64> {
        let text = self.cells.get(cell)?;
        let value = match self.has_decimal_commas && !text.contains('.') {
            true => text.replacen(',', ".", 1).parse::<f64>(),
            false => text.parse(),
        };
        value.ok().filter(|value| value.is_finite())
    }
}

/// Sign between cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Separator {
    Byte(u8),
    Space,
}

impl Separator {
    /// The separator of a row: people who separate by semicolons or tabs may have commas in numbers and in names.
    fn of(row: &str) -> Self {
        let found = [b';', b'\t', b','].into_iter().find(|byte| row.as_bytes().contains(byte));
        found.map_or(Self::Space, Self::Byte)
    }
}

/// The rows of a text. The first row that counts decides the separator of cells.
///
/// ```
/// let rows: Result<Vec<_>, _> = luthier_optics::rows::rows("\u{feff}nm;n\r\n# d line\r\n587,6;1,5168\r\n").collect();
/// let rows = rows.unwrap();
/// assert_eq!((rows[0].cells[1].as_str(), rows[1].line, rows[1].number(1)), ("n", 3, Some(1.5168)));
/// ```
pub fn rows(text: &str) -> impl Iterator<Item = Result<Row, TooManyCells>> {
    let mut splitter: Option<Splitter> = None;
    lines(text).enumerate().filter_map(move |(index, line)| {
        let trimmed = line.trim();
        if trimmed.is_empty() || trimmed.starts_with('#') {
            return None;
        }
        if let Some(separator) = trimmed.strip_prefix("sep=").filter(|_| splitter.is_none()) {
            splitter = separator.bytes().next().map(|byte| Splitter::new(Separator::Byte(byte)));
            return None;
        }
        let splitter = splitter.get_or_insert_with(|| Splitter::new(Separator::of(line)));
        let row = splitter.row(index + 1, line);
        row.map(|row| Some(row).filter(|row| !row.cells.is_empty())).transpose()
    })
}

/// Lines without their ends, whichever these are.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

struct Splitter {
    separator: Separator,
    reader: Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
}

impl Splitter {
    fn new(separator: Separator) -> Self {
        let byte = if let Separator::Byte(byte) = separator { byte } else { b',' };
        let reader = ReaderBuilder::new().delimiter(byte).build();
        Self { separator, reader, text: Vec::new(), ends: vec![0; CELLS_MAX] }
    }

    fn row(&mut self, line: usize, text: &str) -> Result<Row, TooManyCells> {
        let mut cells = match self.separator {
            Separator::Space => {
                let cells: Vec<String> = text.split_whitespace().take(CELLS_MAX + 1).map(str::to_owned).collect();
                if cells.len() > CELLS_MAX {
                    return Err(TooManyCells { line });
                }
                cells
            }
            Separator::Byte(_) => self.cells(text).ok_or(TooManyCells { line })?,
        };
        // Spreadsheets write a row as wide as the widest, and a row without a value as separators.
        let filled = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
        cells.truncate(filled);
        Ok(Row { line, cells, has_decimal_commas: self.separator != Separator::Byte(b',') })
    }

    fn cells(&mut self, line: &str) -> Option<Vec<String>> {
        self.reader.reset();
        self.text.resize(self.text.len().max(line.len() + 1), 0);
        let (mut read, mut written, mut ended) = (0, 0, 0);
        loop {
            // An empty input is the end of the text, which ends the row.
            let (result, bytes, out, ends) =
                self.reader.read_record(&line.as_bytes()[read..], &mut self.text[written..], &mut self.ends[ended..]);
            (read, written, ended) = (read + bytes, written + out, ended + ends);
            match result {
                ReadRecordResult::InputEmpty => {}
                ReadRecordResult::Record | ReadRecordResult::End => break,
                // The text of a row is no longer than the row.
                ReadRecordResult::OutputFull | ReadRecordResult::OutputEndsFull => return None,
            }
        }
        let starts = std::iter::once(0).chain(self.ends[..ended].iter().copied());
        let cells = starts.zip(&self.ends[..ended]).map(|(start, &end)| &self.text[start..end]);
        Some(cells.map(|cell| String::from_utf8_lossy(cell).trim().to_owned()).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(text: &str) -> Vec<Vec<String>> {
        rows(text).map(|row| row.unwrap().cells).collect()
    }

    #[test]
    fn ends_of_lines_and_separators_do_not_matter() {
        let expected = vec![vec!["nm", "n"], vec!["550", "1.5"], vec!["600", "1.4"]];
        for end in ["\n", "\r\n", "\r"] {
            for separator in [",", ";", "\t", " ", " , "] {
                let line = |a: &str, b: &str| format!("{a}{separator}{b}{end}");
                let text = format!(
                    "\u{feff}# by hand{end}{}{end}{}{}",
                    line("nm", "n"),
                    line("550", "1.5"),
                    line("600", "1.4")
                );
                assert_eq!(cells(&text), expected, "{text:?}");
                assert_eq!(rows(&text).map(|row| row.unwrap().line).collect::<Vec<_>>(), [2, 4, 5], "{text:?}");
            }
        }
    }

    #[test]
    fn cells_may_be_quoted_and_rows_empty() {
        assert_eq!(cells("\"wavelength, um\",\"n\"\n,\n0.5,\"1\"\"5\"\n"), [["wavelength, um", "n"], ["0.5", "1\"5"]]);
        assert_eq!(cells("sep=;\n1;2,5\n"), [["1", "2,5"]]);
        assert_eq!(cells("\"open,1\n2,3\n"), [vec!["open,1"], vec!["2", "3"]]);
    }

    #[test]
    fn commas_are_decimal_beside_other_separators_alone() {
        let number = |text: &str, cell| rows(text).next().unwrap().unwrap().number(cell);
        assert_eq!(number("1,5;2", 0), Some(1.5));
        assert_eq!(number("1.234,5;2", 0), None);
        assert_eq!(number("1,5", 0), Some(1.0));
        assert_eq!((number("1,nan", 1), number("1,inf", 1), number("1", 1)), (None, None, None));
    }

    #[test]
    fn a_row_has_an_end() {
        for separator in [",", " "] {
            let cell = format!("1{separator}");
            assert!(rows(&cell.repeat(CELLS_MAX - 1)).next().unwrap().is_ok());
            assert_eq!(rows(&cell.repeat(CELLS_MAX + 2)).next(), Some(Err(TooManyCells { line: 1 })));
        }
    }
}
