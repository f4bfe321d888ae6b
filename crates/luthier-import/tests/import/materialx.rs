//! Materials of MaterialX: shaders, node graphs, pictures, colours, and broken files.

use std::io::{self, ErrorKind};

use luthier_import::{Fate, Import, ImportError, Imported, import, materialx};
use luthier_material::parse;
use proptest::prelude::*;

/// A picture of 2 x 1 texels.
fn picture(texels: [[u8; 3]; 2]) -> Vec<u8> {
    luthier_texture::png::encode_rgb(2, 1, &texels.concat()).unwrap()
}

/// Neighbours of a document: a colour, a grey of roughness, and an include.
fn files(path: &str) -> io::Result<Vec<u8>> {
    match path {
        "maps/color.png" => Ok(picture([[255, 0, 128], [51, 102, 204]])),
        "maps/rough.png" => Ok(picture([[51; 3], [204; 3]])),
        "library.mtlx" => Ok(br#"<materialx version="1.39"><nodegraph name="shared">
            <constant name="c" type="color3"><input name="value" type="color3" value="0.1, 0.2, 0.3"/></constant>
            <output name="out" type="color3" nodename="c"/></nodegraph></materialx>"#
            .to_vec()),
        "circle.mtlx" => Ok(br#"<materialx version="1.39" xmlns:xi="http://www.w3.org/2001/XInclude">
            <xi:include href="circle.mtlx"/></materialx>"#
            .to_vec()),
        "broken.mtlx" => Ok(b"<materialx version=\"1.39\">\n\n<a></materialx>".to_vec()),
        _ => Err(ErrorKind::NotFound.into()),
    }
}

fn document(body: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" colorspace=\"lin_rec709\" \
         xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n{body}\n</materialx>\n"
    )
}

fn imported(body: &str) -> Import {
    materialx("test.mtlx", document(body).as_bytes(), &files).unwrap_or_else(|error| panic!("{error}\n{body}"))
}

/// The one material of a shader, which is a material file.
fn shader(category: &str, inputs: &str, beside: &str) -> (Imported, Import) {
    let body = format!("{beside}\n<{category} name=\"S\" type=\"surfaceshader\">\n{inputs}\n</{category}>\n{MATERIAL}");
    let import = imported(&body);
    let [material] = import.materials.as_slice() else { panic!("{import:?}") };
    let read = parse("x.toml", &material.text, &|_| Err(ErrorKind::NotFound.into()));
    read.unwrap_or_else(|errors| panic!("{errors:?}\n{}", material.text));
    (material.clone(), import)
}

const MATERIAL: &str = r#"<surfacematerial name="Red Paint" type="material">
<input name="surfaceshader" type="surfaceshader" nodename="S"/></surfacematerial>"#;

/// Pictures of a colour and of a roughness, in tiles of 2 x 3.
const PICTURES: &str = r#"<nodegraph name="G" fileprefix="maps/">
<tiledimage name="color" type="color3"><input name="file" type="filename" value="color.png" colorspace="srgb_texture"/>
<input name="uvtiling" type="vector2" value="2, 3"/></tiledimage>
<tiledimage name="rough" type="float"><input name="file" type="filename" value="rough.png"/>
<input name="uvtiling" type="vector2" value="2, 3"/></tiledimage>
<multiply name="half" type="color3"><input name="in1" type="color3" nodename="color"/><input name="in2" type="float" value="0.5"/></multiply>
<invert name="gloss" type="float"><input name="in" type="float" nodename="rough"/></invert>
<normalmap name="bumps" type="vector3"><input name="in" type="vector3" nodename="texels"/><input name="scale" type="float" value="0.5"/></normalmap>
<image name="texels" type="vector3"><input name="file" type="filename" value="color.png"/></image>
<output name="color" type="color3" nodename="color"/><output name="half" type="color3" nodename="half"/>
<output name="rough" type="float" nodename="rough"/><output name="gloss" type="float" nodename="gloss"/>
<output name="bumps" type="vector3" nodename="bumps"/></nodegraph>"#;

