//! Table of the laws that models of layers keep and break, and tests that hold them to it.
//!
//! Claims are tested on random stacks, breaches by their measured amount. Models of one surface are in `everywhere`.
//!
//! A model of layers without a row fails `every_model_of_layers_has_a_row`. To add one, write a row with zeros and run the tests:
//! their messages print what was found.

use glam::{DVec2, DVec3};
use luthier_layers::directional_albedo::{DirectionalAlbedo, directional_albedo};
use luthier_layers::model::{Inputs, Kind, Model};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::registry::models;
use luthier_optics::stack::Distribution;
use proptest::prelude::*;

use crate::random::{Losses, smooth_white, stack as random_stack, upward};
use crate::sphere::{at, furnace};
use crate::stacks::{WHITE, dielectric, ggx, lambert};

/// `f(wi, wo) = f(wo, wi)`.
#[derive(Debug, Clone, Copy)]
enum Reciprocity {
    Kept,
    /// Kept by what is estimated; tested on fixed stacks in `layered_mc/symmetry.rs`. On random ones the heavy tails of the estimates
    /// make their standard errors too small to test against.
    Estimated,
    /// Largest relative difference over a few pairs of directions on [`Scene::CoatedMirror`] of alpha 0.3.
    Broken(f64),
}

/// The most that an eye sees of a white sky, over all stacks on a conductor or on Lambert's surface. (Oren and Nayar's surface gains by
/// itself: `oren_nayar_gains_at_grazing_angles`.)
#[derive(Debug, Clone, Copy)]
enum Energy {
    AtMost(f64),
    /// A stack, an angle in degrees, and the directional albedo there.
    Gains(Scene, f64, f64),
}

/// Stacks without absorption that return everything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Furnace {
    /// All.
    All,
    /// Smooth interfaces, up to 60 degrees; lobes have a finite width.
    Smooth,
    /// One interface that reflects everything, if it is smooth.
    SmoothMirror,
    /// One interface that reflects everything.
    Mirror,
    /// None.
    No,
}

/// White stacks: GGX coats of index 1.5.
#[derive(Debug, Clone, Copy)]
enum Scene {
    /// A coat over a mirror of the same alpha.
    CoatedMirror(f64),
    /// A coat over Lambert's surface.
    CoatedLambert(f64),
    /// Alpha 0.05 over a mirror of alpha 0.3.
    GlossyOverSatin,
}

impl Scene {
    fn stack(self) -> Monochrome {
        let (coat, alpha, base) = match self {
            Self::CoatedMirror(alpha) => (alpha, alpha, WHITE),
            Self::CoatedLambert(alpha) => (alpha, alpha, lambert(1.0)),
            Self::GlossyOverSatin => (0.05, 0.3, WHITE),
        };
        Monochrome::bare(&[(ggx(coat), dielectric(1.5, 0.0)), (ggx(alpha), base)])
    }
}

#[derive(Debug, Clone, Copy)]
struct Claims {
    name: &'static str,
    reciprocity: Reciprocity,
    energy: Energy,
    furnace: Furnace,
    /// Directional albedo of the white coated mirror and the white coated Lambert surface, alpha 0.3, at [`ANGLES`]: 1 in truth.
    white: [[f64; 3]; 2],
}

/// A place with a tilted cell, for models that have such.
const TILTED: DVec2 = DVec2::new(0.5, 0.5);

const ANGLES: [f64; 3] = [0.0, 60.0, 85.0];

const fn row(
    name: &'static str,
    reciprocity: Reciprocity,
    energy: Energy,
    furnace: Furnace,
    white: [[f64; 3]; 2],
) -> Claims {
    Claims { name, reciprocity, energy, furnace, white }
}

use Energy::{AtMost, Gains};
use Reciprocity::{Broken, Estimated, Kept};
use Scene::{CoatedLambert, CoatedMirror, GlossyOverSatin};

