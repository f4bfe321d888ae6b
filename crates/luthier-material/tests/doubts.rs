//! Each warning, and a neighbour of it that is silent.

use std::io;

use luthier_material::{Parsed, parse};

const COAT: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n";
const DIFFUSE: &str = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";

fn parsed(body: &str) -> Parsed {
    let text = format!("schema = 1\nname = \"x\"\n{body}");
    match parse("x.toml", &text, &|_| Err(io::Error::other("none"))) {
        Ok(parsed) => parsed,
        Err(diagnostics) => panic!("{}", diagnostics.iter().map(|d| d.render(&text) + "\n").collect::<String>()),
    }
}

/// The messages and hints of the warnings, one a line.
fn warnings(body: &str) -> String {
    let line = |d: luthier_material::Diagnostic| format!("{} | {}\n", d.message, d.hint.unwrap_or_default());
    parsed(body).warnings.into_iter().map(line).collect()
}

fn layer(kind: &str, rest: &str) -> String {
    format!("[[layer]]\ntype = \"{kind}\"\n{rest}\n")
}

#[test]
fn plain_materials_raise_no_doubt() {
    assert_eq!(warnings(&format!("{COAT}{DIFFUSE}")), "");
    assert_eq!(warnings(&layer("conductor", "ior = \"au\"\nalpha = 0.2")), "");
}

#[test]
fn spectra_that_end_too_early() {
    let cuprite = layer("conductor", "ior = \"cu2o\"\nalpha = 0.2");
    let w = warnings(&cuprite);
    assert!(w.contains("`cu2o` covers 450-690 nm only") && w.contains("360-830 nm"), "{w}");
    let at = |nm: &str| format!("{cuprite}[bake]\ncolor = \"three-wavelengths\"\nwavelengths_nm = {nm}\n");
    assert_eq!(warnings(&at("[690, 550, 450]")), "");
    assert!(warnings(&at("[690, 550, 440]")).contains("over 440-690 nm"));
}

#[test]
fn a_base_smoother_than_its_coat() {
    let stack = |coat: &str, base: &str| {
        layer("dielectric", &format!("ior = 1.5\n{coat}")) + &layer("conductor", &format!("ior = \"au\"\n{base}"))
    };
    let elek = |coat: &str, base: &str| warnings(&(stack(coat, base) + "[bake]\nmodel = \"elek\"\n"));
    let w = elek("slope_deg = 17", "slope_deg = 1");
    assert!(w.contains("smoother") && w.contains("`slope_deg = 17`"), "{w}");
    assert!(elek("alpha = 0.25", "roughness = 0.3").contains("`roughness = 0.5`"));
    assert_eq!(elek("alpha = 0.2", "alpha = 0.2"), "");
    // The default model shows it as it is.
    assert_eq!(warnings(&stack("slope_deg = 17", "slope_deg = 1")), "");
    assert_eq!(warnings(&(layer("dielectric", "ior = 1.5\nalpha = 0.5") + DIFFUSE)), "");
    let by = |model: &str| warnings(&(stack("alpha = 0.3", "alpha = 0.1") + "[bake]\nmodel = \"" + model + "\"\n"));
    assert!(by("elek").contains("`elek` raises it"));
    assert!(by("weidlich-wilkie").contains("as sharp as if it were bare"));
    assert_eq!(by("belcour"), "");
    let chosen = |lower: &str| {
        let bake = format!("[bake]\nmodel = \"weidlich-wilkie\"\nlower_alpha = \"{lower}\"\n");
        warnings(&(stack("alpha = 0.3", "alpha = 0.1") + &bake))
    };
    assert_eq!((chosen("own"), chosen("at-least-above")), (String::new(), String::new()));
}

#[test]
fn interfaces_between_equal_media() {
    assert!(warnings(&format!("{COAT}{COAT}{DIFFUSE}")).contains("reflects nothing"));
    assert!(warnings(&format!("exterior = 1.5\n{COAT}{DIFFUSE}")).contains("reflects nothing"));
    let film = layer("thin-film", "ior = 1.33\nthickness_nm = 300");
    assert_eq!(warnings(&(film + &layer("dielectric", "ior = 1.0\nsmooth = true"))), "");
}

