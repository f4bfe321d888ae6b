//! A TOML file, read once.

use std::path::{Path, PathBuf};
use std::string::FromUtf8Error;

use luthier_export::{input, label};
use luthier_material::{Diagnostic, FileKind, Severity};

use crate::Error;

/// A TOML file that was read, before it is parsed.
///
/// ```
/// use luthier::TomlFile;
/// use luthier_material::FileKind;
///
/// let file = TomlFile { path: "shelf.toml".into(), bytes: b"scene = 1".to_vec() };
/// assert_eq!(file.kind(), FileKind::Scene);
/// ```
#[derive(Debug, Clone)]
pub struct TomlFile {
    /// The file.
    pub path: PathBuf,
    /// Its bytes, which are UTF-8 where it is a text.
    pub bytes: Vec<u8>,
}

impl TomlFile {
    /// Reads a file.
    ///
    /// ```
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    /// # let folder = tempfile::tempdir()?;
    /// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
    /// let file = luthier::TomlFile::read(&folder.path().join("chalk.toml"))?;
    /// assert_eq!(file.bytes, chalk.as_bytes());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = input::bytes(path).map_err(|source| Error::file("read", path, source))?;
        Ok(Self { path: path.to_owned(), bytes })
    }

    /// The name of the file in messages and manifests.
    pub(crate) fn label(&self) -> String {
        label(&self.path)
    }

    /// The kind of its text, by its keys.
    pub fn kind(&self) -> FileKind {
        FileKind::of(&String::from_utf8_lossy(&self.bytes))
    }

    /// The text. Where bytes are not UTF-8, the error has the text with replacement characters, and a diagnostic at the first.
    pub(crate) fn text(self) -> Result<String, (String, Diagnostic)> {
        let label = self.label();
        // The reader of TOML names this format.
        if self.bytes.starts_with(b"glTF") {
            return Ok(String::from_utf8_lossy(&self.bytes).into_owned());
        }
        String::from_utf8(self.bytes).map_err(|source| not_utf8(label, &source))
    }
}

fn not_utf8(label: String, source: &FromUtf8Error) -> (String, Diagnostic) {
    let start = source.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(source.as_bytes()).into_owned();
    let before = &text[..start];
    let diagnostic = Diagnostic {
        severity: Severity::Error,
        label,
        line: before.matches('\n').count() + 1,
        column: before.chars().rev().take_while(|&c| c != '\n').count() + 1,
        span: start..start + char::REPLACEMENT_CHARACTER.len_utf8(),
        message: "the file is not UTF-8".to_owned(),
        hint: Some("save it as UTF-8".to_owned()),
        count: 1,
    };
    (text, diagnostic)
}
