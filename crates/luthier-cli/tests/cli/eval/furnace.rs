//! `eval --furnace` and `--environment`.

use luthier_workshop::material_texts::{gold, lacquer, matte, smooth_coat};

use crate::workshop::Workshop;

fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

/// Exact models keep everything, whatever the material absorbs.
#[test]
fn a_lossless_surface_vanishes() {
    let workshop = Workshop::with(&[("m.toml", &matte("m")), ("c.toml", &smooth_coat("c")), ("g.toml", &gold("g"))]);
    for (file, model, tolerance) in [
        ("m.toml", "elek", 1e-6),
        ("c.toml", "closed-form", 1e-6),
        ("g.toml", "closed-form", 1e-12),
        // Four standard errors are 0 for a mirror: all walks come back.
        ("g.toml", "random-walk", 1e-9),
    ] {
        let text = workshop.run(&["eval", file, "--model", model, "--furnace"]).exits(0).stdout;
        for row in rows(&text) {
            assert!((row[1] - 1.0).abs() < tolerance && (row[2] - (row[1] - 1.0)).abs() < 1e-6, "{model}: {text}");
        }
    }
}

/// Oracle: single scattering of GGX with F = 1 at alpha 0.25: 0.9158124302 from the normal, 0.857263 at 60 degrees. The roughness of the
/// material is 0.5, its alpha the square.
#[test]
fn single_scattering_loses_what_facets_scatter_again() {
    let workshop = Workshop::with(&[("g.toml", &gold("g"))]);
    let text = workshop.run(&["eval", "g.toml", "--model", "microfacet-ggx", "--furnace"]).exits(0).stdout;
    assert_eq!(text.lines().next(), Some("theta_o,radiance,deviation,change_on_doubling"));
    let rows = rows(&text);
    for (theta, expected) in [(0.0, 0.9158124302), (60.0, 0.857263)] {
        let row = rows.iter().find(|row| row[0] == theta).unwrap();
        assert!((row[1] - expected).abs() < 2e-4 && row[3] < 1e-3, "{theta}: {row:?}");
    }
    let args = ["eval", "g.toml", "--model", "microfacet-ggx", "--furnace", "--json", "--wavelength", "600"];
    let json = workshop.run(&args).exits(0).json();
    assert_eq!(json["wavelength_nm"], 600.0);
    let first = &json["furnace"][0];
    assert_eq!((first["theta_o_deg"].as_f64(), first["method"].as_str()), (Some(0.0), Some("quadrature")));
    assert_eq!(first["deviation"].as_f64().unwrap(), first["radiance"].as_f64().unwrap() - 1.0);
}

/// Oracles, by hand: at alpha 1 the D of GGX is 1 / pi. With the masking `implicit` the albedo is then the mean of cos_theta_i / 4 over the
/// hemisphere times 2, which is 1/4 at all angles; with Kelemen's it is 1 - ln 2 from the normal, as with Smith's.
#[test]
fn maskings_of_files_lose_as_much_as_by_hand() {
    let text = |masking: &str| {
        let metal = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 1\n";
        format!("schema = 1\nname = \"g\"\n{metal}[bake]\nmodel = \"microfacet\"\nmasking = \"{masking}\"\n")
    };
    let of = |masking: &str| {
        let workshop = Workshop::with(&[("g.toml", &text(masking))]);
        let args = ["eval", "g.toml", "--model", "microfacet", "--furnace", "--angles", "0,40,85"];
        rows(&workshop.run(&args).exits(0).stdout)
    };
    assert!(of("implicit").iter().all(|row| (row[1] - 0.25).abs() < 1e-6), "{:?}", of("implicit"));
    for masking in ["kelemen", "smith"] {
        assert!((of(masking)[0][1] - (1.0 - std::f64::consts::LN_2)).abs() < 1e-6, "{:?}", of(masking));
    }
}

/// The model as printed gains at grazing angles and loses at the normal, over a white base under a rough coat; the walk of light through
/// the whole stack does neither, within its noise.
#[test]
fn gains_show() {
    let workshop = Workshop::with(&[("l.toml", &lacquer("l"))]);
    let of = |model: &str| rows(&workshop.run(&["eval", "l.toml", "--model", model, "--furnace"]).exits(0).stdout);
    let printed = of("weidlich-wilkie");
    let deviation = |theta: f64| printed.iter().find(|row| row[0] == theta).unwrap()[2];
    assert!(deviation(80.0) > 0.1 && deviation(0.0) < -0.02, "{printed:?}");
    for row in of("layered-mc") {
        assert!(row[2].abs() < 5.0 * row[3] + 1e-6, "{row:?}");
    }
}

/// Fresnel's reflectance of 1.5: 0.04 at the normal, 0.0502399110 at 45 degrees.
#[test]
fn an_environment_is_mirrored() {
    let workshop = Workshop::with(&[("l.toml", &lacquer("l"))]);
    let text = workshop.run(&["eval", "l.toml", "--model", "elek", "--environment"]).exits(0).stdout;
    assert_eq!(text.lines().next(), Some("theta_o,environment"));
    for (theta, expected) in [(0.0, 0.04), (45.0, 0.0502399110)] {
        let row = rows(&text).into_iter().find(|row| row[0] == theta).unwrap();
        assert!((row[1] - expected).abs() < 1e-7, "{row:?}");
    }
    let json = workshop.run(&["eval", "l.toml", "--model", "elek", "--environment", "--json"]).exits(0).json();
    assert!((json["environment"][0]["environment"].as_f64().unwrap() - 0.04).abs() < 1e-12, "{json}");
    workshop
        .run(&["eval", "l.toml", "--model", "phong", "--environment"])
        .fails(2, &["`phong` does not take --environment", "elek"]);
}
