//! Inputs of the models `belcour` and `yamaguchi`: total reflection, and the layers that cover a diffuse base.

use glam::DVec3;
use luthier_bake::Baked;
use luthier_layers::layers::Layers;
use luthier_layers::models::statistics::adding::add;
use luthier_layers::models::statistics::energy::{Energy, ExactEnergy, FresnelEnergy};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_lut::{TableKind, WeightBits};
use luthier_manifest::LayerRecord;
use luthier_material::Material;
use luthier_optics::stack::Distribution;
use luthier_optics::visible_normals;

use crate::materials::{SMALL, atlas, bake_all, bake_anew, conductor, dielectric, material};

/// Tables other than those that are looked at.
const OTHERS: &str = "[bake.fresnel]\nsize = 4\n[bake.distribution]\nsize = [4, 4]\n";

fn belcour(name: &str, layers: &str, settings: &str) -> Material {
    material(name, layers, &format!("[bake]\nmodel = \"belcour\"\ncolor = \"three-wavelengths\"\n{settings}"))
}

/// A coat of n = 1.5.
fn coat(alpha: f64, absorption: &str) -> String {
    dielectric("1.5", alpha) + &format!("thickness_um = 1\nabsorption_per_um = {absorption}\n")
}

const CLEAR: &str = "[0, 0, 0]";

fn diffuse() -> String {
    "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0.2]\n".to_owned()
}

/// The cosine inside glass of the direction refracted into it.
fn inside(cos: f64) -> f64 {
    (1.0 - (1.0 - cos * cos) / 2.25).sqrt()
}

#[test]
fn shares_that_escape_as_counted() {
    let baked = bake_all(&[belcour("coat", &(coat(0.1, CLEAR) + &conductor("\"au\"", 0.2)), SMALL)]);
    let table = atlas(&baked, TableKind::Escape);
    let tile = baked.materials[0].records[0].tiles[TableKind::Escape].unwrap();
    for [cos, alpha] in [[1.0, 0.3], [0.8, 0.5], [0.3, 0.1], [0.1, 0.9], [0.05, 0.2], [0.6, 0.05], [0.02, 0.02]] {
        // Stratified visible normals.
        let w = DVec3::new((1.0 - inside(cos) * inside(cos)).sqrt(), 0.0, inside(cos));
        let (mut within, mut all) = (0, 0);
        for i in 0..400 {
            for j in 0..400 {
                let u = [(f64::from(i) + 0.5) / 400.0, (f64::from(j) + 0.5) / 400.0];
                let m = visible_normals::sample(Distribution::Ggx, alpha, w, u);
                let z = 2.0 * m.dot(w) * m.z - w.z;
                all += i32::from(z > 0.0);
                within += i32::from(z > inside(0.0));
            }
        }
        let expected = f64::from(within) / f64::from(all);
        let found = table.sample(tile, [cos, alpha], WeightBits::Fixed(8))[0];
        assert!((found - expected).abs() < 3e-3, "{cos} {alpha}: {found} against {expected}");
    }
    eprintln!("escape table: {:?}", table.tiles[0].error);
}

#[test]
fn only_what_is_read_is_baked_and_other_tiles_stay_as_they_are() {
    let layers = coat(0.1, CLEAR) + &coat(0.3, CLEAR) + &conductor("\"au\"", 0.2);
    let three = "[bake]\ncolor = \"three-wavelengths\"\n".to_owned() + SMALL;
    let set = [
        belcour("metal", &layers, SMALL),
        belcour("paint", &(coat(0.1, CLEAR) + &diffuse()), ""),
        belcour("glass", &dielectric("1.5", 0.1), ""),
    ];
    let baked = bake_anew(&set);
    let escapes =
        |i: usize| baked.materials[i].records.iter().map(|r| r.tiles[TableKind::Escape].is_some()).collect::<Vec<_>>();
    // The second coat has the index of the first: nothing is totally reflected.
    assert_eq!(escapes(0), [true, false, false]);
    assert_eq!((escapes(1), escapes(2)), (vec![false; 2], vec![false]));

    let plain = bake_anew(&[material("metal", &layers, &three)]);
    let hashes =
        |bake: &Baked| atlas(bake, TableKind::Fgd).tiles.iter().map(|t| t.input_hash.clone()).collect::<Vec<_>>();
    assert_eq!(hashes(&baked), hashes(&plain));
    assert!(plain.atlases.iter().all(|a| a.kind != TableKind::Escape));
    assert_eq!(plain.materials[0].constants.internal_reflectance, [0.0; 3]);
}

#[test]
fn threads_do_not_matter_to_what_the_statistics_read() {
    let set = [
        belcour("metal", &(coat(0.3, CLEAR) + &conductor("\"au\"", 0.2)), SMALL),
        belcour("paint", &(coat(0.1, "[0.1, 0.2, 0.3]") + &diffuse()), ""),
    ];
    let with =
        |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| bake_anew(&set));
    assert_eq!(with(1), with(2));
}

/// Total reflection from above: the walks of a point must not outnumber their random numbers.
#[test]
fn a_rarer_medium_below_can_be_baked() {
    let baked = bake_all(&[material("gap", &(coat(0.1, CLEAR) + &dielectric("1.2", 0.3)), SMALL)]);
    let tile = baked.materials[0].records[1].tiles[TableKind::Fgd].unwrap();
    let [r, ..] = atlas(&baked, TableKind::Fgd).sample(tile, [0.2, 0.1], WeightBits::Exact);
    assert!(r > 0.9, "{r}: a cosine of 0.2 is far beyond the critical angle");
}

