//! `eval`: directions, colour, errors.

use std::f64::consts::PI;

use assert_cmd::cargo::cargo_bin_cmd;
use luthier_workshop::material_texts::{gold, lacquer, matte};

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
    let args = [
        "eval",
        "l.toml",
        "--model",
        "layered-mc",
        "--wi",
        "30,0",
        "--wo",
        "45,180",
        "--three-wavelengths",
        "--samples",
        "65536",
    ];
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
        ("30,0,120,0\n", "standard input:1: theta_o is 120, expected 0 to 90 degrees"),
        ("theta,0,0,0\n", "standard input:1: theta_i is `theta`, expected degrees"),
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
    run(&["m.toml", "--model", "elek", "--furnace", "--rgb"]).fails(2, &["--rgb"]);
    run(&["m.toml", "--model", "elek", "--albedo", "--angles", "0,91"]).fails(2, &["0 to 90"]);
    run(&[&["m.toml", "--model", "elek", "--angles", "0"], &pair[..]].concat()).fails(2, &["required"]);
    run(&["m.toml", "--albedo"]).exits(2).says(&["required", "--model"]);
    run(&[&["no.toml", "--model", "elek"], &pair[..]].concat()).fails(3, &["no.toml"]);
    run(&["m.toml", "--model", "elek"]).fails(2, &["required"]);
    run(&["m.toml", "--model", "elek", "--wi", "0,0"]).fails(2, &["required"]);
    run(&["m.toml", "--model", "elek", "--wi", "91,0", "--wo", "0,0"]).fails(2, &["0 to 90"]);
    run(&[&["m.toml", "--model", "elek", "--wavelength", "100"], &pair[..]].concat()).fails(2, &["360 to 830"]);
}

/// Oracles: single scattering of GGX with F = 1 and height-correlated masking: 1 - ln 2 from the normal at alpha 1, and the albedos at 60
/// degrees of alpha 0.1 to 1. A metal reflects all but about 4 n / k^2.
#[test]
fn albedos_at_any_angle_in_colour() {
    let metal = |alpha: f64| {
        format!(
            "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"conductor\"\nalpha = {alpha}\ndistribution = \"ggx\"\n\
             ior = {{ n = 0.01, k = 50 }}\n"
        )
    };
    let workshop = Workshop::new();
    let at_60 = [(0.1, 0.969205), (0.25, 0.857263), (0.5, 0.69825), (0.75, 0.56462), (1.0, 0.45069)];
    for (alpha, expected) in at_60 {
        workshop.write("m.toml", metal(alpha));
        let args =
            ["eval", "m.toml", "--model", "microfacet-ggx", "--albedo", "--angles", "60,0", "--three-wavelengths"];
        let text = workshop.run(&args).exits(0).stdout;
        let [head, at_60, at_0] = text.lines().collect::<Vec<_>>()[..] else { panic!("{text}") };
        assert_eq!(head, "theta_o,r,g,b,change_on_doubling_r,change_on_doubling_g,change_on_doubling_b");
        let row = numbers(at_60);
        assert!(row[0] == 60.0 && row[1..4].iter().all(|value| (value - expected).abs() < 2e-4), "{alpha}: {row:?}");
        if alpha == 1.0 {
            let expected = 1.0 - std::f64::consts::LN_2;
            assert!(numbers(at_0)[1..4].iter().all(|value| (value - expected).abs() < 2e-4), "{at_0}");
        }
    }
    // The command's default, one wavelength, and a colour that is none: all the same of a grey.
    let of = |more: &[&str]| {
        let args = [&["eval", "m.toml", "--model", "elek", "--albedo", "--angles", "37.5"], more].concat();
        numbers(workshop.run(&args).exits(0).stdout.lines().nth(1).unwrap())
    };
    let (one, colour) = (of(&[])[1], of(&["--rgb"]));
    assert!(colour[1..4].iter().all(|value| (value / one - 1.0).abs() < 1e-4), "{one} {colour:?}");
    // All walks come back, whatever the colour, and the estimate says so.
    let json = ["eval", "m.toml", "--model", "random-walk", "--albedo", "--angles", "60", "--rgb", "--json"];
    let json = workshop.run(&json).exits(0).json();
    assert_eq!((&json["color"], &json["albedo"][0]["method"]), (&"spectral".into(), &"estimate".into()));
    for c in 0..3 {
        assert!((json["albedo"][0]["albedo"][c].as_f64().unwrap() - 1.0).abs() < 1e-4, "{json}");
        assert!(json["albedo"][0]["error"][c].as_f64().unwrap() < 1e-5, "{json}");
    }
}

