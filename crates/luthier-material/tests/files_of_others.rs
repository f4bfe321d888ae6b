//! Numbers and files as others write them: what is odd is read, with a warning; what is wrong has a place and a way out.

use std::io;

use luthier_material::{Diagnostic, Parsed, parse};
use luthier_optics::stack::Base;

fn read(body: &str, file: &str) -> Result<Parsed, Vec<Diagnostic>> {
    let text = format!("schema = 1\nname = \"x\"\n{body}");
    let file = file.to_owned();
    parse("x.toml", &text, &move |name| {
        if name.starts_with("file.") { Ok(file.clone()) } else { Err(io::Error::other("none")) }
    })
}

fn words(diagnostics: &[Diagnostic]) -> String {
    let line =
        |d: &Diagnostic| format!("{}:{} {} | {}\n", d.line, d.column, d.message, d.hint.clone().unwrap_or_default());
    diagnostics.iter().map(line).collect()
}

fn layer(kind: &str, rest: &str) -> String {
    format!("[[layer]]\ntype = \"{kind}\"\n{rest}\n")
}

#[test]
fn reflectances_a_little_above_one_are_one() {
    for (body, place) in [
        (layer("conductor", "f0 = [1.0629, 0.774, 0.3073]\nroughness = 0.1"), "5:7"),
        (layer("metallic-roughness", "base_color = [1.7, 0.5, 0.2]\nmetallic = 1\nroughness = 0.1"), "5:15"),
        (layer("diffuse", "albedo = 1.25"), "5:10"),
    ] {
        let parsed = read(&body, "").unwrap_or_else(|errors| panic!("{body}: {}", words(&errors)));
        let warnings = words(&parsed.warnings);
        assert!(warnings.starts_with(place) && warnings.contains("it is read as 1"), "{body}: {warnings}");
        let first = match &parsed.material.stack.layers[0].base {
            Base::Conductor { ior } => ior.f0().unwrap()[0],
            Base::Diffuse(diffuse) => diffuse.albedo[0],
            Base::Dielectric { .. } => panic!("{body}"),
        };
        assert_eq!(first, 1.0, "{body}");
    }
}

#[test]
fn bytes_and_minuses_are_errors() {
    let found = words(&read(&layer("diffuse", "albedo = [-0.2775, 204, 2.5]"), "").unwrap_err());
    for part in ["found -0.2775", "outside Rec.709", "found 204", "divide by 255: 204 is 0.8", "found 2.5"] {
        assert!(found.contains(part), "{found}");
    }
    assert!(!found.contains("`0.2775`"), "{found}");
    let found = words(&read(&layer("diffuse", "albedo = 0.5\nsigma = -0.2"), "").unwrap_err());
    assert!(found.contains("found -0.2") && !found.contains("= 0"), "{found}");
}

#[test]
fn an_n_of_zero_is_that_of_a_metal() {
    let table =
        "ior = { n = [0, 0.351563, 1.85894], k = [6.59401, 2.08143, 1.49631], wavelengths_nm = [645, 525, 445] }\n";
    let parsed = read(&layer("conductor", &format!("{table}roughness = 0.3")), "").unwrap();
    let Base::Conductor { ior } = &parsed.material.stack.layers[0].base else { panic!() };
    assert_eq!((ior.at(645.0).re, ior.at(645.0).im), (0.0, 6.59401));
    let found = words(&read(&layer("dielectric", &format!("{table}roughness = 0.3")), "").unwrap_err());
    assert!(found.contains("n is 0 at 645 nm") && found.contains("conductor"), "{found}");
    for nothing in ["{ n = 0 }", "{ n = 0, k = 0 }", "{ n = [0, 1], k = 0, wavelengths_nm = [500, 600] }"] {
        let found = words(&read(&layer("conductor", &format!("ior = {nothing}\nroughness = 0.3")), "").unwrap_err());
        assert!(found.contains("nor both 0"), "{nothing}: {found}");
    }
}

