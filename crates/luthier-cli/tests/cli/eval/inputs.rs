//! Inputs that some models take, and inputs that they refuse.

use luthier_workshop::material_texts::{filmed, gold, lacquer, matte};

use crate::workshop::Workshop;

const PAIR: [&str; 6] = ["--wi", "30,0", "--wo", "45,180", "--wavelength", "550"];

fn workshop() -> Workshop {
    Workshop::with(&[
        ("m.toml", &matte("m")),
        ("l.toml", &lacquer("l")),
        ("g.toml", &gold("g")),
        ("f.toml", &filmed("f")),
        ("p.toml", PATINATED),
    ])
}

/// A coat that grew over a metal.
const PATINATED: &str = "schema = 1\nname = \"p\"

[[layer]]
type = \"dielectric\"
ior = 2.5
roughness = 0.6

[[layer]]
type = \"conductor\"
ior = \"cu\"
roughness = 0.4
";

/// A coat over what follows.
const COAT: &str = "schema = 1\nname = \"b\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n";

/// The value, and the name of the material that it is of.
fn eval(workshop: &Workshop, file: &str, model: &str, more: &[&str]) -> (f64, String) {
    let args = [&["eval", file, "--model", model, "--json"], &PAIR[..], more].concat();
    let json = workshop.run(&args).exits(0).json();
    (json["values"][0]["value"][0].as_f64().unwrap(), json["material"].as_str().unwrap().to_owned())
}

/// Flakes seen from far away are Elek's model: the tilt of a single flake no longer shows.
#[test]
fn flakes_at_a_place_and_a_distance() {
    let workshop = workshop();
    let of = |more: &[&str]| eval(&workshop, "p.toml", "flakes", more).0;
    let plain = eval(&workshop, "p.toml", "elek", &[]).0;
    assert!((of(&["--distance", "1e9"]) / plain - 1.0).abs() < 1e-6);
    assert!((of(&["--uv", "0.3,0.6", "--distance", "1e9"]) / plain - 1.0).abs() < 1e-6);
    let [mean, here, there] = [of(&[]), of(&["--uv", "0.3,0.6"]), of(&["--uv=-0.31,0.6"])];
    assert!(mean != here && here != there && mean != plain);
}

/// A coat with a weight is the mean, by that, of the file without the weight and of the file without the coat: in models that show it, and in those that have no
/// shader. `lobes` is fitted at both ends, and is within its own error.
#[test]
fn a_weight_is_the_mean_of_two_files() {
    let workshop = workshop();
    let coated = PATINATED.replacen("roughness = 0.6\n", "roughness = 0.6\nweight = 0.4\n", 1);
    let bare = PATINATED.split("\n\n").filter(|part| !part.contains("dielectric")).collect::<Vec<_>>().join("\n\n");
    workshop.write("w.toml", &coated);
    workshop.write("w0.toml", coated.replace("0.4\n\n", "0\n\n"));
    workshop.write("b.toml", &bare);
    for (model, more, tolerance) in [
        ("elek", &[][..], 1e-12),
        ("weidlich-wilkie", &[], 1e-12),
        ("layered-mc", &["--samples", "256"], 1e-12),
        ("lobes", &[], 0.02),
    ] {
        let of = |file: &str, at: &[&str]| eval(&workshop, file, model, &[more, at].concat()).0;
        let [all, below] = [of("p.toml", &[]), of("b.toml", &[])];
        assert!((all / below - 1.0).abs() > 0.01);
        let mean = |weight: f64| weight * all + (1.0 - weight) * below;
        let near = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < tolerance, "{model}: {found} {expected}")
        };
        near(of("w.toml", &[]), mean(0.4));
        near(of("w0.toml", &[]), below);
        near(of("w.toml", &["--weight-factor", "0.5"]), mean(0.2));
        near(of("w.toml", &["--weight-factor", "9"]), all);
    }
    // A furnace and an environment are blends, too.
    for what in ["--furnace", "--environment"] {
        let of = |file: &str| -> f64 {
            let run = workshop.run(&["eval", file, "--model", "elek", what, "--angles", "40"]).exits(0);
            run.stdout.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap()
        };
        let [all, below, blend] = ["p.toml", "b.toml", "w.toml"].map(of);
        assert!((blend - (0.4 * all + 0.6 * below)).abs() < 2e-6 && (all - below).abs() > 0.01, "{what}: {blend}");
    }
    workshop
        .run(&[&["eval", "b.toml", "--model", "elek", "--weight-factor", "1"], &PAIR[..]].concat())
        .fails(2, &["b.toml has no coat or film with a weight", "leave --weight-factor out"]);
    // What a model leaves out is told, and is not there.
    let args = [&["eval", "w.toml", "--model", "belcour"], &PAIR[..]].concat();
    let run = workshop.run(&args).exits(0);
    assert!(run.stderr.contains("does not show the weight of the coat"), "{}", run.stderr);
    assert_eq!(eval(&workshop, "w.toml", "belcour", &[]).0, eval(&workshop, "p.toml", "belcour", &[]).0);
    workshop
        .run(&[&["eval", "w.toml", "--model", "layered-mc", "--slab-factor", "2"], &PAIR[..]].concat())
        .fails(2, &["--slab-factor"]);
}

