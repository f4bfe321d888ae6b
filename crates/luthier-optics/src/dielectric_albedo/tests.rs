//! Tests of albedos: doubled rules, drawn normals, closed forms.

use glam::DVec3;

use super::*;
use crate::microfacet::lambda;
use crate::quadrature::gauss_legendre;
use crate::split_sum::{Masking, split_sum};
use crate::visible_normals;

const BOTH: [Distribution; 2] = [Distribution::Ggx, Distribution::Beckmann];

/// The bound that the documentation states.
const BOUND: f64 = 1e-6;

#[test]
fn agrees_with_rules_of_twice_the_nodes() {
    let fine = Rules::new([16.0, 12.0], [12.0, 8.0], [1.0, 1.0]);
    for kind in BOTH {
        for eta in [1.5, 1.0001, 99.5, 1.0 / 1.5, 0.9999, 0.01] {
            for alpha in [1e-5, 1e-3, 0.01, 0.2, 1.0] {
                for cos in [0.0, 1e-3, 0.01, 0.1, 0.3, 0.7, 0.7453, 0.99, 1.0] {
                    for masking in JointMasking::ALL {
                        let found = albedo_dir(kind, masking, alpha, eta, cos);
                        let expected = with_rules(&fine, kind, masking, alpha, eta, cos);
                        let off = (found.reflected - expected.reflected)
                            .abs()
                            .max((found.transmitted - expected.transmitted).abs());
                        let limit = if masking == JointMasking::Incident { 2.0 * BOUND } else { BOUND };
                        assert!(off < limit, "{kind:?} {masking:?} {eta} {alpha} {cos}: {off:e}");
                    }
                }
            }
        }
    }
}

/// Visible normals drawn on a grid, each reflecting and refracting a ray by the law in vectors: an independent way for all parts.
#[test]
fn agrees_with_drawn_normals() {
    let n = 400u32;
    let cases =
        [(1.5, 0.5, 0.4), (1.5, 0.1, 0.05), (1.0 / 1.5, 0.5, 0.4), (0.6, 0.3, 0.8), (0.4, 0.8, 0.95), (3.0, 1.0, 0.2)];
    for kind in BOTH {
        for (eta, alpha, cos) in cases {
            let w = DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos);
            let mut expected = [InterfaceAlbedo::default(); 3];
            for i in 0..n * n {
                let u = [i % n, i / n].map(|k| (f64::from(k) + 0.5) / f64::from(n));
                let m = visible_normals::sample(kind, alpha, w, u);
                let cos_d = w.dot(m);
                let refl = crate::fresnel::interface(1.0.into(), eta.into(), cos_d).unpolarised();
                let reflected = 2.0 * cos_d * m - w;
                let inside = 1.0 - (1.0 - cos_d * cos_d) / (eta * eta);
                let refracted = m * (cos_d / eta - libm::sqrt(inside.max(0.0))) - w / eta;
                let li = lambda(kind, alpha, cos);
                for (sum, masking) in expected.iter_mut().zip(JointMasking::ALL) {
                    let leaving = |cos_o: f64| {
                        if cos_o <= 0.0 {
                            return 0.0;
                        }
                        let lo = lambda(kind, alpha, cos_o.min(1.0));
                        match masking {
                            JointMasking::Correlated => (1.0 + li) / (1.0 + li + lo),
                            JointMasking::Separable => 1.0 / (1.0 + lo),
                            JointMasking::Incident => 1.0,
                        }
                    };
                    sum.reflected += refl * leaving(reflected.z) / f64::from(n * n);
                    if inside > 0.0 {
                        sum.transmitted += (1.0 - refl) * leaving(-refracted.z) / f64::from(n * n);
                    }
                }
            }
            for (expected, masking) in expected.into_iter().zip(JointMasking::ALL) {
                let found = albedo_dir(kind, masking, alpha, eta, cos);
                let off =
                    (found.reflected - expected.reflected).abs().max((found.transmitted - expected.transmitted).abs());
                // What a grid of these steps misses at horizons and critical angles; Beckmann's normals are drawn up to six widths.
                let limit = if masking == JointMasking::Incident { 2e-3 } else { 2e-4 };
                assert!(off < limit, "{kind:?} {masking:?} {eta} {alpha} {cos}: {found:?} {expected:?}");
            }
        }
    }
}