#[test]
fn endings_tell_how_a_file_of_an_index_is_read() {
    let csv = "wavelength_nm,n,k\n360,1.5,2\n830,1.5,2\n";
    let yaml = "DATA:\n  - type: tabulated nk\n    data: |\n      0.36 1.5 2\n      0.83 1.5 2\n";
    for (name, text) in [("file.csv", csv), ("file.CSV", csv), ("file.yml", yaml), ("file.yaml", yaml)] {
        let parsed = read(&layer("conductor", &format!("ior = \"{name}\"\nroughness = 0.3")), text).unwrap();
        assert_eq!((parsed.warnings, parsed.material.files), (vec![], vec![name.to_owned()]));
        let Base::Conductor { ior } = &parsed.material.stack.layers[0].base else { panic!() };
        assert_eq!((ior.at(500.0).re, ior.at(500.0).im), (1.5, 2.0), "{name}");
    }
    let index = |text: &str| read(&layer("conductor", "ior = \"file.csv\"\nroughness = 0.3"), text);
    let warned = index("nm,n,k\n360,1.5,2\n830,1.5,-1e-5\n").unwrap().warnings;
    assert!(words(&warned).starts_with("5:7 `file.csv`: negative values of k, 1 in all"), "{}", words(&warned));
    let found = words(&index("nm,n,k\n360,1.5,2\n830,1.5,x\n").unwrap_err());
    assert!(found.starts_with("5:7 `file.csv`: line 3: column 3: `x` is not a number | "), "{found}");
    let found = words(&index("nm,n,k\n0.36,1.5,2\n0.83,1.5,0\n").unwrap_err());
    assert!(found.contains("no sample") && found.contains("were micrometres meant?"), "{found}");
}

/// Coats of assets: shaders raise the slopes of these to alpha 0.001, which nobody sees.
#[test]
fn smooth_coats_raise_no_doubt() {
    for roughness in ["0.02", "0.03"] {
        let coat = layer("dielectric", &format!("ior = 1.5\nroughness = {roughness}"));
        let parsed = read(&format!("{coat}{}", layer("diffuse", "albedo = 0.5")), "").unwrap();
        assert_eq!(parsed.warnings, vec![], "{roughness}");
    }
}

/// Each word of other formats has an advice, and none that the file would be refused for.
#[test]
fn words_of_other_formats_have_an_advice() {
    for (body, advice) in [
        (layer("diffuse", "albedo = 0.5\nemission = [1, 1, 1]"), "the host's business"),
        (layer("sheen", "color = 0.5"), "sheen is not a layer yet"),
        (
            layer("metallic-roughness", "base_color = 0.5\nroughness = 0.3\nclearcoatFactor = 1"),
            "a coat is a layer of its own",
        ),
        (layer("metallic-roughness", "baseColorFactor = 0.5\nroughness = 0.3"), "did you mean `base_color`?"),
        (layer("metallic-roughness", "base_color = 0.5\nroughness = 0.3\nopacity = 1"), "which places are covered"),
        (layer("conductor", "f0 = 1\nroughness = 0.3\nmaps = { base_color = \"c.png\" }"), "a map of its `f0`"),
        (layer("conductor", "color = 1\nroughness = 0.3"), "did you mean `f0`?"),
        (layer("principled", "base_color = 1"), "`type = \"metallic-roughness\"`"),
        (format!("roughness = 0.3\n{}", layer("diffuse", "albedo = 0.5")), "below a `[[layer]]`"),
    ] {
        let found = words(&read(&body, "").unwrap_err());
        assert!(found.contains(advice), "{body}: {found}");
        assert!(!found.contains("-maps"), "{found}");
    }
    let coat = layer("dielectric", "ior = 1.5\nsmooth = true");
    let engine =
        |maps: &str| coat.clone() + &layer("metallic-roughness", &format!("base_color = 0.5\nroughness = 0.3\n{maps}"));
    let found = words(&read(&engine("maps = { normal = \"n.png\" }"), "").unwrap_err());
    assert!(found.contains("write `bumps`") && found.contains("move it to the first layer"), "{found}");
}
