//! `new`: files to begin with.

use luthier_material::Template;

use crate::workshop::Workshop;

fn all() -> impl Iterator<Item = (&'static str, &'static Template)> {
    let classes = Template::CLASSES.iter().map(|template| ("--class", template));
    classes.chain(Template::PRESETS.iter().map(|template| ("--preset", template)))
}

/// Each file that can be begun with is valid without a warning, and bakes with the model that it gets by itself.
#[test]
fn every_template_bakes() {
    let workshop = Workshop::new();
    for (option, template) in all() {
        let file = format!("m/{}.toml", template.name);
        workshop.write("m/README", "");
        let name = format!("my-{}", template.name);
        let said = workshop.run(&["new", &name, option, template.name, "-o", &file]).exits(0).stdout;
        assert!(said.starts_with(&format!("wrote {file}: {}\nnext: luthier ", template.description())), "{said}");
        assert!(workshop.text(&file).contains(&format!("\nname = \"{name}\"\n")), "{file}");
    }
    let checked = workshop.run(&["check", "m"]).exits(0);
    assert_eq!(checked.stderr, "");
    assert_eq!(checked.stdout.lines().count(), all().count(), "{}", checked.stdout);
    let made = workshop.run(&["bake", "m", "--form", "baked", "--target", "wgsl", "--json"]).exits(0);
    assert_eq!(made.stderr, "");
    let materials = workshop.json("out/manifest.json")["materials"].as_array().unwrap().len();
    assert_eq!(materials, all().count());
}

#[test]
fn a_name_alone_is_a_glossy_paint() {
    let workshop = Workshop::new();
    let said = workshop.run(&["new", "mug"]).exits(0).stdout;
    assert!(said.starts_with("wrote mug.toml: "), "{said}");
    let text = workshop.text("mug.toml");
    assert_eq!(text, Template::CLASSES[0].called("mug").unwrap());
    assert_eq!(workshop.run(&["new", "mug", "-o", "-"]).exits(0).stdout, text);
    assert_eq!(workshop.run(&["new", "mug", "--class", "glossy-paint", "-o", "-"]).exits(0).stdout, text);
}

#[test]
fn nothing_is_replaced() {
    let workshop = Workshop::with(&[("mug.toml", "mine")]);
    for words in [&["new", "mug"][..], &["new", "other", "--preset", "gold", "-o", "mug.toml"]] {
        workshop.run(words).fails(2, &["mug.toml is there already", "nothing was written"]);
    }
    assert_eq!((workshop.text("mug.toml").as_str(), workshop.files("")), ("mine", vec!["mug.toml".to_owned()]));
    workshop.run(&["new", "mug", "-o", "none/mug.toml"]).fails(3, &["none/mug.toml"]);
}

#[test]
fn wrong_names_are_refused() {
    let workshop = Workshop::new();
    for name in ["my mug", "mug.toml", "a/b", "", "\"x"] {
        workshop.run(&["new", name]).fails(2, &["cannot be called", "letters, digits and hyphens"]);
    }
    workshop.run(&["new", "mug", "--class", "glosy-paint"]).fails(2, &["glosy-paint"]).says(&["'glossy-paint'"]);
    workshop.run(&["new", "ring", "--preset", "unobtainium"]).fails(2, &["unobtainium"]).says(&["gold", "zinc"]);
    workshop.run(&["new", "ring", "--class", "matte", "--preset", "gold"]).fails(2, &["--preset"]);
    workshop.run(&["new", "--preset", "gold"]).fails(2, &["required"]);
    assert!(workshop.files("").is_empty());
}

#[test]
fn the_list_has_every_template() {
    let list = Workshop::new().run(&["new"]).exits(0).stdout;
    for (_, template) in all() {
        let line = list.lines().find(|line| line.trim_start().starts_with(&format!("{} ", template.name)));
        assert!(line.is_some_and(|line| line.ends_with(template.description())), "{}", template.name);
    }
}
