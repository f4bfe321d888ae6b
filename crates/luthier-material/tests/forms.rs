//! Forms that the grammar accepts, and their meaning.

use std::io;

use luthier_lut::TexelFormat;
use luthier_manifest::ColorMode;
use luthier_material::{DistributionMapping, FlakeSource, Material, Parsed, PictureRef, VariationSource, parse};
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Surface};

fn read(path: &str) -> io::Result<String> {
    match path {
        "lab/paint.csv" => Ok("wavelength_nm,n,k\n360,1.52,0\n830,1.48,0\n".to_owned()),
        "lab/broken.csv" => Ok("wavelength_nm,n,k\n360,1.52\n".to_owned()),
        _ => Err(io::Error::other("none")),
    }
}

fn material(body: &str) -> Material {
    let text = format!("schema = 1\nname = \"x\"\n{body}");
    match parse("x.toml", &text, &read) {
        Ok(Parsed { material, .. }) => material,
        Err(diagnostics) => panic!("{}", diagnostics.iter().map(|d| d.render(&text) + "\n").collect::<String>()),
    }
}

/// Messages of the errors, one a line.
fn errors(body: &str) -> String {
    let text = format!("schema = 1\nname = \"x\"\n{body}");
    let diagnostics = parse("x.toml", &text, &read).unwrap_err();
    diagnostics.into_iter().map(|d| d.message + " | " + d.hint.as_deref().unwrap_or("") + "\n").collect()
}

fn surface(lines: &str) -> Surface {
    material(&format!("[[layer]]\ntype = \"conductor\"\nior = \"au\"\n{lines}")).stack.layers[0].surface
}

