//! Distributions of slopes in files: names, exponents, and parameters of their own.

use luthier_manifest::ShadingModel;
use luthier_material::parse;
use luthier_optics::microfacet::distribution;
use luthier_optics::stack::{Distribution, Surface};

fn read(surface: &str) -> Result<Surface, Vec<String>> {
    let text = format!("schema = 1\nname = \"x\"\n[[layer]]\ntype = \"conductor\"\nior = \"ag\"\n{surface}\n");
    let parsed = parse("x.toml", &text, &|_| Err(std::io::Error::other("none")));
    let parsed = parsed.map_err(|errors| errors.iter().map(|error| error.message.clone()).collect::<Vec<_>>())?;
    assert_eq!(parsed.material.model(), ShadingModel::Elek);
    Ok(parsed.material.stack.layers[0].surface)
}

/// By hand: the exponent of alpha 0.5 is 6, and 2/(n + 2) is 0.01 for n = 198.
#[test]
fn an_exponent_is_a_slope_parameter() {
    let blinn = |alpha| Ok(Surface::isotropic(Distribution::Blinn, alpha));
    assert_eq!(read("distribution = \"blinn\"\nalpha = 0.5"), blinn(0.5));
    assert_eq!(read("distribution = \"blinn\"\nexponent = 6"), blinn(0.5));
    assert_eq!(read("distribution = \"blinn\"\nexponent = 198"), blinn(0.1));
    assert_eq!(read("distribution = \"blinn\"\nexponent = 0"), blinn(1.0));
}

/// Oracles: a uniform distribution, 1/pi, as b goes to 0; GGX near the normal, b = 2/alpha^2 with c = 2, up to the area beyond the horizon.
#[test]
fn parameters_give_the_slope_parameter_of_the_peak() {
    let even = read("abc = { b = 1e-6, c = 1 }").unwrap();
    assert!((even.alpha_x - 1.0).abs() < 1e-5 && even.alpha_x == even.alpha_y);
    let narrow = read("abc = { b = 20000, c = 2 }").unwrap();
    assert!((narrow.alpha_x / 0.01 - 1.0).abs() < 1e-3, "{narrow:?}");
    let sgd = read("sgd = { alpha = 0.1, p = 0.5 }").unwrap();
    let peak = distribution(sgd.distribution, sgd.alpha_x, 1.0, 0.0);
    assert!((peak * std::f64::consts::PI * sgd.alpha_x * sgd.alpha_x - 1.0).abs() < 1e-12);
    assert_eq!((sgd.distribution.name(), sgd.distribution.own_alpha()), ("sgd", Some(sgd.alpha_x)));
}

#[test]
fn one_mistake_is_told_once() {
    for (surface, says) in [
        ("abc = { b = -1, c = 1 }", "`b` must be above 0"),
        ("sgd = { alpha = 0.1, p = 9 }", "`p` must be"),
        ("sgd = { alpha = 10, p = 0.1 }", "wider than one that is even"),
        ("sgd = { alpha = 0.1 }", "`p` is missing"),
        ("distribution = \"phong\"\nalpha = 0.1", "distribution"),
        ("distribution = \"abc\"\nalpha = 0.1", "distribution"),
        ("distribution = \"blinn\"\nexponent = -1", "`exponent`"),
        ("distribution = \"blinn\"\nexponent = 5\nalpha = 0.2", "a second surface"),
        ("distribution = \"blinn\"", "no surface"),
        ("exponent = 5", "`exponent` is a parameter"),
        ("alpha_x = 0.1\nalpha_y = 0.1\ndistribution = \"blinn\"", "isotropic"),
        ("abc = { b = 1, c = 1 }\ndistribution = \"ggx\"", "`abc` is a distribution by itself"),
        ("abc = { b = 1, c = 1 }\nrotation_deg = 3", "`rotation_deg`"),
    ] {
        let errors = read(surface).unwrap_err();
        assert!(errors.len() == 1 && errors[0].contains(says), "{surface}: {errors:?}");
    }
}
