//! `eval --polarised`.

use luthier_workshop::material_texts::{gold, lacquer, matte};

use crate::workshop::Workshop;

fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

fn glass(ior: f64, film: &str) -> String {
    format!("schema = 1\nname = \"g\"\n{film}\n[[layer]]\ntype = \"dielectric\"\nsmooth = true\nior = {ior}\n")
}

/// Oracle: Airy's sums of a soap film, 300 nm of 1.33 in air at 550 nm, computed elsewhere: 0.07543020 from the normal, 0.05362888 (s) and
/// 0.00171259 (p) at 60 degrees.
#[test]
fn airy_sums_of_a_film() {
    let text = glass(1.0, "[[layer]]\ntype = \"thin-film\"\nior = 1.33\nthickness_nm = 300\n");
    let workshop = Workshop::with(&[("f.toml", &text)]);
    let args = ["eval", "f.toml", "--polarised", "--angles", "0,60", "--wavelength", "550"];
    let text = workshop.run(&args).exits(0).stdout;
    assert_eq!(text.lines().next(), Some("theta_i,refl_s,refl_p"));
    for (row, [s, p]) in rows(&text).iter().zip([[0.07543020, 0.07543020], [0.05362888, 0.00171259]]) {
        assert!((row[1] - s).abs() < 1e-8 && (row[2] - p).abs() < 1e-8, "{row:?}");
    }
    let json = workshop.run(&[&args[..], &["--json"]].concat()).exits(0).json();
    assert!((json["polarised"][1]["refl_p"][0].as_f64().unwrap() - 0.00171259).abs() < 1e-8, "{json}");
}

/// Fresnel by hand: Brewster's angle has no p, and grazing light is mirrored whole; colour of a grey index is grey.
#[test]
fn one_interface() {
    let workshop = Workshop::with(&[("g.toml", &glass(1.5, ""))]);
    let brewster = libm::atan(1.5).to_degrees().to_string();
    let angles = format!("{brewster},90");
    for colour in [&[][..], &["--rgb"], &["--three-wavelengths"]] {
        let args = [&["eval", "g.toml", "--polarised", "--angles", &angles], colour].concat();
        let rows = rows(&workshop.run(&args).exits(0).stdout);
        let channels = (rows[0].len() - 1) / 2;
        // At that angle r_s is (1 - n^2) / (1 + n^2).
        let expected = 1.25 * 1.25 / (3.25 * 3.25);
        for c in 0..channels {
            assert!((rows[0][1 + c] - expected).abs() < 1e-6 && rows[0][1 + channels + c].abs() < 1e-12, "{rows:?}");
        }
        assert!(rows[1][1..].iter().all(|value| (value - 1.0).abs() < 1e-6), "{rows:?}");
        assert_eq!(channels, if colour.is_empty() { 1 } else { 3 });
    }
}

#[test]
fn where_light_is_not_coherent() {
    let workshop = Workshop::with(&[("m.toml", &matte("m")), ("l.toml", &lacquer("l")), ("g.toml", &gold("g"))]);
    let run = |file: &str| workshop.run(&["eval", file, "--polarised"]);
    run("m.toml").fails(1, &["m.toml: --polarised is for one smooth interface", "its base is diffuse"]);
    run("l.toml").fails(1, &["it has 2 layers", "not coherent across a slab"]);
    run("g.toml").fails(1, &["its interface is rough", "`smooth = true`"]);
    workshop.run(&["eval", "g.toml", "--polarised", "--model", "elek"]).fails(2, &["--model"]);
    workshop.run(&["eval", "g.toml", "--polarised", "--albedo", "--model", "elek"]).fails(2, &["--polarised"]);
}