fn input(name: &str, of_type: &str, rest: &str) -> String {
    format!("<input name=\"{name}\" type=\"{of_type}\" {rest}/>\n")
}

fn value(name: &str, of_type: &str, value: &str) -> String {
    input(name, of_type, &format!("value=\"{value}\""))
}

fn of_graph(name: &str, of_type: &str, output: &str) -> String {
    input(name, of_type, &format!("nodegraph=\"G\" output=\"{output}\""))
}

#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
}

/// Stored numbers of a picture, from 0 to 1.
fn values(import: &Import, path: &str) -> Vec<[f64; 3]> {
    let bytes = import.pictures.get(path).unwrap_or_else(|| panic!("no {path} in {:?}", import.pictures.keys()));
    let picture = luthier_texture::picture::decode(bytes).unwrap().picture;
    let [width, height] = picture.size();
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.map(|(x, y)| picture.texel(x, y).map(f64::from)).map(|[r, g, b, _]| [r, g, b]).collect()
}

#[track_caller]
fn close(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1e-4, "{found}, wanted {wanted}");
}

fn fates(material: &Imported, property: &str) -> Vec<Fate> {
    material.lines.iter().filter(|line| line.property == property).map(|line| line.fate).collect()
}

#[test]
fn pictures_stay_as_they_are_where_a_file_can_say_so() {
    let inputs = of_graph("base_color", "color3", "half")
        + &of_graph("specular_roughness", "float", "rough")
        + &of_graph("normal", "vector3", "bumps");
    let (material, import) = shader("standard_surface", &inputs, PICTURES);
    has(
        &material.text,
        &[
            "name = \"red-paint\"",
            "base_color = 0.5",
            "base_color = { image = \"maps/color.png\", srgb = true, transform = { scale = [2.0, 3.0] } }",
            "roughness = { image = \"maps/rough.png\", channel = \"r\", transform = { scale = [2.0, 3.0] } }",
            "normal = { image = \"maps/color.png\", scale = 0.5 }",
        ],
    );
    assert_eq!(import.pictures.len(), 2);
    assert_eq!(import.pictures["maps/rough.png"], files("maps/rough.png").unwrap());
}

#[test]
fn pictures_are_computed_where_not() {
    // Below a coat slopes are squares; a graph is evaluated for each texel.
    let inputs = value("coat", "float", "1")
        + &of_graph("specular_roughness", "float", "gloss")
        + &of_graph("coat_color", "color3", "color")
        + &value("base_color", "color3", "0.5, 0.5, 0.5")
        + &value("metalness", "float", "1");
    let (material, import) = shader("standard_surface", &inputs, PICTURES);
    has(
        &material.text,
        &[
            "darkening = false",
            "alpha = 0.64",
            "alpha = { image = \"maps/alpha.png\", transform = { scale = [2.0, 3.0] } }",
        ],
    );
    let alphas = values(&import, "maps/alpha.png");
    close(alphas[0][0], 1.0);
    close(alphas[1][0], 0.04 / 0.64);
    // The colour of a coat multiplies that of the base: linear Rec.709 by the definition of sRGB.
    let linear = |code: f64| if code <= 0.04045 { code / 12.92 } else { libm::pow((code + 0.055) / 1.055, 2.4) };
    let colors = values(&import, "maps/base-color.png");
    has(&material.text, &["base_color = [0.5, ", "image = \"maps/base-color.png\""]);
    let over =
        [[255.0, 0.0, 128.0], [51.0, 102.0, 204.0]].map(|texel: [f64; 3]| texel.map(|code| linear(code / 255.0)));
    for (found, wanted) in colors.iter().zip(over) {
        for (c, (found, wanted)) in found.iter().zip(wanted).enumerate() {
            close(*found, wanted / over[0][c].max(over[1][c]));
        }
    }
}

