//! A material baked in memory: its tables and its shader, for a renderer of one's own. Run with `cargo run -p luthier --example
//! bake_to_memory`.

use luthier::{Bake, MemoryStore, parse};
use luthier_manifest::Form;

const ENAMEL: &str = r#"
schema = 1
name = "enamel"

[[layer]]
type = "dielectric"
ior = 1.5
roughness = 0.2

[[layer]]
type = "diffuse"
albedo = [0.6, 0.05, 0.08]
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let material = parse("enamel.toml", ENAMEL)?;
    let package = Bake::wgsl(&[Form::Baked]).package(&[material], &MemoryStore::default())?;
    for (entry, table) in package.manifest.tables.iter().zip(&package.tables) {
        let [width, height] = [table.texture.width, table.texture.height];
        eprintln!("{}: {width} x {height} texels, {} bytes", entry.kind, table.texture.bytes.len());
    }
    eprintln!("{} bytes of WGSL", package.wgsl(Form::Baked)?.len());
    Ok(())
}
