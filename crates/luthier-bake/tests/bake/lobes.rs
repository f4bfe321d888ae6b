//! Rows of lobes in both layouts, and the numbers of lobes that hold at all views.

use std::collections::BTreeSet;

use luthier_bake::{Baked, Options, Silent, bake_with};
use luthier_lut::{RowLayout, TableKind, WeightBits};
use luthier_manifest::{Budget, CandidateForm, LobesForm, LobesRecord, ShadingModel};
use luthier_material::Material;

use crate::materials::{STORE, atlas, conductor, dielectric, material, no_images};

/// A coat over a base.
fn coated(name: &str, coat: f64, base: &str) -> Material {
    let layers = dielectric("1.5", coat) + base;
    let mut coated = material(name, &layers, "");
    coated.bake.model = Some(ShadingModel::Lobes);
    coated
}

/// A line of a layer.
const BECKMANN: &str = "distribution = \"beckmann\"\n";

fn bake(materials: &[Material], layout: RowLayout) -> Baked {
    let options = Options { layout: Some(layout), ..Options::default() };
    bake_with(materials, &options, &no_images, &Silent, &*STORE).unwrap()
}

/// Shaders take the decays of lobes from the record of a material, and not from its rows: all rows of a tile have them. Steps hold the same rows.
#[test]
fn rows_have_the_decays_of_the_record_in_both_layouts() {
    let mut last_parts = Vec::new();
    let metal = conductor("{ n = 0.2, k = 3.0 }", 0.1);
    let paint = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";
    for (name, coat, base) in [("two", 0.35, metal.as_str()), ("one", 0.3, paint)] {
        let materials = [coated(name, coat, base)];
        let [filtered, steps] = [RowLayout::Filtered, RowLayout::Steps].map(|layout| bake(&materials, layout));
        let decays = filtered.materials[0].constants.lobes.unwrap().inverse_tails;
        assert_eq!(steps.materials[0].constants.lobes.unwrap().inverse_tails, decays);
        let [filtered, steps] = [&filtered, &steps].map(|baked| atlas(baked, TableKind::Lobes));
        assert_eq!((filtered.format, steps.format), (RowLayout::Filtered.format(), RowLayout::Steps.format()));
        assert_eq!((steps.bytes.len(), &steps.texels.data), (2 * filtered.bytes.len(), &filtered.texels.data));
        let (x, y) = (&filtered.layout.x, filtered.layout.y.as_ref().unwrap());
        last_parts.push(y.max);
        // One lobe has a part with its decay in the third place, two have one with both, in the first and third.
        let (part, places): (f64, &[usize]) = if y.max == 5.0 { (4.0, &[0, 2]) } else { (2.0, &[2]) };
        for i in 0..x.size {
            let texel = filtered.sample(0, [x.node(i), part], WeightBits::Exact);
            for (place, decay) in places.iter().zip(decays) {
                assert_eq!(texel[*place], decay, "{name}: node {i} of part {part}");
            }
        }
        // Between nodes both layouts are a line; a step is a half float, whose eleven binary digits are right to half a unit of the last.
        for (i, j) in (0..200).flat_map(|i| (0..y.size).map(move |j| (i, j))) {
            let (at, part) = (f64::from(i) / 199.0, y.min + f64::from(j));
            let node = (x.index(at) as u32).min(x.size - 2);
            let [from, to] = [node, node + 1].map(|i| filtered.sample(0, [x.node(i), part], WeightBits::Exact));
            let [line, stepped] = [filtered, steps].map(|atlas| atlas.sample(0, [at, part], WeightBits::Exact));
            for c in 0..4 {
                let most = (to[c] - from[c]).abs() / 2048.0 + libm::exp2(-25.0);
                let off = (line[c] - stepped[c]).abs();
                assert!(off <= most, "{name} part {part} at {at}: {line:?} {stepped:?}");
            }
        }
    }
    assert_eq!(last_parts, [5.0, 3.0], "two lobes and one");
}

/// A limit on the lobe error takes one lobe of one width where that holds, which costs fewer reads than two lobes in fewer bytes would. A tight limit takes two lobes.
#[test]
fn a_limit_takes_the_form_of_the_lowest_cost() {
    let metal = conductor("{ n = 0.2, k = 3.0 }", 0.1);
    let materials = [coated("two", 0.35, &metal)];
    let last_part = |most: f64| {
        let budget = Budget { max_lobe_err: Some(most), ..Budget::default() };
        let baked =
            bake_with(&materials, &Options { budget, ..Options::default() }, &no_images, &Silent, &*STORE).unwrap();
        let lobes = baked.materials[0].constants.lobes.unwrap();
        assert!(lobes.error.unwrap().lobe <= most, "{lobes:?}");
        (atlas(&baked, TableKind::Lobes).layout.y.as_ref().unwrap().max, lobes.rise.is_some())
    };
    assert_eq!(last_part(0.06), (2.0, true));
    assert_eq!(last_part(0.03), (5.0, false));
}