/// Numbers with published values: F0 of an index, the coat of OpenPBR, its edge tint and its anisotropy.
#[test]
fn open_pbr_is_what_its_specification_says() {
    let inputs = value("base_color", "color3", "0.9, 0.6, 0.3")
        + &value("base_metalness", "float", "1")
        + &value("specular_color", "color3", "0.97, 0.98, 0.99")
        + &value("specular_roughness", "float", "0.4")
        + &value("specular_roughness_anisotropy", "float", "0.5")
        + &value("coat_weight", "float", "0.5")
        + &value("coat_color", "color3", "0.25, 1, 1");
    let (material, _) = shader("open_pbr_surface", &inputs, "");
    // -ln(.25)/2 = .693147; alphas .202 and .101.
    has(
        &material.text,
        &[
            "ior = 1.6",
            "weight = 0.5",
            "absorption_per_um = [0.693147, 0.0, 0.0]",
            "f82_tint = [0.97, 0.98, 0.99]",
            "alpha_x = 0.202386",
            "alpha_y = 0.101193",
        ],
    );
    assert!(!material.text.contains("darkening"), "{}", material.text);
    let (plain, _) = shader("open_pbr_surface", &value("specular_ior", "float", "1.6"), "");
    // ((1.6 - 1)/(1.6 + 1))^2
    has(&plain.text, &["f0 = 0.0532544", "roughness = 0.3"]);
    // Below a coat of the same index nothing reflects: the base is diffuse.
    let (coated, _) =
        shader("open_pbr_surface", &(value("specular_ior", "float", "1.6") + &value("coat_weight", "float", "1")), "");
    has(&coated.text, &["type = \"diffuse\"", "albedo = 0.8"]);
}

#[test]
fn other_shaders_are_read() {
    let (gltf, _) = shader("gltf_pbr", &(value("metallic", "float", "0.25") + &value("ior", "float", "2")), "");
    // A number of metal is a blend, as a map.
    has(&gltf.text, &["f0 = 0.111111", "metallic = { image = \"maps/white.png\" }"]);
    let (usd, _) = shader(
        "UsdPreviewSurface",
        &(value("clearcoat", "float", "1") + &value("clearcoatRoughness", "float", "0.5")),
        "",
    );
    has(&usd.text, &["base_color = 0.18", "ior = 1.5\nroughness = 0.5"]);
    let (disney, _) =
        shader("disney_principled", &(value("specular", "float", "1") + &value("anisotropic", "float", "0.5")), "");
    has(&disney.text, &["f0 = 0.08", "alpha_x = 0.353553", "alpha_y = 0.176777"]);
    let (film, _) = shader(
        "standard_surface",
        &(value("thin_film_thickness", "float", "400") + &value("metalness", "float", "1")),
        "",
    );
    has(&film.text, &["thickness_nm = 400.0", "metallic = 1.0"]);
    let (lost, _) = shader(
        "standard_surface",
        &(value("transmission", "float", "1") + &value("sheen", "float", "0") + &value("odd", "float", "1")),
        "",
    );
    assert_eq!(
        [fates(&lost, "transmission"), fates(&lost, "sheen"), fates(&lost, "odd")],
        [[Fate::Dropped], [Fate::Kept], [Fate::Dropped]]
    );
}

/// What a coat of Standard Surface does to its base, OpenPBR's index below a coat, and the way round of directions: by hand from the graphs of the shaders.
#[test]
fn coats_act_on_their_bases() {
    let inputs = value("base_color", "color3", "0.5, 0.5, 0.5")
        + &value("coat", "float", "0.5")
        + &value("coat_color", "color3", "0.2, 1, 1");
    // The mix of 1 and .2 half way.
    has(
        &shader("standard_surface", &inputs, "").0.text,
        &["weight = 0.5", "base_color = [0.3, 0.5, 0.5]", "f0 = [0.024, 0.04, 0.04]"],
    );
    let inputs = value("base_color", "color3", "0.5, 0.5, 0.5")
        + &value("coat", "float", "1")
        + &value("coat_roughness", "float", "0.4")
        + &value("coat_affect_color", "float", "1")
        + &value("coat_affect_roughness", "float", "0.5");
    // .5^2, and .2 + .8 (.5 1 .4).
    has(&shader("standard_surface", &inputs, "").0.text, &["base_color = 0.25", "roughness = 0.36"]);
    // The index goes from 1.5 to 1.6/1.5 half way: 1.28333.
    has(&shader("open_pbr_surface", &value("coat_weight", "float", "0.5"), "").0.text, &["f0 = 0.0153977"]);
    let turned = value("specular_anisotropy", "float", "0.5") + &value("specular_rotation", "float", "0.1");
    has(&shader("standard_surface", &turned, "").0.text, &["rotation_deg = -36.0"]);
    let turned = value("anisotropy_strength", "float", "0.5") + &value("anisotropy_rotation", "float", "0.628318531");
    has(&shader("gltf_pbr", &turned, "").0.text, &["rotation_deg = 36.0"]);
}

