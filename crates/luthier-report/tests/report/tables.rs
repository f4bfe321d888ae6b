//! Tables whose right values are known without the code that the judge uses.

use luthier_layers::terms::Terms;
use luthier_layers::twins::terms::Exact;
use luthier_lut::{AtlasLayout, Image, Mapping, TableKind, TexelFormat};
use luthier_manifest::{ColorMode, ShadingModel};
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Film, FilmThickness, Slab};
use luthier_report::{FilmMap, FilmSource, Report, Settings, Subject, TableTerms, TileReport, Weights, judge};

use crate::fixture::{Bake, WAVELENGTHS_NM, axis, table};

fn judged(bake: &Bake) -> Report {
    with_pairs(bake, 20)
}

fn with_pairs(bake: &Bake, pairs_per_set: u32) -> Report {
    judge(&bake.subject(), None, &Settings { pairs_per_set, ..Settings::default() }).unwrap()
}

fn tiles(report: &Report, kind: TableKind) -> &[TileReport] {
    &report.tables.iter().find(|t| t.kind == kind).unwrap().tiles
}

impl Bake {
    /// Adds a table of which every texel is a function of tile, column and row.
    fn add(&mut self, kind: TableKind, layout: AtlasLayout, texel: impl Fn(u32, u32, u32) -> [f32; 4]) {
        let [width, height] = layout.size();
        let mut truth = Image::zeros(width, height, 4);
        let [tile_width, tile_height] = layout.tile_size();
        for tile in 0..layout.tiles {
            let [x0, y0] = layout.origin(tile);
            for (x, y) in (0..tile_height).flat_map(|y| (0..tile_width).map(move |x| (x, y))) {
                truth.texel_mut(x0 + x, y0 + y).copy_from_slice(&texel(tile, x, y));
            }
        }
        let names = (0..layout.tiles).map(|t| format!("{}-{t}", kind.name())).collect();
        let (entry, texels) = table(kind, layout, TexelFormat::Rgba16Float, names, &truth);
        self.manifest.tables.push(entry);
        self.textures.push((kind, texels));
    }
}

/// Half floats at 32 x 16 nodes, and the same with one texel of the middle a tenth too low.
#[test]
fn escape_tiles_are_measured() {
    let worst = |spoil: f32| {
        let mut bake = Bake::statistical(ShadingModel::Belcour);
        bake.texels(TableKind::Escape)[(8 * 32 + 16) * 4] -= spoil;
        let report = judged(&bake);
        let tile = &tiles(&report, TableKind::Escape)[0];
        assert_eq!(tile.users, ["lacquered-copper/0"]);
        tile.judge.as_ref().unwrap().max_abs_err
    };
    let (good, bad) = (worst(0.0), worst(0.1));
    assert!(good < 0.04 && bad > 0.06 && bad < 0.11, "{good} {bad}");
}

#[test]
fn albedos_of_a_perfect_mirror_and_of_nothing_at_all() {
    let mut bake = Bake::new();
    // A mirror that loses nothing: 1, for every direction and roughness. An interface between equal media: 0.
    bake.stacks[2].layers[0].base = Base::Conductor { ior: Ior::constant(1.0, 1e6).unwrap() };
    let slab = Slab { thickness_um: 50.0, absorption_per_um: [0.0; 3] };
    bake.stacks[0].layers[0].base = Base::Dielectric { ior: Ior::constant(1.0, 0.0).unwrap(), slab };
    bake.manifest.materials[2].layers[0].tiles[TableKind::Fgd] = Some(0);
    bake.manifest.materials[0].layers[0].tiles[TableKind::Fgd] = Some(1);
    let layout = AtlasLayout {
        x: axis("cos_theta", 0.0, 1.0, 8, Mapping::Power { exponent: 2.0 }),
        y: Some(axis("alpha", 0.0, 1.0, 8, Mapping::Power { exponent: 3.0 })),
        apron: 0,
        columns: 1,
        tiles: 3,
        base: luthier_lut::RowBase::Zero,
    };
    // The second table is a sixteenth too high; nobody reads the third.
    bake.add(TableKind::Fgd, layout, |tile, _, _| if tile == 0 { [1.0; 4] } else { [0.0625; 4] });
    let report = with_pairs(&bake, 24 * 64);
    let [mirror, nothing, unread] = tiles(&report, TableKind::Fgd) else { panic!() };
    let judge = mirror.judge.as_ref().unwrap();
    assert!(judge.max_abs_err < 1e-4, "{judge:?}");
    assert!(judge.points == 24 * 4 && judge.worst.at[0] >= 0.0087 && judge.worst.at[1] >= 0.01);
    assert!(mirror.uncertainty.unwrap() < 1e-5);
    let judge = nothing.judge.as_ref().unwrap();
    assert!((judge.max_abs_err - 0.0625).abs() < 1e-9 && (judge.rms_err - 0.0625).abs() < 1e-9, "{judge:?}");
    assert!(unread.judge.is_none() && unread.uncertainty.is_none());
}

