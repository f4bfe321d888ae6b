//! JSON in the layout of `report.json`: objects indented, arrays in a line. It has a tenth of the lines and half the bytes of the usual layout.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::Formatter;

use crate::error::ReportError;

/// The JSON of a value, with a final newline.
///
/// # Errors
/// [`ReportError::Json`], should the writer fail.
pub(crate) fn to_string(value: &impl Serialize) -> Result<String, ReportError> {
    let mut bytes = Vec::with_capacity(1 << 20);
    value.serialize(&mut Serializer::with_formatter(&mut bytes, Layout::default()))?;
    bytes.push(b'\n');
    // The serialiser writes only UTF-8, so nothing is lost.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[derive(Default)]
struct Layout {
    depth: usize,
    /// Whether the current object has a member already.
    has_members: bool,
}

impl Layout {
    fn new_line(&self, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
        write!(writer, "\n{:width$}", "", width = 2 * self.depth)
    }
}

impl Formatter for Layout {
    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { writer.write_all(b", ") }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        self.has_members = false;
        writer.write_all(b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth -= 1;
        if self.has_members {
            self.new_line(writer)?;
        }
        writer.write_all(b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        self.new_line(writer)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        self.has_members = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    #[test]
    fn objects_are_indented_and_arrays_are_not() {
        let value = json!({"a": [1, [2.5, null], {"b": {}}], "c": [], "d": {"e": "\"\n"}});
        let text = super::to_string(&value).unwrap();
        let expected = r#"{
  "a": [1, [2.5, null], {
    "b": {}
  }],
  "c": [],
  "d": {
    "e": "\"\n"
  }
}
"#;
        assert_eq!(text, expected);
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
    }
}
