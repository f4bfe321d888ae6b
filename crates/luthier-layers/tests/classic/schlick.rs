//! Interfaces of Schlick's in every model: the formula by hand, and a coat on Lambert's surface in closed form.

use std::f64::consts::PI;

use luthier_layers::formulas::interface_fresnel::Fresnel;
use luthier_layers::model::{Estimator, Model};
use luthier_layers::models::microfacet::{Components, Microfacet};
use luthier_layers::models::phong::Coefficients;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_layers::references::closed_form::ClosedForm;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::registry::model;
use luthier_optics::schlick::F82;
use luthier_optics::stack::Surface;
use num_complex::Complex64;

use crate::sphere::{albedo, at};
use crate::stacks::{dielectric, ggx, lambert};

/// Copper's red, green and blue as the lecture prints them, dielectrics, and the ends.
const F0: [f64; 6] = [0.0, 0.04, 0.538, 0.638, 0.955, 1.0];

fn schlick(f0: f64, cos: f64) -> f64 {
    f0 + (1.0 - f0) * (1.0 - cos).powi(5)
}

/// The index of a conductor is no matter beside an F0.
fn metal(alpha: f64, f0: f64) -> Monochrome {
    let mut stack = Monochrome::bare(&[(ggx(alpha), MonochromeBelow::Conductor { ior: Complex64::new(1.0, 0.0) })]);
    stack.layers[0].f0 = Some(F82 { f0, tint: 1.0 });
    stack
}

fn coat(surface: Surface, ior: f64, f0: f64, base: MonochromeBelow) -> Monochrome {
    let mut stack = Monochrome::bare(&[(surface, dielectric(ior, 0.0)), (Surface::smooth(), base)]);
    stack.layers[0].f0 = Some(F82 { f0, tint: 1.0 });
    stack
}

/// A surface of one facet reflects the formula at the half vector times what one of F0 1 does.
#[test]
fn one_facet_reflects_the_formula() {
    for name in ["microfacet", "elek", "weidlich-wilkie", "weidlich-wilkie-corrected"] {
        let model = model(name).unwrap();
        for f0 in F0 {
            for (wi, wo) in [(at(10.0), at(50.0)), (at(75.0), at(-60.0)), (at(80.0), at(-85.0))] {
                let cos_theta_d = (wi + wo).normalize().dot(wo);
                let [found, white] = [f0, 1.0].map(|f0| model.eval(&metal(0.3, f0), wi, wo));
                let ratio = found / white;
                assert!((ratio - schlick(f0, cos_theta_d)).abs() < 1e-12, "{name} {f0}: {ratio}");
            }
        }
    }
}

/// The edge tint of OpenPBR 1.1, typed from its page: `F0 + (1 - F0)(1 - mu)^5 - mu (1 - mu)^6 (F_schlick(1/7) (1 - t)) / ((1/7) (6/7)^6)`.
fn tinted(f0: f64, tint: f64, mu: f64) -> f64 {
    let depth = schlick(f0, 1.0 / 7.0) * (1.0 - tint) / ((1.0 / 7.0) * (6.0 / 7.0_f64).powi(6));
    schlick(f0, mu) - depth * mu * (1.0 - mu).powi(6)
}

fn edged(alpha: f64, f0: f64, tint: f64) -> Monochrome {
    let mut stack = metal(alpha, f0);
    stack.layers[0].f0 = Some(F82 { f0, tint });
    stack
}

/// At the normal a facet reflects F0, at 81.8 degrees the tint times Schlick's, between them the formula; smooth, the albedo is the formula.
#[test]
fn an_edge_tint_is_the_specifications() {
    for (f0, tint) in [(0.9, 0.4), (0.5, 0.0), (1.0, 0.7)] {
        for name in ["microfacet", "elek", "weidlich-wilkie", "weidlich-wilkie-corrected"] {
            let model = model(name).unwrap();
            let edge = (1.0_f64 / 7.0).acos().to_degrees();
            for (wi, wo) in [(at(0.0), at(0.0)), (at(10.0), at(50.0)), (at(edge), at(-edge)), (at(89.0), at(-89.0))] {
                let cos_theta_d = (wi + wo).normalize().dot(wo);
                let ratio = model.eval(&edged(0.3, f0, tint), wi, wo) / model.eval(&metal(0.3, 1.0), wi, wo);
                let expected = tinted(f0, tint, cos_theta_d);
                assert!((ratio - expected).abs() < 1e-12, "{name} {f0} {tint}: {ratio} {expected}");
            }
        }
        for theta in [0.0, 60.0, 82.0, 88.0] {
            let expected = tinted(f0, tint, at(theta).z);
            let stack = edged(0.0, f0, tint);
            let mc = LayeredMc { seed: 5, ..LayeredMc::new(InterfaceMode::SmithWalk) }.albedo(&stack, at(theta), 2000);
            assert!((mc.mean - expected).abs() < 1e-9, "{f0} {tint} {theta}: {} {expected}", mc.mean);
        }
    }
}