#[test]
fn slabs_that_do_not_count() {
    assert!(warnings(&format!("{COAT}absorption_per_um = 1\n{DIFFUSE}")).contains("without thickness"));
    assert!(warnings(&format!("{COAT}thickness_um = 1\n")).contains("no bottom"));
    assert_eq!(warnings(&format!("{COAT}absorption_per_um = 1\nthickness_um = 1\n{DIFFUSE}")), "");
}

/// Oracle: 4 pi k / lambda by hand: k = 0.1 at 645, 525 and 445 nm gives 1.9483, 2.3936, 2.8239 per um.
#[test]
fn absorption_that_only_the_index_knows() {
    let slab =
        |rest: &str| layer("dielectric", &format!("ior = {{ n = 2, k = 0.1 }}\nsmooth = true\n{rest}")) + DIFFUSE;
    let w = warnings(&slab("thickness_um = 1"));
    assert!(w.contains("`absorption_per_um = [1.9483, 2.3936, 2.8239]`"), "{w}");
    assert_eq!(warnings(&slab("thickness_um = 1\nabsorption_per_um = 2")), "");
    assert_eq!(warnings(&slab("")), "");
}

#[test]
fn metals_without_absorption_and_films_without_colours() {
    assert!(warnings(&layer("conductor", "ior = 1.5\nalpha = 0.2")).contains("k = 0"));
    let film = |nm: &str| layer("thin-film", &format!("ior = 1.33\nthickness_nm = {nm}")) + COAT;
    assert!(warnings(&film("20000")).contains("too thick"));
    assert_eq!(warnings(&film("600")), "");
}

#[test]
fn an_exponent_on_a_linear_axis() {
    let bake = |mapping: &str| format!("{COAT}{DIFFUSE}[bake.distribution]\nmapping = \"{mapping}\"\nexponent = 8\n");
    assert!(warnings(&bake("linear")).contains("no exponent"));
    assert_eq!(warnings(&bake("power")), "");
}

/// A map of a thickness that nothing depends on.
#[test]
fn a_thickness_map_of_a_clear_slab() {
    let mapped = |rest: &str| format!("{COAT}{rest}maps = {{ thickness = \"t.png\" }}\n{DIFFUSE}");
    assert!(warnings(&mapped("thickness_um = 1\n")).contains("nor is this map of it"));
    assert_eq!(warnings(&mapped("thickness_um = 1\nabsorption_per_um = 1\n")), "");
}

/// Three samples at red, green and blue stand for the whole range; samples beside its middle do not.
#[test]
fn samples_beside_the_middle_of_the_visible() {
    let metal =
        |nm: &str| layer("conductor", &format!("ior = {{ n = 1, k = [3, 4], wavelengths_nm = {nm} }}\nalpha = 0.2"));
    assert_eq!(warnings(&metal("[690, 450]")), "");
    assert!(warnings(&metal("[900, 700]")).contains("`ior` covers 700-900 nm only"));
}

#[test]
fn reflectances_that_no_clear_medium_has() {
    let coat = |f0: &str| layer("dielectric", &format!("f0 = {f0}\nalpha = 0.2")) + DIFFUSE;
    assert!(warnings(&coat("[0.3, 0.3, 0.3]")).contains("diamond has 0.17"));
    assert_eq!(warnings(&coat("[0.04, 0.04, 0.04]")), "");
}

/// Indices that differ by less than 2e-4 are the same medium; a hundredth is not, though its square is less than that.
#[test]
fn media_that_are_nearly_equal() {
    let under = |ior: &str| layer("dielectric", &format!("ior = {ior}\nsmooth = true"));
    assert_eq!(warnings(&format!("{COAT}{}{DIFFUSE}", under("1.51"))), "");
    assert!(warnings(&format!("{COAT}{}{DIFFUSE}", under("1.50001"))).contains("reflects nothing"));
}

#[test]
fn tables_that_no_layer_fills() {
    let asks = |kind: &str| warnings(&format!("{COAT}{DIFFUSE}[bake]\nmodel = \"elek\"\ntables = [\"{kind}\"]\n"));
    assert!(asks("phase").contains("no layer has a film"), "{}", asks("phase"));
    assert_eq!(asks("fresnel"), "");
}
