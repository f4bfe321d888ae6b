//! Bakes on disk: good ones, and every way in which one can be bad. No device needed.

use std::path::Path;

use luthier_gpu::{Package, PackageError};
use luthier_lut::{AtlasLayout, Mapping, TableKind, TexelFormat};
use luthier_manifest::{FileEntry, Form, Manifest, ManifestError, ShaderEntry, Target};
use luthier_texture::ktx2;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

use crate::bake_by_hand::{Table, axis, diffuse, manifest, texels};

const WGSL: &str = "fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> { return wi; }";

fn table() -> Table {
    let layout = AtlasLayout {
        x: axis("cos_theta", 1.0, 16, Mapping::Linear),
        y: None,
        apron: 0,
        columns: 1,
        tiles: 2,
        base: luthier_lut::RowBase::Zero,
    };
    Table::new(TableKind::Fresnel, layout, TexelFormat::Rgba16Float, |tile, [x, _]| [x as f32, tile as f32, 0.5, 1.0])
}

fn write(folder: &Path, path: &str, bytes: &[u8]) -> FileEntry {
    std::fs::create_dir_all(folder.join(path).parent().unwrap()).unwrap();
    std::fs::write(folder.join(path), bytes).unwrap();
    FileEntry { path: path.to_owned(), sha256: Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect() }
}

/// A bake with one table and one shader, its manifest changed before it is written.
fn bake(change: impl FnOnce(&mut Manifest)) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let table = table();
    let mut manifest = manifest(vec![vec![diffuse([0.5; 3], 0.0)]], std::slice::from_ref(&table));
    let texture = ktx2::encode(&texels(std::slice::from_ref(&table))[0].texture).unwrap();
    manifest.tables[0].texture = write(folder.path(), "tables/fresnel.ktx2", &texture);
    let shader = |target, file| ShaderEntry {
        target,
        form: Form::Baked,
        file,
        materials: None,
        interface: None,
        checks: Vec::new(),
    };
    let missing = FileEntry { path: "shaders/none.glsl".to_owned(), sha256: String::new() };
    manifest.shaders = vec![
        shader(Target::Glsl450, missing),
        shader(Target::Wgsl, write(folder.path(), "shaders/baked.wgsl", WGSL.as_bytes())),
    ];
    change(&mut manifest);
    std::fs::write(folder.path().join("manifest.json"), manifest.to_json().unwrap()).unwrap();
    folder
}

fn refusal(change: impl FnOnce(&mut Manifest)) -> PackageError {
    Package::read(bake(change).path()).unwrap_err()
}

#[test]
fn a_bake_loads_with_what_it_needs_only() {
    let folder = bake(|_| {});
    let artefacts = Package::read(folder.path()).unwrap();
    assert_eq!(artefacts.tables, texels(&[table()]));
    assert_eq!(artefacts.wgsl(Form::Baked).unwrap(), WGSL);
    assert_eq!(artefacts.shaders.len(), 1);
    let error = artefacts.wgsl(Form::Full).unwrap_err();
    assert!(matches!(&error, PackageError::NoShader { known, .. } if known == "baked"), "{error}");
}

#[test]
fn files_that_are_not_the_manifests_are_refused() {
    for file in ["tables/fresnel.ktx2", "shaders/baked.wgsl"] {
        let folder = bake(|_| {});
        let path = folder.path().join(file);
        let mut bytes = std::fs::read(&path).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        std::fs::write(&path, bytes).unwrap();
        let error = Package::read(folder.path()).unwrap_err();
        assert!(matches!(&error, PackageError::Hash { path: named, .. } if *named == path), "{error}");

        std::fs::remove_file(&path).unwrap();
        let error = Package::read(folder.path()).unwrap_err();
        assert!(matches!(&error, PackageError::Read { path: named, .. } if *named == path), "{error}");
    }
}

#[test]
fn paths_stay_inside_the_folder() {
    for path in ["../fresnel.ktx2", "/etc/hostname", "", "tables/../../x"] {
        let error = refusal(|m| m.tables[0].texture.path = path.to_owned());
        assert!(matches!(error, PackageError::Outside { .. }), "{path}: {error}");
    }
}

#[test]
fn a_file_that_is_no_texture_is_refused() {
    let error = refusal(|m| m.tables[0].texture = m.shaders[1].file.clone());
    assert!(matches!(error, PackageError::Texture { .. }), "{error}");
}

#[test]
fn contradictions_are_refused() {
    let table = |error: PackageError| match error {
        PackageError::Manifest { source, .. } => source,
        other => panic!("{other}"),
    };
    let format = table(refusal(|m| m.tables[0].format = TexelFormat::Rgba8Unorm));
    assert!(matches!(format, ManifestError::TableMismatch { .. }), "{format}");
    let tiles = table(refusal(|m| m.tables[0].layout.tiles = 3));
    assert!(matches!(tiles, ManifestError::TableMismatch { .. }), "{tiles}");
    for nonsense in [0, u32::MAX] {
        let error = table(refusal(|m| m.tables[0].layout.columns = nonsense));
        assert!(matches!(error, ManifestError::Layout { .. }), "{nonsense}: {error}");
        let error = table(refusal(|m| m.tables[0].layout.x.size = nonsense));
        assert!(
            matches!(error, ManifestError::Layout { .. } | ManifestError::TableMismatch { .. }),
            "{nonsense}: {error}"
        );
    }
    assert!(matches!(table(refusal(|m| m.tables[0].layout.apron = u32::MAX)), ManifestError::Layout { .. }));
    assert!(matches!(refusal(|m| m.materials.clear()), PackageError::NoMaterials));
    assert!(matches!(refusal(|m| m.materials[0].layers.clear()), PackageError::NoLayers { .. }));
    assert!(matches!(refusal(|m| m.schema = 99), PackageError::Manifest { .. }));
}

#[test]
fn no_bake_at_all_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let error = Package::read(folder.path()).unwrap_err();
    assert!(matches!(&error, PackageError::NoBake { folder: named } if named == folder.path()), "{error}");
    std::fs::write(folder.path().join("manifest.json"), "{]").unwrap();
    assert!(matches!(Package::read(folder.path()), Err(PackageError::Manifest { .. })));
}

#[test]
fn texels_must_be_given_for_every_table() {
    let manifest = manifest(vec![vec![diffuse([0.5; 3], 0.0)]], &[table()]);
    let error = Package::from_parts(manifest, Vec::new(), Vec::new()).unwrap_err();
    assert!(matches!(error, PackageError::MissingTexels { kind: TableKind::Fresnel }), "{error}");
}