/// Oracle: a midpoint rule over light of all directions at once has the light that a smooth tinted metal sends back, with the integrals of the formula by hand:
/// `F0 + (1 - F0)/21 - a/126`.
#[test]
fn a_smooth_tinted_metal_in_a_furnace() {
    let (f0, tint) = (0.8, 0.25);
    let steps = 20_000;
    let mut sum = 0.0;
    for i in 0..steps {
        let mu = (f64::from(i) + 0.5) / f64::from(steps);
        sum += 2.0 * mu * edged(0.0, f0, tint).layers[0].reflectance(mu) / f64::from(steps);
    }
    let depth = schlick(f0, 1.0 / 7.0) * (1.0 - tint) * 7.0_f64.powi(7) / 6.0_f64.powi(6);
    assert!((sum - (f0 + (1.0 - f0) / 21.0 - depth / 126.0)).abs() < 1e-8, "{sum}");
}

/// Every approximation of Fresnel's formulas is Schlick's where there is no index.
#[test]
fn all_formulas_are_schlicks() {
    for name in ["exact", "transfer-matrix", "schlick", "complex-f0", "lazanyi", "f82", "two-beams", "belcour-barla"] {
        let fresnel = match name {
            "exact" => Fresnel::Exact,
            "transfer-matrix" => Fresnel::TransferMatrix,
            "schlick" => Fresnel::Schlick,
            "complex-f0" => Fresnel::ComplexF0,
            "lazanyi" => Fresnel::Lazanyi,
            "f82" => Fresnel::F82,
            "two-beams" => Fresnel::TwoBeams,
            _ => Fresnel::BelcourBarla,
        };
        let one = Microfacet::new(Components { fresnel, ..Components::PLAIN });
        let (wi, wo) = (at(70.0), at(-50.0));
        let ratio = one.eval(&metal(0.4, 0.2), wi, wo) / one.eval(&metal(0.4, 1.0), wi, wo);
        assert!((ratio - schlick(0.2, 60f64.to_radians().cos())).abs() < 1e-12, "{name}: {ratio}");
    }
}

/// A smooth coat of F0 f on a Lambert base of albedo rho, seen at the normal. By reciprocity the coat passes `t = (1 - F) / n^2` of the
/// base's light, F = f + (1 - f)/21 being the mean of the formula, so that `f + (1 - f) rho t / (1 - rho (1 - t))` comes back.
#[test]
fn a_smooth_coat_on_lambert_is_its_closed_form() {
    for (ior, f0, rho) in [(1.5, 0.04, 0.8), (1.5, 0.4975, 0.4775), (1.3, 0.2, 1.0), (2.0, 0.0, 0.5)] {
        let passed = (1.0 - f0) * (20.0 / 21.0) / (ior * ior);
        let expected = f0 + (1.0 - f0) * rho * passed / (1.0 - rho * (1.0 - passed));
        let stack = coat(Surface::smooth(), ior, f0, lambert(rho));
        let close = |name: &str, found: f64, tolerance: f64| {
            assert!((found - expected).abs() < tolerance, "{name} {ior} {f0} {rho}: {found} {expected}");
        };
        for name in ["weidlich-wilkie-corrected", "belcour", "yamaguchi"] {
            close(name, albedo(model(name).unwrap().as_ref(), &stack, at(0.0)), 1e-3);
        }
        let mc = LayeredMc { seed: 5, ..LayeredMc::new(InterfaceMode::SmithWalk) }.albedo(&stack, at(0.0), 100_000);
        close("layered-mc", mc.mean, 4.0 * mc.std_err + 1e-9);
        close("closed-form", ClosedForm.albedo_with_error(&stack, at(0.0), at(0.0)).mean, 1e-6);
    }
}

