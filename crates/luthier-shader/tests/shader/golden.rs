//! Emitted text, as committed under `tests/golden`: the smallest set and one with the common features, in every
//! language. To accept a deliberate change, run with `LUTHIER_ACCEPT=1` and read the difference.

use luthier_lut::TableKind;
use std::fs;
use std::path::Path;

use crate::scenes::{clear, conductor, diffuse, material, tables};
use luthier_shader::{Form, MaterialSet, Target, emit};

fn check(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    // The first line names the version.
    let body = text.split_once('\n').unwrap().1;
    if std::env::var_os("LUTHIER_ACCEPT").is_some() {
        fs::write(&path, body).unwrap();
    }
    let expected = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(expected == body, "{name} differs from tests/golden/{name}; the new text is\n{body}");
}

#[test]
fn lambert_needs_no_table_and_no_interface() {
    let materials = [material("chalk", &[diffuse(0.0)])];
    let set = MaterialSet::new(&materials, tables());
    for target in Target::TEXT {
        check(&format!("chalk.{}", target.extension()), &emit(&set, Form::Baked, target).unwrap());
    }
}

#[test]
fn varnished_gold_has_two_layers_two_distributions_and_no_absorption() {
    let mut gold = conductor();
    gold.tiles[TableKind::Fgd] = None;
    let mut varnish = clear();
    varnish.tiles[TableKind::Fgd] = None;
    let materials = [material("varnished-gold", &[varnish, gold])];
    let set = MaterialSet::new(&materials, tables());
    for form in Form::ALL {
        for target in Target::TEXT {
            let name = format!("varnished-gold.{form}.{}", target.extension());
            check(&name, &emit(&set, form, target).unwrap());
        }
    }
}
