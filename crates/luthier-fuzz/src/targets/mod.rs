//! The targets: a function for each parser, which checks everything that the parser accepts.

mod images;
mod json;
mod lines;
mod meshes;
mod toml;

pub use images::with_sums;

/// A parser, its inputs and its checks.
///
/// ```
/// let target = luthier_fuzz::target("png").unwrap();
/// let inputs = luthier_fuzz::corpus(target).unwrap();
/// assert!(!inputs.is_empty());
/// inputs.iter().for_each(|input| (target.run)(&input.bytes));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Name of the target and of its folder in the corpus.
    pub name: &'static str,
    /// The parser, as a path of Rust.
    pub parser: &'static str,
    /// Inputs that reach the parser, and the commands that read them.
    pub reads: &'static str,
    /// Checks of what the parser accepts.
    pub holds: &'static str,
    /// Folders of the repository with inputs beside the corpus.
    pub folders: &'static [&'static str],
    /// Feeds bytes to the parser. It panics if a check fails.
    pub run: fn(&[u8]),
}

/// All targets.
pub const TARGETS: [Target; 22] = [
    Target {
        name: "material",
        parser: "luthier_material::parse, FileKind::of",
        reads: "material files, and the index files that they name",
        holds: "diagnostics lie in the text and can be shown; slopes, films and bases keep their ranges; reading again gives an equal material",
        folders: &["materials", "materials/papers", "materials/scenes/still-life", "tests/broken"],
        run: toml::material,
    },
    Target {
        name: "scene",
        parser: "luthier_material::parse_scene, parse_surface, FileKind::of",
        reads: "scene files and surface files",
        holds: "diagnostics lie in the text and can be shown; a scene or surface is recognised as one; angles, budgets and shares keep their ranges",
        folders: &["materials/scenes", "materials/surfaces", "tests/broken-surfaces"],
        run: toml::scene,
    },
    Target {
        name: "index",
        parser: "luthier_optics::index_file::csv",
        reads: "CSV files of optical constants",
        holds: "samples ascend, are finite and not negative; so is the index between them and beyond",
        folders: &["crates/luthier-optics/data"],
        run: lines::index,
    },
    Target {
        name: "page",
        parser: "luthier_optics::index_file::yaml",
        reads: "pages of refractiveindex.info in YAML",
        holds: "samples ascend, are finite and not negative; so is the index between them and beyond",
        folders: &[],
        run: lines::page,
    },
    Target {
        name: "axes",
        parser: "luthier_table::Layout::parse",
        reads: "`--axes` of `table` and `audit`",
        holds: "a layout that is printed parses to an equal one; its nodes are finite",
        folders: &[],
        run: lines::axes,
    },
    Target {
        name: "directions",
        parser: "luthier_layers::angles::pairs",
        reads: "`eval --directions`",
        holds: "directions are unit and not below the surface; a list that is printed parses to an equal one",
        folders: &[],
        run: lines::directions,
    },
    Target {
        name: "lobe",
        parser: "luthier_layers::beam_fit::samples",
        reads: "`fit LOBE.csv`",
        holds: "directions are unit and above the surface, values finite and not negative",
        folders: &[],
        run: lines::lobe,
    },
    Target {
        name: "reradiation",
        parser: "luthier_optics::reradiation::Matrix::parse",
        reads: "`eval --matrix`",
        holds: "a matrix has a share for each pair of bins; a matrix that is printed parses to an equal one",
        folders: &[],
        run: lines::reradiation,
    },
    Target {
        name: "lock",
        parser: "luthier_manifest::Lock::from_json",
        reads: "`luthier.lock` beside materials",
        holds: "a lock that is printed parses to an equal one",
        folders: &[],
        run: json::lock,
    },
    Target {
        name: "manifest",
        parser: "luthier_manifest::Manifest::from_json, luthier_export::Package::from_parts",
        reads: "`manifest.json` of a bake",
        holds: "a manifest that is printed parses to an equal one; texels that fit it make a package, whose buffer and tiles can be reached",
        folders: &[],
        run: json::manifest,
    },
    Target {
        name: "report",
        parser: "luthier_report::Report::from_json",
        reads: "`report.json`",
        holds: "a report that is printed parses to an equal one; its summary can be written",
        folders: &[],
        run: json::report,
    },
    Target {
        name: "stability",
        parser: "luthier_report::stability::Stability::from_json",
        reads: "`report --stability`",
        holds: "a suite that is printed parses to an equal one; it can be summed up",
        folders: &[],
        run: json::stability,
    },
    Target {
        name: "costs",
        parser: "luthier_report::Costs",
        reads: "`report --cost`",
        holds: "costs that are printed parse to equal ones",
        folders: &[],
        run: json::costs,
    },
    Target {
        name: "ktx2",
        parser: "luthier_texture::ktx2::decode",
        reads: "textures of a bake",
        holds: "a texture that is written is read as an equal one; it has the values that its size needs",
        folders: &[],
        run: images::ktx2,
    },
    Target {
        name: "exr",
        parser: "luthier_texture::exr::decode",
        reads: "EXR files of a bake",
        holds: "an image that is written is read as an equal one",
        folders: &[],
        run: images::exr,
    },
    Target {
        name: "png",
        parser: "luthier_texture::png::decode, luthier_texture::picture::decode",
        reads: "maps of materials and of bakes",
        holds: "values are in 0..1 and as many as the size needs; a map that is written is read as an equal one",
        folders: &[],
        run: images::png,
    },
    Target {
        name: "picture",
        parser: "luthier_texture::picture::decode",
        reads: "maps of materials: PNG, JPEG and WebP",
        holds: "samples are as many as the size needs; a picture that is written as PNG is read as an equal one",
        folders: &[],
        run: images::picture,
    },
    Target {
        name: "radiance",
        parser: "luthier_texture::radiance::decode",
        reads: "environments: OpenEXR and Radiance HDR of any maker",
        holds: "values are as many as the size needs",
        folders: &[],
        run: images::radiance,
    },
    Target {
        name: "gltf",
        parser: "luthier_mesh::soup, luthier_mesh::Mesh::new",
        reads: "`--mesh`: glTF files, text and binary",
        holds: "corners are numbers of vertices, and these are finite; a mesh made of them lies in the unit sphere, its openness in 0..1",
        folders: &[],
        run: meshes::gltf,
    },
    Target {
        name: "import",
        parser: "luthier_import::import",
        reads: "`import`: glTF files, text and binary, MaterialX, and the JSON of a database",
        holds: "every material is a file that parses, with a name of its own; the pictures that it names are there",
        folders: &["crates/luthier-fuzz/corpus/gltf"],
        run: meshes::import,
    },
    Target {
        name: "table",
        parser: "luthier_texture::table::read",
        reads: "tables of any maker: DDS, KTX2, EXR, PNG, Radiance HDR",
        holds: "values are as many as size and channels need",
        folders: &[],
        run: images::table,
    },
    Target {
        name: "raw",
        parser: "luthier_texture::table::raw",
        reads: "tables without a header; the first bytes stand for the options",
        holds: "values are as many as size and channels need",
        folders: &[],
        run: images::raw,
    },
];

/// The target of a name.
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}
