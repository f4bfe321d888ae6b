//! Containers of tables of energy.

use std::fmt::Write;

use luthier_lut::Image;

use crate::Stored;

/// File format of a renderer's table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EnergyContainer {
    /// A C array of floats with six digits, as Cycles' `shader.tables` has them: one line per row, an empty line between slices.
    CArray,
    /// 16-bit words in decimal, separated by commas on one line, to be included between the braces of an array.
    Words,
    /// Bare texels, little-endian.
    Raw,
}

impl EnergyContainer {
    /// Name of the file of a table.
    pub fn file_name(self, table: &str) -> String {
        match self {
            Self::CArray => format!("{table}.tables"),
            Self::Words => format!("openpbr_{table}_data.h"),
            Self::Raw => format!("{table}.bin"),
        }
    }

    /// The file of a table of one channel, whose parts lie one after the other in memory; `rows` is the number of rows in a slice.
    pub fn write(self, table: &str, parts: &[Image], rows: u32, stored: Stored) -> Vec<u8> {
        match self {
            Self::CArray => c_array(table, parts, rows).into_bytes(),
            Self::Words => {
                let words: Vec<String> = words(parts).map(|word| word.to_string()).collect();
                format!("// clang-format off\n{}\n    // clang-format on\n", words.join(", ")).into_bytes()
            }
            Self::Raw if stored == Stored::Float => {
                parts.iter().flat_map(|part| &part.data).flat_map(|v| v.to_le_bytes()).collect()
            }
            Self::Raw => words(parts).flat_map(u16::to_le_bytes).collect(),
        }
    }
}

/// Texels as words of 16 bits.
fn words(parts: &[Image]) -> impl Iterator<Item = u16> {
    parts.iter().flat_map(|part| &part.data).map(|v| (v * 65535.0).round() as u16)
}

fn c_array(table: &str, parts: &[Image], rows: u32) -> String {
    let count: usize = parts.iter().map(|part| part.data.len()).sum();
    let lines: Vec<&[f32]> = parts.iter().flat_map(|part| part.data.chunks_exact(part.width as usize)).collect();
    let mut out = format!("static const float table_{table}[{count}] = {{\n");
    for (i, line) in lines.iter().enumerate() {
        let numbers: Vec<String> = line.iter().map(|value| format!("{value:.6}f")).collect();
        let is_last = i + 1 == lines.len();
        let ends_slice = rows > 1 && (i + 1) % rows as usize == 0;
        let (comma, gap) = if is_last { ("", "") } else { (",", if ends_slice { "\n" } else { "" }) };
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {}{comma}{gap}", numbers.join(", "));
    }
    out.push_str("};\n");
    out
}

#[cfg(test)]
mod tests {
    use std::slice;

    use super::*;

    #[test]
    fn arrays_read_as_in_cycles() {
        let part =
            Image { width: 2, height: 4, channels: 1, data: vec![1.0, 0.980_405, 0.0, 0.25, 0.5, 0.75, 0.125, 1.0] };
        let text = String::from_utf8(EnergyContainer::CArray.write("ggx_E", slice::from_ref(&part), 2, Stored::Float))
            .unwrap();
        let expected = "static const float table_ggx_E[8] = {\n  1.000000f, 0.980405f,\n  0.000000f, 0.250000f,\n\n  0.500000f, 0.750000f,\n  0.125000f, 1.000000f\n};\n";
        assert_eq!(text, expected);
        let words = EnergyContainer::Words.write("ideal", &[part.clone(), part.clone()], 2, Stored::Unorm16);
        let words = String::from_utf8(words).unwrap();
        assert!(words.starts_with("// clang-format off\n65535, 64251, 0, 16384, ") && words.matches(',').count() == 15);
        assert_eq!(EnergyContainer::Raw.write("ideal", slice::from_ref(&part), 2, Stored::Unorm16).len(), 16);
        assert_eq!(EnergyContainer::Raw.write("ideal", &[part], 2, Stored::Float).len(), 32);
    }
}
