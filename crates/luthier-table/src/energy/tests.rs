//! Tests of tables of energy: figures that renderers ship, drawn normals, reads.

use luthier_optics::glam::DVec3;
use luthier_optics::microfacet::lambda;
use luthier_optics::visible_normals;

use super::*;

fn table(axes: &str, surface: EnergySurface, size: [u32; 3]) -> EnergyTable {
    EnergyTable {
        distribution: Distribution::Ggx,
        masking: JointMasking::Correlated,
        surface,
        layout: EnergyLayout::parse(axes, Nodes::Ends).unwrap(),
        size,
        values: vec![EnergyValue::Albedo, EnergyValue::Reflected],
        stored: Stored::Float,
        balanced: false,
        clear_within: 0.0,
    }
}

/// The content of a node of a renderer's table; the last of its axes goes on through the parts.
fn figure(preset: &str, name: &str, mut texel: [u32; 3]) -> f64 {
    let preset = EnergyPreset::named(preset).unwrap();
    let file = preset.files.iter().find(|file| file.name == name).unwrap();
    for table in preset.tables(file) {
        let last = table.layout.axes().len() - 1;
        if texel[last] < table.size[last] {
            return table.values[0].of(table.at_texel(texel));
        }
        texel[last] -= table.size[last];
    }
    unreachable!("{name} is shorter")
}

/// Figures of Cycles' `shader.tables`, by 8 and 64 million samples (blender/cycles, src/scene/shader.tables, July 2026).
#[test]
fn figures_of_cycles_are_found_again() {
    let figures = [
        ("ggx_E", [1, 0, 0], 0.980_405),
        ("ggx_E", [31, 0, 0], 0.999_079),
        ("ggx_E", [4, 1, 0], 0.911_203),
        ("ggx_E", [12, 3, 0], 0.888_923),
        ("ggx_E", [20, 9, 0], 0.778_733),
        ("ggx_E", [31, 15, 0], 0.457_779),
        ("ggx_E", [8, 20, 0], 0.991_163),
        ("ggx_E", [26, 31, 0], 0.500_893),
        ("ggx_E", [31, 31, 0], 0.306_853),
        ("ggx_Eavg", [3, 0, 0], 0.999_548),
        ("ggx_Eavg", [10, 0, 0], 0.970_160),
        ("ggx_Eavg", [19, 0, 0], 0.791_360),
        ("ggx_Eavg", [31, 0, 0], 0.409_137),
        ("ggx_glass_E", [12, 5, 0], 1.0),
        ("ggx_glass_E", [7, 0, 1], 0.987_859),
        ("ggx_glass_E", [3, 1, 1], 0.951_223),
        ("ggx_glass_E", [9, 1, 4], 0.849_240),
        ("ggx_glass_E", [15, 2, 7], 0.725_815),
        ("ggx_glass_E", [6, 4, 7], 0.947_497),
        ("ggx_glass_E", [12, 5, 7], 0.812_393),
        ("ggx_glass_E", [15, 8, 7], 0.747_196),
        ("ggx_glass_E", [10, 11, 10], 0.912_949),
        ("ggx_glass_E", [4, 2, 13], 0.949_106),
        ("ggx_glass_E", [15, 15, 3], 0.976_141),
        ("ggx_glass_E", [15, 15, 15], 0.329_698),
        ("ggx_glass_Eavg", [3, 1, 0], 0.998_250),
        ("ggx_glass_Eavg", [8, 7, 0], 0.964_631),
        ("ggx_glass_Eavg", [15, 7, 0], 0.794_380),
        ("ggx_glass_Eavg", [12, 11, 0], 0.817_340),
        ("ggx_glass_Eavg", [15, 15, 0], 0.426_737),
        ("ggx_glass_inv_E", [9, 2, 1], 0.610_204),
        ("ggx_glass_inv_E", [15, 15, 1], 0.979_542),
        ("ggx_glass_inv_E", [6, 6, 3], 0.865_810),
        ("ggx_glass_inv_E", [15, 9, 4], 0.639_441),
        ("ggx_glass_inv_E", [12, 12, 5], 0.720_225),
        ("ggx_glass_inv_E", [9, 12, 7], 0.799_008),
        ("ggx_glass_inv_E", [15, 15, 7], 0.395_427),
        ("ggx_glass_inv_E", [8, 3, 15], 0.841_571),
        ("ggx_glass_inv_E", [15, 15, 15], 0.306_851),
    ];
    for (name, texel, expected) in figures {
        let found = figure("cycles", name, texel);
        // Six digits; glass is noisier than metal.
        let limit = if name.contains("glass") { 1.5e-5 } else { 1.5e-6 };
        assert!((found - expected).abs() < limit, "{name} {texel:?}: {found:.6} {expected:.6}");
    }
}

