//! `metallic-roughness` surfaces of a stack.

use luthier_optics::ior::Ior;
use luthier_optics::schlick::{DIELECTRIC_INDEX, F82, metallic_and_tinted, schlick_average};
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};

const COLOR: [f64; 3] = [0.9, 0.4, 0.02];

/// A plastic of a colour, whose interface bends light by an index, below a coat or not.
fn plastic(is_coated: bool, index: f64) -> Stack {
    let slab = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
    let layer = |base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Ggx, 0.3), base };
    let metal = COLOR.map(|f0| F82 { f0, tint: 1.0 });
    let (curves, albedo) = metallic_and_tinted(metal, [0.04; 3], COLOR, 0.0, index);
    let coat = Ior::constant(1.6, 0.0).unwrap();
    let above = if is_coated { coat.clone() } else { Ior::vacuum() };
    let interface = layer(Base::Dielectric { ior: Ior::engine(&above, index).with_f82(curves), slab });
    let base = layer(Base::Diffuse(Diffuse { albedo, sigma: 0.0 }));
    let coat = layer(Base::Dielectric { ior: coat, slab });
    let layers = if is_coated { vec![coat, interface, base] } else { vec![interface, base] };
    Stack { exterior: Ior::vacuum(), layers }
}

fn albedo(stack: &Stack) -> [f64; 3] {
    match &stack.layers.last().unwrap().base {
        Base::Diffuse(base) => base.albedo,
        other => panic!("{other:?}"),
    }
}

fn index(stack: &Stack, layer: usize) -> f64 {
    match &stack.layers[layer].base {
        Base::Dielectric { ior, .. } => ior.at(550.0).re,
        other => panic!("{other:?}"),
    }
}

/// By Saunderson: a base of albedo r shows `r t / (1 - r (1 - t))` through an interface that lets the share t through from below, which is `1 / n^2` of what
/// it lets through from above. A surface that light crosses once is the one whose interface bends none, of the same colour.
#[test]
fn light_that_crosses_once_shows_the_same_colour() {
    for is_coated in [false, true] {
        let [bent, unbent] = [DIELECTRIC_INDEX, 1.0].map(|index| plastic(is_coated, index));
        let passed = (1.0 - schlick_average(0.04)) / 2.25;
        for (r, color) in albedo(&bent).into_iter().zip(COLOR) {
            assert!((r * passed / (1.0 - r * (1.0 - passed)) - color).abs() < 1e-12);
        }
        let crossed = bent.crossed_once();
        assert!(bent.bends_in_engine() && !crossed.bends_in_engine());
        assert!(albedo(&crossed).into_iter().zip(albedo(&unbent)).all(|(a, b)| (a - b).abs() < 1e-12));
        let interface = bent.layers.len() - 2;
        let above = if is_coated { 1.6 } else { 1.0 };
        assert_eq!([&bent, &crossed].map(|stack| index(stack, interface)), [1.5 * above, above]);
        assert_eq!(crossed.crossed_once(), crossed);
        assert_eq!([&crossed, &unbent].map(|stack| index(&stack.bent(), interface)), [1.5 * above; 2]);
        for back in [crossed.bent(), unbent.bent(), bent.bent()] {
            assert!(albedo(&back).into_iter().zip(albedo(&bent)).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}

/// Where a coat is not, the surface bends light by the same ratio, in either order.
#[test]
fn without_a_coat_it_bends_by_the_same_ratio() {
    let coated = plastic(true, DIELECTRIC_INDEX);
    assert_eq!(coated.without_first(), plastic(false, DIELECTRIC_INDEX));
    assert_eq!(coated.crossed_once().without_first(), coated.without_first().crossed_once());
    // An index of its own stays.
    let mut glass = coated;
    if let Base::Dielectric { ior, .. } = &mut glass.layers[1].base {
        *ior = Ior::constant(1.4, 0.0).unwrap();
    }
    assert_eq!(index(&glass.without_first(), 0), 1.4);
}