fn index(ior: &str) -> Ior {
    let material = material(&format!("[[layer]]\ntype = \"dielectric\"\nsmooth = true\nior = {ior}"));
    match &material.stack.layers[0].base {
        Base::Dielectric { ior, .. } => ior.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn roughness_has_five_forms() {
    assert!(surface("smooth = true").is_smooth());
    assert_eq!(surface("alpha = 0.3"), Surface::isotropic(Distribution::Ggx, 0.3));
    assert_eq!(surface("roughness = 0.5").alpha_x, 0.25);
    assert_eq!(surface("distribution = \"beckmann\"\nalpha = 1").distribution, Distribution::Beckmann);
    // tan 12 degrees
    assert!((surface("slope_deg = 12").alpha_y - 0.212_556_561_670_022).abs() < 1e-15);
    assert_eq!(surface("slope_deg = 45").alpha_x, surface("slope_deg = 45").alpha_x.min(1.0));
    let brushed = surface("alpha_x = 0.4\nalpha_y = 0.1\nrotation_deg = 90");
    assert_eq!((brushed.alpha_x, brushed.alpha_y), (0.4, 0.1));
    assert!((brushed.rotation - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
}

#[test]
fn an_index_has_four_forms() {
    assert_eq!(index("1.5"), Ior::constant(1.5, 0.0).unwrap());
    assert_eq!(index("{ n = 1.5, k = 1e-3 }"), Ior::constant(1.5, 1e-3).unwrap());
    // The order of the wavelengths is free; a lone number holds for all of them.
    let sampled = index("{ n = [1.4, 1.45, 1.6], k = 0.01, wavelengths_nm = [645, 525, 445] }");
    assert_eq!([645.0, 525.0, 445.0].map(|nm| sampled.at(nm).re), [1.4, 1.45, 1.6]);
    assert_eq!(sampled.at(500.0).im, 0.01);
    // Oracle: Daimon and Masumura's water at the sodium D line.
    assert!((index("\"water\"").at(589.3).re - 1.33335).abs() < 1e-4);
    assert_eq!(index("\"lab/paint.csv\"").at(595.0).re, 1.5);
}

#[test]
fn wrong_indices_are_explained() {
    let ior = |ior: &str| errors(&format!("[[layer]]\ntype = \"dielectric\"\nsmooth = true\nior = {ior}"));
    assert!(ior("\"lab/broken.csv\"").contains("line 2: 2 columns where the header has 3"));
    assert!(ior("\"lab/none.csv\"").contains("cannot read"));
    assert!(ior("\"diamnd\"").contains("`\"diamond\"`"));
    assert!(ior("{ n = [1, 2], wavelengths_nm = [600, 500, 400] }").contains("2 values of `n` for 3 wavelengths"));
    assert!(ior("{ n = [1, 2], wavelengths_nm = [500, 500] }").contains("must ascend"));
    assert!(ior("{ n = [1, 2], wavelengths_nm = [0.6, 0.5] }").contains("`600`"));
    assert!(ior("{ n = 1.5, wavelengths_nm = [600] }").contains("wavelengths without a list"));
    assert!(ior("{ k = 1 }").contains("`n` is missing"));
    assert!(ior("nan").contains("must be above 0, found NaN"));
    assert!(ior("true").contains("must be a number or a table { n, k, wavelengths_nm } or a string"));
}

#[test]
fn films_stack_and_only_the_top_one_varies() {
    let film = |nm: &str| format!("[[layer]]\ntype = \"thin-film\"\nior = 1.4\nthickness_nm = {nm}\n");
    let range = film("{ min = 10, max = 30, extent_um = 5, map = { image = \"t.png\" } }");
    let base = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nsmooth = true\n";
    let material = material(&format!("{range}{}{base}", film("100")));
    let layer = &material.stack.layers[0];
    assert_eq!(layer.films.iter().map(|f| f.thickness.nominal_nm()).collect::<Vec<_>>(), [20.0, 100.0]);
    let variation = material.layers[0].film_variation.as_ref().unwrap();
    assert_eq!(variation.source, VariationSource::Image(PictureRef::plain("t.png")));
    assert_eq!(variation.extent_um, 5.0);
    assert!(errors(&format!("{}{range}{base}", film("100"))).contains("only the top film"));
    assert!(errors(&format!("{range}[[layer]]\ntype = \"diffuse\"\nalbedo = 1\n")).contains("no interface"));
}

#[test]
fn effects_maps_and_bake_are_read() {
    let material = material(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n\
         [layer.maps]\nnormal = \"n.png\"\nthickness = \"t.png\"\n\
         [[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n\
         [effects.flakes]\ncells = {}\nscale = 0.5\n\
         [effects.patina]\nextent = -0.5\ntransition = 0.5\nmap = { noise = { seed = 4294967295 } }\nbase_alpha = 0.4\n\
         [bake]\ncolor = \"three-wavelengths\"\nwavelengths_nm = [650, 550, 450]\n\
         fresnel = { size = 64, format = \"rgba8unorm\", mapping = \"sqrt-cosine\" }\n\
         distribution = { size = [512, 256], mapping = \"cos-power\", exponent = 8, alpha_mapping = \"log\" }\n\
         fgd = { size = [32, 32], format = \"rgba32float\" }\nphase = { size = 256 }\nthickness = { size = 128 }\n",
    );
    let maps = &material.layers[0].maps;
    let path = |map: &Option<PictureRef>| map.as_ref().map(|picture| picture.path.clone());
    assert_eq!((path(&maps.normal), path(&maps.roughness)), (Some("n.png".to_owned()), None));
    assert_eq!(path(&maps.thickness), Some("t.png".to_owned()));
    let flakes = material.effects.flakes.as_ref().unwrap();
    assert!(matches!(flakes.source, FlakeSource::Cells { seed: 0, count: 64, .. }));
    assert_eq!((flakes.tiling, flakes.scale), (1000.0, 0.5));
    let patina = material.effects.patina.as_ref().unwrap();
    assert_eq!(patina.map, VariationSource::Noise { seed: u32::MAX, frequency: 4.0, octaves: 4 });
    assert_eq!((patina.extent, patina.base_alpha, patina.tarnish), (-0.5, Some(0.4), [1.0; 3]));
    let bake = &material.bake;
    assert_eq!((bake.color, bake.wavelengths_nm()), (Some(ColorMode::ThreeWavelengths), [650.0, 550.0, 450.0]));
    assert_eq!((bake.fresnel.size, bake.fresnel.format), (Some(64), Some(TexelFormat::Rgba8Unorm)));
    assert_eq!(
        (bake.distribution.size, bake.distribution.mapping),
        (Some([512, 256]), Some(DistributionMapping::CosPower))
    );
    assert_eq!((bake.fgd.size, bake.phase.size, bake.thickness.size), (Some([32, 32]), Some(256), Some(128)));
}

#[test]
fn effects_need_two_layers() {
    let gold = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nsmooth = true\n";
    assert!(errors(&format!("{gold}[effects.flakes]\ncells = {{}}\n")).contains("needs a layer below"));
}

#[test]
fn a_trace_of_absorption_leaves_the_exterior_transparent() {
    let material = material("exterior = \"water\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 1\n");
    assert!(material.stack.exterior.samples().iter().all(|s| s.k == 0.0));
    assert!((material.stack.exterior.at(589.3).re - 1.33335).abs() < 1e-4);
}

#[test]
fn types_are_checked_with_the_key_named() {
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\n";
    assert!(errors(&format!("{coat}alpha = \"0.3\"\n")).contains("`alpha = 0.3`, without quotes"));
    assert!(errors(&format!("{coat}alpha = [1]\n")).contains("`alpha` must be a number, found an array"));
    assert!(errors(&format!("{coat}smooth = false\n")).contains("can only be true"));
    assert!(errors("[layer]\ntype = \"diffuse\"\nalbedo = 1\n").contains("[[layer]], with double brackets"));
    assert!(errors("layer = []\n").contains("there is no `layer`"));
    assert!(errors("layer = [1]\n").contains("must be a table"));
    assert!(errors("[[layer]]\nalbedo = 1\n").contains("does not say its `type`"));
    assert!(
        errors(&format!("{coat}smooth = true\n[bake]\nwavelengths_nm = [450, 550, 650]\n")).contains("must descend")
    );
    assert!(errors(&format!("{coat}smooth = true\n[bake.fresnel]\nsize = 1\n")).contains("`size = 2`"));
    assert!(errors(&format!("{coat}smooth = true\nrotation_deg = 3\n")).contains("anisotropic"));
}

#[test]
fn a_file_of_another_version_says_only_that() {
    let diagnostics = parse("x.toml", "schema = 2\nname = \"x\"\nfuture = 1\n", &read).unwrap_err();
    assert_eq!(diagnostics.len(), 1);
    assert_eq!(diagnostics[0].message, "`schema` must be 1, found 2");
}

/// A place of a surface has one normal and one factor on all roughnesses: maps of these belong to the first layer. Each other is refused where
/// it stands, and any layer has those of its own.
#[test]
fn maps_of_the_whole_surface_belong_to_the_first_layer() {
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\nthickness_um = 1\nabsorption_per_um = 1\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n";
    let maps = |names: &[&str]| {
        let named: Vec<String> = names.iter().map(|name| format!("{name} = \"{name}.png\"")).collect();
        format!("maps = {{ {} }}\n", named.join(", "))
    };
    material(&format!("{coat}{}{metal}", maps(&["normal", "roughness", "thickness"])));
    material(&format!("{coat}{coat}{}{metal}{}", maps(&["thickness", "alpha"]), maps(&["bumps", "alpha"])));
    let body = format!("{coat}{coat}{}{metal}{}", maps(&["thickness"]), maps(&["normal", "roughness"]));
    let found = parse("x.toml", &format!("schema = 1\nname = \"x\"\n{body}"), &read).unwrap_err();
    let places: Vec<(usize, String)> = found.iter().map(|d| (d.line, d.message.clone())).collect();
    let expected = [(20, "normal"), (20, "roughness")].map(|(line, name)| {
        (line, format!("a {name} map belongs to the first layer: it is that of the whole surface"))
    });
    assert_eq!(places, expected);
    assert!(found[1].hint.as_deref().is_some_and(|hint| hint.contains("move it to the first layer")), "{found:?}");
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.4\n\
                thickness_nm = { min = 10, max = 30, extent_um = 5, map = { noise = {} } }\n";
    material(&format!("{film}{coat}{metal}"));
    let found = errors(&format!("{coat}{film}{metal}"));
    assert!(
        found.contains("a film below the first layer varies in thickness on metals with an F0 alone")
            && found.contains("`thickness_nm = 20`"),
        "{found}"
    );
}

/// By hand: the slope parameter that an exponent n stands for is (2 / (n + 2))^(1/2), so that 30 and 6 are a ratio of 2.
#[test]
fn the_inner_lobe_is_as_wide_as_its_exponent_says() {
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.33\nthickness_nm = 300\n";
    let text = format!(
        "{film}[[layer]]\ntype = \"conductor\"\nior = \"au\"\nexponents = [30, 6]\n[bake]\nmodel = \"granier-heidrich\"\n"
    );
    assert_eq!(material(&text).beams().unwrap().inner_alpha_ratio, 2.0);
}

#[test]
fn texels_have_a_scale_of_one_at_most() {
    let paint = |scale: &str| {
        format!(
            "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\nmaps = {{ albedo = {{ image = \"a.png\", scale = {scale} }} }}\n"
        )
    };
    material(&paint("1"));
    material(&paint("0.5"));
    assert!(errors(&paint("1.5")).contains("`scale` must be at most 1, found 1.5"));
}
