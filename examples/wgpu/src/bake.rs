//! What `luthier bake` or a build script wrote, read with a JSON, a KTX2 and a zstd crate.

use std::borrow::Cow;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

/// Files with a manifest.
pub struct Bake {
    files: Files,
    manifest: Value,
}

/// Where the files of a bake are.
enum Files {
    Folder(PathBuf),
    /// Inside the program, each with its path.
    BuiltIn(&'static [(&'static str, &'static [u8])]),
}

/// A line of `bindings[]`: what group 0 of the shader expects at a number.
pub struct Binding {
    pub number: u32,
    /// `luthier_` and, for a table, its kind.
    pub name: String,
    /// `texture_2d<f32>`, `texture_cube<f32>`, `sampler`, `buffer`, or `buffer<vec4<u32>>` for a table in a buffer.
    pub resource: String,
}

/// A texture as it is uploaded.
pub struct Texels {
    pub width: u32,
    pub height: u32,
    /// 1, or 6 of a cube.
    pub faces: u32,
    pub levels: u32,
    /// WebGPU's name: `rgba16float`.
    pub format: String,
    /// Level by level, face by face.
    pub bytes: Vec<u8>,
}

impl Bake {
    pub fn open(folder: &Path) -> Result<Self> {
        Self::of(Files::Folder(folder.to_owned())).context("bake first")
    }

    /// `FILES` of the module that luthier-build writes.
    pub fn built_in(files: &'static [(&'static str, &'static [u8])]) -> Result<Self> {
        Self::of(Files::BuiltIn(files))
    }

    fn of(files: Files) -> Result<Self> {
        let manifest: Value = serde_json::from_slice(&files.read("manifest.json")?)?;
        ensure!(manifest["schema"] == 4, "this program reads schema 4 of the manifest, not {}", manifest["schema"]);
        Ok(Self { files, manifest })
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
        Ok(String::from_utf8(self.files.read(path)?.into_owned())?)
    }

    /// The material buffer, ready to upload.
    pub fn material_buffer(&self) -> Result<Vec<u8>> {
        Ok(self.files.read(text(&self.manifest["material_buffer"]["path"])?)?.into_owned())
    }

    /// The texels of a table: one level, two dimensions.
    pub fn table(&self, kind: &str) -> Result<Texels> {
        let found = self.entries("tables")?.iter().find(|table| table["kind"] == kind);
        let entry = found.with_context(|| format!("no table `{kind}` in the bake"))?;
        texels(&self.files.read(text(&entry["texture"]["path"])?)?, text(&entry["format"])?)
    }

    fn entries(&self, field: &str) -> Result<&[Value]> {
        Ok(self.manifest[field].as_array().with_context(|| format!("no list `{field}` in the manifest"))?)
    }
}

impl Files {
    /// The bytes of a file, by its path in the manifest.
    fn read(&self, path: &str) -> Result<Cow<'static, [u8]>> {
        match self {
            Self::Folder(folder) => Ok(Cow::Owned(read(&folder.join(path))?)),
            Self::BuiltIn(files) => {
                let found = files.iter().find(|(known, _)| *known == path);
                Ok(Cow::Borrowed(found.with_context(|| format!("no file `{path}` in the program"))?.1))
            }
        }
    }
}

/// A cube of `luthier environment`: `environment` with its levels, or `irradiance`.
pub fn cube(folder: &Path, content: &str) -> Result<Texels> {
    texels(&read(&folder.join(format!("{content}-cube.ktx2")))?, "rgba16float")
}

fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| path.display().to_string())
}

/// The texels of a file, of which each level may be compressed with zstd.
fn texels(file: &[u8], format: &str) -> Result<Texels> {
    let ktx2 = ktx2::Reader::new(file)?;
    let header = ktx2.header();
    let mut bytes = Vec::new();
    for level in ktx2.levels() {
        match header.supercompression_scheme {
            None => bytes.extend_from_slice(level.data),
            Some(ktx2::SupercompressionScheme::Zstandard) => {
                ruzstd::decoding::StreamingDecoder::new(level.data)?.read_to_end(&mut bytes)?;
            }
            Some(other) => bail!("{other:?} supercompression"),
        }
    }
    Ok(Texels {
        width: header.pixel_width,
        height: header.pixel_height,
        faces: header.face_count,
        levels: header.level_count.max(1),
        format: format.to_owned(),
        bytes,
    })
}

fn text(value: &Value) -> Result<&str> {
    value.as_str().with_context(|| format!("{value} should be a string"))
}
