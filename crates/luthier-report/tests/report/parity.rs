//! The parity run against devices whose errors are known.

use luthier_lut::TableKind;
use luthier_manifest::ShadingModel;
use luthier_report::{
    Factor, Form, POLISHED_ALPHAS, Parity, ParityCase, ParityRow, ParitySet, ReportError, Settings, Share, Verdict,
    judge, parity,
};

use crate::fixture::Bake;

const MODELS: [ShadingModel; 7] = [
    ShadingModel::Elek,
    ShadingModel::WeidlichWilkie,
    ShadingModel::GranierHeidrich,
    ShadingModel::Belcour,
    ShadingModel::Yamaguchi,
    ShadingModel::Phong,
    ShadingModel::Microfacet,
];

fn shaded(model: ShadingModel) -> Bake {
    if matches!(model, ShadingModel::Belcour | ShadingModel::Yamaguchi) {
        return Bake::statistical(model);
    }
    let mut bake = Bake::new();
    bake.manifest.materials.iter_mut().for_each(|material| material.model = model);
    bake
}

/// The materials of the fixture, each its own polished variants.
fn cases(bake: &Bake) -> Vec<ParityCase> {
    let case = |(n, m): (u32, &luthier_manifest::MaterialEntry)| ParityCase {
        name: m.name.clone(),
        material: n,
        polished: vec![n; POLISHED_ALPHAS.len()],
    };
    (0..).zip(&bake.manifest.materials).map(case).collect()
}

fn rows(bake: &Bake, spoil: impl Fn(Form, u32, usize, [f32; 3]) -> [f32; 3]) -> Vec<ParityRow> {
    let device = bake.device(spoil);
    parity(&bake.subject(), &device, &cases(bake), 120, &mut || {}).unwrap()
}

/// A device that computes in f64 has no arithmetic error but the rounding of its results, in any model; what it reads from tables is
/// found, and only where tables are read.
#[test]
fn errors_of_tables_and_of_arithmetic_are_told_apart() {
    for model in MODELS {
        let found = rows(&shaded(model), |_, _, _, value| value);
        assert_eq!(found.len(), 8);
        for row in &found {
            let name = format!("{} {} {}", model.name(), row.form, row.material);
            assert_eq!((row.pairs, row.not_finite), (600, 0), "{name}");
            assert!(row.arithmetic.max < 1.2e-7, "{name}: {}", row.arithmetic.max);
            assert_eq!(row.verdict(Share::Arithmetic), Verdict::Met);
            assert_eq!(row.table.is_some(), row.form == Form::Baked, "{name}");
            let is_bare_metal = row.material.contains("satin");
            let reads = row.form == Form::Baked && is_bare_metal && model != ShadingModel::Phong;
            if reads {
                assert!(row.max(Share::Table) > 1e-6, "{name}");
                assert!(!row.parts.is_empty(), "{name}");
            }
            if model == ShadingModel::Phong {
                assert_eq!(row.max(Share::Table), 0.0);
            }
        }
    }
}

/// Puts something wrong into a bake.
type Spoil = fn(&mut Bake);

/// A spoilt texel of a table, or a wrong constant, is named as the cause.
#[test]
fn what_statistical_models_read_wrong_is_named() {
    let spoil: [(Factor, Spoil); 3] = [
        (Factor::Fgd, |bake| bake.texels(TableKind::Fgd).iter_mut().for_each(|v| *v *= 0.8)),
        (Factor::Escape, |bake| bake.texels(TableKind::Escape).iter_mut().for_each(|v| *v *= 0.5)),
        (Factor::Veil, |bake| bake.manifest.materials[0].constants.internal_reflectance = [0.9; 3]),
    ];
    for (factor, spoil) in spoil {
        let mut bake = shaded(ShadingModel::Yamaguchi);
        spoil(&mut bake);
        let found = rows(&bake, |_, _, _, value| value);
        let of = if factor == Factor::Veil { "red-lacquer" } else { "lacquered-copper" };
        let row = found.iter().find(|row| row.material == of && row.form == Form::Baked).unwrap();
        assert_eq!(row.parts[0].cause.factor(), factor, "{:?}", row.parts);
        assert!(row.max(Share::Table) > 0.05 && row.arithmetic.max < 1.2e-7, "{factor:?}: {}", row.max(Share::Table));
    }
}

/// A statistical model cannot be judged without its tile.
#[test]
fn a_missing_tile_is_refused() {
    for kind in [TableKind::Fgd, TableKind::Escape] {
        let mut bake = shaded(ShadingModel::Belcour);
        let record = &mut bake.manifest.materials[1].layers[0];
        *(if kind == TableKind::Fgd {
            &mut record.tiles[TableKind::Fgd]
        } else {
            &mut record.tiles[TableKind::Escape]
        }) = None;
        let refusal = judge(&bake.subject(), None, &Settings { pairs_per_set: 8, ..Settings::default() }).unwrap_err();
        let expected = ReportError::MissingTile { material: "lacquered-copper".to_owned(), layer: 0, kind };
        assert_eq!(refusal.to_string(), expected.to_string());
    }
}

#[test]
fn an_error_of_arithmetic_breaks_its_tolerance() {
    let found = rows(&shaded(ShadingModel::Phong), |form, material, pair, value| {
        if (form, material, pair) == (Form::Full, 2, 7) { value.map(|v| v + 1.0) } else { value }
    });
    let broken: Vec<&ParityRow> = found.iter().filter(|row| !row.holds()).collect();
    assert_eq!(broken.len(), 1);
    assert_eq!((broken[0].form, broken[0].verdict(Share::Arithmetic)), (Form::Full, Verdict::Broken));
    let (set, worst) = broken[0].worst_arithmetic.as_ref().unwrap();
    assert!((worst.found - worst.expected - 1.0).abs() < 1e-5, "{set:?} {worst:?}");
    let page = Parity::new("test", "none".to_owned(), 120, found.clone()).to_markdown("the command");
    assert!(page.contains("**not accepted**") && page.contains("the command"), "{page}");
}

#[test]
fn values_that_are_not_finite_are_never_accepted() {
    let found = rows(&shaded(ShadingModel::Microfacet), |form, material, pair, value| {
        if (form, material, pair) == (Form::Baked, 0, 3) { [f32::NAN, value[1], f32::INFINITY] } else { value }
    });
    // The pair is the fourth of each of eight runs: four sets, and the smooth set four times.
    assert_eq!(found[0].not_finite, 2 * (4 + POLISHED_ALPHAS.len() as u64));
    assert!(!found[0].holds());
    assert_eq!(found[1].not_finite, 0);
}

#[test]
fn json_reads_back() {
    let report = Parity::new("test", "none".to_owned(), 120, rows(&shaded(ShadingModel::Elek), |_, _, _, v| v));
    let json = report.to_json().unwrap();
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(value["rows"][0]["model"], "elek");
    assert_eq!(value["rows"][0]["sets"].as_array().unwrap().len(), ParitySet::ALL.len());
}

/// The judge of a bake takes any model that has a twin.
#[test]
fn a_bake_of_any_model_is_judged() {
    for model in MODELS {
        let bake = shaded(model);
        let device = bake.device(|_, _, _, value| value);
        let settings = Settings { pairs_per_set: 64, ..Settings::default() };
        let report = judge(&bake.subject(), Some(&device), &settings).unwrap();
        assert_eq!(report.model, model.name());
        let arithmetic = report.max_arithmetic_error().unwrap();
        assert!(arithmetic < 1.2e-7, "{}: {arithmetic}", model.name());
    }
}