/// Oracle: a Lambert surface whose normal leans by t from the eye's: rho (1 + cos t) / 2 of the light comes from above the horizon of both, by
/// quadrature and by the closed form's share of azimuths.
#[test]
fn albedos_with_another_normal() {
    let workshop = Workshop::with(&[("m.toml", &matte("m")), ("l.toml", &lacquer("l"))]);
    for lean in [0.0, 20.0, 60.0] {
        let normal = format!("{lean},40");
        let expected = 0.3 * 0.5 * (1.0 + libm::cos(f64::to_radians(lean)));
        for (model, tolerance) in [("elek", 2e-3), ("closed-form", 1e-4)] {
            let args = ["eval", "m.toml", "--model", model, "--albedo", "--angles", "0,10", "--normal", &normal];
            let text = workshop.run(&args).exits(0).stdout;
            for row in text.lines().skip(1).map(numbers) {
                assert!((row[1] / expected - 1.0).abs() < tolerance, "{model} {lean}: {row:?} {expected}");
            }
        }
    }
    // Paths that are counted and values that are summed, two routes through the reference.
    let albedo = [
        "eval",
        "l.toml",
        "--model",
        "layered-mc",
        "--albedo",
        "--angles",
        "30",
        "--normal",
        "25,0",
        "--samples",
        "60000",
    ];
    let row = numbers(workshop.run(&albedo).exits(0).stdout.lines().nth(1).unwrap());
    let list: Vec<[f64; 2]> = (0..24u32)
        .flat_map(|i| (0..24u32).map(move |j| [(f64::from(i) + 0.5) / 24.0, (f64::from(j) + 0.5) * 15.0]))
        .map(|[cos, phi]| [libm::acos(cos).to_degrees(), phi])
        .collect();
    let lines: Vec<String> = list.iter().map(|[theta, phi]| format!("{theta},{phi},30,0")).collect();
    workshop.write("all.csv", lines.join("\n"));
    let values = [
        "eval",
        "l.toml",
        "--model",
        "layered-mc",
        "--normal",
        "25,0",
        "--wavelength",
        "550",
        "--samples",
        "512",
        "--directions",
        "all.csv",
    ];
    let text = workshop.run(&values).exits(0).stdout;
    let sum: f64 = text.lines().skip(1).map(|line| line.split(',').nth(4).unwrap().parse::<f64>().unwrap()).sum();
    let summed = sum * 2.0 * PI / list.len() as f64;
    assert!((summed / row[1] - 1.0).abs() < 0.03, "{summed} {row:?}");
}

/// Inside glass, light of 85 degrees that goes from facet to facet: 8.9e-4 +- 2e-6 was printed of 1.5e-3. And light that no sample meets
/// has no error.
#[test]
fn errors_are_stated_where_they_are_known() {
    let glass = "schema = 1\nname = \"g\"\nexterior = { n = 1.5 }\n[[layer]]\ntype = \"dielectric\"\nior = { n = 1.0 }\nalpha = 0.05\n";
    let workshop = Workshop::with(&[("g.toml", glass), ("l.toml", &lacquer("l"))]);
    for model in ["random-walk", "layered-mc"] {
        let args = ["eval", "g.toml", "--model", model, "--wi", "85,0", "--wo", "0,0", "--wavelength", "550"];
        let row = numbers(workshop.run(&args).exits(0).stdout.lines().nth(1).unwrap());
        assert!((row[4] - 1.434e-3).abs() < 5.0 * libm::hypot(row[5], 2e-6) && row[5] < 6e-5, "{row:?}");
    }
    let few = ["eval", "l.toml", "--model", "layered-mc", "--wi", "30,0", "--wo", "45,180", "--samples", "6"];
    let text = workshop.run(&few).exits(0).stdout;
    assert!(text.lines().nth(1).unwrap().ends_with(",not-settled,not-settled,not-settled"), "{text}");
    let json = workshop.run(&[&few[..], &["--json"]].concat()).exits(0).json();
    assert!(json["values"][0]["std_err"][0].is_null() && json["values"][0]["settled"][0] == false, "{json}");
}

/// A file with three wavelengths is evaluated at these, as its shaders are. Oracle: Fresnel's reflectance at normal incidence of the n and k that the
/// file of indices has at each wavelength; D and masking are the same in all channels.
#[test]
fn values_have_the_colour_of_the_file() {
    let nodes = [(645.0, 0.2, 3.0), (525.0, 1.5, 0.4), (445.0, 3.0, 2.0)];
    // Other indices at all wavelengths between, so that a spectral colour is another one.
    let mut lines = vec!["wavelength_nm,n,k".to_owned()];
    for nm in (360..=830).step_by(5) {
        let at = nodes.iter().find(|node| node.0 == f64::from(nm));
        let (n, k) = at.map_or((1.1, 0.01), |node| (node.1, node.2));
        lines.push(format!("{nm},{n},{k}"));
    }
    let metal = "schema = 1\nname = \"metal\"\n[[layer]]\ntype = \"conductor\"\nior = \"measured.csv\"\nalpha = 0.3\n[bake]\nmodel = \"microfacet\"\n";
    let workshop = Workshop::with(&[
        ("measured.csv", &(lines.join("\n") + "\n")),
        ("own.toml", &format!("{metal}color = \"three-wavelengths\"\n")),
        ("plain.toml", metal),
    ]);
    let values = |file: &str, more: &[&str]| {
        let args = ["eval", file, "--model", "microfacet", "--wi", "0,0", "--wo", "0,0"];
        let text = workshop.run(&[&args, more].concat()).exits(0).stdout;
        numbers(text.lines().nth(1).unwrap())[4..].to_vec()
    };
    let own = values("own.toml", &[]);
    let fresnel =
        nodes.map(|(_, n, k): (f64, f64, f64)| ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k));
    for c in 1..3 {
        let (found, expected) = (own[c] / own[0], fresnel[c] / fresnel[0]);
        assert!((found / expected - 1.0).abs() < 1e-5, "channel {c}: {found}, {expected}");
    }
    assert_eq!(own, values("plain.toml", &["--three-wavelengths"]));
    // The other way round, and both by their names.
    let spectral = values("own.toml", &["--rgb"]);
    assert_eq!(spectral, values("plain.toml", &[]));
    assert!((spectral[0] / own[0] - 1.0).abs() > 0.1, "{spectral:?} {own:?}");
    let said =
        workshop.run(&["eval", "own.toml", "--model", "microfacet", "--wi", "0,0", "--wo", "0,0", "--json"]).exits(0);
    assert_eq!(said.json()["color"], serde_json::json!({"three_wavelengths_nm": [645.0, 525.0, 445.0]}));
}