/// Light that leaves a coat over a thinner medium by several ways has more than two lobes. Without limits there are two.
#[test]
fn a_tight_limit_takes_a_third_lobe() {
    let layers = [("1.99", 0.086), ("0.82", 0.255)].map(|(ior, alpha)| dielectric(ior, alpha)).concat();
    let mut coats = material("coats", &(layers + &conductor("\"au\"", 0.025)), "");
    coats.bake.model = Some(ShadingModel::Lobes);
    let materials = [coats];
    let of = |limit: Option<f64>| {
        let budget = Budget { max_lobe_err: limit, ..Budget::default() };
        bake_with(&materials, &Options { budget, ..Options::default() }, &no_images, &Silent, &*STORE).unwrap()
    };
    let last_part = |baked: &Baked| atlas(baked, TableKind::Lobes).layout.y.as_ref().unwrap().max;
    assert_eq!(last_part(&of(None)), 5.0);
    let all = of(Some(1.0));
    let search = all.searches.iter().find(|search| search.kind == TableKind::Lobes).unwrap();
    let least = |last: f64| {
        let of_form = search.front.iter().filter(|candidate| match &candidate.form {
            CandidateForm::Table { y: Some(y), .. } => y.max == last,
            _ => false,
        });
        of_form.filter_map(|candidate| candidate.error.lobe).fold(f64::INFINITY, f64::min)
    };
    let [two, three] = [5.0, 7.0].map(least);
    assert!(three < 0.9 * two, "{three} {two}");
    let tight = of(Some(0.5 * (two + three)));
    let record = tight.materials[0].constants.lobes.unwrap();
    assert_eq!((record.lobes, LobesForm::of(&record), last_part(&tight)), (3, Some(LobesForm::ThreeLobes), 7.0));
    assert!(record.error.unwrap().lobe <= 0.5 * (two + three));
    assert_eq!(last_part(&of(Some(1.01 * two))), 5.0);
}

