//! `eval`: directions, colour, errors.

use std::f64::consts::PI;

use assert_cmd::cargo::cargo_bin_cmd;

use crate::material_texts::{gold, lacquer, matte};
use crate::workshop::Workshop;

fn numbers(line: &str) -> Vec<f64> {
    line.split(',').map(|field| field.parse().unwrap()).collect()
}

/// A Lambertian surface: f cos theta_i is albedo cos theta_i / pi, from everywhere and in every mode.
#[test]
fn a_matte_surface_is_lambertian() {
    let workshop = Workshop::with(&[("m.toml", &matte("m"))]);
    let expected = [0.6, 0.3, 0.1].map(|albedo| albedo * 0.5 / PI);
    for mode in [&[][..], &["--rgb"], &["--three-wavelengths"]] {
        let args = ["eval", "m.toml", "--model", "elek", "--wi", "60,10", "--wo", "30,-50"];
        let text = workshop.run(&[&args, mode].concat()).exits(0).stdout;
        let [head, row] = text.lines().collect::<Vec<_>>()[..] else { panic!("{text}") };
        assert_eq!(head, "theta_i,phi_i,theta_o,phi_o,r,g,b");
        assert_eq!(numbers(row)[..4], [60.0, 10.0, 30.0, -50.0]);
        for (found, expected) in numbers(row)[4..].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6 * expected, "{text}");
        }
    }
    let args =
        ["eval", "m.toml", "--model", "elek", "--wi", "60,10", "--wo", "30,-50", "--wavelength", "640", "--json"];
    let json = workshop.run(&args).exits(0).json();
    assert_eq!(json["color"]["wavelength_nm"], 640.0);
    assert!((json["values"][0]["value"][0].as_f64().unwrap() - expected[0]).abs() < 1e-12, "{json}");
    assert!(json["values"][0]["std_err"].is_null());
}

#[test]
fn albedo_against_angle() {
    let workshop = Workshop::with(&[("m.toml", &matte("m")), ("gold.toml", &gold("gold"))]);
    let text = workshop.run(&["eval", "m.toml", "--model", "elek", "--albedo"]).exits(0).stdout;
    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(numbers).collect();
    assert_eq!(rows.first().unwrap()[0], 0.0);
    assert_eq!(rows.last().unwrap()[0], 85.0);
    for row in &rows {
        assert!((row[1] - 0.3).abs() < 1e-4 && row[2] < 1e-4, "550 nm is in the green channel: {text}");
    }
    // Opaque rough metal, one facet per meeting: quadrature of the closed form and paths of the reference are two routes
    // to one number.
    let of = |model: &str| {
        let json = workshop.run(&["eval", "gold.toml", "--model", model, "--albedo", "--json"]).exits(0).json();
        let list = json["albedo"].as_array().unwrap();
        list.iter().map(|e| (e["albedo"].as_f64().unwrap(), e["error"].as_f64().unwrap())).collect::<Vec<_>>()
    };
    for ((closed, change), (estimate, std_err)) in of("microfacet").into_iter().zip(of("layered-mc-one-facet")) {
        assert!(std_err > 0.0 && change < 1e-3);
        assert!((closed - estimate).abs() < 5.0 * std_err + change, "{closed} {estimate} +- {std_err}");
    }
}

#[test]
fn estimates_come_with_their_error() {
    let workshop = Workshop::with(&[("l.toml", &lacquer("l"))]);
    let args = ["eval", "l.toml", "--model", "layered-mc", "--wi", "30,0", "--wo", "45,180", "--three-wavelengths"];
    let run = workshop.run(&args).exits(0);
    assert_eq!(run.stdout, workshop.run(&args).exits(0).stdout, "the same numbers every time");
    let [head, row] = run.stdout.lines().collect::<Vec<_>>()[..] else { panic!("{}", run.stdout) };
    assert_eq!(head, "theta_i,phi_i,theta_o,phi_o,r,g,b,std_err_r,std_err_g,std_err_b");
    let row = numbers(row);
    for channel in 4..7 {
        assert!(row[channel] > 0.0 && row[channel + 3] > 0.0 && row[channel + 3] < 0.2 * row[channel], "{row:?}");
    }
}

#[test]
fn lists_of_directions() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    let list = "# there and back\n30,0,60,180\n\n60, 180, 30, 0\n";
    workshop.write("list.csv", list);
    let args = ["eval", "gold.toml", "--model", "microfacet", "--wavelength", "600", "--directions"];
    let text = workshop.run(&[&args[..], &["list.csv"]].concat()).exits(0).stdout;
    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(numbers).collect();
    // Reciprocity: f is the same, and the cosines are sqrt(3)/2 and 1/2.
    assert_eq!(rows.len(), 2);
    assert!((rows[0][4] / rows[1][4] - libm::sqrt(3.0)).abs() < 1e-5, "{text}");

    let piped = |input: &str| {
        let mut command = cargo_bin_cmd!("luthier");
        command.current_dir(workshop.path("")).args(args).arg("-").write_stdin(input.to_owned());
        command.output().unwrap()
    };
    assert_eq!(String::from_utf8(piped(list).stdout).unwrap(), text);
    for (input, part) in [
        ("30,0,60,180\n30,0,60\n", "standard input:2: expected theta_i,phi_i,theta_o,phi_o, found 3 fields"),
        ("30,0,120,0\n", "standard input:1: wo: theta is 120, expected 0 to 90 degrees"),
        ("theta,0,0,0\n", "standard input:1: wi: theta is `theta`, expected degrees"),
        ("\n", "standard input: no directions"),
    ] {
        let output = piped(input);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && output.stdout.is_empty() && stderr.contains(part), "{stderr}");
    }
}

#[test]
fn what_eval_refuses() {
    let workshop = Workshop::with(&[("m.toml", &matte("m"))]);
    let pair = ["--wi", "0,0", "--wo", "0,0"];
    let run = |args: &[&str]| workshop.run(&[&["eval"], args].concat());
    run(&[&["m.toml", "--model", "oracle"], &pair[..]].concat())
        .fails(2, &["`oracle`; known", "belcour", "layered-mc"]);
    run(&[&["m.toml", "--model", "belcor"], &pair[..]].concat()).fails(2, &["`belcor`; did you mean `belcour`? known"]);
    let both = ["m.toml", "--model", "elek", "--rgb", "--wavelength", "550"];
    run(&[&both, &pair[..]].concat()).fails(2, &["--rgb", "--wavelength"]);
    run(&["m.toml", "--model", "elek", "--albedo", "--furnace"]).fails(2, &["--albedo", "--furnace"]);
    run(&["m.toml", "--model", "elek", "--albedo", "--rgb"]).fails(2, &["--rgb"]);
    run(&[&["no.toml", "--model", "elek"], &pair[..]].concat()).fails(3, &["no.toml"]);
    run(&["m.toml", "--model", "elek"]).fails(2, &["required"]);
    run(&["m.toml", "--model", "elek", "--wi", "0,0"]).fails(2, &["required"]);
    run(&["m.toml", "--model", "elek", "--wi", "91,0", "--wo", "0,0"]).fails(2, &["0 to 90"]);
    run(&[&["m.toml", "--model", "elek", "--wavelength", "100"], &pair[..]].concat()).fails(2, &["360 to 830"]);
}