/// Reflectors are those of the split sum, which integrates over directions.
#[test]
fn reflectors_agree_with_the_split_sum() {
    for kind in BOTH {
        for (alpha, cos) in [(1e-3, 0.5), (0.01, 0.05), (0.1, 1e-3), (0.3, 1.0), (1.0, 0.2)] {
            let sum = split_sum(kind, Masking::SmithCorrelated, alpha, cos);
            let all = reflected_dir(kind, JointMasking::Correlated, alpha, cos, |_| 1.0);
            let bias = reflected_dir(kind, JointMasking::Correlated, alpha, cos, |cos_d| libm::pow(1.0 - cos_d, 5.0));
            assert!((all - sum.albedo()).abs() < 2e-6, "{kind:?} {alpha} {cos}: {all} {sum:?}");
            assert!((bias - sum.bias).abs() < 2e-6, "{kind:?} {alpha} {cos}: {bias} {sum:?}");
        }
    }
}

#[test]
fn no_more_light_leaves_than_falls_on_it() {
    for kind in BOTH {
        for masking in JointMasking::ALL {
            for eta in [1.0, 1.1, 2.0, 1.0 / 1.1, 0.5] {
                for cos in [0.0, 0.05, 0.4, 0.9, 1.0] {
                    for alpha in [1e-4, 0.03, 0.3, 1.0] {
                        let total = albedo_dir(kind, masking, alpha, eta, cos).total();
                        assert!(
                            total > 0.0 && total <= 1.0 + BOUND,
                            "{kind:?} {masking:?} {eta} {cos} {alpha}: {total}"
                        );
                        if alpha < 0.01 && cos > 0.01 {
                            assert!(total > 1.0 - 1e-4, "{kind:?} {masking:?} {eta} {cos}: {total}");
                        }
                    }
                }
            }
        }
    }
}

/// Nearly a plane: Fresnel's reflectance, 1 under total reflection.
#[test]
fn smooth_interfaces_are_planes() {
    for eta in [1.5, 1.0 / 1.5] {
        for cos in [0.2, 0.5, 0.9, 1.0] {
            let plane = crate::fresnel::interface(1.0.into(), eta.into(), cos).unpolarised();
            for alpha in [0.0, 3e-4] {
                let found = albedo_dir(Distribution::Ggx, JointMasking::Correlated, alpha, eta, cos).reflected;
                assert!((found - plane).abs() < 1e-5, "{eta} {cos} {alpha}: {found} {plane}");
            }
        }
    }
}

/// Refraction that does not bend light leaves all of it, up to shadowing: the same Lambda twice.
#[test]
fn an_interface_between_equal_media_shadows_alone() {
    for kind in BOTH {
        for (alpha, cos) in [(0.1, 0.05), (0.5, 0.5), (1.0, 0.2)] {
            let l = lambda(kind, alpha, cos);
            let found = albedo_dir(kind, JointMasking::Correlated, alpha, 1.0, cos);
            assert_eq!(found.reflected, 0.0);
            assert!(
                (found.transmitted - (1.0 + l) / (1.0 + 2.0 * l)).abs() < BOUND,
                "{kind:?} {alpha} {cos}: {found:?}"
            );
        }
    }
}

/// Light transmitted on average: from the rarer side `eta^2` times that from the denser (Helmholtz). The two sides share little but the rings.
#[test]
fn transmission_is_reciprocal() {
    for (eta, alpha) in [(1.5, 0.3), (1.5, 1.0), (3.0, 0.7), (1.01, 0.05), (20.0, 0.5)] {
        for masking in [JointMasking::Correlated, JointMasking::Separable] {
            let rarer = albedo_avg(Distribution::Ggx, masking, alpha, eta).transmitted;
            let denser = albedo_avg(Distribution::Ggx, masking, alpha, 1.0 / eta).transmitted;
            assert!((rarer - eta * eta * denser).abs() < BOUND, "{eta} {alpha} {masking:?}: {rarer} {denser}");
        }
    }
}