/// A film whose picture is the same everywhere has one thickness, and ships no picture.
#[test]
fn even_films_have_a_number() {
    let even = r#"<image name="r" type="float"><input name="file" type="filename" value="maps/rough.png"/></image>
<clamp name="m" type="float"><input name="in" type="float" nodename="r"/><input name="low" type="float" value="300"/><input name="high" type="float" value="300"/></clamp>"#;
    let inputs = value("iridescence", "float", "1") + &input("iridescence_thickness", "float", "nodename=\"m\"");
    let (material, import) = shader("gltf_pbr", &inputs, even);
    has(&material.text, &["thickness_nm = 300.0"]);
    assert!(import.pictures.is_empty(), "{:?}", import.pictures.keys());
}

#[test]
fn colours_become_rec709() {
    // ACEScg (0.2, 0.5, 0.3): negative in red, by the matrix of the format's library.
    let inputs = input("base_color", "color3", "value=\"0.5, 0.4, 0.3\" colorspace=\"acescg\"");
    let (material, _) = shader("gltf_pbr", &inputs, "");
    has(&material.text, &["base_color = [0.578831, 0.388029, 0.282302]"]);
    let inputs = input("base_color", "color3", "value=\"0, 0.5, 0\" colorspace=\"acescg\"");
    let (material, _) = shader("gltf_pbr", &inputs, "");
    assert!(material.lines.iter().any(|line| line.note.contains("is beyond what is read")), "{:?}", material.lines);
    let inputs = input("base_color", "color3", "value=\"0.5, 0.5, 0.5\" colorspace=\"klingon\"");
    let (material, _) = shader("gltf_pbr", &inputs, "");
    assert_eq!(fates(&material, "base_color"), [Fate::Dropped]);
}

/// A node that the document defines, whose graph has its inputs; interface names of graphs; includes.
#[test]
fn graphs_are_followed() {
    let defined = r#"<xi:include href="library.mtlx"/>
<nodedef name="ND_twice" node="twice"><input name="in" type="color3" value="0.4, 0.4, 0.4"/><output name="out" type="color3"/></nodedef>
<nodegraph name="NG_twice" nodedef="ND_twice">
<multiply name="m" type="color3"><input name="in1" type="color3" interfacename="in"/><input name="in2" type="float" value="2"/></multiply>
<output name="out" type="color3" nodename="m"/></nodegraph>
<nodegraph name="G"><input name="tint" type="color3" nodename="t"/>
<twice name="a" type="color3"><input name="in" type="color3" interfacename="tint"/></twice>
<twice name="b" type="color3"/>
<output name="a" type="color3" nodename="a"/><output name="b" type="color3" nodename="b"/></nodegraph>
<constant name="t" type="color3"><input name="value" type="color3" value="0.05, 0.1, 0.2"/></constant>"#;
    let of = |output: &str| shader("gltf_pbr", &of_graph("base_color", "color3", output), defined).0.text;
    has(&of("a"), &["base_color = [0.1, 0.2, 0.4]"]);
    has(&of("b"), &["base_color = 0.8"]);
    let shared = input("base_color", "color3", "nodegraph=\"shared\"");
    has(&shader("gltf_pbr", &shared, defined).0.text, &["base_color = [0.1, 0.2, 0.3]"]);
    // Names that lead nowhere, circles and nodes that are not read are told with their line.
    for (beside, said) in [
        ("", "there is no node graph `G`"),
        (
            "<nodegraph name=\"G\"><output name=\"out\" type=\"color3\" nodename=\"x\"/></nodegraph>",
            "line 3: there is no node `x`",
        ),
        (
            "<nodegraph name=\"G\">\n<noise3d name=\"n\" type=\"color3\"/><output name=\"out\" type=\"color3\" nodename=\"n\"/></nodegraph>",
            "line 4: the node `noise3d` is not read",
        ),
        (
            "<nodegraph name=\"G\"><dot name=\"n\" type=\"color3\"><input name=\"in\" type=\"color3\" nodename=\"n\"/></dot>\
             <output name=\"out\" type=\"color3\" nodename=\"n\"/></nodegraph>",
            "a circle of them",
        ),
    ] {
        let (material, _) = shader("gltf_pbr", &of_graph("base_color", "color3", "out"), beside);
        let line = material.lines.iter().find(|line| line.property == "base_color").unwrap();
        assert!(line.fate == Fate::Dropped && line.note.contains(said), "{line:?}");
        has(&material.text, &["base_color = 1.0"]);
    }
}