#[test]
fn phases_follow_the_closed_form() {
    let mut bake = Bake::new();
    // 2 d_max n / lambda is 1, 2 and 3 waves, so that five nodes hold whole quarters.
    let thickness = FilmThickness { min_nm: 100.0, max_nm: 300.0 };
    bake.stacks[1].layers[0].films = vec![Film { ior: Ior::constant(1.5, 0.0).unwrap(), thickness }];
    bake.manifest.materials[1].wavelengths_nm = [900.0, 450.0, 300.0];
    bake.manifest.materials[1].layers[0].tiles[TableKind::Phase] = Some(0);
    let nodes = [[2.0, 2.0, 2.0], [0.0, -2.0, 0.0], [-2.0, 2.0, -2.0], [0.0, -2.0, 0.0], [2.0, 2.0, 2.0]];
    let x = axis("s", 0.0, 1.0, 5, Mapping::Linear);
    bake.add(
        TableKind::Phase,
        AtlasLayout { x, y: None, apron: 0, columns: 1, tiles: 1, base: luthier_lut::RowBase::Zero },
        |_, x, _| {
            let [r, g, b] = nodes[x as usize];
            [r, g, b, 1.0]
        },
    );
    let report = judged(&bake);
    let judge = tiles(&report, TableKind::Phase)[0].judge.as_ref().unwrap();
    // Three quarters of a wave between nodes: |2 cos x - 2 + 4x/(3 pi)| is largest, 2.7119, where sin x = 2/(3 pi).
    assert_eq!(judge.worst.channel, 2);
    assert!((2.6..2.7125).contains(&judge.max_abs_err), "{judge:?}");
}

/// Reflectance of a film of index 1.9 on one of 1.5 (Airy), both real.
fn airy(cos_theta: f64, nm: f64, wavelength_nm: f64) -> f64 {
    let n = [1.0, 1.9, 1.5];
    let cos = n.map(|n| (1.0 - (1.0 - cos_theta * cos_theta) / (n * n)).sqrt());
    let delay = libm::cos(4.0 * std::f64::consts::PI * n[1] * nm * cos[1] / wavelength_nm);
    let power = |a: f64, b: f64| (a * a + b * b + 2.0 * a * b * delay) / (1.0 + a * a * b * b + 2.0 * a * b * delay);
    let s = |i: usize| (n[i] * cos[i] - n[i + 1] * cos[i + 1]) / (n[i] * cos[i] + n[i + 1] * cos[i + 1]);
    let p = |i: usize| (n[i + 1] * cos[i] - n[i] * cos[i + 1]) / (n[i + 1] * cos[i] + n[i] * cos[i + 1]);
    0.5 * (power(s(0), s(1)) + power(p(0), p(1)))
}

/// A tile of Airy's formula, and the same a tenth too high in one channel.
#[test]
fn film_tiles_are_measured() {
    const MAX_NM: f64 = 400.0;
    let worst = |spoil: f64| {
        let mut bake = Bake::new();
        let thickness = FilmThickness { min_nm: 100.0, max_nm: MAX_NM };
        bake.stacks[1].layers[0].films = vec![Film { ior: Ior::constant(1.9, 0.0).unwrap(), thickness }];
        let material = &mut bake.manifest.materials[1];
        material.color = ColorMode::ThreeWavelengths;
        let record = &mut material.layers[0];
        (record.film_thickness_nm, record.film_thickness_max_nm) = (250.0, MAX_NM);
        record.tiles[TableKind::Film] = Some(0);
        let x = axis("cos_theta", 0.0, 1.0, 128, Mapping::Power { exponent: 2.0 });
        let y = axis("fraction", 0.0, 1.0, 256, Mapping::Linear);
        let (cosines, fractions) = (x.clone(), y.clone());
        let layout = AtlasLayout { x, y: Some(y), apron: 0, columns: 1, tiles: 1, base: luthier_lut::RowBase::Zero };
        bake.add(TableKind::Film, layout, |_, i, j| {
            let nm = MAX_NM * fractions.node(j);
            let [r, g, b] = WAVELENGTHS_NM.map(|wavelength| airy(cosines.node(i), nm, wavelength));
            [r, g + spoil, b, 1.0].map(|value| value as f32)
        });
        tiles(&judged(&bake), TableKind::Film)[0].judge.clone().unwrap()
    };
    let (good, bad) = (worst(0.0), worst(0.1));
    assert!(good.max_abs_err < 2e-3, "{good:?}");
    assert!(bad.worst.channel == 1 && (bad.max_abs_err - 0.1).abs() < 2e-3, "{bad:?}");
}

