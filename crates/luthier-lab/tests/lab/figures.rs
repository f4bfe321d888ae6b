//! `figures`.

use crate::workshop::Workshop;

/// The figures that the project promises, one by one.
const NAMES: [&str; 40] = [
    "elek-2",
    "elek-4",
    "elek-5",
    "elek-7",
    "elek-8",
    "elek-3",
    "elek-9",
    "elek-10",
    "granier-3",
    "granier-4",
    "granier-5",
    "granier-6",
    "granier-7",
    "yamaguchi-4",
    "yamaguchi-1",
    "yamaguchi-3",
    "yamaguchi-5",
    "lecture-25",
    "course-classes",
    "course-varnish",
    "course-3-3",
    "course-3-5",
    "course-3-6",
    "course-3-7",
    "course-3-8",
    "course-3-9",
    "course-4-1",
    "course-5-7",
    "course-5-6",
    "course-phong",
    "course-glow-paint",
    "course-5-1",
    "course-5-2",
    "course-5-3",
    "course-5-1-cells",
    "elek-6",
    "elek-line-22",
    "lecture-metal",
    "yamaguchi-2",
    "course-3-9-own",
];

/// The smallest picture, and more values of a channel than a plain picture has.
const SIDE: u32 = 16;

#[test]
fn all_are_listed() {
    let text = Workshop::new().run(&["figures", "--list"]).exits(0).stdout;
    let names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(names, NAMES);
    // Each names its place in a paper; the lecture has an exercise in the place of figures.
    assert!(text.lines().all(|line| line.contains("figure") || line.contains("exercise")), "{text}");
}

#[test]
fn an_unknown_name_is_refused_before_anything_is_written() {
    let workshop = Workshop::new();
    workshop.run(&["figures", "elek-66", "-o", "seen"]).fails(2, &["`elek-66`", "did you mean `elek-", "yamaguchi-4"]);
    assert!(!workshop.path("seen").exists());
}

#[test]
fn a_simulated_figure_is_made_the_same_twice() {
    let workshop = Workshop::new();
    let make = |folder: &str| {
        let size = SIDE.to_string();
        workshop.run(&["figures", "yamaguchi-4", "-o", folder, "--size", &size, "--paths", "8"])
    };
    let first = make("a");
    if first.lacks_adapter() {
        return;
    }
    first.exits(0);
    make("b").exits(0);
    assert_eq!(workshop.files("a"), ["figures.json", "yamaguchi-4.png"]);
    assert_eq!(workshop.tree("a").get("yamaguchi-4.png"), workshop.tree("b").get("yamaguchi-4.png"));

    let picture = image::open(workshop.path("a").join("yamaguchi-4.png")).unwrap().to_rgb8();
    // Three rows of five: 8 pixels between pictures, 16 for a line of text.
    assert_eq!((picture.width(), picture.height()), (5 * (SIDE + 8) + 8, 3 * (SIDE + 24) + 8));
    for (column, row) in [(0, 0), (1, 1), (2, 2), (3, 1)] {
        let [left, top] = [8 + column * (SIDE + 8), 8 + row * (SIDE + 24)];
        let reds = (0..SIDE * SIDE).map(|i| picture.get_pixel(left + i % SIDE, top + i / SIDE)[0]);
        let distinct: std::collections::BTreeSet<u8> = reds.collect();
        assert!(distinct.len() > 8, "picture {column}, {row}: {distinct:?}");
    }

    let manifest = workshop.json("a/figures.json");
    let figure = &manifest["figures"][0];
    assert_eq!(figure["name"], "yamaguchi-4");
    assert_eq!(figure["command"], "luthier-lab figures yamaguchi-4 -o a --size 16 --paths 8");
    let measured = figure["measured"].as_array().unwrap();
    let rmse = measured.iter().find(|m| m["what"] == "a isotropic, yamaguchi against simulation: RMSE").unwrap();
    let value = rmse["value"].as_f64().unwrap();
    assert!(value > 0.0 && value < 0.5, "{value}");
    let page = workshop.text("a.md");
    assert!(page.contains("![statistical layering against simulation](a/yamaguchi-4.png)"), "{page}");
}

/// A run for one figure leaves those of earlier runs on the page, each with its verdict.
#[test]
fn figures_of_earlier_runs_stay_on_the_page() {
    let workshop = Workshop::new();
    for names in [["yamaguchi-5", "--size", "32"], ["yamaguchi-3", "--size", "32"]] {
        let args = [["figures", "-o", "seen"], names].concat();
        workshop.run(&args).exits(0);
    }
    let manifest = workshop.json("seen/figures.json");
    let figures = manifest["figures"].as_array().unwrap();
    let names: Vec<&str> = figures.iter().map(|figure| figure["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["yamaguchi-3", "yamaguchi-5"]);
    for figure in figures {
        assert!(figure["must_show"].as_str().unwrap().ends_with('.'), "{figure}");
        assert_eq!(figure["shows"], true, "{figure}");
        assert!(!figure["because"].as_array().unwrap().is_empty(), "{figure}");
    }
    let page = workshop.text("seen.md");
    for text in [
        "seen/yamaguchi-3.png",
        "seen/yamaguchi-5.svg",
        "seen/yamaguchi-5-more.svg",
        "2 of 2 figures show what they must",
        "*Must show:*",
    ] {
        assert!(page.contains(text), "{text}: {page}");
    }

    // A number that a claim is about is gone: the figure is named.
    let text = workshop.text("seen/figures.json").replace("BRDF over normals: standard deviation along x\"", "gone\"");
    workshop.write("seen/figures.json", &text);
    workshop.run(&["figures", "yamaguchi-5", "-o", "seen"]).fails(1, &["yamaguchi-3", "make the figure anew"]);
}

#[test]
fn shaders_make_pictures_of_the_size_asked_for() {
    let workshop = Workshop::new();
    let run = workshop.run(&["figures", "granier-4", "-o", "seen", "--size", "24", "--samples", "1"]);
    if run.lacks_adapter() {
        return;
    }
    run.exits(0);
    let picture = image::open(workshop.path("seen").join("granier-4.png")).unwrap().to_rgb8();
    assert_eq!((picture.width(), picture.height()), (4 * 32 + 8, 48 + 8));
    // An inner boundary that leans shows other colours than one that does not.
    let at = |column: u32| -> Vec<[u8; 3]> {
        (0..24 * 24).map(|i| picture.get_pixel(8 + column * 32 + i % 24, 8 + i / 24).0).collect()
    };
    assert!(at(0) != at(1) && at(1) != at(2));
}
