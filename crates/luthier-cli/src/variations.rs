//! One material file with other numbers at two of its keys: the grid of `gallery --grid`.

use std::path::Path;
use std::str::FromStr;

use luthier::Source;
use luthier_terminal::{Failure, Outcome};
use toml_edit::{DocumentMut, Formatted, Item, TableLike, Value};

/// A key of a material file, and the numbers that it takes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Range {
    key: String,
    from: f64,
    to: f64,
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').and_then(|(key, range)| Some((key, range.split_once("..")?)));
        match parts.map(|(key, (from, to))| (key, [from, to].map(str::parse::<f64>))) {
            Some((key, [Ok(from), Ok(to)]))
                if from.is_finite() && to.is_finite() && !key.split('.').any(str::is_empty) =>
            {
                Ok(Self { key: key.to_owned(), from, to })
            }
            _ => Err(format!("`{text}` is no KEY=FROM..TO, for instance roughness=0.1..1")),
        }
    }
}

impl Range {
    /// The number at one of `steps` equal steps. It is rounded to ten digits, so that 0.3 is not written as 0.30000000000000004.
    fn at(&self, step: u32, steps: u32) -> f64 {
        let t = f64::from(step) / f64::from(steps - 1);
        let number = self.from * (1.0 - t) + self.to * t;
        format!("{number:.9e}").parse().unwrap_or(number)
    }
}

/// Variations of a file, row by row from the top left, each with its two numbers. The first key grows along the rows, the second down the columns. If
/// a variation is no material, it is the only one that is returned.
///
/// # Errors
/// The file cannot be read, or has no place for a key.
pub(crate) fn variations(file: &Path, ranges: [&Range; 2], steps: u32) -> Outcome<Vec<(String, Source)>> {
    let original = Source::read(file)?;
    let Ok(parsed) = &original.parsed else { return Ok(vec![(String::new(), original)]) };
    let document: DocumentMut = original.text.parse().map_err(|error| Failure::Input(anyhow::anyhow!("{error}")))?;
    let mut variations = Vec::new();
    for (row, column) in (0..steps).flat_map(|row| (0..steps).map(move |column| (row, column))) {
        let numbers = [ranges[0].at(column, steps), ranges[1].at(row, steps)];
        let mut document = document.clone();
        document["name"] = toml_edit::value(format!("{}-{row}-{column}", parsed.material.name));
        for (range, number) in ranges.into_iter().zip(numbers) {
            set(&mut document, &range.key, number)
                .map_err(|why| Failure::Input(anyhow::anyhow!("{}: {why}", original.label)))?;
        }
        let source = Source::of_text(file, document.to_string());
        let title = numbers.map(rounded).join(" ");
        if source.parsed.is_err() {
            return Ok(vec![(title, source)]);
        }
        variations.push((title, source));
    }
    Ok(variations)
}

/// A number with three significant digits.
fn rounded(number: f64) -> String {
    let short: f64 = format!("{number:.2e}").parse().unwrap_or(number);
    short.to_string()
}

/// Writes a number at a key. A key with dots leads from the top of the file, and counts elements of arrays from 0. A key without dots belongs to the
/// topmost layer that has it, or else is new in the first layer.
fn set(document: &mut DocumentMut, key: &str, number: f64) -> Result<(), String> {
    let path: Vec<String> = if key.contains('.') {
        key.split('.').map(str::to_owned).collect()
    } else {
        let layers = (0..).map_while(|number| document.get("layer")?.get(number));
        let layer = layers.into_iter().position(|layer| layer.get(key).is_some()).unwrap_or(0);
        vec!["layer".to_owned(), layer.to_string(), key.to_owned()]
    };
    let (last, above) = path.split_last().ok_or("an empty key")?;
    let mut here = Place::Table(document.as_table_mut());
    for segment in above {
        here = here.step(segment).ok_or_else(|| format!("nothing is at `{segment}` of `{key}`"))?;
    }
    here.write(last, number).ok_or_else(|| format!("no number can be at `{key}`"))
}