/// A metal below a coat of GGX takes one read for a view where a limit allows it, and a diffuse base takes more, each as alone.
#[test]
fn a_limit_takes_a_short_lobe() {
    let lacquered = coated("lacquered", 0.3, &conductor("{ n = 0.2, k = 3.0 }", 0.3));
    let over_white = dielectric("1.5", 0.3) + &dielectric("1.4", 0.2) + "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.7\n";
    let mut white = material("white", &over_white, "");
    white.bake.model = Some(ShadingModel::Lobes);
    let forms = |materials: &[Material], max_lobe_err: f64| {
        let budget = Budget { max_lobe_err: Some(max_lobe_err), ..Budget::default() };
        let baked =
            bake_with(materials, &Options { budget, ..Options::default() }, &no_images, &Silent, &*STORE).unwrap();
        let records = baked.materials.iter().map(|material| material.constants.lobes.unwrap());
        let held = records.inspect(|record| assert!(record.error.unwrap().lobe <= max_lobe_err, "{record:?}"));
        held.map(|record| LobesForm::of(&record).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(forms(std::slice::from_ref(&lacquered), 0.05), [LobesForm::ShortLobe]);
    let [with, alone] = [vec![lacquered, white.clone()], vec![white]].map(|materials| forms(&materials, 0.05));
    assert_eq!(with, [LobesForm::ShortLobe, alone[0]]);
    assert_ne!(alone[0], LobesForm::ShortLobe);
}

/// Materials that differ in what they need: each takes its own form in the common bake, and its rows show the light that they show alone.
#[test]
fn each_material_of_a_bake_takes_the_form_that_it_needs() {
    let metal = |k: f64, alpha| conductor(&format!("{{ n = 0.2, k = {k} }}"), alpha);
    let layers = [
        dielectric("1.5", 0.3) + &metal(3.0, 0.3),
        dielectric("1.5", 0.02) + BECKMANN + &dielectric("2.0", 0.02) + BECKMANN + &metal(3.0, 0.4) + BECKMANN,
        dielectric("1.5", 0.1) + BECKMANN + &metal(3.0, 0.1) + BECKMANN,
        dielectric("1.4", 0.2) + "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.3\n",
        conductor("\"cu\"", 0.2),
    ];
    let of = |(number, layers): (usize, &String)| {
        let mut material = material(&format!("material-{number}"), layers, "");
        material.bake.model = Some(ShadingModel::Lobes);
        material
    };
    let materials: Vec<Material> = layers.iter().enumerate().map(of).collect();
    let budget = Budget { max_lobe_err: Some(0.05), max_albedo_err: Some(0.02), ..Budget::default() };
    let options = Options { budget, ..Options::default() };
    let bake = |materials: &[Material]| bake_with(materials, &options, &no_images, &Silent, &*STORE).unwrap();
    let form = |record: &LobesRecord| (LobesForm::of(record).unwrap(), record.reflectance.is_some());
    let common = bake(&materials);
    let records: Vec<LobesRecord> = common.materials.iter().map(|material| material.constants.lobes.unwrap()).collect();
    let forms: Vec<(LobesForm, bool)> = records.iter().map(form).collect();
    let distinct: BTreeSet<String> = forms.iter().map(|form| format!("{form:?}")).collect();
    assert!(distinct.len() >= 4, "{forms:?}");
    let rows = atlas(&common, TableKind::Lobes);
    let search = common.searches.iter().find(|search| search.kind == TableKind::Lobes).unwrap();
    let chosen = &search.front[search.chosen];
    let CandidateForm::Table { x, y, format, .. } = &chosen.form else { panic!("{chosen:?}") };
    assert_eq!((x, y, format), (&rows.layout.x, &rows.layout.y, &rows.format));
    let largest = records.iter().map(|record| record.error.unwrap().lobe).fold(0.0, f64::max);
    assert!(chosen.error.lobe == Some(largest) && largest <= 0.05, "{chosen:?} {largest}");
    for (number, (material, record)) in materials.iter().zip(&records).enumerate() {
        let alone = bake(std::slice::from_ref(material));
        let own = alone.materials[0].constants.lobes.unwrap();
        // More rows may suffice for fewer reads.
        let reads = |form: LobesForm| LobesForm::ALL.iter().position(|other| *other == form);
        assert!(reads(form(record).0) <= reads(form(&own).0), "{number}: {record:?} {own:?}");
        let alone = atlas(&alone, TableKind::Lobes);
        if form(record) == form(&own) && alone.layout.x.size == rows.layout.x.size {
            // Layouts round differently. A remainder and a first lobe have the same places in all forms but that of a short lobe; a short lobe has the second alone, and rows without a lobe the first.
            let from = alone.layout.y.as_ref().unwrap().min.max(0.0) as u32;
            for (part, c) in
                (from..=record.lobes.min(1)).flat_map(|part| (0..8).map(move |i| (f64::from(part), f64::from(i) / 8.0)))
            {
                let tile = number as u32;
                let [found, expected] =
                    [(rows, tile), (alone, 0)].map(|(rows, tile)| rows.sample(tile, [c, part], WeightBits::Exact));
                let is_same =
                    found.iter().zip(expected).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-3 * a.abs().max(0.1));
                assert!(is_same, "{number} {part}: {found:?} {expected:?}");
            }
        }
    }
}

/// Under a limit a clear coat reflects by a polynomial, and a metal beside it does not; without one both have Fresnel's equations.
#[test]
fn a_limit_takes_a_polynomial_for_the_first_interface() {
    let clear = coated("clear", 0.3, &conductor("{ n = 0.2, k = 3.0 }", 0.3));
    let metal = {
        let mut metal = material("metal", &conductor("\"cu\"", 0.3), "");
        metal.bake.model = Some(ShadingModel::Lobes);
        metal
    };
    let reflectances = |materials: &[Material], max_lobe_err: Option<f64>| {
        let budget = Budget { max_lobe_err, ..Budget::default() };
        let baked =
            bake_with(materials, &Options { budget, ..Options::default() }, &no_images, &Silent, &*STORE).unwrap();
        baked.materials.iter().map(|material| material.constants.lobes.unwrap().reflectance).collect::<Vec<_>>()
    };
    let [alone] = reflectances(std::slice::from_ref(&clear), Some(0.03))[..] else { panic!("one material") };
    let [f, ..] = alone.unwrap();
    assert!((f - 0.04).abs() < 1e-9, "{f}");
    assert_eq!(reflectances(std::slice::from_ref(&clear), None), [None]);
    assert!(matches!(reflectances(&[clear, metal], Some(0.05))[..], [Some(_), None]));
}

/// Two lobes in the half vectors of a steep coat seem near at flat views in cells of these half vectors, and are .07 off there. A judge sees that lobes in other half
/// vectors are nearer.
#[test]
fn a_limit_takes_lobes_in_the_medium_where_they_are_nearest() {
    let layers = [dielectric("2.22", 0.115), conductor("\"ti\"", 0.157)].map(|layer| layer + BECKMANN).concat();
    let of = |limit: Option<f64>, form: Option<LobesForm>, maps: &str| {
        let mut steep = material("steep", &format!("{layers}{maps}"), "");
        steep.bake.model = Some(ShadingModel::Lobes);
        steep.bake.lobes = form;
        let materials = [steep];
        let budget = Budget { max_lobe_err: limit, ..Budget::default() };
        let baked = bake_with(&materials, &Options { budget, ..Options::default() }, &no_images, &Silent, &*STORE);
        baked.unwrap().materials[0].constants.lobes.unwrap()
    };
    let [usual, near] = [None, Some(0.03)].map(|limit| of(limit, None, ""));
    assert!(usual.index > 2.0 && usual.error.unwrap().lobe > 0.045, "{usual:?}");
    assert!(near.index < 1.1 && near.lobes == 2 && near.error.unwrap().lobe < 0.03, "{near:?}");
    // A form chooses among media, too, but where a layer leans: lobes stay where their light was measured.
    let [flat, leaning] = ["", "maps = { bumps = \"b.png\" }\n"].map(|maps| of(None, Some(LobesForm::TwoLobes), maps));
    assert_eq!([flat, leaning].map(|lobes| lobes.index), [near.index, usual.index]);
}

/// Light through three coats of which two are thinner than what is above them changes fast next to two critical angles.
#[test]
fn a_limit_that_no_lobes_hold_takes_rows_twice_as_close() {
    let coats =
        [("0.73", 0.153), ("0.60", 0.243), ("1.72", 0.13)].map(|(ior, alpha)| dielectric(ior, alpha) + BECKMANN);
    let mut thin = material("thin", &(coats.concat() + &conductor("\"cu\"", 0.129) + BECKMANN), "");
    thin.bake.model = Some(ShadingModel::Lobes);
    let materials = [thin, coated("plain", 0.1, &conductor("{ n = 0.2, k = 3.0 }", 0.1))];
    let of = |limit: f64| {
        let budget = Budget { max_lobe_err: Some(limit), ..Budget::default() };
        bake_with(&materials, &Options { budget, ..Options::default() }, &no_images, &Silent, &*STORE).unwrap()
    };
    let rows = |baked: &Baked| atlas(baked, TableKind::Lobes).layout.x.size;
    let all = of(1.0);
    assert!(rows(&all) < 20);
    let search = all.searches.iter().find(|search| search.kind == TableKind::Lobes).unwrap();
    let least = |is_fine: bool| {
        let of_rows = search.front.iter().filter(|candidate| match &candidate.form {
            CandidateForm::Table { x, .. } => (x.size > 20) == is_fine,
            _ => false,
        });
        of_rows.filter_map(|candidate| candidate.error.lobe).fold(f64::INFINITY, f64::min)
    };
    let [coarse, fine] = [false, true].map(least);
    assert!(fine < 0.9 * coarse, "{fine} {coarse}");
    let tight = of(0.5 * (coarse + fine));
    assert_eq!(rows(&tight), 37);
    // The rows of the other material show the light that they did.
    let errors = tight.materials.iter().map(|material| material.constants.lobes.unwrap().error.unwrap().lobe);
    assert!(errors.fold(0.0, f64::max) <= 0.5 * (coarse + fine));
}

/// Rows of a coat with a weight beside textures are those of two materials: the one without the weight, and the layers below the coat alone.
#[test]
fn sides_of_a_coat_have_the_rows_of_two_materials() {
    let coat = dielectric("1.5", 0.2);
    let metal = conductor("{ n = 0.2, k = 3.0 }", 0.3) + "maps = { alpha = \"a.png\" }\n";
    let engine =
        "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.8\nalpha = 0.4\nmaps = { base_color = \"c.png\" }\n";
    let paint = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\nmaps = { albedo = \"c.png\" }\n";
    for (below, tiles) in [(metal.as_str(), [3, 3]), (engine, [1, 1]), (paint, [1, 0])] {
        let of = |name: &str, layers: &str| {
            let mut material = material(name, layers, "");
            material.bake.model = Some(ShadingModel::Lobes);
            // Texels from a quarter to all.
            material.layers.iter_mut().for_each(|layer| layer.texels.alpha = [0.25, 1.0]);
            material
        };
        let weighed = [of("weighed", &format!("{coat}weight = 0.3\n{below}"))];
        let both = bake(&weighed, RowLayout::Filtered);
        let [whole, alone] = [of("whole", &(coat.clone() + below)), of("alone", below)]
            .map(|material| bake(&[material], RowLayout::Filtered));
        let constants = &both.materials[0].constants;
        let coat = constants.coat.as_ref().unwrap();
        assert_eq!(constants.lobes, whole.materials[0].constants.lobes);
        let side = coat.side.unwrap().lobes;
        assert_eq!(side, alone.materials[0].constants.lobes.filter(|_| tiles[1] > 0));
        let rows = atlas(&both, TableKind::Lobes);
        assert_eq!(rows.layout.tiles, tiles.iter().sum::<u32>());
        assert_eq!(coat.bare.tiles[TableKind::Lobes], (tiles[1] > 0).then_some(tiles[0]));
        let parts = rows.layout.y.clone().unwrap();
        for (baked, first, count) in
            [(&whole, 0, tiles[0]), (&alone, tiles[0], tiles[1])].into_iter().filter(|of| of.2 > 0)
        {
            let expected = atlas(baked, TableKind::Lobes);
            assert_eq!(expected.layout.tiles, count);
            for (tile, part, c) in (0..count).flat_map(|t| (0..parts.size).map(move |p| (t, p, f64::from(p) / 8.0))) {
                let at = [c, parts.min + f64::from(part)];
                let [found, expected] = [(rows, first + tile), (expected, tile)]
                    .map(|(rows, tile)| rows.sample(tile, at, WeightBits::Exact));
                assert_eq!(found, expected, "{below} {tile} {part}");
            }
        }
        // One axis has less than 10 KiB a side.
        assert!(rows.bytes.len() < 10 * 1024 * tiles.iter().filter(|count| **count > 0).count());
    }
}

/// A file chooses the form of its material: a set has parts of one width where none has more, and as many parts as the material with the most lobes.
#[test]
fn forms_of_materials_decide_the_rows_of_a_set() {
    let with = |name: &str, form| {
        let mut coated = coated(name, 0.1, &conductor("{ n = 0.2, k = 3.0 }", 0.3));
        coated.bake.lobes = Some(form);
        coated
    };
    let [none, short, narrow, one, two, three] = LobesForm::ALL.map(|form| with(form.name(), form));
    for (materials, ends) in [
        ([none.clone(), with("other", LobesForm::NoLobe)], [0.0, 1.0]),
        ([short.clone(), with("other", LobesForm::ShortLobe)], [1.0, 2.0]),
        ([none.clone(), narrow.clone()], [0.0, 2.0]),
        ([narrow.clone(), one.clone()], [0.0, 3.0]),
        ([short.clone(), narrow.clone()], [0.0, 3.0]),
        ([none.clone(), two.clone()], [0.0, 5.0]),
        ([two.clone(), three.clone()], [0.0, 7.0]),
    ] {
        let baked = bake_with(&materials, &Options::default(), &no_images, &Silent, &*STORE).unwrap();
        let forms = materials.each_ref().map(|material| material.bake.lobes.unwrap());
        let parts = atlas(&baked, TableKind::Lobes).layout.y.as_ref().unwrap();
        assert_eq!([parts.min, parts.max], ends, "{forms:?}");
        for (baked, form) in baked.materials.iter().zip(forms) {
            let record = baked.constants.lobes.unwrap();
            let has = (record.rise.is_some(), record.short.is_some());
            let is_short = form == LobesForm::ShortLobe;
            let has_one_width = is_short || form == LobesForm::OneWidth || ends[1] == 2.0;
            assert_eq!((record.lobes as usize, has), (form.most(), (has_one_width, is_short)), "{forms:?}");
            assert!(record.error.is_some_and(|error| error.lobe > 0.0));
        }
        // Without fits an outline has the same tables.
        let outlined =
            luthier_bake::outline_with(&materials, &Options { fits: false, ..Options::default() }, &no_images, &*STORE);
        let outlined = outlined.unwrap();
        let (_, layout, format) = outlined.tables.iter().find(|(kind, ..)| *kind == TableKind::Lobes).unwrap();
        let baked = atlas(&baked, TableKind::Lobes);
        assert_eq!((layout, format), (&baked.layout, &baked.format), "{forms:?}");
    }
}
