//! Reflectances in place of indices: what `f0` and `metallic-roughness` become.

use luthier_material::{Parsed, parse};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};

const COPPER: &str = "[0.955, 0.638, 0.538]";

fn parsed(body: &str) -> Parsed {
    let text = format!("schema = 1\nname = \"x\"\n{body}");
    let parsed = parse("x.toml", &text, &|_| Err(std::io::Error::other("none")));
    parsed.unwrap_or_else(|errors| panic!("{}", errors[0].render(&text)))
}

fn stack(body: &str) -> Stack {
    let Parsed { material, warnings } = parsed(body);
    assert!(warnings.is_empty(), "{body}: {warnings:?}");
    material.stack
}

fn reflectance(stack: &Stack, layer: usize, cos_theta: f64) -> [f64; 3] {
    Interface::of(stack, layer).unwrap().sampled(&Color::Spectral).rgb(cos_theta)
}

fn index(stack: &Stack, layer: usize) -> f64 {
    match &stack.layers[layer].base {
        Base::Dielectric { ior, .. } => ior.at(589.3).re,
        other => panic!("{other:?}"),
    }
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
}

#[test]
fn a_conductor_takes_an_f0() {
    let metal = stack(&format!("[[layer]]\ntype = \"conductor\"\nf0 = {COPPER}\nsmooth = true\n"));
    // (1 - cos 60)^5 = 1/32.
    for (found, f0) in reflectance(&metal, 0, 0.5).into_iter().zip([0.955, 0.638, 0.538]) {
        close(found, f0 + (1.0 - f0) / 32.0);
    }
}

/// The index is the given one, or that of the mean F0: (1 + .2)/(1 - .2) = 1.5 times the index above.
#[test]
fn a_dielectric_has_an_index_beside_its_f0() {
    let base = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";
    let coat = |lines: &str| format!("[[layer]]\ntype = \"dielectric\"\nsmooth = true\n{lines}\n");
    close(index(&stack(&(coat("f0 = [0.03, 0.04, 0.05]") + base)), 0), 1.5);
    close(index(&stack(&(coat("f0 = 0.04\nior = 1.33") + base)), 0), 1.33);
    let under_water = stack(&("exterior = 1.33\n".to_owned() + &coat("f0 = 0.04") + base));
    close(index(&under_water, 0), 1.5 * 1.33);
    let two = stack(&(coat("ior = 1.4") + &coat("f0 = 0.04") + base));
    close(index(&two, 1), 1.5 * 1.4);
    close(reflectance(&two, 1, 1.0)[1], 0.04);
}