/// Pictures that are placed differently are computed over texture coordinates: at each place the value is that of the graph.
#[test]
fn placements_are_baked_together() {
    let graph = r#"<nodegraph name="G" fileprefix="maps/">
<tiledimage name="a" type="float"><input name="file" type="filename" value="rough.png"/><input name="uvtiling" type="vector2" value="2, 1"/></tiledimage>
<image name="b" type="float"><input name="file" type="filename" value="rough.png"/></image>
<multiply name="m" type="float"><input name="in1" type="float" nodename="a"/><input name="in2" type="float" nodename="b"/></multiply>
<output name="out" type="float" nodename="m"/></nodegraph>"#;
    let (material, import) = shader("gltf_pbr", &of_graph("metallic", "float", "out"), graph);
    has(&material.text, &["metallic = { image = \"maps/metallic.png\" }"]);
    // Texels .2 and .8, once over the width and twice: the second picture is read bilinearly at four places.
    let at = |u: f64, tiles: f64| {
        let x = (u * tiles).rem_euclid(1.0) * 2.0 - 0.5;
        let share = x.rem_euclid(1.0);
        let [a, b] = if x.floor().rem_euclid(2.0) < 0.5 { [0.2, 0.8] } else { [0.8, 0.2] };
        a + (b - a) * share
    };
    let found = values(&import, "maps/metallic.png");
    assert_eq!(found.len(), 4);
    let wanted: Vec<f64> = [0.125, 0.375, 0.625, 0.875].map(|u| at(u, 2.0) * at(u, 1.0)).to_vec();
    let most = wanted.iter().copied().fold(0.0, f64::max);
    for (found, wanted) in found.iter().zip(&wanted) {
        close(found[0], wanted / most);
    }
}

#[test]
fn a_picture_that_is_missing_is_told() {
    let graph = r#"<image name="c" type="color3"><input name="file" type="filename" value="none.png"/></image>"#;
    let (material, import) = shader("gltf_pbr", &input("base_color", "color3", "nodename=\"c\""), graph);
    assert_eq!(fates(&material, "picture of base_color"), [Fate::Dropped, Fate::Approximated]);
    assert!(import.pictures.is_empty());
    let tiles =
        r#"<image name="c" type="color3"><input name="file" type="filename" value="a.&lt;UDIM&gt;.png"/></image>"#;
    let (material, _) = shader("gltf_pbr", &input("base_color", "color3", "nodename=\"c\""), tiles);
    assert!(material.lines[0].note.contains("one of many tiles"), "{:?}", material.lines);
}

