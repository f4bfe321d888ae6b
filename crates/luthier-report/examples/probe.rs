//! Probe of families.
use luthier_layers::models::lobes::{Family, FitSettings, Lobes, Paint, Varied, Varying};
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};
use luthier_report::{ModelSubject, Reference, ReferenceSettings, Shown};
use rayon::prelude::*;

fn stack(kind: &str, d: Distribution, a: [f64; 2], f0: [f64; 3], albedo: [f64; 3], tau: [f64; 3]) -> Stack {
    let slab = Slab { thickness_um: 1.0, absorption_per_um: tau };
    let layer = |alpha, base| Layer { films: vec![], surface: Surface::isotropic(d, alpha), base };
    let coat = layer(a[0], Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab });
    let none = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
    let diffuse = layer(0.0, Base::Diffuse(Diffuse { albedo, sigma: 0.0 }));
    let layers = match kind {
        "metal" | "mixmetal" => {
            vec![coat, layer(a[1], Base::Conductor { ior: Ior::constant(1.5, 0.0).unwrap().with_f0(f0) })]
        }
        "plastic" => vec![
            coat,
            layer(a[1], Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap().with_f0(f0), slab: none }),
            diffuse,
        ],
        "bare" => vec![
            layer(a[1], Base::Dielectric { ior: Ior::constant(1.0, 0.0).unwrap().with_f0(f0), slab: none }),
            diffuse,
        ],
        "baremetal" => vec![layer(a[1], Base::Conductor { ior: Ior::constant(1.5, 0.0).unwrap().with_f0(f0) })],
        "ag" => vec![coat, layer(a[1], Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() })],
        _ => panic!(),
    };
    Stack { exterior: Ior::vacuum(), layers }
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let kind = args[1].as_str();
    let places: u64 = args[2].parse().unwrap();
    let rows: usize = args.get(3).map_or(9, |x| x.parse().unwrap());
    let tint = args.get(4).map_or(0.0, |x: &String| x.parse().unwrap());
    let d = Distribution::Ggx;
    let color = Color::ThreeWavelengths([645.0, 525.0, 445.0]);
    let is_m = kind == "plastic" || kind == "bare";
    let nominal = stack(kind, d, [1.0, 1.0], if is_m { [0.04; 3] } else { [0.5; 3] }, [0.5; 3], [0.0; 3]);
    let family = if std::env::var("OWN").is_ok() {
        Family::new(&nominal, [0.5; 2], [0.5; 2], is_m)
    } else {
        Family::new(&nominal, [0.001, 0.8], [0.001, 1.0], is_m)
    }
    .unwrap();
    println!("{family:?}");
    let start = std::time::Instant::now();
    let varied =
        Varied::with(&nominal, &color, Some(Varying::Family(family)), FitSettings { rows, ..FitSettings::default() });
    println!("fit {:?} {} nodes", start.elapsed(), varied.nodes.len());
    let mut seed = 12345u64;
    let mut next = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((seed >> 33) as f64) / (1u64 << 31) as f64
    };
    let all: Vec<_> = (0..places)
        .map(|_| {
            let s = |u: f64| {
                let r = 0.0316 + u * (0.894 - 0.0316);
                r * r
            };
            let a = [s(next()), s(next())];
            let m = [0.0, next(), 1.0][(next() * 3.0) as usize];
            let c = [next(), next(), next()];
            let (f0, albedo) = if kind == "metal" || kind == "ag" {
                (c.map(|c| 0.3 + 0.7 * c), [0.0; 3])
            } else {
                let f = c.map(|c| 0.04 + m * (c - 0.04));
                let alb = [0, 1, 2].map(|i: usize| {
                    let sh = c[i] * (1.0 - m);
                    let t = (1.0 - f[i]) * 20.0 / 21.0;
                    sh / (t + sh * (1.0 - t)).max(1e-9)
                });
                (f, alb)
            };
            let tau = [tint * next(), tint * next(), tint * next()];
            (a, f0, albedo, tau, m, c)
        })
        .collect();
    let thetas = [0.0, 30.0, 60.0, 75.0, 85.0];
    let results: Vec<_> = all.par_iter().map(|&(a, f0, albedo, tau, m, c)| {
        let kind_here = match (kind, m == 1.0) { ("plastic", true) => "metal", ("bare", true) => "baremetal", _ => kind };
        let here = stack(kind_here, d, a, f0, albedo, tau);
        let subject = ModelSubject { name: String::new(), stack: here.clone(), wavelengths_nm: [645.0, 525.0, 445.0] };
        let reference = Reference::new(&subject, &thetas, ReferenceSettings { noise: 0.005, albedo_std_err: 7e-4, most: 1 << 22, seed: 1 << 40 });
        let own_family;
        let used = if std::env::var("OWN").is_ok() {
            let one = Family::new(&nominal, [a[0]; 2], [a[1]; 2], is_m).unwrap();
            own_family = Varied::with(&nominal, &color, Some(Varying::Family(one)), FitSettings { rows, ..FitSettings::default() });
            &own_family
        } else { &varied };
        let lobes = used.painted(a, &if is_m { Paint::of(&here).metallic(c, m) } else { Paint::of(&here) }).unwrap();
        let errors = reference.errors(Shown::Lobes(&lobes));
        let own = if args.len() > 5 { let l = Lobes::of(&here, &color); reference.errors(Shown::Lobes(&l)).iter().map(|e| e.lobe.error).fold(0.0, f64::max) } else { 0.0 };
        let worst = errors.iter().max_by(|x, y| x.lobe.error.total_cmp(&y.lobe.error)).unwrap();
        let walb = errors.iter().max_by(|x, y| x.albedo.error.total_cmp(&y.albedo.error)).unwrap();
        let signed: Vec<String> = errors.iter().map(|e| format!("{:.3}/{:+.4}", e.lobe.error, e.albedo.error)).collect();
        (worst.lobe.error, walb.albedo.error, format!("{a:.3?} f {f0:.2?} r {albedo:.2?} m {m:.2} tau {tau:.1?}: lobe {:.4} at {} {}, albedo {:.4} at {} {} own {own:.4}", worst.lobe.error, worst.theta_deg, worst.wavelength_nm, walb.albedo.error, walb.theta_deg, walb.wavelength_nm), signed.join(" "))
    }).collect();
    let rank = |mut v: Vec<f64>| {
        v.sort_by(f64::total_cmp);
        [v[v.len() / 2], v[v.len() * 95 / 100], v[v.len() - 1]]
    };
    println!("lobe {:.4?}", rank(results.iter().map(|r| r.0).collect()));
    println!("albedo {:.4?}", rank(results.iter().map(|r| r.1).collect()));
    let mut sorted: Vec<_> = results.iter().collect();
    sorted.sort_by(|a, b| b.0.total_cmp(&a.0));
    for r in sorted.iter().take(8) {
        println!("{}", r.2);
    }
    sorted.sort_by(|a, b| b.1.total_cmp(&a.1));
    for r in sorted.iter().take(5) {
        println!("{}", r.2);
    }
}