/// glTF 2.0, appendix B, and the exercise of the lecture: F0 goes from 0.04 to the base colour, and what shows of the base is the base colour
/// times 1 - metallic. The reflectance of the whole by hand: with t = (1 - f)(20/21) / 1.5^2 the base returns r t / (1 - r (1 - t)).
#[test]
fn the_surface_of_engines_is_two_layers() {
    for metallic in [0.0, 0.25, 0.5, 0.75] {
        let surface = stack(&format!(
            "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = {COPPER}\nmetallic = {metallic}\nroughness = 0.4\nsigma = 0.2\n"
        ));
        assert_eq!(surface.layers.len(), 2);
        assert!((surface.layers[0].surface.alpha_x - 0.16).abs() < 1e-12);
        close(index(&surface, 0), 1.5);
        let Base::Diffuse(base) = &surface.layers[1].base else { panic!("{surface:?}") };
        close(base.sigma, 0.2);
        for (i, color) in [0.955, 0.638, 0.538].into_iter().enumerate() {
            let f0 = reflectance(&surface, 0, 1.0)[i];
            close(f0, 0.04 + metallic * (color - 0.04));
            let (r, t) = (base.albedo[i], (1.0 - f0) * (20.0 / 21.0) / 2.25);
            close(r * t / (1.0 - r * (1.0 - t)), color * (1.0 - metallic));
        }
    }
    // The lecture's middle of the grid: red .4975 + .5025 .4775 = .737.
    let metal =
        stack(&format!("[[layer]]\ntype = \"metallic-roughness\"\nbase_color = {COPPER}\nmetallic = 1\nalpha = 0.1\n"));
    assert!(matches!(metal.layers.as_slice(), [only] if matches!(only.base, Base::Conductor { .. })), "{metal:?}");
    close(reflectance(&metal, 0, 1.0)[1], 0.638);
    let coated = stack(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.6\nsmooth = true\n[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.5\nalpha = 0.1\n",
    );
    close(index(&coated, 1), 2.4);
    // Where a coat has a weight, the surface beside it bends light by the same ratio.
    close(index(&coated.without_first(), 0), 1.5);
}

#[test]
fn a_sigma_of_a_metal_is_doubted() {
    let metal =
        "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.9\nmetallic = 1\nsmooth = true\nsigma = 0.2\n";
    let warnings = parsed(metal).warnings;
    assert!(warnings.len() == 1 && warnings[0].message.contains("sigma"), "{warnings:?}");
}

#[test]
fn an_f0_of_no_clear_medium_is_doubted() {
    let warnings = parsed("[[layer]]\ntype = \"dielectric\"\nf0 = [0.9, 0.6, 0.3]\nsmooth = true\n").warnings;
    assert!(warnings.len() == 1 && warnings[0].message.contains("0.9"), "{warnings:?}");
}

/// Wood below varnish that does not darken it. K of index 1.5 is 0.596346 by quadrature in another language, so that the base shows
/// 0.4 / (1 - K + 0.4 K) = 0.622866, and in the same way 0.452292 and 0.252517; the rest is as in `a_mixture_is_a_dielectric_over_a_base`.
#[test]
fn a_coat_need_not_darken_its_base() {
    const SHOWN: [f64; 3] = [0.622_866, 0.452_292, 0.252_517];
    let file = |coat: &str, base: &str| {
        format!("[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n{coat}\n[[layer]]\n{base}\n")
    };
    const WOOD: &str = "base_color = [0.4, 0.25, 0.12]\nroughness = 0.5";
    let engine = format!("type = \"metallic-roughness\"\n{WOOD}");
    let base = |text: &str| match stack(text).layers.pop().unwrap().base {
        Base::Diffuse(diffuse) => diffuse.albedo,
        Base::Conductor { ior } => ior.f0().unwrap(),
        other => panic!("{other:?}"),
    };
    let t = 0.96 * 20.0 / 21.0 / 2.25;
    let albedo = base(&file("darkening = false", &engine));
    for (r, shown) in albedo.into_iter().zip(SHOWN) {
        assert!((r * t / (1.0 - r * (1.0 - t)) - shown).abs() < 2e-6, "{r} {shown}");
    }
    let matt = base(&file("darkening = false", "type = \"diffuse\"\nalbedo = [0.4, 0.25, 0.12]"));
    assert!(matt.into_iter().zip(SHOWN).all(|(found, shown)| (found - shown).abs() < 1e-6), "{matt:?}");
    // The index over that of the exterior decides: 1.5 x 1.33 in water of 1.33.
    let water = file("darkening = false", &engine).replace("ior = 1.5", "ior = 1.995");
    assert!(base(&format!("exterior = 1.33\n{water}")).into_iter().zip(albedo).all(|(a, b)| (a - b).abs() < 1e-9));
    // A coat that is absent darkens nothing, and one that is said to darken is as one that is not.
    let none = base(&file("weight = 0\ndarkening = false", "type = \"diffuse\"\nalbedo = 0.4"));
    assert!(none.into_iter().all(|found| (found - 0.4).abs() < 1e-12), "{none:?}");
    assert_eq!(stack(&file("darkening = true", &engine)), stack(&file("", &engine)));
    // A mirror returns light along the normal, where the coat sends 0.04 of it back: 0.5 / (0.96 + 0.04 x 0.5).
    for metal in ["conductor\"\nf0 = 0.5", "metallic-roughness\"\nbase_color = 0.5\nmetallic = 1"] {
        let f0 = base(&file("darkening = false", &format!("type = \"{metal}\nsmooth = true")));
        assert!(f0.into_iter().all(|found| (found - 0.510_204).abs() < 1e-6), "{metal}: {f0:?}");
    }
}

/// Where no base has a colour, or no place could have one of its own.
#[test]
fn darkening_is_of_a_coat_above_a_colour() {
    let coat = |lines: &str| format!("[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n{lines}\n");
    let undarkened = coat("darkening = false");
    let base = "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.5\nroughness = 0.5\n";
    let weighted = coat("darkening = false\nmaps = { weight = \"w.png\" }");
    let cases = [
        (undarkened.clone(), "no base"),
        (undarkened.clone() + &coat("") + base, "another dielectric"),
        (coat("") + &undarkened + base, "only the first layer"),
        (
            undarkened.clone() + "[[layer]]\ntype = \"conductor\"\nior = \"cu\"\nsmooth = true\n",
            "`f0` in place of its `ior`",
        ),
        (
            undarkened.clone() + "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\nmaps = { albedo = \"a.png\" }\n",
            "with a map of `base_color`",
        ),
        (weighted.clone() + base, "white.png"),
        (weighted + "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n", "with a map of `base_color`"),
        (coat("") + &base.replace("base_color", "darkening = false\nbase_color"), "of the coat above"),
        (
            undarkened + base + "[effects.patina]\nextent = 0.5\ntransition = 0.2\nmap = { noise = { seed = 1 } }\n",
            "beside `patina`",
        ),
    ];
    for (body, part) in cases {
        let text = format!("schema = 1\nname = \"x\"\n{body}");
        let errors = parse("x.toml", &text, &|_| Err(std::io::Error::other("none"))).unwrap_err();
        let told = errors.iter().map(|error| error.render(&text)).collect::<String>();
        assert!(errors.len() == 1 && errors[0].hint.is_some() && told.contains(part), "{body}: {told}");
    }
}

/// OpenPBR 1.1, metal, typed from its page with the numbers of the cosine 1/7, of metals by both types, and of a mixture by its share.
#[test]
fn metals_have_an_edge_tint() {
    const TINT: [f64; 3] = [0.6, 0.8, 1.0];
    let schlick = |f0: f64, mu: f64| f0 + (1.0 - f0) * libm::pow(1.0 - mu, 5.0);
    let tinted = |f0: f64, tint: f64, mu: f64| {
        let depth = schlick(f0, 1.0 / 7.0) * (1.0 - tint) * 7.0 / libm::pow(6.0 / 7.0, 6.0);
        schlick(f0, mu) - depth * mu * libm::pow(1.0 - mu, 6.0)
    };
    for head in [
        format!("type = \"conductor\"\nf0 = {COPPER}"),
        format!("type = \"metallic-roughness\"\nbase_color = {COPPER}\nmetallic = 1"),
    ] {
        let metal = stack(&format!("[[layer]]\n{head}\nf82_tint = [0.6, 0.8, 1.0]\nsmooth = true\n"));
        assert_eq!(metal.layers.len(), 1);
        for mu in [0.0, 0.05, 1.0 / 7.0, 0.5, 1.0] {
            let found = reflectance(&metal, 0, mu);
            [0.955, 0.638, 0.538]
                .iter()
                .zip(TINT)
                .zip(found)
                .for_each(|((f0, tint), found)| close(found, tinted(*f0, tint, mu)));
        }
    }
    let mixed = stack(&format!(
        "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = {COPPER}\nmetallic = 0.25\nf82_tint = [0.6, 0.8, 1.0]\nsmooth = true\n"
    ));
    let Base::Diffuse(base) = &mixed.layers[1].base else { panic!("{mixed:?}") };
    for (i, (color, tint)) in [0.955, 0.638, 0.538].into_iter().zip(TINT).enumerate() {
        let at = |mu: f64| 0.25 * tinted(color, tint, mu) + 0.75 * schlick(0.04, mu);
        close(reflectance(&mixed, 0, 0.2)[i], at(0.2));
        // Simpson's rule has the light that the interface passes; the base shows the colour through it.
        let steps = 2000;
        let weight = |i: u32| if i == 0 || i == steps { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
        let mean = (0..=steps).map(|i| {
            let mu = f64::from(i) / f64::from(steps);
            weight(i) * 2.0 * mu * at(mu) / f64::from(3 * steps)
        });
        let (r, t) = (base.albedo[i], (1.0 - mean.sum::<f64>()) / 2.25);
        assert!((r * t / (1.0 - r * (1.0 - t)) - 0.75 * color).abs() < 1e-9, "{r} {t}");
    }
}

#[test]
fn edge_tints_of_other_interfaces_are_refused() {
    let errors = |body: &str| {
        let text = format!("schema = 1\nname = \"x\"\n{body}");
        let errors = parse("x.toml", &text, &|_| Err(std::io::Error::other("none"))).unwrap_err();
        errors.iter().map(|error| error.render(&text)).collect::<Vec<_>>().join("\n")
    };
    let of_index = errors("[[layer]]\ntype = \"conductor\"\nior = \"cu\"\nf82_tint = 0.5\nsmooth = true\n");
    assert!(of_index.contains("x.toml:6") && of_index.contains("`f82_tint` is for a metal with an `f0`"), "{of_index}");
    let glass = errors("[[layer]]\ntype = \"dielectric\"\nior = 1.5\nf82_tint = 0.5\nsmooth = true\n");
    assert!(glass.contains("an edge tint is for metals"), "{glass}");
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.4\nthickness_nm = 300\n";
    for metal in ["type = \"conductor\"\nf0 = 0.5", "type = \"metallic-roughness\"\nbase_color = 0.5\nmetallic = 1"] {
        let below_film = errors(&format!("{film}[[layer]]\n{metal}\nf82_tint = 0.5\nsmooth = true\n"));
        assert!(below_film.contains("an edge tint below a film"), "{below_film}");
    }
    let bright = errors("[[layer]]\ntype = \"conductor\"\nf0 = 0.5\nf82_tint = 1.2\nsmooth = true\n");
    assert!(bright.contains("f82_tint"), "{bright}");
    let none = "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.5\nf82_tint = 0.5\nsmooth = true\n";
    assert!(parsed(none).warnings[0].message.contains("of no consequence"));
}
