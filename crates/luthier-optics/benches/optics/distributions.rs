//! Benchmarks of the distributions of micro-normals.

use crate::inputs::{INPUTS, angles, each};
use divan::Bencher;
use luthier_optics::microfacet::Anisotropic;
use luthier_optics::microfacet::distribution;
use luthier_optics::ndf::{Abc, BlinnPhong, Ndf, Sgd};
use luthier_optics::stack::Distribution;
use luthier_optics::stack::Distribution::{Beckmann, Ggx};

fn of(bencher: Bencher<'_, '_>, ndf: &impl Ndf) {
    each(bencher, &angles(), |a| ndf.density(a.cos_theta_h, a.sin_theta_h_sq));
}

#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn isotropic(bencher: Bencher<'_, '_>, kind: Distribution) {
    each(bencher, &angles(), |a| distribution(kind, 0.3, a.cos_theta_h, a.sin_theta_h_sq));
}

#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn anisotropic(bencher: Bencher<'_, '_>, kind: Distribution) {
    let ndf = Anisotropic::new(kind, 0.4, 0.1).expect("valid slopes");
    each(bencher, &angles(), |a| ndf.density(a.wh));
}

#[divan::bench(sample_size = INPUTS)]
fn blinn_phong(bencher: Bencher<'_, '_>) {
    of(bencher, &BlinnPhong::from_alpha(0.3).expect("a valid slope"));
}

#[divan::bench(sample_size = INPUTS)]
fn abc(bencher: Bencher<'_, '_>) {
    of(bencher, &Abc::new(40.0, 1.5).expect("valid parameters"));
}

#[divan::bench(sample_size = INPUTS)]
fn sgd(bencher: Bencher<'_, '_>) {
    of(bencher, &Sgd::new(0.1, 0.5).expect("valid parameters"));
}
