//! Fluorescent bases in material files: their matrix in Rec.709, what is refused, and which model they take.

use std::io;

use luthier_manifest::{Feature, ShadingModel};
use luthier_material::{Diagnostic, Material, left_out, parse};
use luthier_optics::reradiation::{Matrix, rgb};
use luthier_optics::stack::Base;

const DYE: &str = "nm,400,450,500,550,600,650,700\n\
                   400,0.1,0,0,0,0,0,0\n450,0,0.1,0,0,0,0,0\n500,0,0,0.2,0,0,0,0\n550,0.2,0.2,0.2,0.6,0,0,0\n\
                   600,0.3,0.4,0.4,0.2,0.8,0,0\n650,0.1,0.1,0.1,0.1,0,0.8,0\n700,0,0,0,0,0,0,0.8\n";

fn read(path: &str) -> io::Result<String> {
    match path {
        "dye.csv" => Ok(DYE.to_owned()),
        "gain.csv" => Ok("# a pump\nnm,450,550\n450,0.5,0\n550,0.7,0.4\n".to_owned()),
        "short.csv" => Ok("nm,450,550\n450,0.5\n550,0.2,0.4\n".to_owned()),
        _ => Err(io::Error::new(io::ErrorKind::NotFound, "no such file")),
    }
}

fn material(base: &str, more: &str) -> Result<Material, Vec<Diagnostic>> {
    let text = format!(
        "schema = 1\nname = \"x\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n[[layer]]\ntype = \"diffuse\"\n{base}\n{more}\n"
    );
    parse("x.toml", &text, &read).map(|parsed| parsed.material)
}

#[test]
fn a_matrix_takes_the_place_of_an_albedo() {
    let found = material("reradiation = \"dye.csv\"", "").unwrap();
    let rows = rgb(&Matrix::parse(DYE).unwrap());
    assert_eq!(found.reradiation(), Some(rows));
    assert_eq!(found.files, ["dye.csv"]);
    // The dye is brighter in red than a perfect reflector; an albedo is not.
    let sums = rows.map(|row| row.iter().sum::<f64>());
    assert!(sums[0] > 1.0, "{sums:?}");
    let Base::Diffuse(base) = &found.stack.layers[1].base else { panic!("a diffuse base") };
    assert_eq!(base.albedo, sums.map(|sum| sum.clamp(0.0, 1.0)));
    assert_eq!(material("albedo = 0.5", "").unwrap().reradiation(), None);
}

#[test]
fn the_default_model_shows_it() {
    let found = material("reradiation = \"dye.csv\"", "").unwrap();
    assert_eq!(found.model(), ShadingModel::Elek);
    for model in ShadingModel::ALL {
        let is_left_out = left_out(&found, model).iter().any(|left| left.feature == Feature::Reradiation);
        let is_chain = matches!(model, ShadingModel::Elek | ShadingModel::WeidlichWilkie);
        // Of a base that is left out nothing else is told.
        assert_eq!(is_left_out, !is_chain && model != ShadingModel::Microfacet, "{model}");
    }
}

#[test]
fn mistakes_are_pointed_at() {
    let patina = "[effects.patina]\nextent = 0.5\ntransition = 0.2\n[effects.patina.map.noise]\n";
    for (base, more, expected) in [
        (
            "reradiation = \"gain.csv\"",
            "",
            "`gain.csv`:2: 1.2 of the power of the light at 450 nm comes out; it has to be 1 at most",
        ),
        ("reradiation = \"short.csv\"", "", "`short.csv`:2: expected 2 shares after the wavelength, found 1"),
        ("reradiation = \"none.csv\"", "", "cannot read `none.csv`: no such file"),
        ("reradiation = \"dye.csv\"\nalbedo = 0.5", "", "a second reflectance: `albedo` is given already"),
        ("reradiation = \"dye.csv\"\nsigma = 0.3", "", "a base with `reradiation` has no slopes"),
        ("reradiation = \"dye.csv\"", patina, "no model has patina over a base with `reradiation`"),
        ("", "", "this diffuse has no reflectance"),
    ] {
        let errors = material(base, more).unwrap_err();
        let found: Vec<&str> = errors.iter().map(|error| error.message.as_str()).collect();
        assert_eq!(found, [expected], "{base} {more}");
        assert!(errors[0].line > 6, "{}", errors[0].line);
    }
}