/// Table or list on the way to a key.
enum Place<'a> {
    Table(&'a mut dyn TableLike),
    Tables(&'a mut toml_edit::ArrayOfTables),
    Array(&'a mut toml_edit::Array),
}

impl<'a> Place<'a> {
    fn step(self, segment: &str) -> Option<Self> {
        match self {
            Self::Table(table) => match table.get_mut(segment)? {
                Item::ArrayOfTables(tables) => Some(Self::Tables(tables)),
                Item::Table(table) => Some(Self::Table(table)),
                Item::Value(value) => Self::of(value),
                Item::None => None,
            },
            Self::Tables(tables) => Some(Self::Table(tables.get_mut(segment.parse().ok()?)?)),
            Self::Array(array) => Self::of(array.get_mut(segment.parse().ok()?)?),
        }
    }

    fn of(value: &'a mut Value) -> Option<Self> {
        match value {
            Value::InlineTable(table) => Some(Self::Table(table)),
            Value::Array(array) => Some(Self::Array(array)),
            _ => None,
        }
    }

    /// Writes the number. Where a whole number was, a whole number stays one.
    fn write(self, last: &str, number: f64) -> Option<()> {
        match self {
            Self::Table(table) => {
                let value = match table.get(last) {
                    None | Some(Item::None) => Value::Float(Formatted::new(number)),
                    Some(item) => like(item.as_value()?, number),
                };
                table.insert(last, Item::Value(value));
            }
            Self::Tables(_) => return None,
            Self::Array(array) => {
                let old = array.get_mut(last.parse().ok()?)?;
                *old = like(old, number);
            }
        }
        Some(())
    }
}

/// A number as a value: a whole number where a whole number was.
fn like(old: &Value, number: f64) -> Value {
    match old {
        Value::Integer(_) if number.fract() == 0.0 => Value::Integer(Formatted::new(number as i64)),
        _ => Value::Float(Formatted::new(number)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "[[layer]]\ntype = \"dielectric\" # a coat\nior = 1.5\nfilms = [{ thickness_nm = 300 }]\n\
                        [[layer]]\ntype = \"diffuse\"\nalbedo = [0.1, 0.2, 0.3]\nroughness = 0.5\n";

    fn with(key: &str, number: f64) -> Result<String, String> {
        let mut document: DocumentMut = FILE.parse().unwrap();
        set(&mut document, key, number).map(|()| document.to_string())
    }

    #[test]
    fn names_have_three_digits() {
        let names = [10.666666667, 0.36666, 30.0, 0.0, 1234.5, -0.00012345].map(rounded);
        assert_eq!(names, ["10.7", "0.367", "30", "0", "1230", "-0.000123"]);
    }

    #[test]
    fn ranges_are_read() {
        let range: Range = "layer.0.alpha=0.1..1".parse().unwrap();
        assert_eq!(range, Range { key: "layer.0.alpha".to_owned(), from: 0.1, to: 1.0 });
        assert_eq!([0, 1, 2, 3].map(|step| range.at(step, 4)), [0.1, 0.4, 0.7, 1.0]);
        for wrong in ["alpha", "alpha=1", "alpha=1..", "=0..1", "alpha=0..nan", "a..b=0..1"] {
            let range: Result<Range, String> = wrong.parse();
            assert!(range.is_err(), "{wrong}");
        }
    }

    #[test]
    fn only_the_number_changes() {
        assert_eq!(with("ior", 1.6).unwrap(), FILE.replace("1.5", "1.6"));
        assert_eq!(with("roughness", 0.25).unwrap(), FILE.replace("0.5\n", "0.25\n"));
        assert_eq!(with("layer.1.albedo.2", 0.9).unwrap(), FILE.replace("0.3]", "0.9]"));
        assert!(with("layer.0.films.0.thickness_nm", 400.0).unwrap().contains("thickness_nm = 400 "));
        assert!(with("layer.0.films.0.thickness_nm", 400.5).unwrap().contains("thickness_nm = 400.5 "));
        assert!(with("alpha", 0.5).unwrap().contains("films = [{ thickness_nm = 300 }]\nalpha = 0.5\n"));
    }

    #[test]
    fn layers_may_be_an_array() {
        let mut document: DocumentMut = "layer = [{ ior = 1.5 }, { roughness = 0.5 }]\n".parse().unwrap();
        set(&mut document, "roughness", 0.25).unwrap();
        assert!(document.to_string().contains("{ ior = 1.5 }, { roughness = 0.25 }"), "{document}");
    }

    #[test]
    fn small_numbers_stay() {
        let range: Range = "k=1e-8..3e-8".parse().unwrap();
        assert_eq!([0, 1, 2].map(|step| range.at(step, 3)), [1e-8, 2e-8, 3e-8]);
    }

    #[test]
    fn a_key_that_leads_nowhere() {
        for key in ["layer.2.ior", "layer.x.ior", "bake.fgd.size", "layer.1.albedo.3", "layer.0", "layer.0.ior.0"] {
            assert!(with(key, 1.0).is_err(), "{key}");
        }
    }
}
