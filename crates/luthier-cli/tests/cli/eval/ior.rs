//! `ior`.

use serde_json::Value;

use crate::workshop::Workshop;

fn samples(json: &Value) -> Vec<[f64; 3]> {
    let number = |sample: &Value, key: &str| sample[key].as_f64().unwrap();
    let list = json["samples"].as_array().unwrap();
    list.iter().map(|s| [number(s, "wavelength_nm"), number(s, "n"), number(s, "k")]).collect()
}

/// n and k between the samples, piecewise linear.
fn at(samples: &[[f64; 3]], wavelength_nm: f64) -> [f64; 2] {
    let pair = samples.windows(2).find(|pair| pair[0][0] <= wavelength_nm && wavelength_nm <= pair[1][0]).unwrap();
    let t = (wavelength_nm - pair[0][0]) / (pair[1][0] - pair[0][0]);
    [1, 2].map(|i| pair[0][i] + (pair[1][i] - pair[0][i]) * t)
}

#[test]
fn the_list_names_every_set() {
    let workshop = Workshop::new();
    let text = workshop.run(&["ior"]).exits(0).stdout;
    let list = workshop.run(&["ior", "--json"]).exits(0).json();
    let ids: Vec<&str> = list.as_array().unwrap().iter().map(|set| set["id"].as_str().unwrap()).collect();
    assert!(ids.len() >= 20 && ids.is_sorted(), "{ids:?}");
    let listed: Vec<&str> = text.lines().skip(1).filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(listed, ids);
    for set in list.as_array().unwrap() {
        for key in ["name", "citation", "licence"] {
            assert!(set[key].as_str().is_some_and(|text| !text.is_empty()), "{}: {key}", set["id"]);
        }
    }
    for needed in ["au", "ag", "cu", "cr", "cu2o", "ti", "water"] {
        assert!(ids.contains(&needed), "{needed}");
    }
}

#[test]
fn every_set_can_be_shown() {
    let workshop = Workshop::new();
    for set in workshop.run(&["ior", "--json"]).exits(0).json().as_array().unwrap() {
        let id = set["id"].as_str().unwrap();
        let text = workshop.run(&["ior", id]).exits(0).stdout;
        assert!(text.contains(set["citation"].as_str().unwrap()), "{id}");
        let json = workshop.run(&["ior", id, "--json"]).exits(0).json();
        let samples = samples(&json);
        assert!(samples.is_sorted_by(|a, b| a[0] < b[0]), "{id}");
        assert!(samples.iter().all(|[_, n, k]| *n > 0.0 && *k >= 0.0), "{id}");
        let rows = text.lines().skip_while(|line| !line.starts_with("wavelength_nm")).count();
        assert_eq!(rows, samples.len() + 1, "{id}");
    }
}

/// Catalogue values: Schott's n_d of N-BK7 and N-SF11 (587.56 nm), water and diamond at the sodium line (CRC Handbook), gold of
/// Johnson and Christy 1972, table I, at 1.88 and 1.76 eV.
#[test]
fn well_known_indices() {
    let workshop = Workshop::new();
    let cases = [
        ("n_bk7", 587.56, 1.5168, 0.0, 2e-4),
        ("sf11", 587.56, 1.7847, 0.0, 3e-4),
        ("water", 589.3, 1.3330, 0.0, 1e-3),
        ("diamond", 589.3, 2.417, 0.0, 2e-3),
        ("au", 659.5, 0.14, 3.697, 2e-2),
        ("au", 704.5, 0.13, 4.103, 2e-2),
    ];
    for (id, wavelength_nm, n, k, tolerance) in cases {
        let json = workshop.run(&["ior", id, "--json"]).exits(0).json();
        let [found_n, found_k] = at(&samples(&json), wavelength_nm);
        assert!((found_n - n).abs() < tolerance && (found_k - k).abs() < tolerance, "{id}: {found_n} + {found_k}i");
    }
}

#[test]
fn unknown_sets() {
    let workshop = Workshop::new();
    workshop.run(&["ior", "unobtainium"]).fails(2, &["`unobtainium`; known", "au", "water"]);
    workshop.run(&["ior", "tio2_flim"]).fails(2, &["did you mean `tio2_film`?"]);
    workshop.run(&["ior", ""]).fails(2, &["``"]);
}

/// Oracles: the lecture's printed gold and zinc; what the data sets give in another program's sums (zinc's red differs by 0.211).
#[test]
fn printed_reflectances_beside_computed_ones() {
    let workshop = Workshop::new();
    let json = workshop.run(&["ior", "--f0", "--json"]).exits(0).json();
    let metals = json["metals"].as_array().unwrap();
    assert_eq!((metals.len(), json["dielectrics"].as_array().unwrap().len()), (12, 4));
    let metal = |name: &str| metals.iter().find(|metal| metal["name"] == name).unwrap();
    assert_eq!(metal("Gold")["printed_linear"].as_array().unwrap()[0], 1.022);
    let zinc = metal("Zinc")["difference"][0].as_f64().unwrap();
    assert!((zinc - 0.211).abs() < 6.5e-4, "{zinc}");
    // 0.04 is the F0 of 1.5.
    let plastic = json["dielectrics"][1]["index"][0].as_f64().unwrap();
    assert!((plastic - 1.5).abs() < 1e-12, "{plastic}");
    let text = workshop.run(&["ior", "--f0"]).exits(0).stdout;
    for entry in metals.iter().chain(json["dielectrics"].as_array().unwrap()) {
        let name = entry["name"].as_str().unwrap();
        assert_eq!(text.lines().filter(|line| line.starts_with(name)).count(), 1, "{name}");
    }
    workshop.run(&["ior", "au", "--f0"]).fails(2, &["--f0"]);
}
