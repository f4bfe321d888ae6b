//! Searches: budgets hold as an independent scan sees it, tighter ones never take fewer bytes, and what cannot be met is refused.

use luthier_bake::{BakeError, Baked, MemoryStore, Options, Silent, bake_with};
use luthier_lut::{RowBase, TableKind, TexelFormat, WeightBits};
use luthier_manifest::{Budget, CandidateForm, Search};
use luthier_material::Material;
use luthier_optics::interface::Interface;

use crate::materials::{STORE, atlas, bake_all, conductor, dielectric, material, no_images};

/// Albedos that no search touches: small, and their format given.
const FIXED_ALBEDO: &str = "[bake.fgd]\nsize = [8, 8]\nformat = \"rgba16float\"\n";

const LIMITS: [f64; 5] = [2e-2, 5e-3, 1e-3, 3e-4, 1e-4];

/// The bake's errors are measured at sixteen points a cell and around the worst of them; what lies between may be this much worse.
const BETWEEN: f64 = 1.02;

fn set() -> Vec<Material> {
    let coated = dielectric("1.5", 0.1) + &conductor("{ n = 0.2, k = 3.5 }", 0.3);
    vec![
        material("coated", &coated, FIXED_ALBEDO),
        material("chromium", &conductor("{ n = 3.2, k = 4.4 }", 0.3), ""),
        material("inverse", &dielectric("1.02", 0.3), ""),
    ]
}

fn with(materials: &[Material], budget: Budget) -> Result<Baked, BakeError> {
    bake_with(materials, &Options { budget, ..Options::default() }, &no_images, &Silent, &*STORE)
}

fn max_abs(limit: f64) -> Budget {
    Budget { max_abs: Some(limit), ..Budget::default() }
}

fn search(bake: &Baked, kind: TableKind) -> &Search {
    bake.searches.iter().find(|s| s.kind == kind).unwrap()
}

fn chosen(bake: &Baked, kind: TableKind) -> &luthier_manifest::Candidate {
    let search = search(bake, kind);
    &search.front[search.chosen]
}

/// Largest error of the shipped rows over 20000 cosines, half of them crowded at grazing angles.
fn fresnel_error(materials: &[Material], bake: &Baked) -> f64 {
    let rows = atlas(bake, TableKind::Fresnel);
    let mut worst = 0.0_f64;
    for (material, baked) in materials.iter().zip(&bake.materials) {
        for (i, record) in baked.records.iter().enumerate() {
            let exact = Interface::of(&material.stack, i).unwrap().at(550.0, 1);
            for step in 0..10_000 {
                let u = f64::from(step) / 9999.0;
                for cos_theta in [u, u.powi(4)] {
                    let at = [record.row_cosine(cos_theta), 0.0];
                    let read = rows.sample(record.tiles[TableKind::Fresnel].unwrap(), at, WeightBits::Fixed(8));
                    worst = worst.max((read[1] - exact.reflectance(cos_theta)).abs());
                }
            }
        }
    }
    worst
}

#[test]
fn budgets_hold_and_tighter_ones_never_take_fewer_bytes() {
    let set = set();
    let mut before = 0;
    for limit in LIMITS {
        let bake = with(&set, max_abs(limit)).unwrap();
        let found = fresnel_error(&set, &bake);
        assert!(found <= limit * BETWEEN, "{limit}: {found}");
        let candidate = chosen(&bake, TableKind::Fresnel);
        assert!(candidate.error.max_abs <= limit);
        let [width, height] = atlas(&bake, TableKind::Fresnel).layout.size();
        assert_eq!(candidate.bytes, u64::from(width * height * atlas(&bake, TableKind::Fresnel).format.texel_bytes()));
        assert!(candidate.bytes >= before, "{limit}: {} after {before}", candidate.bytes);
        before = candidate.bytes;
    }
}

#[test]
fn relative_and_seen_errors_are_limits_too() {
    let set = set();
    let rough = chosen(&with(&set, max_abs(2e-2)).unwrap(), TableKind::Fresnel).clone();
    let budget = Budget { delta_e: Some(0.3), ..max_abs(2e-2) };
    let seen = chosen(&with(&set, budget).unwrap(), TableKind::Fresnel).clone();
    assert!(seen.error.delta_e.unwrap() <= 0.3 && seen.bytes > rough.bytes);
    let budget = Budget { max_rel: Some(1e-2), ..max_abs(2e-2) };
    let relative = chosen(&with(&set, budget).unwrap(), TableKind::Fresnel).clone();
    assert!(relative.error.max_rel <= 1e-2 && relative.bytes > rough.bytes);
    assert_eq!(rough.error.delta_e, None);
}

