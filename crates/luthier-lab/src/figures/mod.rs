//! The figures of the papers, made anew.

mod course;
mod course_appearance;
mod course_fluorescent;
mod course_shader;
mod course_surfaces;
mod elek;
mod elek_examples;
mod elek_places;
mod figure;
mod granier;
mod lecture;
mod page;
mod studio;
mod textured;
mod yamaguchi;
mod yamaguchi_balls;

use luthier_terminal::{Bar, Failure, Outcome, files, print};
use luthier_texture::png;

use crate::cli::FiguresOptions;
use figure::{Content, Figure, Made};
use studio::Studio;

/// All figures, in the order of the page.
fn figures() -> Vec<Figure> {
    [
        elek::FIGURES.as_slice(),
        &elek_places::FIGURES,
        &elek_examples::FIGURES,
        &granier::FIGURES,
        &yamaguchi::FIGURES,
        &yamaguchi_balls::FIGURES,
        &lecture::FIGURES,
        &course::FIGURES,
        &course_shader::FIGURES,
        &course_appearance::FIGURES,
        &course_fluorescent::FIGURES,
        &course_surfaces::FIGURES,
        &textured::FIGURES,
    ]
    .concat()
}

/// Makes some figures or all, and the page about them.
pub(crate) fn run(options: &FiguresOptions) -> Outcome {
    let all = figures();
    if options.list {
        let lines: Vec<String> = all.iter().map(|f| format!("{:<16}{} ({})", f.name, f.title, f.source)).collect();
        return print(&lines.join("\n"));
    }
    let names: Vec<&str> = all.iter().map(|figure| figure.name).collect();
    if let Some(unknown) = options.names.iter().find(|name| !names.contains(&name.as_str())) {
        return Err(Failure::unknown("figure", unknown, &names));
    }
    let is_asked = |figure: &&Figure| options.names.is_empty() || options.names.iter().any(|name| name == figure.name);
    let asked: Vec<&Figure> = all.iter().filter(is_asked).collect();

    let folder = &options.output;
    std::fs::create_dir_all(folder).map_err(files(folder, "make"))?;
    let studio = Studio::new(options);
    let bar = Bar::new("figures");
    let mut made: Vec<(&Figure, Made)> = Vec::new();
    for figure in asked {
        let new = (figure.make)(&studio)?;
        for (file, content) in &new.files {
            let path = folder.join(file);
            let bytes = match content {
                Content::Picture(image) => png::encode_image(image).map_err(Failure::input)?,
                Content::Plot(plot) => plot.to_svg().into_bytes(),
            };
            std::fs::write(&path, bytes).map_err(files(&path, "write"))?;
        }
        made.push((figure, new));
        bar.set(made.len() as u64, names.len() as u64);
    }
    let manifest = folder.join("figures.json");
    let text = format!("{:#}\n", page::json(options, &studio, &made));
    std::fs::write(&manifest, text).map_err(files(&manifest, "write"))?;
    let page = folder.with_extension("md");
    std::fs::write(&page, page::markdown(options, &studio, &made)).map_err(files(&page, "write"))?;
    let count: usize = made.iter().map(|(_, made)| made.files.len()).sum();
    print(&format!("{} figures, {count} files in {}; page {}", made.len(), folder.display(), page.display()))
}