#[test]
fn thickness_maps_are_held_to_their_film() {
    let film = |bake: &mut Bake, thickness| {
        bake.stacks[1].layers[0].films = vec![Film { ior: Ior::constant(1.5, 0.0).unwrap(), thickness }];
        bake.manifest.materials[1].layers[0].tiles[TableKind::Thickness] = Some(0);
    };
    let findings = |texel: [f32; 4]| {
        let mut bake = Bake::new();
        film(&mut bake, FilmThickness { min_nm: 100.0, max_nm: 300.0 });
        let [x, y] = ["u", "v"].map(|name| axis(name, 0.0, 1.0, 4, Mapping::Periodic));
        let layout = AtlasLayout { x, y: Some(y), apron: 1, columns: 1, tiles: 1, base: luthier_lut::RowBase::Zero };
        bake.add(TableKind::Thickness, layout, |_, x, _| if x == 2 { texel } else { [0.25, 0.0, 0.0, 1.0] });
        let findings = judged(&bake).findings;
        findings.into_iter().filter(|f| f.starts_with("thickness")).collect::<Vec<_>>()
    };
    // d / (2 d_max): a sixth for 100 nm, a half for 300. Slopes of 3 and 4 lengthen a normal to sqrt(26).
    assert_eq!(findings([0.5, 3.0, 4.0, 5.0990195]), Vec::<String>::new());
    let [thick] = &findings([0.75, 0.0, 0.0, 1.0])[..] else { panic!() };
    assert!(thick.contains("150 to 450 nm, the film is 100 to 300 nm"), "{thick}");
    let [tilted] = &findings([0.4, 3.0, 4.0, 1.0])[..] else { panic!() };
    assert!(tilted.contains("in 6 texels"), "{tilted}");
}

/// A picture of two texels, 0 and 1, has 1/2, 0, 1/2 and 1 at the quarters of its repeat, and is linear between them.
#[test]
fn thickness_tiles_are_held_to_the_map_of_the_file() {
    let held = |planted: f32, source: FilmSource| {
        let mut bake = Bake::new();
        let thickness = FilmThickness { min_nm: 100.0, max_nm: 300.0 };
        bake.stacks[1].layers[0].films = vec![Film { ior: Ior::constant(1.5, 0.0).unwrap(), thickness }];
        bake.manifest.materials[1].layers[0].tiles[TableKind::Thickness] = Some(0);
        let [x, y] = ["u", "v"].map(|name| axis(name, 0.0, 1.0, 4, Mapping::Periodic));
        let layout = AtlasLayout { x, y: Some(y), apron: 1, columns: 1, tiles: 1, base: luthier_lut::RowBase::Zero };
        // The apron repeats the last column before the first, and the first behind the last.
        let nm = [300.0, 200.0, 100.0, 200.0, 300.0, 200.0_f32];
        bake.add(TableKind::Thickness, layout, |_, x, _| {
            [nm[x as usize] / 600.0 + if x == 2 { planted } else { 0.0 }, 0.0, 0.0, 1.0]
        });
        let films = vec![FilmMap { material: 1, layer: 0, source, extent_um: 1e9 }];
        let subject = Subject { films, ..bake.subject() };
        let report = judge(&subject, None, &Settings { pairs_per_set: 20, ..Settings::default() }).unwrap();
        tiles(&report, TableKind::Thickness)[0].judge.clone().unwrap()
    };
    let picture = || FilmSource::Image(Image { width: 2, height: 1, channels: 1, data: vec![0.0, 1.0] });
    // Weights of 8 bits, half floats.
    assert!(held(0.0, picture()).max_abs_err < 5e-4);
    let found = held(0.1, picture());
    assert!((found.max_abs_err - 0.1).abs() < 5e-4 && found.worst.channel == 0, "{found:?}");
    assert!((found.worst.at[0] - 0.25).abs() < 1e-9, "{found:?}");
    // Another map is another film.
    assert!(held(0.0, FilmSource::Noise { seed: 1, frequency: 2.0, octaves: 2 }).max_abs_err > 0.05);
}

#[test]
fn fresnel_rows_over_the_angle_are_read_as_such() {
    let mut bake = Bake::new();
    let theta = axis("theta", 0.0, std::f64::consts::FRAC_PI_2, 128, Mapping::Linear);
    let mut row = 0;
    for (stack, material) in bake.stacks.iter().zip(&bake.manifest.materials) {
        let exact = Exact::new(stack, Color::Spectral);
        for (layer, record) in material.layers.iter().enumerate().filter(|(_, r)| r.tiles[TableKind::Fresnel].is_some())
        {
            assert_eq!(record.tiles[TableKind::Fresnel], Some(row));
            for x in 0..128 {
                let rgb = exact.fresnel(layer, libm::cos(theta.node(x)).max(0.0));
                bake.textures[0].1.texel_mut(x, row)[..3].copy_from_slice(&rgb.map(|c| c as f32));
            }
            row += 1;
        }
    }
    bake.manifest.tables[0].layout.x = theta;
    let report = judged(&bake);
    for tile in tiles(&report, TableKind::Fresnel) {
        assert!(tile.judge.as_ref().unwrap().max_abs_err < 2e-3, "{tile:?}");
    }
    let subject = bake.subject();
    let terms = TableTerms::new(&subject, 2, Weights::Exact).unwrap();
    let exact = Exact::new(&bake.stacks[2], Color::Spectral);
    let [found, expected] = [terms.fresnel(0, 0.5), exact.fresnel(0, 0.5)];
    assert!((found[0] - expected[0]).abs() < 1e-4, "{found:?} {expected:?}");
}