/// Measured with these tests.
#[rustfmt::skip]
const TABLE: &[Claims] = &[
    // The light's albedo gains nevertheless: `phong_gains_and_is_not_reciprocal`.
    row("phong", Broken(0.864), AtMost(1.0), Furnace::SmoothMirror, [[1.0000, 0.8976, 0.5817], [1.0000, 0.9959, 0.9833]]),
    row("microfacet", Kept, AtMost(1.0), Furnace::SmoothMirror, [[0.0356, 0.0610, 0.1545], [0.0356, 0.0610, 0.1545]]),
    row("microfacet-v-cavity", Kept, AtMost(1.0), Furnace::SmoothMirror, [[0.0350, 0.0689, 0.2766], [0.0350, 0.0689, 0.2766]]),
    row("elek", Kept, Gains(CoatedMirror(0.02), 0.0, 2.108), Furnace::SmoothMirror, [[1.3183, 0.9913, 1.0536], [0.9579, 0.9807, 1.1934]]),
    row("flakes", Kept, Gains(CoatedMirror(0.3), 0.0, 1.297), Furnace::SmoothMirror, [[1.2969, 0.9726, 1.0422], [0.9579, 0.9807, 1.1934]]),
    row("patina", Kept, Gains(CoatedMirror(0.02), 0.0, 1.697), Furnace::No, [[1.2350, 1.0813, 1.1499], [1.1228, 1.1329, 1.2364]]),
    row("weidlich-wilkie", Kept, Gains(CoatedMirror(0.02), 0.0, 2.108), Furnace::SmoothMirror, [[1.3183, 0.9913, 1.0536], [0.9579, 0.9807, 1.1934]]),
    row("weidlich-wilkie-directions", Kept, Gains(CoatedMirror(0.02), 0.0, 2.107), Furnace::SmoothMirror, [[1.2769, 0.9324, 0.5979], [0.9069, 0.8962, 0.6283]]),
    row("weidlich-wilkie-facet", Kept, Gains(CoatedLambert(0.3), 85.0, 1.193), Furnace::SmoothMirror, [[0.7838, 0.4576, 0.4384], [0.9579, 0.9807, 1.1934]]),
    // A rough coat reflects a little more than the smooth one that transmits in its place: `rough_coats_gain_a_few_thousandths`.
    row("weidlich-wilkie-corrected", Kept, AtMost(1.0023), Furnace::Smooth, [[0.6102, 0.4770, 0.4350], [0.9950, 0.9798, 0.6638]]),
    row("granier-heidrich", Broken(0.576), Gains(CoatedLambert(0.3), 0.0, 1.958), Furnace::SmoothMirror, [[0.9581, 0.6892, 0.6717], [1.9581, 1.6892, 1.6717]]),
    row("belcour", Broken(0.339), AtMost(1.0), Furnace::Smooth, [[0.6030, 0.5606, 0.7993], [0.9955, 0.9883, 0.9834]]),
    row("belcour-half-vector", Kept, Gains(GlossyOverSatin, 89.0, 1.1536), Furnace::Smooth, [[0.5861, 0.5702, 0.7866], [0.9963, 0.9807, 0.9111]]),
    row("yamaguchi", Broken(0.339), AtMost(1.0), Furnace::Smooth, [[0.6030, 0.5606, 0.7993], [0.9955, 0.9883, 0.9834]]),
    row("yamaguchi-half-vector", Kept, Gains(GlossyOverSatin, 89.0, 1.1536), Furnace::Smooth, [[0.5861, 0.5702, 0.7866], [0.9963, 0.9807, 0.9111]]),
    row("lobes", Broken(0.2422), AtMost(1.002), Furnace::No, [[1.0001, 0.9989, 0.9998], [1.0001, 1.0001, 1.0000]]),
    row("fluorescence", Kept, AtMost(1.003), Furnace::No, [[0.0; 3], [0.9956, 0.9718, 0.5417]]),
    row("heterogeneous", Kept, Gains(CoatedMirror(0.02), 0.0, 2.108), Furnace::No, [[1.3183, 0.9913, 1.0536], [0.9579, 0.9807, 1.1934]]),
    row("heterogeneous-glitter", Broken(0.957), Gains(CoatedMirror(0.02), 0.0, 2.108), Furnace::No, [[1.3183, 0.9913, 1.0536], [0.9579, 0.9807, 1.1934]]),
    row("heterogeneous-switch", Kept, Gains(CoatedMirror(0.02), 0.0, 2.108), Furnace::No, [[1.3183, 0.9913, 1.0536], [0.9579, 0.9807, 1.1934]]),
    row("closed-form", Kept, AtMost(1.0), Furnace::Smooth, [[1.0; 3]; 2]),
    row("random-walk", Estimated, AtMost(1.0), Furnace::Mirror, [[0.0383, 0.0715, 0.1682], [0.0354, 0.0627, 0.1516]]),
    row("layered-mc", Estimated, AtMost(1.0), Furnace::All, [[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]),
    row("layered-mc-one-facet", Estimated, AtMost(1.0), Furnace::Smooth, [[0.6266, 0.5321, 0.5063], [0.6985, 0.6796, 0.6878]]),
];

/// Models and their rows.
fn claimed() -> impl Iterator<Item = (Box<dyn Model>, Claims)> {
    models().into_iter().filter_map(|model| {
        let row = TABLE.iter().find(|row| row.name == model.info().name)?;
        Some((model, *row))
    })
}

/// Tolerance of a directional albedo: four standard errors of an estimate, the quadrature's own error otherwise, and 1e-3.
fn slack(albedo: DirectionalAlbedo) -> f64 {
    if albedo.is_estimate { 4.0 * albedo.error + 1e-3 } else { albedo.error + 1e-3 }
}

#[test]
fn every_model_of_layers_has_a_row() {
    let infos: Vec<_> = models().iter().map(|model| model.info()).collect();
    for info in infos.iter().filter(|info| matches!(info.kind, Kind::Layered | Kind::Place | Kind::Reference)) {
        assert_eq!(TABLE.iter().filter(|row| row.name == info.name).count(), 1, "rows of {}", info.name);
    }
    for row in TABLE {
        let info = infos.iter().find(|info| info.name == row.name);
        let info = info.unwrap_or_else(|| panic!("{} is not registered", row.name));
        // A surface keeps energy both ways or does not claim to; the table is about what an eye sees.
        if info.kind == Kind::Surface {
            continue;
        }
        assert_eq!(info.claims.reciprocal, !matches!(row.reciprocity, Broken(_)), "reciprocity of {}", row.name);
        assert_eq!(info.claims.conserves_energy, matches!(row.energy, AtMost(_)), "energy of {}", row.name);
    }
}

#[test]
fn white_stacks_return_what_was_measured() {
    let mut wrong = String::new();
    for (model, row) in claimed() {
        for (scene, expected) in [CoatedMirror(0.3), CoatedLambert(0.3)].into_iter().zip(row.white) {
            let found = ANGLES.map(|theta| directional_albedo(&*model, &scene.stack(), at(theta)));
            // Those in the table are estimates too.
            let off = |(a, e): (&DirectionalAlbedo, &f64)| (a.value - e).abs() > 1.5 * slack(*a);
            if found.iter().zip(&expected).any(off) {
                wrong += &format!("{} {scene:?}: {:?}\n", row.name, found.map(|a| a.value));
            }
        }
    }
    assert!(wrong.is_empty(), "found:\n{wrong}");
}

#[test]
fn models_that_gain_do_so_by_the_measured_amount() {
    let mut wrong = String::new();
    for (model, row) in claimed() {
        if let Gains(scene, theta, expected) = row.energy {
            let found = directional_albedo(&*model, &scene.stack(), at(theta));
            if (found.value - expected).abs() > slack(found) || expected <= 1.0 {
                wrong += &format!("{} {scene:?} {theta}: {found:?}\n", row.name);
            }
        }
    }
    assert!(wrong.is_empty(), "found:\n{wrong}");
}

/// The most over a white base of a grid of both distributions, indices 1.1 to 3.5, alpha 0.05 to 0.4 and angles to 70 degrees: a
/// Beckmann coat of index 1.4 and alpha 0.2, seen at 50 degrees.
#[test]
fn rough_coats_gain_a_few_thousandths() {
    let mut white = Monochrome::bare(&[(ggx(0.2), dielectric(1.4, 0.0)), (ggx(0.02), lambert(1.0))]);
    white.layers[0].surface.distribution = Distribution::Beckmann;
    for (name, expected) in [("weidlich-wilkie-corrected", 1.00223), ("fluorescence", 1.00294)] {
        let (model, row) = claimed().find(|(_, row)| row.name == name).unwrap();
        let found = directional_albedo(&*model, &white, at(50.0));
        assert!((found.value - expected).abs() <= 1e-4, "{name}: {found:?}");
        assert!(matches!(row.energy, AtMost(most) if most > expected), "{name}");
    }
}

#[test]
fn models_that_are_not_reciprocal_miss_by_the_measured_amount() {
    let stack = CoatedMirror(0.3).stack();
    let mut wrong = String::new();
    for (model, row) in claimed() {
        if let Broken(expected) = row.reciprocity {
            let model = model.with_inputs(&Inputs { uv: Some(TILTED), ..Inputs::default() }).unwrap_or(model);
            let mut most = 0.0f64;
            for (i, o) in [(0.0, 40.0), (30.0, 75.0), (60.0, 20.0), (85.0, 50.0)] {
                for turn in [0.0f64, 0.8, 2.9] {
                    let (wi, wo) = (at(i), at(o));
                    let wo = DVec3::new(wo.x * turn.cos(), wo.x * turn.sin(), wo.z);
                    let (there, back) = (model.eval(&stack, wi, wo) / wi.z, model.eval(&stack, wo, wi) / wo.z);
                    most = most.max((there - back).abs() / there.max(back));
                }
            }
            if (most - expected).abs() > 1e-3 || expected < 1e-2 {
                wrong += &format!("{}: {most}\n", row.name);
            }
        }
    }
    assert!(wrong.is_empty(), "found:\n{wrong}");
}

#[test]
fn lobes_keep_energy_and_are_not_negative() {
    let (model, _) = claimed().find(|(_, row)| row.name == "lobes").unwrap();
    let flat = dielectric(0.8, 0.2);
    for layers in [
        vec![(ggx(0.01), dielectric(1.7, 0.0)), (ggx(0.4), WHITE)],
        vec![(ggx(0.6), dielectric(1.3, 0.1)), (ggx(0.1), dielectric(2.2, 0.0)), (ggx(0.0), lambert(0.9))],
        vec![(ggx(0.0), flat), (ggx(0.2), lambert(1.0))],
    ] {
        let stack = Monochrome::bare(&layers);
        for theta in [0.0, 40.0, 75.0, 89.0] {
            let found = directional_albedo(&*model, &stack, at(theta));
            assert!(found.value <= 1.002 + slack(found), "{theta}: {found:?}");
            for (i, turn) in [(0.0, 0.0), (50.0, 1.0), (89.99, 3.0)] {
                let wi = DVec3::new(at(i).x * f64::cos(turn), at(i).x * f64::sin(turn), at(i).z);
                let f = model.eval(&stack, wi, at(theta));
                assert!(f.is_finite() && f >= 0.0, "{theta} {i}: {f}");
            }
        }
    }
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(12))]

    /// All that is claimed of any stack, from the normal to 89.99 degrees.
    #[test]
    fn claims_hold_on_random_stacks(
        stack in prop_oneof![random_stack(Losses::Any), random_stack(Losses::None)],
        wi in upward(1e-4), wo in upward(1e-4), grazing in upward(1e-7),
    ) {
        // A fit takes a second: see `lobes_keep_energy_and_are_not_negative`.
        for (model, row) in claimed().filter(|(_, row)| row.name != "lobes") {
            let name = row.name;
            for (wi, wo) in [(wi, wo), (wo, grazing), (grazing, wo), (grazing, grazing)] {
                let f = model.eval(&stack, wi, wo);
                prop_assert!(f.is_finite() && f >= 0.0, "{name}: {f} from {wi} to {wo}");
                prop_assert!(model.eval(&stack, wi, -wo) == 0.0 && model.eval(&stack, -wi, wo) == 0.0, "{name}");
            }
            // Below 1e-100 rounding of the exponents of narrow lobes shows.
            if matches!(row.reciprocity, Kept) {
                let (f, g) = (model.eval(&stack, wi, wo) / wi.z, model.eval(&stack, wo, wi) / wo.z);
                prop_assert!((f - g).abs() <= 1e-9 * f.max(g) + 1e-100, "{name}: {f} {g}");
            }
            if let AtMost(most) = row.energy {
                let found = directional_albedo(&*model, &stack, wo);
                prop_assert!(found.value <= most + slack(found), "{name}: {found:?} at {wo}");
            }
        }
    }

    /// Claims of white stacks.
    #[test]
    fn white_stacks_return_everything_where_it_is_claimed(
        rough in random_stack(Losses::None), smooth in smooth_white(), wo in upward(0.5), anywhere in upward(1e-4),
    ) {
        let bare = |stack: &Monochrome| Monochrome { layers: stack.layers[stack.layers.len() - 1..].to_vec(), exterior: 1.0 };
        let [mut rough_mirror, mut smooth_mirror] = [bare(&rough), bare(&smooth)];
        for mirror in [&mut rough_mirror, &mut smooth_mirror] {
            (mirror.layers[0].above, mirror.layers[0].below) = (1.0, WHITE);
        }
        for (model, row) in claimed() {
            let (stack, wo) = match row.furnace {
                Furnace::All => (&rough, anywhere),
                Furnace::Mirror => (&rough_mirror, anywhere),
                Furnace::Smooth => (&smooth, wo),
                Furnace::SmoothMirror => (&smooth_mirror, wo),
                Furnace::No => continue,
            };
            let (found, slack) = if model.estimator().is_some() {
                let found = directional_albedo(&*model, stack, wo);
                (found.value, slack(found))
            } else {
                (furnace(&*model, stack, wo), 2e-3)
            };
            prop_assert!((found - 1.0).abs() <= slack, "{}: {found} at {wo}", row.name);
        }
    }
}