/// A factor on a part that the file lacks is told, and so is anisotropy that a model has not.
#[test]
fn options_that_change_nothing_are_told() {
    let workshop = workshop();
    let metal = |surface: &str| {
        format!("schema = 1\nname = \"metal\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\n{surface}")
    };
    workshop.write("metal.toml", metal("alpha = 0.2\n"));
    workshop.write("brushed.toml", metal("alpha_x = 0.1\nalpha_y = 0.4\n"));
    let told = |file: &str, model: &str, more: &[&str]| {
        let run = workshop.run(&[&["eval", file, "--model", model], &PAIR[..], more].concat()).exits(0);
        run.stderr.lines().filter(|line| line.starts_with("note: ")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(told("metal.toml", "elek", &["--alpha-factor", "0.5"]), [""; 0]);
    for (option, part) in [("--slab-factor", "no slab is below"), ("--film-factor", "no film is on")] {
        let told = told("metal.toml", "elek", &[option, "0.5"]);
        assert!(told.len() == 1 && told[0].contains(option) && told[0].contains(part), "{told:?}");
    }
    let told = ["elek", "yamaguchi"].map(|model| told("brushed.toml", model, &[]).join(" "));
    assert!(told[0].contains("leaves out anisotropy of brushed.toml") && !told[1].contains("anisotropy"), "{told:?}");
}

/// None below 0, all above 1; the ends are the stack without and with its first layer.
#[test]
fn patina_grows_with_its_extent() {
    let workshop = workshop();
    let of = |more: &[&str]| eval(&workshop, "p.toml", "patina", more).0;
    workshop.edit("p.toml", |text| {
        text.replace("type = \"dielectric\"\nior = 2.5", "type = \"dielectric\"\nior = 1.000001")
    });
    let all = of(&["--extent", "2"]);
    // A layer that is all but air: patina adds its diffuse term alone, 0.3 cos 30 / pi.
    let none = of(&["--extent=-1"]);
    let diffuse = 0.3 * libm::sqrt(0.75) / std::f64::consts::PI;
    // The clamp that stands for blur makes the metal as rough as the coat: the lobes differ.
    assert!(all > diffuse && none > 0.0, "{all} {none}");
    assert!((of(&["--extent", "0.5", "--map", "0.5"]) - 0.5 * (all + none)).abs() < 1e-9 * all);
    assert_eq!(of(&["--extent", "0.5", "--map", "1"]), none);
}

/// A deviated inner boundary of a film: turned by nothing it is the model without the option, tilted the light goes elsewhere.
#[test]
fn a_film_with_boundaries_of_its_own() {
    let workshop = workshop();
    let of = |more: &[&str]| eval(&workshop, "f.toml", "granier-heidrich", more).0;
    assert_eq!(of(&["--inner-normal", "0,0"]), of(&[]));
    assert!((of(&["--inner-normal", "6,0"]) / of(&[]) - 1.0).abs() > 1e-2);
}

/// Places of both materials, each with the value of its own.
#[test]
fn two_materials_share_a_surface() {
    let workshop = workshop();
    let plain = |file| eval(&workshop, file, "weidlich-wilkie", &[]).0;
    let (gold, matte) = (plain("g.toml"), plain("m.toml"));
    for model in ["heterogeneous", "heterogeneous-switch"] {
        let mut seen = Vec::new();
        for place in ["0.1,0.1", "0.2,0.7", "0.5,0.3", "0.9,0.9", "0.33,0.61", "0.71,0.12", "0.05,0.55", "0.82,0.41"] {
            let (value, name) = eval(&workshop, "g.toml", model, &["--uv", place, "--other", "m.toml"]);
            assert_eq!(value, if name == "g" { gold } else { matte }, "{model} {place} {name}");
            seen.push(name);
        }
        assert!(seen.contains(&"g".to_owned()) && seen.contains(&"m".to_owned()), "{model}: {seen:?}");
        assert_eq!(eval(&workshop, "g.toml", model, &["--uv", "0.2,0.7"]), (gold, "g".to_owned()));
    }
    let glitter = |x: u32| eval(&workshop, "g.toml", "heterogeneous-glitter", &["--uv", &format!("0.{x}7,0.5")]).0;
    let tilted = (0..10).filter(|&x| glitter(x) != gold).count();
    assert!((1..10).contains(&tilted), "{tilted}");
}

/// Textures act on every model: halved slope parameters, thicker slabs and films are those of another file.
#[test]
fn textures_act_on_every_model() {
    let workshop = workshop();
    workshop.write("thick.toml", workshop.text("f.toml").replace("thickness_nm = 300", "thickness_nm = 450"));
    workshop.write("slab.toml", workshop.text("f.toml").replace("thickness_um = 1", "thickness_um = 3"));
    workshop.write("fine.toml", workshop.text("f.toml").replace("alpha = 0.2", "alpha = 0.1"));
    for (option, factor, other) in [
        ("--film-factor", "1.5", "thick.toml"),
        ("--slab-factor", "3", "slab.toml"),
        ("--alpha-factor", "0.5", "fine.toml"),
    ] {
        for model in ["elek", "weidlich-wilkie-corrected", "closed-form"] {
            let (found, expected) =
                (eval(&workshop, "f.toml", model, &[option, factor]).0, eval(&workshop, other, model, &[]).0);
            assert!((found / expected - 1.0).abs() < 1e-12, "{option} {model}: {found} {expected}");
        }
    }
    // The prefiltered film too, in its own colour.
    let rgb = |file: &str, more: &[&str]| {
        let args = ["eval", file, "--model", "microfacet-belcour-barla", "--wi", "30,0", "--wo", "30,180"];
        workshop.run(&[&args, more].concat()).exits(0).stdout
    };
    assert_eq!(rgb("f.toml", &["--film-factor", "1.5"]), rgb("thick.toml", &[]));
    assert_ne!(rgb("f.toml", &[]), rgb("f.toml", &["--three-wavelengths"]));
    // Lambert's surface seen through a tilted normal: the cosine against it, 30 degrees less 10.
    let found = eval(&workshop, "m.toml", "lambert", &["--normal", "10,0"]).0;
    let expected = 0.3 * libm::cos(20f64.to_radians()) / std::f64::consts::PI;
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
}

/// Sixteen times the samples, a quarter of the standard error; another seed, another value within their errors.
#[test]
fn estimates_take_samples_and_a_seed() {
    let workshop = workshop();
    for model in ["random-walk", "layered-mc", "layered-mc-one-facet"] {
        let of = |more: &[&str]| {
            let args = [&["eval", "p.toml", "--model", model, "--json"], &PAIR[..], more].concat();
            let json = workshop.run(&args).exits(0).json();
            ["value", "std_err"].map(|key| json["values"][0][key][0].as_f64().unwrap())
        };
        let ([few, few_err], [many, many_err]) = (of(&["--samples", "20000"]), of(&["--samples", "320000"]));
        assert!((0.15..0.4).contains(&(many_err / few_err)), "{model}: {few_err} {many_err}");
        let [other, other_err] = of(&["--samples", "20000", "--seed", "7"]);
        assert!(other != few && (other - few).abs() < 5.0 * (few_err + other_err), "{model}: {few} {other}");
        assert!((many - few).abs() < 5.0 * few_err, "{model}: {few} {many}");
    }
    workshop
        .run(&[&["eval", "p.toml", "--model", "layered-mc"], &PAIR[..], &["--samples", "0"]].concat())
        .fails(2, &["1.."]);
}

/// By hand: with all weight on its base, the density of a surface is the cosine over pi.
#[test]
fn layers_are_drawn_by_weights_of_ones_own() {
    let workshop = workshop();
    workshop.write("b.toml", format!("{COAT}[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n"));
    let of = |weights: &[&str]| eval(&workshop, "b.toml", "density-layers-local", weights).0;
    let base = libm::cos(30.0_f64.to_radians()) / std::f64::consts::PI;
    assert!((of(&["--weights", "0,2"]) / base - 1.0).abs() < 1e-12);
    let (half, coat) = (of(&["--weights", "3,3"]), of(&["--weights", "1,0"]));
    assert!((half - 0.5 * (base + coat)).abs() < 1e-12 && (half / of(&[]) - 1.0).abs() > 1e-3);
}

#[test]
fn what_models_do_not_take_is_refused() {
    let workshop = workshop();
    let refuses = |model: &str, more: &[&str], parts: &[&str]| {
        workshop.run(&[&["eval", "f.toml", "--model", model], &PAIR[..], more].concat()).fails(2, parts);
    };
    refuses("elek", &["--uv", "0,0"], &["`elek` does not take --uv", "flakes", "heterogeneous"]);
    refuses("patina", &["--distance", "2"], &["--distance", "flakes"]);
    refuses("flakes", &["--extent", "1"], &["--extent", "patina"]);
    refuses("flakes", &["--map", "1"], &["--map", "patina"]);
    refuses("elek", &["--inner-normal", "1,0"], &["--inner-normal", "granier-heidrich"]);
    refuses("elek", &["--other", "m.toml"], &["--other", "heterogeneous"]);
    refuses("elek", &["--samples", "9"], &["--samples", "layered-mc"]);
    refuses("elek", &["--weights", "1,1"], &["--weights", "density-layers-local"]);
    refuses("density-layers-local", &["--weights", "1"], &["--weights has 1 numbers", "each of the"]);
    refuses("density-layers-local", &["--weights", "0,0,0,0"], &["--weights has 4 numbers"]);
    refuses("density-layers-local", &["--weights=-1,1"], &["from 0 up"]);
    refuses("flakes", &["--uv", "0.1"], &["texture coordinate"]);
    refuses("flakes", &["--uv", "0.1,x"], &["texture coordinate"]);
    refuses("flakes", &["--distance=-1"], &["from 0 up"]);
    refuses("patina", &["--map", "1.5"], &["0 to 1"]);
    refuses("patina", &["--extent", "nan"], &["expected a number"]);
    refuses("elek", &["--alpha-factor=-1"], &["from 0 up"]);
    refuses("elek", &["--normal", "95,0"], &["0 to 90"]);
    let tilted_albedo = ["eval", "f.toml", "--model", "elek", "--furnace", "--normal", "10,0"];
    workshop.run(&tilted_albedo).fails(2, &["--normal"]);
    let missing = ["eval", "g.toml", "--model", "heterogeneous", "--other", "no.toml"];
    workshop.run(&[&missing[..], &PAIR].concat()).fails(3, &["no.toml"]);
}