#[test]
fn broken_files_say_where() {
    let said = |text: &str| materialx("x.mtlx", text.as_bytes(), &files).unwrap_err().to_string();
    assert_eq!(
        said("<materialx version=\"1.37\"/>"),
        "line 1: version 1.37 is older than 1.38: write the file anew with MaterialX"
    );
    assert_eq!(said("\n<html/>"), "line 2: the root is `html`: a MaterialX file has `materialx`");
    assert!(said("<materialx version=\"1.39\">\n<a>\n</b></materialx>").starts_with("line 3: no well-formed XML: "));
    assert!(said("<!DOCTYPE x [<!ENTITY a \"b\">]><materialx version=\"1.39\"/>").starts_with("line 1: "));
    assert!(said("<materialx version=\"1.39\"/>").contains("no materials"));
    let include = |href: &str| said(&document(&format!("<xi:include href=\"{href}\"/>")));
    assert!(include("none.mtlx").starts_with("line 3: `none.mtlx`: "));
    assert!(include("broken.mtlx").starts_with("broken.mtlx, line 3: "));
    assert!(include("circle.mtlx").contains("no materials"));
    let deep = format!("{}{}", "<a>".repeat(100), "</a>".repeat(100));
    assert!(said(&document(&deep)).contains("more than 64"));
    let hair = "<hair name=\"S\" type=\"surfaceshader\"/>".to_owned() + MATERIAL;
    let error = materialx("x.mtlx", document(&hair).as_bytes(), &files).unwrap_err();
    assert!(
        matches!(&error, ImportError::Empty(_)) && error.to_string().contains("the shader `hair` is not read"),
        "{error}"
    );
    // The format is told by its content.
    let body = format!("<gltf_pbr name=\"S\" type=\"surfaceshader\"/>{MATERIAL}");
    assert_eq!(import("x", document(&body).as_bytes(), &files).unwrap().materials.len(), 1);
}

/// A node with constant inputs as a base colour.
fn node(category: &str, inputs: &str) -> String {
    let beside = format!("<{category} name=\"n\" type=\"color3\">{inputs}</{category}>");
    shader("gltf_pbr", &input("base_color", "color3", "nodename=\"n\""), &beside).0.text
}

/// Values by hand from the graphs of the format's library.
#[test]
fn nodes_are_those_of_the_library() {
    let grey = |name: &str, number: &str| value(name, "color3", &format!("{number}, {number}, {number}"));
    // The background decides: 1 - 2 (1 - .2)(1 - .8).
    has(&node("overlay", &(grey("fg", "0.2") + &grey("bg", "0.8"))), &["base_color = 0.68"]);
    has(&node("ifequal", &(grey("in1", "0.3") + &grey("in2", "0.6"))), &["base_color = 0.3"]);
    has(&node("switch", &(value("which", "float", "10") + &grey("in10", "0.7"))), &["base_color = 0.0"]);
    has(&node("smoothstep", &(grey("in", "0.5") + &grey("low", "0.4") + &grey("high", "0.4"))), &["base_color = 1.0"]);
    let luma = value("in", "color3", "0.1, 0.2, 0.4") + &value("lumacoeffs", "color3", "0, 0, 1");
    has(&node("luminance", &luma), &["base_color = 0.4"]);
    // A number that is none, as (-.5)^.5, is 0.
    has(&node("power", &(grey("in1", "-0.5") + &grey("in2", "0.5"))), &["base_color = 0.0"]);
}

/// The metal of a mix has the colour of the base, whatever lies below the surface of the rest.
#[test]
fn subsurface_leaves_metals_alone() {
    let inputs = value("base_color", "color3", "0.9, 0.7, 0.3")
        + &value("metalness", "float", "1")
        + &value("subsurface", "float", "1")
        + &value("subsurface_color", "color3", "0.8, 0.1, 0.1");
    has(&shader("standard_surface", &inputs, "").0.text, &["base_color = [0.9, 0.7, 0.3]"]);
    let inputs = value("base_metalness", "float", "0.5") + &value("specular_weight", "float", "0.5");
    has(&shader("open_pbr_surface", &inputs, "").0.text, &["base_color = 0.6"]);
}