#[test]
fn the_front_is_one() {
    let bake = with(&set(), max_abs(1e-3)).unwrap();
    for search in &bake.searches {
        assert!(search.measured as usize >= search.front.len());
        for (i, a) in search.front.iter().enumerate() {
            let beaten =
                search.front.iter().enumerate().any(|(j, b)| {
                    j != i && b.bytes <= a.bytes && b.cost <= a.cost && b.error.max_abs <= a.error.max_abs
                });
            assert!(!beaten || i == search.chosen, "{:?}: {a:?}", search.kind);
        }
    }
}

#[test]
fn bytes_and_cost_are_kept() {
    let set = set();
    let total = |bake: &Baked| -> u64 {
        let bytes = |a: &luthier_lut::Atlas| a.format.encode(&a.texels).len() as u64;
        bake.atlases.iter().map(bytes).sum()
    };
    let mut before = f64::INFINITY;
    for max_bytes in [3000, 4000, 8000] {
        let bake = with(&set, Budget { max_bytes: Some(max_bytes), ..Budget::default() }).unwrap();
        assert!(total(&bake) <= max_bytes, "{} > {max_bytes}", total(&bake));
        let error = chosen(&bake, TableKind::Fresnel).error.max_abs;
        assert!(error <= before, "{max_bytes}: {error} after {before}");
        before = error;
    }
    let bake = with(&set, Budget { max_cost: Some(60.0), ..max_abs(1e-3) }).unwrap();
    assert!(bake.searches.iter().map(|s| s.front[s.chosen].cost).sum::<f64>() <= 60.0);
    assert_eq!(atlas(&bake, TableKind::Fresnel).layout.base, RowBase::Zero, "three more fetches are too dear");
}

#[test]
fn d_is_computed_unless_a_table_is_asked_for() {
    let set = set();
    for bake in [bake_all(&set), with(&set, max_abs(1e-2)).unwrap()] {
        assert!(bake.atlases.iter().all(|a| a.kind != TableKind::Distribution));
        assert_eq!(chosen(&bake, TableKind::Distribution).form, CandidateForm::ClosedForm);
        assert!(bake.materials.iter().flat_map(|m| &m.records).all(|r| r.tiles[TableKind::Distribution].is_none()));
    }
    let asked = [material(
        "asked",
        &conductor("\"au\"", 0.3),
        "[bake]\ndistribution = { size = [16, 8] }\nfgd = { size = [8, 8] }",
    )];
    let bake = bake_all(&asked);
    assert_eq!(atlas(&bake, TableKind::Distribution).layout.size(), [16, 8]);
    assert!(bake.searches.iter().all(|s| s.kind != TableKind::Distribution));
}

#[test]
fn what_a_file_decides_is_not_searched() {
    let asked = |fresnel: &str| {
        let settings =
            format!("[bake]\nfresnel = {{ {fresnel} }}\nfgd = {{ size = [8, 8], format = \"rgba16float\" }}");
        [material("asked", &conductor("{ n = 0.2, k = 3.5 }", 0.3), &settings)]
    };
    let bake = with(&asked("size = 20"), max_abs(1e-2)).unwrap();
    assert_eq!(atlas(&bake, TableKind::Fresnel).layout.x.size, 20);
    let bake = with(&asked("format = \"rgba8unorm\""), max_abs(1e-2)).unwrap();
    let rows = atlas(&bake, TableKind::Fresnel);
    assert_eq!((rows.format, rows.layout.base), (luthier_lut::TexelFormat::Rgba8Unorm, RowBase::Zero));
    let bake = with(&asked("mapping = \"sqrt-cosine\""), max_abs(1e-2)).unwrap();
    assert_eq!(atlas(&bake, TableKind::Fresnel).layout.x.mapping, luthier_lut::Mapping::Power { exponent: 2.0 });
}

