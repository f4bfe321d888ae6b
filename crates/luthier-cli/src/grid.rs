//! The materials of the grid: metallic against roughness (Palubicki, lecture GRK 7, exercise).

use luthier_gpu::GRID_SIDE;
use luthier_material::{Material, parse};
use luthier_terminal::{Failure, Outcome};

/// Base colour: F0 of copper as the lecture prints it.
const BASE: [f64; 3] = [0.955, 0.638, 0.538];

/// F0 of dielectrics.
const DIELECTRIC: f64 = 0.04;

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
            let parsed = parse(&name, &text, &|_| Err(std::io::ErrorKind::NotFound.into()));
            let wrong = |errors: Vec<luthier_material::Diagnostic>| {
                let messages: Vec<String> = errors.into_iter().map(|e| e.render(&text)).collect();
                Failure::Input(anyhow::anyhow!(messages.join("\n")))
            };
            materials.push(parsed.map_err(wrong)?.material);
        }
    }
    Ok(materials)
}

/// The common model in layers: an interface whose F0 goes from 0.04 to the base colour, over a diffuse base whose albedo goes
/// from the base colour to nothing. A metal has no base and takes its F0 from absorption, anything else from a real index.
fn text(name: &str, metallic: f64, roughness: f64) -> String {
    let metal = metallic >= 1.0;
    let list = |f: &dyn Fn(f64) -> f64| BASE.map(|base| format!("{:.6}", f(base))).join(", ");
    let f0 = |base: f64| DIELECTRIC + metallic * (base - DIELECTRIC);
    // |n + i k - 1|^2 / |n + i k + 1|^2 at n = 1, and at k = 0.
    let (kind, n, k) = if metal {
        ("conductor", list(&|_| 1.0), list(&|base| 2.0 * (f0(base) / (1.0 - f0(base))).sqrt()))
    } else {
        ("dielectric", list(&|base| (1.0 + f0(base).sqrt()) / (1.0 - f0(base).sqrt())), list(&|_| 0.0))
    };
    let albedo = list(&|base| base * (1.0 - metallic));
    let base = if metal { String::new() } else { format!("[[layer]]\ntype = \"diffuse\"\nalbedo = [{albedo}]\n") };
    format!(
        "schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"{kind}\"\nroughness = {roughness:.3}\n\
         ior = {{ n = [{n}], k = [{k}], wavelengths_nm = [645, 525, 445] }}\n{base}\
         [bake]\nmodel = \"elek\"\ncolor = \"three-wavelengths\"\nwavelengths_nm = [645, 525, 445]\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_materials() {
        let materials = materials().unwrap();
        assert_eq!(materials.len(), 25);
        assert_eq!(materials[0].name, "grid-0-0");
    }

    /// Reflectance at normal incidence in the middle of the range: half way between 0.04 and copper's.
    #[test]
    fn f0_is_interpolated() {
        let materials = materials().unwrap();
        for (material, metallic) in [(&materials[0], 1.0), (&materials[10], 0.5), (&materials[20], 0.0)] {
            for (wavelength, base) in [645.0, 525.0, 445.0].into_iter().zip(BASE) {
                let interface = luthier_optics::interface::Interface::of(&material.stack, 0).unwrap();
                let f0 = interface.at(wavelength).reflectance(1.0);
                let expected = 0.04 + metallic * (base - 0.04);
                assert!((f0 - expected).abs() < 1e-5, "{} {wavelength}: {f0} {expected}", material.name);
            }
        }
    }
}
