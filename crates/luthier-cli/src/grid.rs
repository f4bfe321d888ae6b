//! The materials of the grid: metallic against roughness (Palubicki, lecture GRK 7, exercise).

use luthier_gpu::GRID_SIDE;
use luthier_material::{Material, parse};
use luthier_terminal::{Failure, Outcome};

/// Base colour: F0 of copper as the lecture prints it.
const BASE: [f64; 3] = [0.955, 0.638, 0.538];

/// Smoothest and roughest.
const ROUGHNESS: [f64; 2] = [0.1, 1.0];

/// Row by row from the top left: metallic falls from 1 to 0 down the rows, roughness grows along them.
pub(crate) fn materials() -> Outcome<Vec<Material>> {
    let last = f64::from(GRID_SIDE - 1);
    let mut materials = Vec::new();
    for row in 0..GRID_SIDE {
        for column in 0..GRID_SIDE {
            let metallic = 1.0 - f64::from(row) / last;
            let roughness = ROUGHNESS[0] + f64::from(column) / last * (ROUGHNESS[1] - ROUGHNESS[0]);
            let name = format!("grid-{row}-{column}");
            let text = text(&name, metallic, roughness);
            let parsed = parse(&name, &text, &|_| Err(std::io::ErrorKind::NotFound.into())).map_err(|errors| {
                let messages: Vec<String> = errors.into_iter().map(|e| e.render(&text)).collect();
                Failure::Input(anyhow::anyhow!(messages.join("\n")))
            })?;
            materials.push(parsed.material);
        }
    }
    Ok(materials)
}

/// A model that follows all bounces: in it the base shows the base colour.
fn text(name: &str, metallic: f64, roughness: f64) -> String {
    format!(
        "schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"metallic-roughness\"\nbase_color = {BASE:?}\n\
         metallic = {metallic:.3}\nroughness = {roughness:.3}\n[bake]\nmodel = \"belcour\"\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    use luthier_optics::color::Color;
    use luthier_optics::interface::Interface;
    use luthier_optics::stack::Base;

    #[test]
    fn all_are_materials() {
        let materials = materials().unwrap();
        assert_eq!(materials.len(), 25);
        assert_eq!(materials[0].name, "grid-0-0");
    }

    /// Reflectance at normal incidence in the middle of the range: half way between 0.04 and copper's. The albedo of the base by hand, red of a
    /// dielectric and of the middle, where .91429 and .47857 over 1.5^2 of the light of the base is let through: .955/(.40635 + .955 .59365) and .4775/(.21270 + .4775 .78730).
    #[test]
    fn f0_and_albedo_are_interpolated() {
        let materials = materials().unwrap();
        for (material, metallic) in [(&materials[0], 1.0), (&materials[10], 0.5), (&materials[20], 0.0)] {
            let f0 = Interface::of(&material.stack, 0).unwrap().sampled(&Color::Spectral).rgb(1.0);
            for (f0, base) in f0.into_iter().zip(BASE) {
                let expected = 0.04 + metallic * (base - 0.04);
                assert!((f0 - expected).abs() < 1e-12, "{}: {f0} {expected}", material.name);
            }
            match &material.stack.layers.last().unwrap().base {
                Base::Diffuse(diffuse) => {
                    let expected = if metallic == 0.0 { 0.98121 } else { 0.81120 };
                    assert!((diffuse.albedo[0] - expected).abs() < 1e-5, "{}: {:?}", material.name, diffuse.albedo);
                }
                base => assert!(matches!(base, Base::Conductor { .. }) && metallic == 1.0, "{base:?}"),
            }
        }
    }
}