/// Duntley's closed form of the average reflectance of a plane (1942), as Judd 1942 and Egan and Hilgeman 1979 print it: 0.0918 at 1.5.
#[test]
fn averages_of_planes_are_the_closed_form() {
    for n in [1.1, 1.33, 1.5, 2.0, 2.5] {
        let n_sq = n * n;
        let (down, up) = (n_sq - 1.0, n_sq + 1.0);
        let closed = 0.5
            + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
            + n_sq * down * down / (up * up * up) * libm::log((n - 1.0) / (n + 1.0))
            - 2.0 * n * n_sq * (n_sq + 2.0 * n - 1.0) / (up * (n_sq * n_sq - 1.0))
            + 8.0 * n_sq * n_sq * (n_sq * n_sq + 1.0) / (up * (n_sq * n_sq - 1.0) * (n_sq * n_sq - 1.0)) * libm::log(n);
        let from_air = albedo_avg(Distribution::Ggx, JointMasking::Correlated, 0.0, n).reflected;
        let from_inside = albedo_avg(Distribution::Ggx, JointMasking::Correlated, 0.0, 1.0 / n).reflected;
        assert!((from_air - closed).abs() < 1e-8, "{n}: {from_air} {closed}");
        assert!((from_inside - (1.0 - (1.0 - closed) / n_sq)).abs() < 1e-8, "{n}: {from_inside}");
    }
}

/// The average of metals' E against a plain rule.
#[test]
fn averages_of_reflectors_agree_with_a_plain_rule() {
    for alpha in [0.1, 0.5, 1.0] {
        let plain: f64 = gauss_legendre(96)
            .into_iter()
            .map(|(x, w)| {
                4.0 * w * x * x * x * reflected_dir(Distribution::Ggx, JointMasking::Correlated, alpha, x * x, |_| 1.0)
            })
            .sum();
        let found = reflected_avg(Distribution::Ggx, JointMasking::Correlated, alpha, |_| 1.0);
        assert!((found - plain).abs() < BOUND, "{alpha}: {found} {plain}");
    }
}

#[test]
fn averages_agree_with_rules_of_twice_the_nodes() {
    let fine = Rules::new([1.0, 1.0], [1.0, 1.0], [12.0, 8.0]);
    for (eta, alpha) in [(1.5, 0.05), (1.0 / 1.5, 1e-3), (1.0 / 1.01, 0.05), (1.0 / 3.0, 1.0), (0.01, 0.01)] {
        let (mut reflected, mut transmitted) = (0.0, 0.0);
        average(&fine, alpha, eta, |weight, cos| {
            let albedo = albedo_dir(Distribution::Ggx, JointMasking::Correlated, alpha, eta, cos);
            reflected += weight * albedo.reflected;
            transmitted += weight * albedo.transmitted;
        });
        let found = albedo_avg(Distribution::Ggx, JointMasking::Correlated, alpha, eta);
        let off = (found.reflected - reflected).abs().max((found.transmitted - transmitted).abs());
        assert!(off < 2.0 * BOUND, "{eta} {alpha}: {off:e}");
    }
}

/// At the end of an axis of f0 an interface is a mirror.
#[test]
fn large_indices_make_reflectors() {
    for alpha in [0.01, 0.3, 1.0] {
        for cos in [0.05, 0.5, 1.0] {
            let mirror = reflected_dir(Distribution::Ggx, JointMasking::Correlated, alpha, cos, |_| 1.0);
            for eta in [1e6, 1e-6] {
                let found = albedo_dir(Distribution::Ggx, JointMasking::Correlated, alpha, eta, cos).total();
                assert!((found - mirror).abs() < 1e-5, "{eta} {alpha} {cos}: {found} {mirror}");
            }
        }
    }
}
