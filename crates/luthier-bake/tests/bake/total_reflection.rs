//! Interfaces that reflect totally: their rows hold what others hold, cost others nothing, and are named where they do not.

use luthier_bake::{AIM, Baked, kinked_rows};
use luthier_lut::{TableKind, WeightBits};
use luthier_material::Material;
use luthier_optics::interface::Interface;

use crate::brute_force::{Facets, Heights, Slopes, Surface};
use crate::materials::{atlas, bake_all, conductor, dielectric, material};

/// Albedos that no search touches.
const FIXED_ALBEDO: &str = "[bake.fgd]\nsize = [8, 8]\nformat = \"rgba16float\"\n";

/// Largest error, as sampled, of the row of an interface that goes down in index.
const HELD: f64 = 1e-3;

/// Points between those of the bake's own scan may be this much worse.
const BETWEEN: f64 = 1.02;

/// Fresnel's formulas for real indices, unpolarised: Born and Wolf, sec. 1.5.
fn fresnel(above: f64, below: f64, cos_theta: f64) -> f64 {
    let sin_t = above / below * (1.0 - cos_theta * cos_theta).sqrt();
    if sin_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin_t * sin_t).sqrt();
    let s = (above * cos_theta - below * cos_t) / (above * cos_theta + below * cos_t);
    let p = (below * cos_theta - above * cos_t) / (below * cos_theta + above * cos_t);
    0.5 * (s * s + p * p)
}

/// Cosines all over, and crowded on both sides of the critical one.
fn cosines(above: f64, below: f64) -> Vec<f64> {
    let critical = (1.0 - (below / above).powi(2)).max(0.0).sqrt();
    let all = (0..=20_000).map(|i| f64::from(i) / 20_000.0);
    let near = (0..2000).flat_map(|i| {
        let away = 0.3 * (f64::from(i) / 2000.0).powi(4);
        [critical - away, critical + away]
    });
    all.chain(near).filter(|cos| (0.0..=1.0).contains(cos)).collect()
}

/// Largest error of the row of a layer, and what the bake states of it.
fn errors(bake: &Baked, material: usize, layer: usize, exact: impl Fn(f64) -> f64, at: &[f64]) -> (f64, f64) {
    let rows = atlas(bake, TableKind::Fresnel);
    let record = &bake.materials[material].records[layer];
    let tile = record.tiles[TableKind::Fresnel].unwrap();
    let error = |cos_theta: f64| {
        let read = rows.sample(tile, [record.row_cosine(cos_theta), 0.0], WeightBits::Fixed(8));
        (0..3).map(|c| (read[c] - exact(cos_theta)).abs()).fold(0.0, f64::max)
    };
    (at.iter().copied().map(error).fold(0.0, f64::max), rows.tiles[tile as usize].error.max_abs_err)
}

fn wine_glass() -> Material {
    let slab = dielectric("1.5", 0.1) + "thickness_um = 1000\n";
    material("wine-glass", &(slab + &dielectric("1.0", 0.1)), FIXED_ALBEDO)
}

fn others() -> Vec<Material> {
    let coated = dielectric("1.5", 0.1) + &conductor("{ n = 0.2, k = 3.5 }", 0.3);
    vec![material("coated", &coated, FIXED_ALBEDO), material("chromium", &conductor("{ n = 3.2, k = 4.4 }", 0.3), "")]
}

#[test]
fn rows_down_in_index_hold_a_thousandth() {
    for (above, below) in [(1.5, 1.0), (1.5, 1.33), (1.5, 1.485), (2.4, 1.0)] {
        let layers = format!("exterior = {above}\n{}", dielectric(&below.to_string(), 0.1));
        let bake = bake_all(&[material("down", &layers, FIXED_ALBEDO)]);
        let (found, stated) = errors(&bake, 0, 0, |c| fresnel(above, below, c), &cosines(above, below));
        eprintln!("{above} to {below}: {found:.2e}, stated {stated:.2e}");
        assert!(found <= HELD && found <= stated * BETWEEN, "{above} to {below}: {found} {stated}");
    }
}

#[test]
fn a_wine_glass_costs_the_others_nothing() {
    let alone = bake_all(&others());
    let mut set = others();
    set.push(wine_glass());
    let bake = bake_all(&set);
    for (layer, (above, below)) in [(1.0, 1.5), (1.5, 1.0)].into_iter().enumerate() {
        let (found, _) = errors(&bake, 2, layer, |c| fresnel(above, below, c), &cosines(above, below));
        assert!(found <= HELD, "layer {layer}: {found}");
    }
    same_rows(&alone, &bake);
}

