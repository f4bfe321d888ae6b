//! Small materials: tables that bake in no time.

/// Settings that all materials here share: a model without a fit, and tables that unoptimised builds bake in a moment.
const SMALL: &str = "
[bake]
fresnel = { size = 64 }
distribution = { size = [32, 32] }
fgd = { size = [8, 8] }
phase = { size = 32 }
thickness = { size = 16 }
model = \"elek\"
";

/// A material without any table.
pub fn matte(name: &str) -> String {
    format!("schema = 1\nname = \"{name}\"\n\n[[layer]]\ntype = \"diffuse\"\nalbedo = [0.6, 0.3, 0.1]\n")
}

/// Fresnel, distribution and FGD tables: a rough, tinted coat on a diffuse base.
pub fn lacquer(name: &str) -> String {
    format!("schema = 1\nname = \"{name}\"\n{LACQUER}{SMALL}")
}

/// [`lacquer`] with the default Fresnel and distribution tables.
pub fn fine_lacquer(name: &str) -> String {
    format!("schema = 1\nname = \"{name}\"\n{LACQUER}\n[bake]\nmodel = \"elek\"\nfgd = {{ size = [8, 8] }}\n")
}

const LACQUER: &str = "
[[layer]]
type = \"dielectric\"
ior = 1.5
roughness = 0.4
thickness_um = 1
absorption_per_um = [0.1, 0.5, 0.9]

[[layer]]
type = \"diffuse\"
albedo = [0.8, 0.2, 0.2]
";

/// Rough gold: the tables of [`lacquer`] with other content.
pub fn gold(name: &str) -> String {
    format!("schema = 1\nname = \"{name}\"\n\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nroughness = 0.5\n{SMALL}")
}

/// All five tables: a film whose thickness follows a map, on glass.
pub fn film(name: &str, map: &str) -> String {
    format!(
        "schema = 1\nname = \"{name}\"

[[layer]]
type = \"thin-film\"
ior = 1.33

[layer.thickness_nm]
min = 100
max = 400
extent_um = 1000
map = {map}

[[layer]]
type = \"dielectric\"
ior = 1.5
roughness = 0.3

[[layer]]
type = \"diffuse\"
albedo = 0
{SMALL}"
    )
}

/// Perlin noise for [`film`].
pub const NOISE: &str = "{ noise = { seed = 3, frequency = 2, octaves = 2 } }";

/// A material that is valid but doubtful: an interface between equal media.
pub fn doubtful(name: &str) -> String {
    let top = "[[layer]]\ntype = \"dielectric\"\nior = 1.0\nsmooth = true\n";
    let base = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";
    format!("schema = 1\nname = \"{name}\"\n\n{top}\n{base}{SMALL}")
}

/// A film on a rough coat on a diffuse base: every model has something to say of it.
pub fn filmed(name: &str) -> String {
    format!(
        "schema = 1\nname = \"{name}\"

[[layer]]
type = \"thin-film\"
ior = 1.33
thickness_nm = 300

[[layer]]
type = \"dielectric\"
ior = 1.5
alpha = 0.2
thickness_um = 1
absorption_per_um = [0.1, 0.2, 0.3]

[[layer]]
type = \"diffuse\"
albedo = 0.5
sigma = 0.35
{SMALL}"
    )
}

/// A smooth coat without absorption on a diffuse base of albedo 0.8.
pub fn smooth_coat(name: &str) -> String {
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n";
    format!("schema = 1\nname = \"{name}\"\n\n{coat}\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n{SMALL}")
}
