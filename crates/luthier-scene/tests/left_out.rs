//! The table of what models show, against their f64 twins; and where what they leave out is told.

#![expect(clippy::disallowed_methods, reason = "an oracle decides no bytes")]

use std::f64::consts::{PI, TAU};
use std::io;

use glam::DVec3;
use luthier_layers::twins::real_time::Twin;
use luthier_layers::twins::terms::Exact;
use luthier_manifest::{Feature, Form, ShadingModel};
use luthier_material::left_out;
use luthier_material::{Material, parse};
use luthier_optics::color::Color;
use luthier_scene::{LeaveOut, simplified};

/// Change of values that a shown feature exceeds; a feature that is not shown moves none.
const SHOWN: f64 = 0.02;

fn material(body: &str) -> Material {
    let text = format!("schema = 1\nname = \"x\"\n{body}");
    parse("x.toml", &text, &|_| Err(io::Error::other("none"))).unwrap().material
}

fn layer(kind: &str, rest: &str) -> String {
    format!("[[layer]]\ntype = \"{kind}\"\n{rest}\n")
}

fn film(nm: f64) -> String {
    layer("thin-film", &format!("ior = 1.9\nthickness_nm = {nm}"))
}

fn values(model: ShadingModel, material: &Material) -> Vec<f64> {
    let color = Color::ThreeWavelengths(material.bake.wavelengths_nm());
    let twin = Twin::new(model, &material.stack, material.bake.wavelengths_nm(), color);
    let terms = Exact::new(&material.stack, color);
    let unit = |theta: f64, phi: f64| DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
    let pair = |i: u32| {
        let [a, b, c] = [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|r: f64| (0.5 + r * f64::from(i)).fract());
        let wi = unit(1.4 * a, TAU * b);
        let wo = if i.is_multiple_of(2) { unit(1.4 * c, 2.5 + TAU * b) } else { unit(1.4 * a, PI + 0.3 * c + TAU * b) };
        (wi, wo)
    };
    (0..40).map(pair).flat_map(|(wi, wo)| twin.eval(&terms, wi, wo)).collect()
}

/// The largest change of a value, relative to it; values below a thousandth of the largest do not count.
fn moved(model: ShadingModel, with: &Material, without: &Material) -> f64 {
    let (with, without) = (values(model, with), values(model, without));
    let floor = 1e-3 * with.iter().chain(&without).fold(0.0f64, |a, b| a.max(b.abs()));
    let change = |(a, b): (&f64, &f64)| (a - b).abs() / a.abs().max(b.abs()).max(floor);
    with.iter().zip(&without).map(change).fold(0.0, f64::max)
}

/// A material that has a feature of stacks, for a model, and a word of the line that asks for it.
fn example(feature: Feature, model: ShadingModel) -> Option<(Material, &'static str)> {
    let coat = layer("dielectric", "ior = 1.5\nalpha = 0.3");
    let gold = layer("conductor", "ior = \"au\"\nalpha = 0.3");
    let chalk = layer("diffuse", "albedo = [0.8, 0.5, 0.2]");
    let (body, line) = match feature {
        Feature::InnerInterface => (coat + &gold, "\"conductor\""),
        Feature::Base => (coat + &chalk, "\"diffuse\""),
        Feature::Absorption | Feature::BaseAbsorption => (
            layer("dielectric", "ior = 1.5\nalpha = 0.3\nthickness_um = 1\nabsorption_per_um = 1")
                + if feature == Feature::Absorption { &gold } else { &chalk },
            "absorption_per_um",
        ),
        Feature::Films => (film(140.0) + &coat + &chalk, "\"thin-film\""),
        Feature::InnerFilms => (film(140.0) + &film(90.0).replace("1.9", "1.4") + &coat + &chalk, "\"thin-film\""),
        // A model of the first layer has the base as its first layer.
        Feature::DiffuseSlopes if model == ShadingModel::Microfacet => (chalk + "sigma = 0.6\n", "sigma"),
        Feature::DiffuseSlopes => (coat + &chalk + "sigma = 0.6\n", "sigma"),
        Feature::Anisotropy => {
            (layer("conductor", "ior = \"au\"\nalpha_x = 0.1\nalpha_y = 0.9\nrotation_deg = 20"), "alpha_x")
        }
        Feature::Beckmann => (gold + "distribution = \"beckmann\"\n", "distribution"),
        _ => return None,
    };
    Some((material(&body), line))
}