/// Texels beyond a key's range are held to it one by one: .2 and .8 times 2.
#[test]
fn texels_are_held() {
    let twice = r#"<image name="r" type="float"><input name="file" type="filename" value="maps/rough.png"/></image>
<multiply name="m" type="float"><input name="in1" type="float" nodename="r"/><input name="in2" type="float" value="2"/></multiply>"#;
    let (material, import) = shader("gltf_pbr", &input("metallic", "float", "nodename=\"m\""), twice);
    has(&material.text, &["metallic = 1.0"]);
    let found = values(&import, "maps/metallic.png");
    close(found[0][0], 0.4);
    close(found[1][0], 1.0);
    // A film from -100 nm to 500 nm begins at 0.
    let film = r#"<image name="r" type="float"><input name="file" type="filename" value="maps/rough.png"/></image>
<remap name="m" type="float"><input name="in" type="float" nodename="r"/><input name="inlow" type="float" value="0.2"/>
<input name="inhigh" type="float" value="0.8"/><input name="outlow" type="float" value="-100"/><input name="outhigh" type="float" value="500"/></remap>"#;
    let inputs = value("iridescence", "float", "1") + &input("iridescence_thickness", "float", "nodename=\"m\"");
    has(&shader("gltf_pbr", &inputs, film).0.text, &["min = 0.0, max = 500.0"]);
}

/// Graphs that would take for ever, or all memory, are told and left.
#[test]
fn graphs_have_ends() {
    let chain = |count: usize, of: &dyn Fn(usize) -> String| (0..count).map(of).collect::<String>();
    let start =
        "<image name=\"n0\" type=\"color3\"><input name=\"file\" type=\"filename\" value=\"maps/color.png\"/></image>";
    let doubled = |i: usize| {
        let input = |name: &str| input(name, "color3", &format!("nodename=\"n{i}\""));
        format!("<multiply name=\"n{}\" type=\"color3\">{}{}</multiply>", i + 1, input("in1"), input("in2"))
    };
    shader("gltf_pbr", &input("base_color", "color3", "nodename=\"n40\""), &(start.to_owned() + &chain(40, &doubled)));
    let defined = |i: usize| {
        let node = |name: &str| format!("<d{} name=\"{name}\" type=\"color3\"/>", i + 1);
        format!(
            "<nodedef name=\"D{i}\" node=\"d{i}\"><output name=\"out\" type=\"color3\"/></nodedef><nodegraph name=\"G{i}\" nodedef=\"D{i}\">{}{}\
             <multiply name=\"m\" type=\"color3\"><input name=\"in1\" type=\"color3\" nodename=\"a\"/><input name=\"in2\" type=\"color3\" nodename=\"b\"/></multiply>\
             <output name=\"out\" type=\"color3\" nodename=\"m\"/></nodegraph>",
            node("a"),
            node("b")
        )
    };
    let end = "<nodedef name=\"D30\" node=\"d30\"><output name=\"out\" type=\"color3\"/></nodedef><nodegraph name=\"G30\" nodedef=\"D30\">\
               <constant name=\"c\" type=\"color3\"/><output name=\"out\" type=\"color3\" nodename=\"c\"/></nodegraph>";
    let laughs = chain(30, &defined) + end + "<d0 name=\"top\" type=\"color3\"/>";
    let (material, _) = shader("gltf_pbr", &input("base_color", "color3", "nodename=\"top\""), &laughs);
    assert!(material.lines.iter().any(|line| line.note.contains("more than 20000 nodes")), "{:?}", material.lines);
    let circle = r#"<nodegraph name="g"><output name="out" type="surfaceshader" nodegraph="g"/></nodegraph>
<surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodegraph="g"/></surfacematerial>"#;
    assert!(materialx("x.mtlx", document(circle).as_bytes(), &files).is_err());
}

