//! What `luthier bake` wrote, read with a JSON, a KTX2 and a zstd crate.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

/// A folder with a manifest.
pub struct Bake {
    folder: PathBuf,
    manifest: Value,
}

/// A line of `bindings[]`: what group 0 of the shader expects at a number.
pub struct Binding {
    pub number: u32,
    /// `luthier_` and, for a texture, the kind of its table.
    pub name: String,
    /// `texture_2d<f32>`, `sampler` or `buffer`.
    pub resource: String,
}

/// A table as it is uploaded.
pub struct Texels {
    pub width: u32,
    pub height: u32,
    /// WebGPU's name: `rgba16float`.
    pub format: String,
    pub bytes: Vec<u8>,
}

impl Bake {
    pub fn open(folder: &Path) -> Result<Self> {
        let path = folder.join("manifest.json");
        let text = fs::read_to_string(&path).with_context(|| format!("{}: bake first", path.display()))?;
        let manifest: Value = serde_json::from_str(&text)?;
        ensure!(manifest["schema"] == 3, "this program reads schema 3 of the manifest, not {}", manifest["schema"]);
        Ok(Self { folder: folder.to_owned(), manifest })
    }

    /// Number of a material in the shader: its place in `materials[]`.
    pub fn material(&self, name: &str) -> Result<u32> {
        let found = self.entries("materials")?.iter().position(|material| material["name"] == name);
        Ok(found.with_context(|| format!("no material `{name}` in the bake"))? as u32)
    }

    pub fn bindings(&self) -> Result<Vec<Binding>> {
        let binding = |entry: &Value| {
            Ok(Binding {
                number: entry["binding"].as_u64().context("a binding without a number")? as u32,
                name: text(&entry["name"])?.to_owned(),
                resource: text(&entry["resource"])?.to_owned(),
            })
        };
        self.entries("bindings")?.iter().map(binding).collect()
    }

    /// The shader that reads the tables, in WGSL.
    pub fn wgsl(&self) -> Result<String> {
        let shaders = self.entries("shaders")?;
        let found = shaders.iter().find(|shader| shader["target"] == "wgsl" && shader["form"] == "baked");
        let path = text(&found.context("no WGSL in the bake")?["file"]["path"])?;
        Ok(fs::read_to_string(self.folder.join(path))?)
    }

    /// The material buffer, ready to upload.
    pub fn material_buffer(&self) -> Result<Vec<u8>> {
        Ok(fs::read(self.folder.join(text(&self.manifest["material_buffer"]["path"])?))?)
    }

    /// The texels of a table: one level, two dimensions, zstd.
    pub fn table(&self, kind: &str) -> Result<Texels> {
        let found = self.entries("tables")?.iter().find(|table| table["kind"] == kind);
        let entry = found.with_context(|| format!("no table `{kind}` in the bake"))?;
        let file = fs::read(self.folder.join(text(&entry["texture"]["path"])?))?;
        let ktx2 = ktx2::Reader::new(file.as_slice())?;
        let header = ktx2.header();
        let level = ktx2.levels().next().context("a texture without a level")?;
        let mut bytes = Vec::new();
        match header.supercompression_scheme {
            None => bytes.extend_from_slice(level.data),
            Some(ktx2::SupercompressionScheme::Zstandard) => {
                ruzstd::decoding::StreamingDecoder::new(level.data)?.read_to_end(&mut bytes)?;
            }
            Some(other) => bail!("{other:?} supercompression"),
        }
        Ok(Texels {
            width: header.pixel_width,
            height: header.pixel_height,
            format: text(&entry["format"])?.to_owned(),
            bytes,
        })
    }

    fn entries(&self, field: &str) -> Result<&[Value]> {
        Ok(self.manifest[field].as_array().with_context(|| format!("no list `{field}` in the manifest"))?)
    }
}

fn text(value: &Value) -> Result<&str> {
    value.as_str().with_context(|| format!("{value} should be a string"))
}