/// Figures of the tables that Cycles has had since, of 32 nodes along each axis; from the denser side made anew, without the light that turned back.
#[test]
fn figures_of_the_finer_tables_of_cycles_are_found_again() {
    let figures = [
        ("ggx_E", [1, 1, 0], 0.892_075),
        ("ggx_E", [3, 4, 0], 0.905_928),
        ("ggx_E", [12, 10, 0], 0.885_307),
        ("ggx_E", [28, 20, 0], 0.566_096),
        ("ggx_glass_E", [1, 1, 1], 0.897_512),
        ("ggx_glass_E", [2, 2, 1], 0.910_783),
        ("ggx_glass_E", [31, 2, 1], 0.581_649),
        ("ggx_glass_E", [10, 5, 1], 0.726_129),
        ("ggx_glass_E", [20, 11, 1], 0.654_415),
        ("ggx_glass_inv_E", [31, 1, 1], 0.148_153),
        ("ggx_glass_inv_E", [6, 1, 1], 0.523_845),
        ("ggx_glass_inv_E", [14, 2, 1], 0.172_608),
        ("ggx_glass_inv_E", [31, 5, 1], 0.491_557),
        ("ggx_glass_inv_E", [12, 6, 1], 0.522_478),
    ];
    for (name, texel, expected) in figures {
        let found = figure("cycles-32", name, texel);
        assert!((found - expected).abs() < 1.5e-5, "{name} {texel:?}: {found:.6} {expected:.6}");
    }
}

/// Cycles' table of light from the denser side was made when its sampler let light pass that refraction had turned back above the surface; its
/// sampler has since learnt to drop that light. The figures are those of all refracted light, found here by drawn normals.
#[test]
fn from_the_denser_side_cycles_counts_light_that_turned_back() {
    let n = 300u32;
    for (texel, shipped) in
        [([13, 0, 1], 0.956_897), ([8, 1, 3], 0.702_769), ([10, 1, 7], 0.863_017), ([12, 3, 6], 0.632_355)]
    {
        let preset = EnergyPreset::named("cycles").unwrap();
        let file = preset.files.iter().find(|file| file.name == "ggx_glass_inv_E").unwrap();
        let table = &preset.tables(file)[0];
        let place = table.layout.place(|k, axis| axis.canonical(texel[k], table.size[k]));
        let (alpha, cos, eta) = (place.alpha, place.cos_theta.unwrap(), 1.0 / place.ior.unwrap());
        let w = DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos);
        let g1 = 1.0 + lambda(Distribution::Ggx, alpha, cos);
        let leaving = |cos_o: f64| g1 / (g1 + lambda(Distribution::Ggx, alpha, cos_o.clamp(0.0, 1.0)));
        let (mut all, mut upturned) = (0.0, 0.0);
        for i in 0..n * n {
            let u = [i % n, i / n].map(|k| (f64::from(k) + 0.5) / f64::from(n));
            let m = visible_normals::sample(Distribution::Ggx, alpha, w, u);
            let cos_d = w.dot(m);
            let refl = luthier_optics::dielectric_albedo::fresnel_dielectric(eta, cos_d);
            let up = 2.0 * cos_d * m.z - cos;
            let inside = 1.0 - (1.0 - cos_d * cos_d) / (eta * eta);
            let through = m.z * (cos_d / eta - libm::sqrt(inside.max(0.0))) - cos / eta;
            all += if up > 0.0 { refl * leaving(up) } else { 0.0 } / f64::from(n * n);
            if refl < 1.0 {
                let part = (1.0 - refl) * leaving(through.abs()) / f64::from(n * n);
                all += part;
                upturned += if through > 0.0 { part } else { 0.0 };
            }
        }
        let found = figure("cycles", "ggx_glass_inv_E", texel);
        assert!((all - shipped).abs() < 1e-4, "{texel:?}: {all:.6} {shipped:.6}");
        assert!((all - upturned - found).abs() < 1e-4, "{texel:?}: {all:.6} {upturned:.6} {found:.6}");
        assert!(shipped - found > 0.05, "{texel:?}: {found:.6}");
    }
}

