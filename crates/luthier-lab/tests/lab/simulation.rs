//! `simulation`.

use luthier_workshop::material_texts::matte;
use serde_json::Value;

use crate::workshop::Workshop;

/// Oracle: a Lambertian ball is one thing to all models and to the simulation, whatever surrounds it.
#[test]
fn a_matte_ball_is_one_to_all() {
    let workshop = Workshop::with(&[("m.toml", &matte("m"))]);
    let small = ["--size", "16", "--samples", "1024", "--time-size", "8", "--repeats", "1", "--data", "data.json"];
    let run = workshop.run(&[&["simulation", "m.toml"][..], &small].concat());
    if run.lacks_adapter() {
        return;
    }
    let page = run.exits(0).stdout;
    for part in
        ["luthier-lab simulation m.toml --size 16", "Time over that of the model", "| m | 2048 |", "| m | 240 |"]
    {
        assert!(page.contains(part), "no {part} in {page}");
    }
    let data: Value = serde_json::from_str(&workshop.text("data.json")).unwrap();
    let [times, errors] = ["times", "errors"].map(|key| data[key].as_array().unwrap());
    assert_eq!((times.len(), errors.len()), (4 * 5, 3));
    assert!(times.iter().all(|time| time["median_ms"].as_f64().unwrap() > 0.0), "{data}");
    for error in errors {
        let noise = error["noise"].as_f64().unwrap();
        for model in ["yamaguchi", "belcour", "lobes"] {
            // Models draw as many directions as the simulation has samples: their noise is left.
            let rms = error["rms_err"][model].as_f64().unwrap();
            assert!(rms < 2.0 * noise && noise < 0.3 * error["mean"].as_f64().unwrap(), "{model}: {error}");
        }
    }
}