/// The rows of a bake are those of another that has more.
fn same_rows(alone: &Baked, bake: &Baked) {
    let [few, all] = [alone, bake].map(|bake| atlas(bake, TableKind::Fresnel));
    assert_eq!((few.format, few.layout.base, &few.layout.x), (all.format, all.layout.base, &all.layout.x));
    for (tile, other) in few.tiles.iter().zip(&all.tiles) {
        assert_eq!((&tile.name, &tile.error), (&other.name, &other.error));
    }
}

/// Light that a film absorbs where it would be totally reflected has a kink over any cosine. The row has what others have, and its tile says
/// by how much it misses.
#[test]
fn a_row_that_none_serves_is_named_and_decides_nothing() {
    let film = "exterior = 1.5\n[[layer]]\ntype = \"thin-film\"\nior = { n = 1.45, k = 0.02 }\nthickness_nm = 200\n";
    let frustrated = material("frustrated", &(film.to_owned() + &dielectric("1.0", 0.1)), FIXED_ALBEDO);
    let alone = bake_all(&others());
    let mut set = others();
    set.push(frustrated.clone());
    let bake = bake_all(&set);
    same_rows(&alone, &bake);
    let rows = atlas(&bake, TableKind::Fresnel);
    let missed: Vec<&str> = rows.tiles.iter().filter(|t| t.miss().is_some()).map(|t| t.name.as_str()).collect();
    assert_eq!(missed, ["frustrated/0"]);

    let interface = Interface::of(&frustrated.stack, 0).unwrap().at(550.0, 1);
    let (found, stated) = errors(&bake, 2, 0, |c| interface.reflectance(c), &cosines(1.5, 1.0));
    eprintln!("frustrated: {found:.2e}, stated {stated:.2e}");
    assert!(found > AIM && (found / stated - 1.0).abs() < 0.1, "{found} {stated}");
    assert!(matches!(kinked_rows(&frustrated, &|_, _| Err(String::new())).unwrap()[..], [(0, error)] if error > AIM));
    assert!(kinked_rows(&wine_glass(), &|_, _| Err(String::new())).unwrap().is_empty());
}

/// Glass that disperses is totally reflected from another angle on at every wavelength.
#[test]
fn dispersion_is_stated_as_it_is() {
    let layers = "exterior = \"n_bk7\"\n".to_owned() + &dielectric("1.0", 0.1);
    let glass = material("glass", &layers, FIXED_ALBEDO);
    let bake = bake_all(std::slice::from_ref(&glass));
    let sampled = Interface::of(&glass.stack, 0).unwrap().sampled(&luthier_optics::color::Color::Spectral);
    let rows = atlas(&bake, TableKind::Fresnel);
    let record = &bake.materials[0].records[0];
    let error = |cos_theta: f64| {
        let read = rows.sample(0, [record.row_cosine(cos_theta), 0.0], WeightBits::Fixed(8));
        let exact = sampled.rgb(cos_theta);
        (0..3).map(|c| (read[c] - exact[c]).abs()).fold(0.0, f64::max)
    };
    let found = cosines(1.5168, 1.0).into_iter().map(error).fold(0.0, f64::max);
    let (stated, size) = (rows.tiles[0].error.max_abs_err, rows.layout.x.size);
    eprintln!("bk7: {found:.2e}, stated {stated:.2e}, {size} nodes of {}", rows.format);
    assert!(found <= stated * BETWEEN, "{found} {stated}");
}

/// An albedo tile beside a critical angle, where roughness is least, against brute force: what is stated is not less than what is there, and
/// the tile misses its aim.
#[test]
fn albedo_tiles_state_their_kinks() {
    let layers = "exterior = 1.5\n".to_owned() + &dielectric("1.0", 0.1);
    let bake = bake_all(&[material("down", &layers, "[bake]\ntables = [\"fgd\"]\n")]);
    let table = atlas(&bake, TableKind::Fgd);
    let tile = &table.tiles[0];
    let facets = Facets::Dielectric { n: 1.0 / 1.5 };
    let surface = Surface { slopes: Slopes::Ellipsoid, heights: Heights::Uniform, alpha: 0.01, facets };
    let at = [0.7415, 0.01];
    let shares = surface.shares(at[0], 1 << 17, 1);
    let share = shares.never_crossed + shares.crossed;
    let error = (table.sample(0, at, WeightBits::Fixed(8))[0] - share).abs();
    eprintln!("albedo at the kink: {error:.2e}, stated {:.2e} at {:?}", tile.error.max_abs_err, tile.error.worst.at);
    assert!(error > AIM && tile.miss().is_some(), "{error} {:?}", tile.error);
    assert!(error <= tile.error.max_abs_err + 4.0 * shares.sigma(share), "{error} {:?}", tile.error);
}