/// Words of Adobe's tables (adobe/openpbr-bsdf, impl/data). Its own figures scatter by some 2e-3: neighbours of one row are up to that far from
/// a smooth line.
#[test]
fn figures_of_openpbr_are_found_again() {
    let figures = [
        ("ideal_dielectric_energy_complement", [0, 1, 3], 7765),
        ("ideal_dielectric_energy_complement", [10, 12, 0], 6904),
        ("ideal_dielectric_energy_complement", [20, 20, 8], 18612),
        ("ideal_dielectric_energy_complement", [0, 5, 15], 58812),
        ("ideal_dielectric_energy_complement", [0, 2, 16], 8073),
        ("ideal_dielectric_energy_complement", [5, 9, 20], 3563),
        ("ideal_dielectric_energy_complement", [16, 24, 24], 10383),
        ("ideal_dielectric_energy_complement", [31, 31, 31], 15142),
        ("ideal_dielectric_avg_energy_complement", [6, 1, 0], 381),
        ("ideal_dielectric_avg_energy_complement", [20, 5, 0], 17396),
        ("ideal_dielectric_avg_energy_complement", [31, 16, 0], 14902),
        ("ideal_dielectric_avg_energy_complement", [14, 31, 0], 1956),
        ("opaque_dielectric_energy_complement", [10, 12, 0], 7337),
        ("opaque_dielectric_energy_complement", [20, 20, 8], 31577),
        ("opaque_dielectric_energy_complement", [0, 5, 15], 59444),
        ("opaque_dielectric_energy_complement", [0, 2, 16], 54182),
        ("opaque_dielectric_energy_complement", [5, 9, 20], 47925),
        ("opaque_dielectric_energy_complement", [31, 31, 31], 61816),
        ("opaque_dielectric_avg_energy_complement", [20, 5, 0], 30902),
        ("opaque_dielectric_avg_energy_complement", [14, 31, 0], 53254),
        ("ideal_metal_energy_complement", [1, 2, 0], 648),
        ("ideal_metal_energy_complement", [31, 16, 0], 6297),
        ("ideal_metal_energy_complement", [14, 31, 0], 37828),
        ("ideal_metal_avg_energy_complement", [8, 0, 0], 943),
        ("ideal_metal_avg_energy_complement", [31, 0, 0], 40831),
    ];
    for (name, texel, word) in figures {
        let (found, expected) = (figure("openpbr", name, texel), f64::from(word) / 65535.0);
        assert!((found - expected).abs() < 2e-3, "{name} {texel:?}: {found:.6} {expected:.6}");
    }
}

#[test]
fn layouts_have_one_axis_of_each_kind() {
    for text in ["roughness", "cos_theta,alpha", "roughness,-cos_theta,fourth_root_f0", "sqrt_f0,alpha_sq"] {
        assert_eq!(EnergyLayout::parse(text, Nodes::Ends).unwrap().to_string(), text);
    }
    for text in ["", "cos_theta", "ior", "roughness,alpha", "roughness,cos_theta,theta", "roughness,ior,f0"] {
        assert!(EnergyLayout::parse(text, Nodes::Ends).is_err(), "{text}");
    }
}

