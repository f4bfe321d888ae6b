//! `new`: a material file to begin with.

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use luthier_material::Template;
use luthier_terminal::{Failure, Outcome, STDOUT, files, print};

use crate::cli::NewOptions;

/// Writes a template under a name, or lists all.
pub(crate) fn run(options: &NewOptions) -> Outcome {
    let Some(name) = &options.name else { return print(&list()) };
    let (templates, wanted) = match &options.preset {
        Some(preset) => (Template::PRESETS, preset),
        None => (Template::CLASSES, &options.class),
    };
    let known: Vec<&str> = templates.iter().map(|template| template.name).collect();
    let template = templates.iter().find(|template| template.name == wanted);
    let template = template.ok_or_else(|| Failure::unknown("template", wanted, &known))?;
    let text = template.called(name).map_err(|mistake| {
        let text = format!("a material cannot be called `{name}`: {}\nhint: --output names the file", mistake.message);
        Failure::Usage(anyhow::anyhow!(text))
    })?;
    let path = options.output.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.toml")));
    if path == Path::new(STDOUT) {
        return print(&text);
    }
    write(&path, &text)?;
    let shown = path.display();
    let next = if cfg!(feature = "gpu") {
        format!("luthier preview {shown} -o {name}.png")
    } else {
        format!("luthier bake {shown}")
    };
    print(&format!("wrote {shown}: {}\nnext: {next}\n", template.description()))
}

/// Writes a file where none is.
fn write(path: &Path, text: &str) -> Outcome {
    let mut file = File::create_new(path).map_err(|source| match source.kind() {
        ErrorKind::AlreadyExists => Failure::Usage(anyhow::anyhow!(
            "{} is there already: choose another name, or another file with --output; nothing was written",
            path.display()
        )),
        _ => files(path, "write")(source),
    })?;
    file.write_all(text.as_bytes()).map_err(files(path, "write"))
}

fn list() -> String {
    let rows = |templates: &[Template]| {
        templates.iter().map(|t| format!("  {:<18} {}\n", t.name, t.description())).collect::<String>()
    };
    format!(
        "classes of surfaces: luthier new NAME --class CLASS\n{}\nreal substances: luthier new NAME --preset PRESET\n{}",
        rows(Template::CLASSES),
        rows(Template::PRESETS)
    )
}