/// Oracle for smooth glass: the closed form, to ten digits. Rough glass keeps more; an absorbing slab keeps less.
#[test]
fn what_covers_a_diffuse_base() {
    let internal = |alpha: f64, absorption: &str, settings: &str| {
        let baked =
            bake_all(&[belcour("paint", &(coat(alpha, absorption) + &diffuse()), &(SMALL.to_owned() + settings))]);
        let constants = &baked.materials[0].constants;
        (constants.internal_reflectance, constants.upward_loss)
    };
    let (smooth, loss) = internal(0.0, CLEAR, "");
    assert!(smooth.iter().all(|r| (r - 0.5963457597).abs() < 1e-7) && loss.abs() < 1e-12, "{smooth:?} {loss}");
    let ([r, g, b], _) = internal(0.0, "[0, 0.1, 0.5]", "");
    assert!(r > g + 0.05 && g > b + 0.1, "{r} {g} {b}");

    // Two coats, the lower one rough: the upper one turns back what the lower one scatters beyond its critical angle.
    let layers = coat(0.0, CLEAR) + &dielectric("1.8", 0.4) + "thickness_um = 1\n" + &diffuse();
    let baked = bake_all(&[belcour("paint", &layers, SMALL)]);
    let stack = Layers::from(&Monochrome::new(&belcour("paint", &layers, SMALL).stack, 550.0, 1));
    let constants = &baked.materials[0].constants;
    assert!(constants.upward_loss > 0.05 && constants.upward_loss < 0.8, "{}", constants.upward_loss);
    assert!(stack.layers.len() == 3 && constants.internal_reflectance[1] > smooth[1]);
}

/// Energies as the baked shader reads them.
struct Read<'a> {
    bake: &'a Baked,
    records: &'a [LayerRecord],
}

impl Energy<3> for Read<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> [f64; 3] {
        let tile = self.records[layer].tiles[TableKind::Fgd].unwrap();
        let [r, g, b, _] = atlas(self.bake, TableKind::Fgd).sample(tile, [cos_theta_i, alpha], WeightBits::Fixed(8));
        [r, g, b]
    }

    fn escaping(&self, layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        let Some(tile) = self.records[layer].tiles[TableKind::Escape] else { return 1.0 };
        let cos = (1.0 - (1.0 - cos_theta_i * cos_theta_i) / (eta * eta)).max(0.0).sqrt();
        atlas(self.bake, TableKind::Escape).sample(tile, [cos, alpha], WeightBits::Fixed(8))[0]
    }
}

/// Largest difference between any channels.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max)
}

/// Directional albedos, as energies of all lobes, of what the forms read and of the model at each wavelength, and those of light paths, in
/// which nothing is approximated. Gold at 645, 525 and 445 nm below glass.
///
/// Tables in place of integrals, and one mean number of bounces for three channels, change nothing. Level facets without total reflection, the form
/// without tables, are up to 0.29 too bright.
#[test]
fn forms_differ_by_what_facets_and_total_reflection_do() {
    // FGD tables of this size are within 3e-3; the rest is one index for all wavelengths.
    const TABLES: f64 = 3e-3;
    let settings = OTHERS.to_owned() + "[bake.fgd]\nsize = [32, 32]\n";
    let (mut level_apart, mut paths_apart) = (0.0f64, [[0.0f64; 3]; 2]);
    for (name, coat_alpha, base_alpha, absorption) in [
        ("polished", 0.02, 0.05, CLEAR),
        ("satin", 0.2, 0.2, CLEAR),
        ("frosted", 0.5, 0.1, CLEAR),
        ("tinted", 0.02, 0.4, "[0.1, 0.3, 0.6]"),
    ] {
        let material = belcour(name, &(coat(coat_alpha, absorption) + &conductor("\"au\"", base_alpha)), &settings);
        let bake = bake_all(std::slice::from_ref(&material));
        let (records, stack) = (&bake.materials[0].records, Layers::rgb(&material.stack));
        let wavelengths_nm = material.bake.wavelengths_nm();
        let level = FresnelEnergy::new(&material.stack, wavelengths_nm);
        let one = [0, 1, 2].map(|c: usize| Monochrome::new(&material.stack, wavelengths_nm[c], c));
        let exact = one.each_ref().map(ExactEnergy::new);
        for (angle, degrees) in [0.0, 60.0, 80.0].into_iter().enumerate() {
            let cos = f64::to_radians(degrees).cos();
            let baked = add::<f64, 3>(&stack, &Read { bake: &bake, records }, cos).reflected();
            let full = add::<f64, 3>(&stack, &level, cos).reflected();
            let model = [0, 1, 2].map(|c: usize| add::<f64, 1>(&Layers::from(&one[c]), &exact[c], cos).reflected()[0]);
            let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let paths = one.each_ref().map(|one| LayeredMc::new(InterfaceMode::SmithWalk).albedo(one, wo, 10_000).mean);
            eprintln!("{name:9} {degrees:2}: baked {baked:.4?}, full {full:.4?}");
            eprintln!("              model {model:.4?}, light paths {paths:.4?}");
            assert!(apart(baked, model) < TABLES, "{baked:?} {model:?}");
            level_apart = level_apart.max(apart(full, model));
            for (worst, value) in paths_apart.iter_mut().zip([baked, full]) {
                worst[angle] = worst[angle].max(apart(value, paths));
            }
        }
    }
    eprintln!("from light paths, at 0, 60 and 80 degrees: baked, full: {paths_apart:.3?}");
    assert!((0.27..0.30).contains(&level_apart), "{level_apart}");
    let [baked, full] = paths_apart;
    assert!((1..3).all(|angle| full[angle] > baked[angle]), "{paths_apart:?}");
}
