//! The figures of the papers, made anew.

mod claim;
mod course;
mod course_appearance;
mod course_cells;
mod course_fluorescent;
mod course_shader;
mod course_surfaces;
mod elek;
mod elek_examples;
mod elek_places;
mod figure;
mod granier;
mod lecture;
mod numbers;
mod page;
mod studio;
mod textured;
mod yamaguchi;
mod yamaguchi_balls;
mod yamaguchi_times;

use std::fmt::Write as _;

use luthier_terminal::{Bar, Failure, Outcome, files, print};
use luthier_texture::png;

use crate::cli::FiguresOptions;
use claim::Verdict;
use figure::{Content, Figure, Made, Measured};
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
        &yamaguchi_times::FIGURES,
        &lecture::FIGURES,
        &course::FIGURES,
        &course_shader::FIGURES,
        &course_appearance::FIGURES,
        &course_fluorescent::FIGURES,
        &course_surfaces::FIGURES,
        &course_cells::FIGURES,
        &textured::FIGURES,
    ]
    .concat()
}

/// Makes some figures or all, and the page about all that are in the folder.
pub(crate) fn run(options: &FiguresOptions) -> Outcome {
    let all = figures();
    if options.list {
        let lines: Vec<String> = all.iter().map(|f| format!("{:<18}{} ({})", f.name, f.title, f.source)).collect();
        return print(&lines.join("\n"));
    }
    let names: Vec<&str> = all.iter().map(|figure| figure.name).collect();
    if let Some(unknown) = options.names.iter().find(|name| !names.contains(&name.as_str())) {
        return Err(Failure::unknown("figure", unknown, &names));
    }
    let is_all = options.names.is_empty();
    let asked: Vec<&Figure> =
        all.iter().filter(|f| is_all || options.names.iter().any(|name| name == f.name)).collect();

    let folder = &options.output;
    std::fs::create_dir_all(folder).map_err(files(folder, "make"))?;
    let manifest = folder.join("figures.json");
    let old = page::read(&manifest)?;
    let mut studio = Studio::new(options);
    let bar = Bar::new("figures");
    let mut new: Vec<Done> = Vec::new();
    for &figure in &asked {
        studio.begin(options.size.unwrap_or(figure.size));
        let mut figured = Made::default();
        (figure.make)(&studio, &mut figured)?;
        let mut names = Vec::new();
        for (file, content) in figured.files {
            let path = folder.join(&file);
            let bytes = match content {
                Content::Picture(image) => png::encode_image(&image).map_err(Failure::input)?,
                Content::Plot(plot) => plot.to_svg().into_bytes(),
            };
            std::fs::write(&path, bytes).map_err(files(&path, "write"))?;
            names.push(file);
        }
        let command = page::command(options, figure.name);
        new.push(Done::new(figure, studio.size, studio.adapter_name(), command, names, figured.measured)?);
        bar.set(new.len() as u64, asked.len() as u64);
    }
    drop(bar);
    let (count, written) = (new.len(), new.iter().map(|done| done.files.len()).sum::<usize>());
    // Figures that an earlier run made, and this one did not, stay on the page.
    let mut made = new;
    for figure in all.iter().filter(|figure| !asked.iter().any(|asked| asked.name == figure.name)) {
        made.extend(old.as_ref().map(|old| page::kept(figure, old)).transpose()?.flatten());
    }
    made.sort_by_key(|done| all.iter().position(|figure| figure.name == done.figure.name));
    let text = format!("{:#}\n", page::json(&made));
    std::fs::write(&manifest, text).map_err(files(&manifest, "write"))?;
    let page = folder.with_extension("md");
    let text = page::markdown(options, &made);
    std::fs::write(&page, text).map_err(files(&page, "write"))?;
    let mut said = format!("{count} figures, {written} files in {}; page {}", folder.display(), page.display());
    for Done { figure, verdict, .. } in made.iter().filter(|done| !done.verdict.holds) {
        let _ = write!(said, "\n{} does not show what it must: {}", figure.name, verdict.because.join("; "));
    }
    print(&said)
}

/// A figure that was made, by this run or an earlier one.
struct Done<'a> {
    figure: &'a Figure,
    /// Side of each single picture.
    size: u32,
    /// The adapter that it was made on, where it needed one.
    adapter: Option<String>,
    /// The command line that makes it.
    command: String,
    files: Vec<String>,
    measured: Vec<Measured>,
    verdict: Verdict,
}

impl<'a> Done<'a> {
    fn new(
        figure: &'a Figure,
        size: u32,
        adapter: Option<String>,
        command: String,
        files: Vec<String>,
        measured: Vec<Measured>,
    ) -> Outcome<Self> {
        let verdict = figure.claim.verdict(figure.name, &measured)?;
        Ok(Self { figure, size, adapter, command, files, measured, verdict })
    }
}
