//! MaterialX 1.39: a shader and a material for each material, with a graph of its textures.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use luthier_material::UvTransform;

use super::{Named, rounded};
use crate::maps::{Slot, Texture};
use crate::{Format, Numbers};

/// The file as text. Writing to a `String` does not fail.
pub(super) fn text(format: Format, materials: &[Named<'_>], generator: &str) -> String {
    let mut out = String::from("<?xml version=\"1.0\"?>\n");
    let _ = writeln!(out, "<!-- Written by {} -->", generator.replace("--", "-"));
    out += "<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n";
    let mut taken = BTreeSet::new();
    // Materials have their names first: a shader or a graph may not be called as one of them.
    let names: Vec<String> = materials.iter().map(|material| free(&mut taken, identifier(&material.name))).collect();
    for (material, name) in materials.iter().zip(&names) {
        let numbers = &material.of.numbers;
        let mut shader = Shader {
            textures: &material.textures,
            nodes: String::new(),
            outputs: String::new(),
            inputs: String::new(),
            graph: free(&mut taken, format!("NG_{name}")),
        };
        let surface = free(&mut taken, format!("SR_{name}"));
        let category = match format {
            Format::StandardSurface => {
                shader.standard_surface(numbers);
                "standard_surface"
            }
            Format::Gltf | Format::OpenPbr => {
                shader.open_pbr(numbers);
                "open_pbr_surface"
            }
        };
        let Shader { nodes, outputs, inputs, graph, .. } = shader;
        // Nodes that turn the tangent stand outside of the graph of textures.
        if !outputs.is_empty() {
            let _ = write!(out, "  <nodegraph name=\"{graph}\">\n{nodes}{outputs}  </nodegraph>\n");
        }
        let _ = write!(out, "  <{category} name=\"{surface}\" type=\"surfaceshader\">\n{inputs}  </{category}>\n");
        let _ = write!(
            out,
            "  <surfacematerial name=\"{name}\" type=\"material\">\n    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"{surface}\" />\n  </surfacematerial>\n"
        );
    }
    out += "</materialx>\n";
    out
}

/// A name of MaterialX for that of a material.
fn identifier(name: &str) -> String {
    let name = name.replace('-', "_");
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("_{name}") } else { name }
}

/// A name that no other element of the file has, with as few underscores behind it as it takes.
fn free(taken: &mut BTreeSet<String>, mut name: String) -> String {
    while !taken.insert(name.clone()) {
        name.push('_');
    }
    name
}

/// A shader under way: nodes and outputs of its graph, its inputs.
struct Shader<'s> {
    textures: &'s [(String, &'s Texture)],
    nodes: String,
    outputs: String,
    inputs: String,
    graph: String,
}

fn three(rgb: [f64; 3]) -> String {
    rgb.map(|c| rounded(c).to_string()).join(", ")
}

/// Factor on a texture: a number or a colour; or the ends between which it mixes.
#[derive(Clone, Copy)]
enum Factor {
    Number(f64),
    Color([f64; 3]),
    Range([f64; 2]),
    /// The texture stands in place of the number.
    Replaced([f64; 3]),
}

