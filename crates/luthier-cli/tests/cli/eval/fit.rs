//! `fit`: numbers of Granier and Heidrich's model for lobes that `eval` prints.

use crate::workshop::Workshop;

const OWN: &str = "schema = 1\nname = \"own\"\n
[[layer]]\ntype = \"dielectric\"\nior = { n = [1.4, 1.5, 1.6], wavelengths_nm = [645, 525, 445] }\nexponents = [60, 25]\n
[[layer]]\ntype = \"diffuse\"\nalbedo = [0.6, 0.4, 0.2]\n
[bake]\nmodel = \"granier-heidrich\"\ncolor = \"three-wavelengths\"\n
[bake.granier-heidrich]\nspecular_weight = 0.7\n";

/// Directions of the eye in the plane of the light and across it, for a few lights.
fn pairs() -> String {
    let mut text = String::new();
    for theta_i in [10, 35, 60] {
        for theta_o in [5, 15, 25, 35, 45, 55, 65, 75] {
            for phi_o in [0, 60, 120, 150, 165, 180] {
                text += &format!("{theta_i},0,{theta_o},{phi_o}\n");
            }
        }
    }
    text
}

fn lobe(workshop: &Workshop, file: &str, model: &[&str]) -> String {
    let args = ["eval", file, "--three-wavelengths", "--directions", "pairs.csv"];
    workshop.run(&[&args, model].concat()).exits(0).stdout
}

fn values(text: &str) -> Vec<f64> {
    let row = |line: &str| line.split(',').skip(4).take(3).map(|x| x.parse::<f64>().unwrap()).collect::<Vec<_>>();
    text.lines().skip(1).flat_map(row).collect()
}

/// Sum of the differences over that of the values.
fn apart(found: &str, expected: &str) -> f64 {
    let (found, expected) = (values(found), values(expected));
    let sum: f64 = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).sum();
    sum / expected.iter().sum::<f64>()
}

#[test]
fn a_file_comes_back_from_its_lobe() {
    let workshop = Workshop::with(&[("own.toml", OWN), ("pairs.csv", &pairs())]);
    let model = ["--model", "granier-heidrich"];
    let given = lobe(&workshop, "own.toml", &model);
    workshop.write("lobe.csv", &given);
    workshop.run(&["fit", "lobe.csv", "-o", "fitted.toml"]).exits(0);
    workshop.run(&["check", "fitted.toml"]).exits(0);
    let found = lobe(&workshop, "fitted.toml", &model);
    assert!(apart(&found, &given) < 1e-4, "{}", apart(&found, &given));
    let json = workshop.run(&["fit", "lobe.csv", "--json"]).exits(0).json();
    for (found, expected) in json["exponents"].as_array().unwrap().iter().zip([60.0, 25.0]) {
        assert!((found.as_f64().unwrap() / expected - 1.0).abs() < 1e-2, "{json}");
    }
    assert!((json["specular_weight"].as_f64().unwrap() - 0.7).abs() < 1e-2, "{json}");
    assert_eq!(json["samples"], 144);
}

/// A simulated coat over a base: no lobes of Phong's. The error is the one that the file says, worked out from what the file evaluates to.
#[test]
fn a_simulated_coat_is_fitted_as_well_as_the_file_says() {
    let coat = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.25\n\
                [[layer]]\ntype = \"diffuse\"\nalbedo = [0.7, 0.4, 0.2]\n";
    let workshop = Workshop::with(&[("coat.toml", coat), ("pairs.csv", &pairs())]);
    let given = lobe(&workshop, "coat.toml", &["--model", "layered-mc", "--samples", "4000"]);
    workshop.write("simulated.csv", &given);
    workshop.run(&["fit", "simulated.csv", "-o", "fitted.toml"]).exits(0);
    let json = workshop.run(&["fit", "simulated.csv", "--json"]).exits(0).json();
    let said = json["lobe_err"].as_f64().unwrap();
    let found = apart(&lobe(&workshop, "fitted.toml", &["--model", "granier-heidrich"]), &given);
    eprintln!("lobe error {found}, said {said}");
    assert!((found - said).abs() < 1e-3 && found < 0.2, "{found} {said}");
    let text = std::fs::read_to_string(workshop.path("fitted.toml")).unwrap();
    assert!(text.contains(&format!("lobe error {said:.4}")) && text.contains("144 values"), "{text}");
}

#[test]
fn mistakes_are_refused() {
    let workshop = Workshop::with(&[("few.csv", "theta_i,phi_i,theta_o,phi_o,r,g,b\n30,0,30,180,1,1,1\n")]);
    workshop.write("columns.csv", "theta_i,phi_i,r,g,b\n");
    workshop.run(&["fit", "few.csv"]).fails(1, &["few.csv: 1 values are too few"]);
    workshop.run(&["fit", "columns.csv"]).fails(1, &["columns.csv:1: no column `theta_o`"]);
    workshop.run(&["fit", "none.csv"]).fails(3, &["none.csv"]);
    workshop.run(&["fit", "few.csv", "--film", "800,50"]).fails(2, &["expected MIN,MAX in nm"]);
}