/// Kelemen and Szirmay-Kalos 2001: below a smooth Schlick interface a base of albedo c / (t + c (1 - t)), as `metallic-roughness` files make it,
/// is the matte term c (1 - F(i))(1 - F(o)) / (pi (1 - mean F)), whatever the index.
#[test]
fn the_base_of_engines_is_the_matte_term_of_kelemen() {
    for (ior, f0, c) in [(1.0, 0.04, 0.955), (1.0, 0.4975, 0.4775), (1.5, 0.3, 0.6)] {
        let mean = f0 + (1.0 - f0) / 21.0;
        let passed = (1.0 - mean) / (ior * ior);
        let stack = coat(Surface::smooth(), ior, f0, lambert(c / (passed + c * (1.0 - passed))));
        for (wi, wo) in [(at(0.0), at(60.0)), (at(75.0), at(30.0))] {
            let expected = wi.z * c * (1.0 - schlick(f0, wi.z)) * (1.0 - schlick(f0, wo.z)) / (PI * (1.0 - mean));
            for name in ["weidlich-wilkie-corrected", "belcour"] {
                let found = model(name).unwrap().eval(&stack, wi, wo);
                assert!((found / expected - 1.0).abs() < 1e-6, "{name} {ior} {f0}: {found} {expected}");
            }
        }
    }
}

/// White furnace: an F0 of 1 returns everything, and so does a coat of any F0 on white, rough or smooth, index-matched or not.
#[test]
fn lossless_stacks_return_everything() {
    let mc = LayeredMc { seed: 2, ..LayeredMc::new(InterfaceMode::SmithWalk) };
    let stacks = [
        metal(0.0, 1.0),
        metal(0.4, 1.0),
        metal(0.4, 0.3).lossless(),
        coat(Surface::smooth(), 1.5, 0.04, lambert(1.0)),
        coat(ggx(0.4), 1.5, 0.5, lambert(1.0)),
        coat(ggx(0.4), 1.0, 0.5, lambert(1.0)),
    ];
    for (i, stack) in stacks.iter().enumerate() {
        for theta in [0.0, 60.0, 85.0] {
            let found = mc.albedo(stack, at(theta), 4_000).mean;
            assert!((found - 1.0).abs() < 2e-3, "{i} {theta}: {found}");
        }
    }
}

/// Models that claim energy return no more than falls in.
#[test]
fn nothing_is_gained() {
    for name in ["belcour", "yamaguchi", "weidlich-wilkie-corrected", "lobes"] {
        let model = model(name).unwrap();
        for f0 in [0.04, 0.5] {
            let found = albedo(model.as_ref(), &coat(ggx(0.3), 1.5, f0, lambert(1.0 - f0)), at(40.0));
            assert!(found > 0.3 && found < 1.01, "{name} {f0}: {found}");
        }
    }
}

/// Granier and Heidrich's beams have the F0 in place of that of the index (eq. 8), and its mean in the diffuse term (eq. 14).
#[test]
fn beams_have_the_f0() {
    let beams = model("granier-heidrich").unwrap();
    let matched = |f0| coat(ggx(0.3), 1.5, f0, lambert(0.6));
    let mut by_index = matched(0.04);
    by_index.layers[0].f0 = None;
    let (wi, wo) = (at(40.0), at(-20.0));
    let (own, of_index) = (beams.eval(&matched(0.04), wi, wo), beams.eval(&by_index, wi, wo));
    assert!((own - of_index).abs() < 1e-12 && own > 0.0, "{own} {of_index}");
    assert!((beams.eval(&matched(0.5), wi, wo) - own).abs() > 1e-2);
    // A bare metal: one beam, by hand.
    let e = 2.0 / 0.09 - 2.0;
    let lobe = |away: f64| (e + 1.0) / (2.0 * PI) * away.cos().powf(e);
    let expected = schlick(0.638, 40f64.to_radians().cos()) * lobe(20f64.to_radians());
    assert!((beams.eval(&metal(0.3, 0.638), wi, wo) - expected).abs() < 1e-12);
}

/// Phong's coefficients by hand at the normal: the coat's F0, and what it leaves of the base.
#[test]
fn phong_has_the_f0() {
    let Coefficients { diffuse, specular, .. } = Coefficients::of(&coat(ggx(0.3), 1.5, 0.2, lambert(0.5)));
    assert!((specular - 0.2).abs() < 1e-12 && (diffuse - 0.4).abs() < 1e-12, "{specular} {diffuse}");
}
