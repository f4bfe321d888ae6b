//! Tests of rewritten files.

use luthier_optics::stack::Stack;

use super::*;
use crate::{LayerExtras, parse};

const COATED: &str = r#"# A varnish.
schema = 1
name = "m"

[[layer]]
type = "thin-film"
ior = 2.2 # oxide
thickness_nm = { min = 100, max = 300, extent_um = 10, map = { noise = { seed = 3 } } }

[[layer]] # the coat
type = "dielectric"
roughness = 0.5 # satin
ior = 1.5
absorption_per_um = 0.1

[[layer]]
type = "conductor"
ior = { n = 0.2, k = 3 }
alpha_x = 0.2
alpha_y = 0.4

[effects.glitter]
frequency = 100
"#;

fn material(text: &str) -> Material {
    parse("m.toml", text, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap().material
}

/// The text of an edit, which is that of the edited material.
fn written(text: &str, edit: impl Fn(&mut Material)) -> String {
    let original = material(text);
    let mut edited = original.clone();
    edit(&mut edited);
    let text = rewritten(&original, &edited).unwrap();
    let read = material(&text);
    assert_eq!(stated(&read.stack), stated(&edited.stack), "{text}");
    assert_eq!(read.effects, edited.effects, "{text}");
    // Edits change the stack, and not what the file of before stated.
    let extras = |material: &Material| {
        let layers = material.layers.iter().cloned();
        layers.map(|layer| LayerExtras { stated: None, ..layer }).collect::<Vec<_>>()
    };
    assert_eq!(extras(&read), extras(&edited), "{text}");
    text
}

/// A stack whose indices are numbers, whether they follow from those above or not.
fn stated(stack: &Stack) -> Stack {
    let mut here = stack.clone();
    for layer in &mut here.layers {
        if let Base::Dielectric { ior, .. } = &mut layer.base
            && let Some(curves) = ior.f82_rgb()
        {
            *ior = Ior::sampled(ior.samples().to_vec()).unwrap().with_f82(curves);
        }
    }
    here
}

fn slab(material: &mut Material, number: usize) -> &mut Slab {
    match &mut material.stack.layers[number].base {
        Base::Dielectric { slab, .. } => slab,
        _ => panic!("a dielectric"),
    }
}

#[test]
fn nothing_changes_without_an_edit() {
    assert_eq!(written(COATED, |_| ()), COATED);
}

#[test]
fn only_what_was_edited_changes() {
    let text = written(COATED, |m| m.stack.layers[0].surface = Surface::isotropic(Default::default(), 0.123));
    assert_eq!(text, COATED.replace("roughness = 0.5 # satin", "alpha = 0.123 # satin"));
    let text = written(COATED, |m| slab(m, 0).absorption_per_um = [0.1, 0.2, 0.25]);
    assert_eq!(text, COATED.replace("absorption_per_um = 0.1", "absorption_per_um = [0.1, 0.2, 0.25]"));
    let text = written(COATED, |m| m.stack.layers[0].films[0].thickness.max_nm = 350.5);
    assert_eq!(text, COATED.replace("max = 300", "max = 350.5"));
    let text = written(COATED, |m| m.stack.layers[0].films[0].ior = Ior::constant(2.0, 0.0).unwrap());
    assert_eq!(text, COATED.replace("2.2 # oxide", "2 # oxide"));
    let text = written(COATED, |m| m.stack.layers[1].base = Base::Conductor { ior: Ior::constant(0.3, 3.5).unwrap() });
    assert_eq!(text, COATED.replace("{ n = 0.2, k = 3 }", "{ n = 0.3, k = 3.5 }"));
    let text = written(COATED, |m| m.effects.glitter.as_mut().unwrap().frequency = 50.0);
    assert_eq!(text, COATED.replace("frequency = 100", "frequency = 50"));
}

/// Every tenth of a degree is an angle that can be written.
#[test]
fn angles_are_degrees() {
    for tenths in -1800..=1800 {
        let angle = (f64::from(tenths) / 10.0).to_radians();
        let Item::Value(written) = degrees(angle) else { panic!("a value") };
        let text = written.to_string();
        assert!(text.len() <= 6, "{text}");
        assert_eq!(text.parse::<f64>().unwrap().to_radians(), angle);
    }
    let text = written(COATED, |m| m.stack.layers[1].surface.rotation = 30.0_f64.to_radians());
    assert!(text.contains("alpha_y = 0.4\nrotation_deg = 30\n"), "{text}");
    let text = written(COATED, |m| m.effects.glitter.as_mut().unwrap().tilt = 7.5_f64.to_radians());
    assert!(text.contains("frequency = 100\ntilt_deg = 7.5\n"), "{text}");
}

#[test]
fn an_engine_surface_stays_one_where_it_can() {
    let plain = "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n\
                     [[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.8, 0.4, 0.2]\nroughness = 0.5\nsigma = 0.2\n";
    let text = written(plain, |m| m.stack.layers[1].surface = Surface::isotropic(Default::default(), 0.1));
    assert_eq!(text, plain.replace("roughness = 0.5", "alpha = 0.1"));
    let text = written(plain, |m| m.stack.layers[1].surface.alpha_x = 0.1);
    assert!(text.contains("alpha_x = 0.1\nsigma = 0.2\nalpha_y = 0.25\nrotation_deg = 0\n"), "{text}");
}

#[test]
fn an_engine_surface_that_no_longer_fits() {
    let plain = "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.8, 0.4, 0.2]\n\
                     roughness = 0.5\nsigma = 0.2\n\n[bake]\nmodel = \"elek\"\n";
    for edit in [
        |m: &mut Material| slab(m, 0).thickness_um = 3.0,
        |m: &mut Material| {
            let Base::Diffuse(diffuse) = &mut m.stack.layers[1].base else { panic!("a diffuse base") };
            diffuse.albedo = [0.1, 0.2, 0.3];
        },
    ] {
        let text = written(plain, edit);
        assert!(text.contains("type = \"diffuse\"") && !text.contains("base_color"), "{text}");
    }
    let metal = plain.replace("sigma = 0.2", "metallic = 1");
    let text =
        written(&metal, |m| m.stack.layers[0].base = Base::Conductor { ior: Ior::vacuum().with_f0([0.9, 0.5, 0.1]) });
    assert!(text.contains("base_color = [0.9, 0.5, 0.1]"), "{text}");
}

/// Numbers of a base below a coat that does not darken it are not those of the file.
#[test]
fn a_brighter_base_is_left_to_the_file() {
    let plain = "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\ndarkening = false\n\
                     [[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.8, 0.4, 0.2]\nroughness = 0.5\n";
    let rough = |m: &mut Material| m.stack.layers[1].surface = Surface::isotropic(Default::default(), 0.1);
    assert_eq!(written(plain, rough), plain.replace("roughness = 0.5", "alpha = 0.1"));
    let refused = |text: &str, edit: &dyn Fn(&mut Material)| {
        let original = material(text);
        let mut edited = original.clone();
        edit(&mut edited);
        let error = rewritten(&original, &edited).unwrap_err();
        assert!(error.message.contains("brighter than its colour"), "{error}");
    };
    refused(plain, &|m| {
        let Base::Diffuse(diffuse) = &mut m.stack.layers[2].base else { panic!("a diffuse base") };
        diffuse.albedo = [0.1, 0.2, 0.3];
    });
    refused(plain, &|m| {
        let Base::Dielectric { ior, .. } = &mut m.stack.layers[0].base else { panic!("a coat") };
        *ior = Ior::constant(1.6, 0.0).unwrap();
    });
    refused(&plain.replace("roughness = 0.5", "roughness = 0.5\nmetallic = 1"), &rough);
}

#[test]
fn an_index_that_was_implied_is_stated() {
    let schlick = "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.3\nsmooth = true\n\
                       [[layer]]\ntype = \"dielectric\"\nf0 = 0.04\nsmooth = true\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";
    let text = written(schlick, |m| {
        let Base::Dielectric { ior, .. } = &mut m.stack.layers[1].base else { panic!("a dielectric") };
        *ior = ior.clone().with_f0([0.04, 0.05, 0.06]);
    });
    assert!(text.contains("f0 = [0.04, 0.05, 0.06]") && text.matches("ior = ").count() == 2, "{text}");
    let text = written(schlick, |m| {
        let Base::Dielectric { ior, .. } = &mut m.stack.layers[0].base else { panic!("a dielectric") };
        *ior = Ior::constant(1.2, 0.0).unwrap();
    });
    assert!(text.contains("f0 = 0.04") && text.matches("ior = ").count() == 2, "{text}");
}

#[test]
fn a_number_without_a_key_is_refused() {
    let abc = "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nabc = { b = 50, c = 1.5 }\n";
    let original = material(abc);
    let mut edited = original.clone();
    edited.stack.layers[0].surface.alpha_x = 0.5;
    let refusal = rewritten(&original, &edited).unwrap_err();
    assert_eq!((refusal.line, refusal.label.as_str()), (6, "m.toml"));
}

#[test]
fn layers_may_be_a_list() {
    let list = "schema = 1\nname = \"m\"\nlayer = [{ type = \"dielectric\", ior = 1.5, smooth = true }, { type = \"diffuse\", albedo = 0.5 }]\n";
    let text = written(list, |m| m.stack.layers[0].surface = Surface::isotropic(Default::default(), 0.2));
    assert_eq!(text, list.replace("smooth = true", "alpha = 0.2"));
}

#[test]
fn paint_has_another_colour() {
    const PAINT: &str = "schema = 1\nname = \"m\"\n\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5 # grey\n";
    let text = written(PAINT, |m| {
        m.stack.layers[0].base =
            Base::Diffuse(luthier_optics::stack::Diffuse { albedo: [0.5, 0.25, 0.125], sigma: 0.0 });
    });
    assert_eq!(text, PAINT.replace("0.5 # grey", "[0.5, 0.25, 0.125] # grey"));
}