#[test]
fn threads_do_not_matter_to_a_search() {
    let mut set = set();
    set.truncate(1);
    set.push(material("free", &conductor("{ n = 1.2, k = 2.4 }", 0.3), "[bake.phase]\nsize = 16\n"));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let options = Options { budget: max_abs(3e-3), ..Options::default() };
        pool.install(|| bake_with(&set, &options, &no_images, &Silent, &MemoryStore::default()).unwrap())
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn what_cannot_be_met_says_what_could() {
    let set = set();
    let refusal = |budget| match with(&set, budget).unwrap_err() {
        BakeError::Budget { hint, .. } => hint,
        other => panic!("{other}"),
    };
    let value = |hint: &str| hint.rsplit(' ').next().unwrap().parse::<f64>().unwrap();
    let error = value(&refusal(max_abs(1e-9)));
    assert!(error > 1e-9 && with(&set, max_abs(error)).is_ok(), "{error}");
    let tight = Budget { max_bytes: Some(10), ..max_abs(1e-3) };
    let bytes = value(&refusal(tight)) as u64;
    with(&set, Budget { max_bytes: Some(bytes), ..tight }).unwrap();
    assert!(with(&set, Budget { max_bytes: Some(bytes - 1), ..tight }).is_err());
    for nonsense in [-1.0, 0.0, f64::NAN] {
        assert!(matches!(with(&set, max_abs(nonsense)), Err(BakeError::BudgetValue { name: "max_abs", .. })));
    }
}

#[test]
fn the_tightest_of_the_files_counts_and_options_replace_it() {
    let budget = |limit| format!("[budget]\nmax_abs = {limit}\n{FIXED_ALBEDO}");
    let set = [
        material("one", &conductor("{ n = 0.2, k = 3.5 }", 0.3), &budget("1e-2")),
        material("two", &conductor("{ n = 3.2, k = 4.4 }", 0.3), &budget("1e-3")),
    ];
    assert_eq!(search(&with(&set, Budget::default()).unwrap(), TableKind::Fresnel).budget, max_abs(1e-3));
    assert_eq!(search(&with(&set, max_abs(5e-3)).unwrap(), TableKind::Fresnel).budget, max_abs(5e-3));
}

/// Asked rows are taken as they are.
#[test]
fn rows_of_a_form_that_is_asked_for_are_not_searched() {
    let layers = dielectric("0.5", 0.1) + &conductor("{ n = 0.2, k = 3.5 }", 0.3);
    let inverse = material("inverse", &layers, FIXED_ALBEDO);
    let asked = (RowBase::Schlick, TexelFormat::Rgb10a2Unorm);
    let bake =
        bake_with(&[inverse], &Options { rows: Some(asked), ..Options::default() }, &no_images, &Silent, &*STORE)
            .unwrap();
    let atlas = atlas(&bake, TableKind::Fresnel);
    assert_eq!((atlas.layout.base, atlas.format), asked);
}

/// The material whose table misses, and the file that states the limit. Oracle: each material alone under the same limit, of which the worse is the one.
#[test]
fn a_refusal_names_the_material_that_breaks_the_budget() {
    let glass = |name: &str, limit: &str| material(name, &dielectric("1.5", 0.3), limit);
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.6\nthickness_nm = 900\n".to_owned();
    let film = material("film", &(film + &conductor("\"au\"", 0.3)), FIXED_ALBEDO);
    let limit = &format!("[budget]\nmax_abs = 1e-9\n{FIXED_ALBEDO}");
    let refused = |set: &[Material], budget: Budget| match with(set, budget).unwrap_err() {
        BakeError::Budget { reason, hint, diagnostics } => (reason, hint, diagnostics),
        other => panic!("{other}"),
    };
    let needs = |hint: &str| hint.rsplit(' ').next().unwrap().parse::<f64>().unwrap();
    let [of_glass, of_film] =
        [&glass("glass", FIXED_ALBEDO), &film].map(|one| needs(&refused(std::slice::from_ref(one), max_abs(1e-9)).1));
    assert!(of_film > of_glass, "{of_film} {of_glass}");
    // The file before the film states the limit; the film breaks it.
    let (reason, hint, told) =
        refused(&[glass("first", limit), film.clone(), glass("last", FIXED_ALBEDO)], Budget::default());
    assert!(reason.contains("no fresnel table is good enough for layer 0 of `film` (film.toml:"), "{reason}");
    assert!(reason.contains("under max_abs = 1e-9 of first.toml:9;"), "{reason}");
    assert_eq!(needs(&hint), of_film);
    assert_eq!((told.len(), told[0].label.as_str()), (1, "film.toml"));
    // A limit of the options has no place; the material has.
    let (reason, _, told) = refused(&[glass("first", limit), film], max_abs(1e-8));
    assert!(reason.contains("`film` (film.toml:") && reason.contains("under max_abs = 1e-8;"), "{reason}");
    assert_eq!(told[0].label, "film.toml");
    // Bytes are of all together: the file that states the limit is named.
    let bytes = "[budget]\nmax_abs = 1e-3\nmax_bytes = 16\n";
    let (reason, _, told) =
        refused(&[glass("first", FIXED_ALBEDO), glass("small", &format!("{bytes}{FIXED_ALBEDO}"))], Budget::default());
    assert!(reason.ends_with("more than max_bytes = 16 of small.toml:10"), "{reason}");
    assert_eq!((told[0].label.as_str(), told[0].line), ("small.toml", 10));
}