/// Slices lie one below the other, whatever the order of the axes; a read at a node is the node.
#[test]
fn texels_lie_where_the_layout_says() {
    let plain = table("roughness,cos_theta,sqrt_f0=0.1..0.6", EnergySurface::FromRarer, [5, 4, 3]);
    let turned = table("-sqrt_f0=0.1..0.6,roughness,cos_theta", EnergySurface::FromRarer, [3, 5, 4]);
    let (a, b) = (plain.bake(), turned.bake());
    assert_eq!(([a.width, a.height], [b.width, b.height]), ([5, 12], [3, 20]));
    for (r, c, f) in (0..60).map(|i| (i % 5, i / 5 % 4, i / 20)) {
        assert_eq!(a.texel(r, 4 * f + c), b.texel(2 - f, 5 * c + r));
    }
    let expected = albedo_dir(Distribution::Ggx, JointMasking::Correlated, 0.25, 1.35 / 0.65, 1.0 / 3.0);
    let found = a.texel(2, 4 + 1);
    assert!((f64::from(found[0]) - expected.total()).abs() < 1e-6);
    assert!((f64::from(found[1]) - expected.reflected).abs() < 1e-6);
}

/// A table twice as fine errs a quarter as much; a balanced one less, though not at its borders, where nodes stay.
#[test]
fn errors_fall_with_the_square_of_the_size() {
    let domain = EnergyDomain { min_cos: 0.3, min_alpha: 0.2, ior: [1.3, 2.0] };
    let error = |n: u32, balanced: bool| {
        let mut table = table("alpha=0.2..1,cos_theta=0.3..1,ior=1.3..2", EnergySurface::FromRarer, [n, n, n]);
        table.balanced = balanced;
        table.values = vec![EnergyValue::Loss];
        table.error(&table.bake(), domain)
    };
    let (coarse, fine, balanced) = (error(5, false), error(9, false), error(9, true));
    let ratio = coarse.rms_err / fine.rms_err;
    assert!((3.0..5.0).contains(&ratio), "{coarse:?} {fine:?}");
    assert!(balanced.rms_err < 0.8 * fine.rms_err && balanced.max_abs_err < fine.max_abs_err, "{balanced:?} {fine:?}");
    let [cos, alpha, ior] = *fine.worst.at.as_slice() else { panic!("{fine:?}") };
    assert!((0.3..=1.0).contains(&cos) && (0.2..=1.0).contains(&alpha) && (1.3..=2.0).contains(&ior));
}

/// Statements of every table of every preset are in order; the smallest tables bake, and are written whole.
#[test]
fn presets_bake() {
    assert!(EnergyPreset::ALL.is_sorted_by_key(|preset| preset.name));
    for preset in &EnergyPreset::ALL {
        for file in preset.files {
            let tables = preset.tables(file);
            let texels: u32 = tables.iter().map(|table| table.size.iter().product::<u32>()).sum();
            for table in &tables {
                let has_index = table.layout.axes().iter().any(|axis| axis.quantity.is_index());
                assert_eq!(has_index, table.surface != EnergySurface::Reflector, "{} {}", preset.name, file.name);
            }
            if texels > 1024 || file.name.contains("ielectric") || file.name.contains("glass") {
                continue;
            }
            let parts = preset.bake(file);
            let bytes = preset.write(file, &parts);
            let count = match preset.container {
                EnergyContainer::Raw => bytes.len() / 4,
                _ => 1 + bytes.iter().filter(|byte| **byte == b',').count(),
            };
            assert_eq!(count, texels as usize, "{} {}", preset.name, file.name);
        }
    }
}

/// As many texels on an axis that crowds at grazing angles: a fifth of the error of Cycles' layout from the rarer side.
#[test]
fn curved_axes_hold_more() {
    let domain = EnergyDomain { min_cos: 0.05, min_alpha: 0.01, ior: [1.05, 2.5] };
    let error = |axes: &str, balanced: bool| {
        let mut table = table(axes, EnergySurface::FromRarer, [16, 16, 16]);
        (table.values, table.balanced) = (vec![EnergyValue::Loss], balanced);
        table.error(&table.bake(), domain).max_abs_err
    };
    let plain = error("roughness,cos_theta,fourth_root_f0", false);
    let curved = error("roughness=0.1..1,cos_theta=0.05..1^2,fourth_root_f0=0.15617..0.65465", true);
    assert!(curved < 6e-3 && curved < 0.2 * plain, "{plain:e} {curved:e}");
}
