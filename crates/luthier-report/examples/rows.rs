//! Rows.
use luthier_layers::models::lobes::{Family, FitSettings, Lobes, Paint, Varied, Varying};
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};
fn main() {
    let none = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
    let layer = |alpha, base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Ggx, alpha), base };
    let st = Stack {
        exterior: Ior::vacuum(),
        layers: vec![
            layer(0.459, Base::Dielectric { ior: Ior::constant(1.0, 0.0).unwrap().with_f0([0.04; 3]), slab: none }),
            layer(0.0, Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 })),
        ],
    };
    let color = Color::ThreeWavelengths([645.0, 525.0, 445.0]);
    let family = Family::new(&st, [0.5; 2], [0.459; 2], true).unwrap();
    let set = FitSettings { rows: 19, ..FitSettings::default() };
    let varied = Varied::with(&st, &color, Some(Varying::Family(family)), set);
    let paint = Paint { metal: [0.5; 3], metallic: 0.0, albedo: [0.5; 3], depth: [0.0; 3] };
    let p = varied.painted([0.5, 0.459], &paint).unwrap();
    let own = Lobes::with(&st, &color, set);
    println!("{:?}\n{:?}", p.frame, own.frame);
    for (p, q) in p.rows.iter().zip(&own.rows) {
        println!(
            "{:.4} {:.4} | {:.4} {:.4} | {:.4} {:.4} {:?} {:?}",
            p.albedo_dir[0],
            q.albedo_dir[0],
            p.wide[0],
            q.wide[0],
            p.first_facet()[0],
            q.first_facet()[0],
            p.base.map(|b| b.falloff),
            q.base.map(|b| b.falloff)
        );
    }
}
