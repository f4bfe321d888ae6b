//! Rows.
use luthier_layers::models::lobes::{Family, FitSettings, Paint, Varied, Varying};
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Layer, Slab, Stack, Surface};
fn main() {
    let d = Distribution::Ggx;
    let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] };
    let layer = |alpha, base| Layer { films: vec![], surface: Surface::isotropic(d, alpha), base };
    let coat = layer(0.5, Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab });
    let st = Stack { exterior: Ior::vacuum(), layers: vec![coat, layer(0.1, Base::Conductor { ior: Ior::constant(1.5, 0.0).unwrap().with_f0([0.9; 3]) })] };
    let color = Color::ThreeWavelengths([645.0, 525.0, 445.0]);
    let a: Vec<f64> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
    let family = Family::new(&st, [a[0], a[1]], [a[2], a[3]]).unwrap();
    let varied = Varied::with(&st, &color, Some(Varying::Family(family)), FitSettings { rows: 9, ..FitSettings::default() });
    for (n, node) in varied.nodes.iter().enumerate() {
        println!("node {n} {:?}", family.alphas(n));
        for (i, row) in node.rows.iter().enumerate() {
            println!("{:.1} alb {:.3?} wide {:.3?}", node.axis.cos_theta(i as f64).acos().to_degrees(), row.albedo_dir, row.wide);
            for l in &row.lobes { println!("    {:.4?} share {:.3} shift {:.3} sharp {:.3?} tail {:.3}", l.strength, l.share, l.shift, l.sharpness, l.tail); }
        }
    }
    for f in [0.04, 0.25, 0.5, 0.75, 0.9, 1.0] {
        let p = varied.painted([a[0], a[2]], &Paint { f0: [f; 3], albedo: [0.0; 3], depth: [0.0; 3] }).unwrap();
        let mut here = family.apply(&st, [a[0], a[2]]);
        here.layers[1].base = Base::Conductor { ior: Ior::constant(1.5, 0.0).unwrap().with_f0([f; 3]) };
        let own = luthier_layers::models::lobes::Lobes::with(&here, &color, FitSettings { rows: 9, ..FitSettings::default() });
        println!("f {f}");
        for (r, o) in p.rows.iter().zip(&own.rows) { println!("  {:.4} {:.4} {:+.4} | first {:.4} {:.4}", r.albedo_dir[1], o.albedo_dir[1], r.albedo_dir[1] - o.albedo_dir[1], r.first_facet()[1], o.first_facet()[1]); }
    }
}
