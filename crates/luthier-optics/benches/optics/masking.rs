//! Benchmarks of masking and shadowing.

use crate::inputs::{INPUTS, angles, draws, each};
use divan::{Bencher, black_box};
use luthier_optics::masking::{self, Correlation};
use luthier_optics::microfacet::Anisotropic;
use luthier_optics::microfacet::lambda;
use luthier_optics::ndf::BlinnPhong;
use luthier_optics::quadrature::gauss_legendre;
use luthier_optics::stack::Distribution;
use luthier_optics::stack::Distribution::{Beckmann, Ggx};

#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn smith_lambda(bencher: Bencher<'_, '_>, kind: Distribution) {
    each(bencher, &angles(), |a| lambda(kind, 0.3, a.cos_theta_o));
}

#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn smith_lambda_anisotropic(bencher: Bencher<'_, '_>, kind: Distribution) {
    let ndf = Anisotropic::new(kind, 0.4, 0.1).expect("valid slopes");
    each(bencher, &draws(), |draw| ndf.lambda(draw.wo));
}

/// Smith's separable masking, both Lambdas included.
#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn smith_separable(bencher: Bencher<'_, '_>, kind: Distribution) {
    smith(bencher, kind, Correlation::Separable);
}

/// Smith's height-correlated masking, both Lambdas included.
#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn smith_height_correlated(bencher: Bencher<'_, '_>, kind: Distribution) {
    smith(bencher, kind, Correlation::Height);
}

fn smith(bencher: Bencher<'_, '_>, kind: Distribution, correlation: Correlation) {
    let lambda = |cos| lambda(kind, 0.3, cos);
    each(bencher, &angles(), |a| masking::smith(correlation, lambda(a.cos_theta_i), lambda(a.cos_theta_o)));
}

#[divan::bench(sample_size = INPUTS)]
fn implicit(bencher: Bencher<'_, '_>) {
    each(bencher, &angles(), |a| masking::implicit(a.cos_theta_i, a.cos_theta_o));
}

#[divan::bench(sample_size = INPUTS)]
fn v_cavity(bencher: Bencher<'_, '_>) {
    each(bencher, &angles(), |a| masking::v_cavity(a.cos_theta_i, a.cos_theta_o, a.cos_theta_h, a.cos_theta_d));
}

#[divan::bench(sample_size = INPUTS)]
fn kelemen(bencher: Bencher<'_, '_>) {
    each(bencher, &angles(), |a| masking::kelemen(a.cos_theta_i, a.cos_theta_o, a.cos_theta_d));
}

#[divan::bench(sample_size = INPUTS)]
fn schlick_smith(bencher: Bencher<'_, '_>) {
    each(bencher, &angles(), |a| masking::schlick_smith(0.3, a.cos_theta_i, a.cos_theta_o));
}

/// One G1 by quadrature, of a distribution without a closed form.
#[divan::bench(sample_size = 4, sample_count = 256)]
fn smith_g1_by_quadrature(bencher: Bencher<'_, '_>) {
    let ndf = BlinnPhong::from_alpha(0.3).expect("a valid slope");
    each(bencher, &angles(), |a| masking::smith_g1_of(&ndf, a.cos_theta_o));
}

/// The rule that such a quadrature makes first.
#[divan::bench(args = [32, 128], sample_size = 8, sample_count = 32)]
fn gauss_legendre_rule(count: usize) -> Vec<(f64, f64)> {
    gauss_legendre(black_box(count))
}