/// Twins of the `baked` form, whose tables are of exact terms, show what the table says; the shaders themselves are run in tests of
/// luthier-shader.
#[test]
fn twins_show_what_the_table_says() {
    let (mut wrong, mut tried) = (Vec::new(), 0);
    for model in ShadingModel::ALL {
        for feature in Feature::ALL {
            let Some((with, _)) = example(feature, model) else { continue };
            let without = simplified(&with, &[LeaveOut::Feature(feature)]).unwrap_or_else(|| {
                let mut top = with.clone();
                top.stack.layers.truncate(1);
                top.layers.truncate(1);
                top
            });
            let change = moved(model, &with, &without);
            let says = model.honours(feature, Form::Baked);
            // Energies know the distribution, lobes do not: those of the `full` form are compared in luthier-shader.
            let is_energy =
                feature == Feature::Beckmann && matches!(model, ShadingModel::Belcour | ShadingModel::Yamaguchi);
            if is_energy {
                continue;
            }
            tried += 1;
            if says != (change > SHOWN) || !says && change > 1e-9 {
                wrong.push(format!("{} {feature:?}: {says} in the table, moved by {change}", model.name()));
            }
        }
    }
    assert_eq!(tried, 70);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Each is told once, where the file asks for it, exactly where the table says so.
#[test]
fn what_is_left_out_is_told_where_it_stands() {
    for model in ShadingModel::ALL {
        for feature in Feature::ALL {
            let Some((material, line)) = example(feature, model) else { continue };
            // Nothing is told of what lies in front of a layer that is left out.
            let needed = match feature {
                Feature::Absorption => Some(Feature::InnerInterface),
                Feature::BaseAbsorption => Some(Feature::Base),
                _ => None,
            };
            if needed.is_some_and(|layer| !model.honours(layer, Form::Baked)) {
                continue;
            }
            let told = left_out(&material, model);
            let found = told.iter().find(|part| part.feature == feature);
            let forms: Vec<Form> = Form::ALL.into_iter().filter(|&form| !model.honours(feature, form)).collect();
            assert_eq!(found.map(|part| part.forms.clone()).unwrap_or_default(), forms, "{} {feature:?}", model.name());
            let Some(part) = found else { continue };
            let number: usize = material.place(&part.key).rsplit(':').next().unwrap().parse().unwrap();
            let text = material.text.lines().nth(number - 1).unwrap();
            assert!(text.contains(line), "{} {feature:?}: `{text}`", model.name());
        }
    }
}

#[test]
fn effects_and_maps_are_told() {
    let body = layer("dielectric", "ior = 1.5\nalpha = 0.3\nthickness_um = 1\nabsorption_per_um = 1")
        + "maps = { normal = \"n.png\", roughness = \"r.png\", thickness = \"t.png\" }\n"
        + &layer("conductor", "ior = \"au\"\nalpha = 0.3")
        + "[effects.flakes]\ncells = {}\n[effects.glitter]\n[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = { noise = {} }\n";
    let material = material(&body);
    let told = |model| -> Vec<Feature> { left_out(&material, model).into_iter().map(|part| part.feature).collect() };
    assert_eq!(told(ShadingModel::Elek), []);
    assert_eq!(told(ShadingModel::Belcour), [Feature::Flakes, Feature::Patina]);
    // Rows of lobes are over one factor.
    assert_eq!(told(ShadingModel::Lobes), [Feature::ThicknessMap, Feature::Patina]);
    assert_eq!(told(ShadingModel::Phong), [Feature::ThicknessMap, Feature::Flakes, Feature::Patina]);
    // Of the layer that is left out, and of the slab above it, nothing else is told.
    let expected = [Feature::InnerInterface, Feature::ThicknessMap, Feature::Flakes, Feature::Patina];
    assert_eq!(told(ShadingModel::Microfacet), expected);
    for part in left_out(&material, ShadingModel::Microfacet) {
        assert!(material.places.has(&part.key), "{}", part.key);
    }
}

#[test]
fn every_name_is_that_of_one_part() {
    for feature in Feature::ALL {
        assert_eq!(LeaveOut::from_name(feature.name()), Some(LeaveOut::Feature(feature)));
    }
    assert_eq!(LeaveOut::from_name(&LeaveOut::Layer(3).name()), Some(LeaveOut::Layer(3)));
}
