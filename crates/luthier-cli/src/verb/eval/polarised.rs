//! Reflectances of both polarisations.

use luthier::function::Kind;
use luthier_material::Material;
use luthier_optics::Rgb;
use luthier_optics::stack::{Base, Stack};
use luthier_terminal::{Failure, Outcome, print};
use serde_json::{Value, json};

use super::{describe, significant};

/// Prints the reflectances of the one interface of a material, its films included, for light polarised normal to the plane of
/// incidence (s) and in it (p).
pub(crate) fn polarised(material: &Material, kind: &Kind, thetas_deg: &[f64], json: bool) -> Outcome {
    coherent(&material.stack).map_err(|why| {
        Failure::Input(anyhow::anyhow!(
            "{}: --polarised is for one smooth interface, bare or under films: {why}; leave --polarised out for unpolarised values",
            material.source
        ))
    })?;
    let parts = kind.parts(&material.stack);
    let columns = kind.columns("").len();
    let rows: Vec<(f64, [Rgb; 2])> = thetas_deg
        .iter()
        .map(|&theta_deg| {
            let cos_theta_i = libm::cos(theta_deg.to_radians()).max(0.0);
            let mut sums = [[0.0; 3]; 2];
            for (stack, weight) in &parts {
                let Some(powers) = stack.layers.first().and_then(|layer| layer.polarised(cos_theta_i)) else {
                    continue;
                };
                for (sum, power) in sums.iter_mut().zip([powers.refl_s, powers.refl_p]) {
                    (0..3).for_each(|c| sum[c] += weight[c] * power);
                }
            }
            (theta_deg, sums)
        })
        .collect();
    if json {
        let rows = rows.iter().map(
            |(theta_deg, [s, p])| json!({"theta_i_deg": theta_deg, "refl_s": s[..columns], "refl_p": p[..columns]}),
        );
        let rows: Value = rows.collect();
        let head = json!({"material": material.name, "color": describe(kind), "polarised": rows});
        return print(&format!("{head:#}"));
    }
    let [s, p] = ["refl_s", "refl_p"].map(|what| {
        let names = kind.columns("").into_iter();
        let names = names.map(|name| if name.is_empty() { what.to_owned() } else { format!("{what}_{name}") });
        names.collect::<Vec<_>>().join(",")
    });
    let mut text = format!("theta_i,{s},{p}");
    for (theta_deg, sums) in &rows {
        let fields: Vec<String> =
            sums.iter().flat_map(|rgb| &rgb[..columns]).map(|value| significant(*value)).collect();
        text.push_str(&format!("\n{theta_deg},{}", fields.join(",")));
    }
    print(&text)
}

/// Refuses a stack whose reflected light is not a sum of amplitudes, with the reason.
fn coherent(stack: &Stack) -> Result<(), String> {
    let [only] = stack.layers.as_slice() else {
        return Err(format!("it has {} layers, and light is not coherent across a slab", stack.layers.len()));
    };
    if matches!(only.base, Base::Diffuse(_)) {
        return Err("its base is diffuse".to_owned());
    }
    if let Base::Dielectric { ior, .. } | Base::Conductor { ior } = &only.base
        && ior.f0().is_some()
        && only.films.is_empty()
    {
        return Err("its `f0` stands for Schlick's formula, which knows no polarisation (give an index)".to_owned());
    }
    if !only.surface.is_smooth() {
        return Err("its interface is rough, and facets turn the plane of incidence (write `smooth = true`)".to_owned());
    }
    Ok(())
}