/// Inputs of the shaders that are read, with numbers and pictures.
const INPUTS: [(&str, &[&str]); 5] = [
    (
        "standard_surface",
        &[
            "base",
            "base_color",
            "diffuse_roughness",
            "metalness",
            "specular",
            "specular_color",
            "specular_roughness",
            "specular_IOR",
            "specular_anisotropy",
            "specular_rotation",
            "subsurface",
            "subsurface_color",
            "coat",
            "coat_color",
            "coat_roughness",
            "coat_anisotropy",
            "coat_rotation",
            "coat_IOR",
            "coat_affect_color",
            "coat_affect_roughness",
            "thin_film_thickness",
            "thin_film_IOR",
            "normal",
            "coat_normal",
        ],
    ),
    (
        "open_pbr_surface",
        &[
            "base_weight",
            "base_color",
            "base_diffuse_roughness",
            "base_metalness",
            "specular_weight",
            "specular_color",
            "specular_roughness",
            "specular_ior",
            "specular_roughness_anisotropy",
            "subsurface_weight",
            "coat_weight",
            "coat_color",
            "coat_roughness",
            "coat_roughness_anisotropy",
            "coat_ior",
            "coat_darkening",
            "thin_film_weight",
            "thin_film_thickness",
            "thin_film_ior",
            "geometry_normal",
            "geometry_coat_normal",
        ],
    ),
    (
        "gltf_pbr",
        &[
            "base_color",
            "metallic",
            "roughness",
            "ior",
            "specular",
            "specular_color",
            "anisotropy_strength",
            "anisotropy_rotation",
            "clearcoat",
            "clearcoat_roughness",
            "iridescence",
            "iridescence_thickness",
            "iridescence_ior",
            "normal",
            "clearcoat_normal",
        ],
    ),
    (
        "UsdPreviewSurface",
        &[
            "diffuseColor",
            "metallic",
            "roughness",
            "ior",
            "useSpecularWorkflow",
            "specularColor",
            "clearcoat",
            "clearcoatRoughness",
            "normal",
        ],
    ),
    (
        "disney_principled",
        &[
            "baseColor",
            "metallic",
            "roughness",
            "specular",
            "specularTint",
            "anisotropic",
            "clearcoat",
            "clearcoatGloss",
        ],
    ),
];

const NUMBERS: [&str; 10] = ["0", "1", "0.5", "-1", "1e30", "1e-30", "2.4", "0.04", "400", "0.999999"];

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_import_is_a_material(
        category in 0..INPUTS.len(),
        chosen in prop::collection::vec((0_usize..64, 0..NUMBERS.len(), 0_usize..5), 0..14),
    ) {
        let (category, names) = INPUTS[category];
        let mut inputs = String::new();
        let mut known = Vec::new();
        for (name, number, source) in chosen {
            let name = names[name % names.len()];
            if known.contains(&name) {
                continue;
            }
            known.push(name);
            let is_color = name.contains("olor") && !name.contains("affect");
            inputs += &match (name.contains("ormal"), is_color, source) {
                (true, ..) => of_graph(name, "vector3", "bumps"),
                (_, true, 3) => of_graph(name, "color3", "color"),
                (_, true, 4) => of_graph(name, "color3", "half"),
                (_, true, _) => value(name, "color3", &format!("{0}, 0.3, {0}", NUMBERS[number])),
                (_, false, 3) => of_graph(name, "float", "rough"),
                (_, false, 4) => of_graph(name, "float", "gloss"),
                _ => value(name, "float", NUMBERS[number]),
            };
        }
        let body = format!("{PICTURES}<{category} name=\"S\" type=\"surfaceshader\">{inputs}</{category}>{MATERIAL}");
        let import = materialx("odd.mtlx", document(&body).as_bytes(), &files).unwrap();
        let text = &import.materials[0].text;
        let parsed = parse("odd.toml", text, &|_| Err(ErrorKind::NotFound.into()));
        let said = parsed.as_ref().err().map(|errors| errors.iter().map(|e| e.render(text)).collect::<String>());
        prop_assert!(parsed.is_ok(), "{}\n{}\n{}", said.unwrap_or_default(), text, inputs);
        let named = |path: &&String| text.contains(&format!("\"{path}\""));
        prop_assert!(import.pictures.keys().all(|path| named(&path)), "{:?}\n{}", import.pictures.keys(), text);
    }
}