impl Shader<'_> {
    fn standard_surface(&mut self, numbers: &Numbers) {
        use Factor::{Color, Number, Range, Replaced};
        let turns = |turn: f64| {
            let turns = -turn / TAU;
            turns - libm::floor(turns)
        };
        self.input("base", Number(1.0), None);
        self.input("base_color", Color(numbers.base_color), Some(Slot::BaseColor));
        self.unless("diffuse_roughness", numbers.diffuse_roughness, 0.0);
        self.input("metalness", Number(numbers.metallic), Some(Slot::Metal));
        self.input("specular", Number(numbers.specular), None);
        self.input("specular_color", Color(numbers.specular_color), Some(Slot::SpecularColor));
        self.input("specular_roughness", Number(numbers.roughness), Some(Slot::Roughness));
        self.input("specular_IOR", Number(numbers.ior), None);
        if numbers.anisotropy > 0.0 {
            self.input("specular_anisotropy", Number(numbers.anisotropy), Some(Slot::Anisotropy));
            self.unless("specular_rotation", turns(numbers.turn), 0.0);
        }
        if let Some(coat) = &numbers.coat {
            self.input("coat", Number(coat.weight), Some(Slot::CoatWeight));
            self.input("coat_color", Replaced(coat.color), Some(Slot::CoatColor));
            self.input("coat_roughness", Number(coat.roughness), Some(Slot::CoatRoughness));
            self.input("coat_IOR", Number(coat.ior), None);
            if coat.anisotropy > 0.0 {
                self.input("coat_anisotropy", Number(coat.anisotropy), None);
                self.unless("coat_rotation", turns(coat.turn), 0.0);
            }
        }
        if let Some(film) = &numbers.film {
            self.input("thin_film_thickness", Range(film.thickness_nm), Some(Slot::FilmThickness));
            self.input("thin_film_IOR", Number(film.ior), None);
        }
        self.normals(["normal", "coat_normal"], numbers);
    }

    fn open_pbr(&mut self, numbers: &Numbers) {
        use Factor::{Color, Number, Range, Replaced};
        self.input("base_weight", Number(1.0), None);
        self.input("base_color", Color(numbers.base_color), Some(Slot::BaseColor));
        self.unless("base_diffuse_roughness", numbers.diffuse_roughness, 0.0);
        self.input("base_metalness", Number(numbers.metallic), Some(Slot::Metal));
        self.input("specular_weight", Number(numbers.specular), None);
        self.input("specular_color", Color(numbers.specular_color), Some(Slot::SpecularColor));
        self.input("specular_roughness", Number(numbers.roughness), Some(Slot::Roughness));
        self.input("specular_ior", Number(numbers.ior), None);
        if numbers.anisotropy > 0.0 {
            self.input("specular_roughness_anisotropy", Number(numbers.anisotropy), Some(Slot::Anisotropy));
            self.tangent("geometry_tangent", numbers.turn);
        }
        if let Some(coat) = &numbers.coat {
            self.input("coat_weight", Number(coat.weight), Some(Slot::CoatWeight));
            self.input("coat_color", Replaced(coat.color), Some(Slot::CoatColor));
            self.input("coat_roughness", Number(coat.roughness), Some(Slot::CoatRoughness));
            self.input("coat_ior", Number(coat.ior), None);
            self.input("coat_darkening", Number(if coat.darkens { 1.0 } else { 0.0 }), None);
            if coat.anisotropy > 0.0 {
                self.input("coat_roughness_anisotropy", Number(coat.anisotropy), None);
                self.tangent("geometry_coat_tangent", coat.turn);
            }
        }
        if let Some(film) = &numbers.film {
            self.input("thin_film_weight", Number(film.weight), Some(Slot::FilmWeight));
            self.input("thin_film_thickness", Range(film.thickness_nm.map(|nm| 1e-3 * nm)), Some(Slot::FilmThickness));
            self.input("thin_film_ior", Number(film.ior), None);
        }
        self.normals(["geometry_normal", "geometry_coat_normal"], numbers);
    }

    fn unless(&mut self, name: &str, value: f64, default: f64) {
        if rounded(value) != default {
            self.input(name, Factor::Number(value), None);
        }
    }

    /// An input: a value, or the output of the graph where there is a texture.
    fn input(&mut self, name: &str, factor: Factor, slot: Option<Slot>) {
        let kind = match factor {
            Factor::Number(_) | Factor::Range(_) => "float",
            Factor::Color(_) | Factor::Replaced(_) => "color3",
        };
        let textures = self.textures;
        if let Some((path, texture)) = textures.iter().find(|(_, texture)| Some(texture.slot) == slot) {
            let node = self.picture(name, kind, path, texture);
            let node = self.times(name, kind, node, factor);
            return self.connect(name, kind, &node);
        }
        let value = match factor {
            Factor::Number(value) => rounded(value).to_string(),
            // Without a map both ends are one.
            Factor::Range([_, most]) => rounded(most).to_string(),
            Factor::Color(rgb) | Factor::Replaced(rgb) => three(rgb),
        };
        let _ = writeln!(self.inputs, "    <input name=\"{name}\" type=\"{kind}\" value=\"{value}\" />");
    }

    fn connect(&mut self, name: &str, kind: &str, node: &str) {
        let _ = writeln!(self.outputs, "    <output name=\"{name}_out\" type=\"{kind}\" nodename=\"{node}\" />");
        let graph = &self.graph;
        let _ = writeln!(
            self.inputs,
            "    <input name=\"{name}\" type=\"{kind}\" nodegraph=\"{graph}\" output=\"{name}_out\" />"
        );
    }

    /// Nodes that read a picture; the name of the last.
    fn picture(&mut self, name: &str, kind: &str, path: &str, texture: &Texture) -> String {
        let node = format!("{name}_image");
        // A channel of a picture in colour is taken out of it.
        let stored = match (kind, texture.channel) {
            ("float", Some(luthier_material::Channel::A)) => "color4",
            ("float", Some(channel)) if texture.is_grey() && channel == luthier_material::Channel::R => "float",
            ("float", _) => "color3",
            (kind, _) => kind,
        };
        let space = if texture.is_srgb { "srgb_texture" } else { "lin_rec709" };
        let space = if stored == "vector3" { String::new() } else { format!(" colorspace=\"{space}\"") };
        let placed = texture.transform.map(|transform| self.placement(name, &transform));
        let _ = writeln!(self.nodes, "    <image name=\"{node}\" type=\"{stored}\">");
        let _ = writeln!(self.nodes, "      <input name=\"file\" type=\"filename\" value=\"{path}\"{space} />");
        if let Some(placed) = placed {
            let _ = writeln!(self.nodes, "      <input name=\"texcoord\" type=\"vector2\" nodename=\"{placed}\" />");
        }
        self.nodes += "    </image>\n";
        if kind != "float" || stored == "float" {
            return node;
        }
        let index = texture.channel.map_or(0, luthier_material::Channel::index);
        let _ = write!(
            self.nodes,
            "    <extract name=\"{name}_channel\" type=\"float\">\n      <input name=\"in\" type=\"{stored}\" nodename=\"{node}\" />\n      <input name=\"index\" type=\"integer\" value=\"{index}\" />\n    </extract>\n"
        );
        format!("{name}_channel")
    }

    /// Nodes that place a picture. Coordinates of MaterialX have v upwards, those of material files downwards: the matrix of a placement is turned over on both sides.
    fn placement(&mut self, name: &str, transform: &UvTransform) -> String {
        let [[a, b, u], [c, d, v]] = transform.matrix();
        // (x, 1 - y) goes in, and 1 - (the second row) comes out.
        let rows = [[a, -b, b + u], [-c, d, 1.0 - d - v]];
        let number = |value: f64| rounded(value).to_string();
        let [[ax, ay, at], [bx, by, bt]] = rows.map(|row| row.map(number));
        let _ = write!(
            self.nodes,
            "    <texcoord name=\"{name}_uv\" type=\"vector2\" />\n\
             \x20   <dotproduct name=\"{name}_s\" type=\"float\">\n      <input name=\"in1\" type=\"vector2\" nodename=\"{name}_uv\" />\n      <input name=\"in2\" type=\"vector2\" value=\"{ax}, {ay}\" />\n    </dotproduct>\n\
             \x20   <dotproduct name=\"{name}_t\" type=\"float\">\n      <input name=\"in1\" type=\"vector2\" nodename=\"{name}_uv\" />\n      <input name=\"in2\" type=\"vector2\" value=\"{bx}, {by}\" />\n    </dotproduct>\n\
             \x20   <combine2 name=\"{name}_st\" type=\"vector2\">\n      <input name=\"in1\" type=\"float\" nodename=\"{name}_s\" />\n      <input name=\"in2\" type=\"float\" nodename=\"{name}_t\" />\n    </combine2>\n\
             \x20   <add name=\"{name}_placed\" type=\"vector2\">\n      <input name=\"in1\" type=\"vector2\" nodename=\"{name}_st\" />\n      <input name=\"in2\" type=\"vector2\" value=\"{at}, {bt}\" />\n    </add>\n"
        );
        format!("{name}_placed")
    }

    /// A node times a factor, or between two ends.
    fn times(&mut self, name: &str, kind: &str, node: String, factor: Factor) -> String {
        let value = match factor {
            Factor::Replaced(_) => return node,
            Factor::Number(1.0) | Factor::Color([1.0, 1.0, 1.0]) => return node,
            Factor::Number(value) => rounded(value).to_string(),
            Factor::Color(rgb) => three(rgb),
            Factor::Range([least, most]) => {
                let [least, most] = [least, most].map(|end| rounded(end).to_string());
                let _ = write!(
                    self.nodes,
                    "    <mix name=\"{name}_range\" type=\"float\">\n      <input name=\"fg\" type=\"float\" value=\"{most}\" />\n      <input name=\"bg\" type=\"float\" value=\"{least}\" />\n      <input name=\"mix\" type=\"float\" nodename=\"{node}\" />\n    </mix>\n"
                );
                return format!("{name}_range");
            }
        };
        let _ = write!(
            self.nodes,
            "    <multiply name=\"{name}_times\" type=\"{kind}\">\n      <input name=\"in1\" type=\"{kind}\" nodename=\"{node}\" />\n      <input name=\"in2\" type=\"{kind}\" value=\"{value}\" />\n    </multiply>\n"
        );
        format!("{name}_times")
    }

    fn normals(&mut self, [base, coat]: [&str; 2], numbers: &Numbers) {
        self.normal(base, Slot::Normal);
        if numbers.coat.is_some() {
            self.normal(coat, Slot::CoatNormal);
        }
    }

    fn normal(&mut self, name: &str, slot: Slot) {
        let textures = self.textures;
        let Some((path, texture)) = textures.iter().find(|(_, texture)| texture.slot == slot) else { return };
        let node = self.picture(name, "vector3", path, texture);
        let scale = rounded(texture.scale);
        let _ = write!(
            self.nodes,
            "    <normalmap name=\"{name}_map\" type=\"vector3\">\n      <input name=\"in\" type=\"vector3\" nodename=\"{node}\" />\n      <input name=\"scale\" type=\"float\" value=\"{scale}\" />\n    </normalmap>\n"
        );
        self.connect(name, "vector3", &format!("{name}_map"));
    }

    /// A tangent that is turned counter-clockwise; the node turns clockwise.
    fn tangent(&mut self, name: &str, turn: f64) {
        let degrees = rounded(-turn.to_degrees());
        if degrees == 0.0 {
            return;
        }
        let _ = write!(
            self.nodes,
            "    <tangent name=\"{name}_mesh\" type=\"vector3\">\n      <input name=\"space\" type=\"string\" value=\"world\" />\n    </tangent>\n\
             \x20   <normal name=\"{name}_normal\" type=\"vector3\">\n      <input name=\"space\" type=\"string\" value=\"world\" />\n    </normal>\n\
             \x20   <rotate3d name=\"{name}_turned\" type=\"vector3\">\n      <input name=\"in\" type=\"vector3\" nodename=\"{name}_mesh\" />\n      <input name=\"amount\" type=\"float\" value=\"{degrees}\" />\n      <input name=\"axis\" type=\"vector3\" nodename=\"{name}_normal\" />\n    </rotate3d>\n"
        );
        self.connect(name, "vector3", &format!("{name}_turned"));
    }
}
