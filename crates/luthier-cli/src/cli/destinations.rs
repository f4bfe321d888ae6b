//! Places that a command line names for what is written, looked at before any work.

use std::path::Path;

use luthier_terminal::{Failure, Outcome, STDOUT};

use super::{Function, TableOptions, Verb};

impl Verb {
    /// Refuses a folder in the place of a file, a file in that of a folder, and `-` where nothing goes to standard output.
    ///
    /// # Errors
    /// [`Failure::Files`], [`Failure::Usage`] for `-`.
    pub(crate) fn refuse_destinations(&self) -> Outcome {
        match self {
            Self::Bake(options) | Self::Merge(options) => {
                folder("--out", &options.out)?;
                options.pipeline.depfile.as_deref().map_or(Ok(()), |path| file("--depfile", path))
            }
            Self::Report(options) => baked(&options.out),
            Self::Eval(options) => options.out.as_deref().map_or(Ok(()), baked),
            Self::Table(options) => table(options),
            #[cfg(feature = "gpu")]
            Self::Preview(options) => file("--output", &options.output),
            Self::Gallery(options) => {
                #[cfg(feature = "gpu")]
                options.output.as_deref().map_or(Ok(()), |path| file("--output", path))?;
                text("--html", options.html.as_deref())
            }
            #[cfg(feature = "gpu")]
            Self::Compare(options) => folder("--output", &options.output),
            #[cfg(feature = "gpu")]
            Self::Bench(options) => text("--output", options.output.as_deref()),
            #[cfg(feature = "cost")]
            Self::Cost(options) => text("--output", options.output.as_deref()),
            #[cfg(feature = "view")]
            Self::View(options) => options.screenshot.as_deref().map_or(Ok(()), |path| file("--screenshot", path)),
            Self::Shader(options) => text("--output", options.output.as_deref()),
            Self::New(options) => text("--output", options.output.as_deref()),
            Self::Environment(options) => folder("--out", &options.out),
            Self::Import(options) => folder("--output", &options.output),
            Self::Export(options) => options.output.as_deref().map_or(Ok(()), |path| folder("--output", path)),
            Self::Fit(options) => text("--output", options.output.as_deref()),
            Self::Man(options) => options.out.as_deref().map_or(Ok(()), |path| folder("--out", path)),
            Self::Cache(_)
            | Self::Check(_)
            | Self::Audit(_)
            | Self::Models(_)
            | Self::Ior(_)
            | Self::Schema { .. }
            | Self::Completions(_) => Ok(()),
        }
    }
}

fn table(options: &TableOptions) -> Outcome {
    let (delivery, is_folder) = match &options.function {
        Function::Dfg(options) => (&options.delivery, false),
        Function::Cloth(options) => (&options.delivery, false),
        Function::Energy(options) => (&options.delivery, options.preset.is_some()),
        Function::Film(options) => (&options.delivery, false),
        Function::Fresnel(options) => (&options.delivery, false),
        Function::Ltc(options) => (&options.delivery, true),
        Function::Sheen(options) => (&options.delivery, false),
    };
    let check = if is_folder { folder } else { file };
    check("--output", &delivery.output)?;
    delivery.report.as_deref().map_or(Ok(()), |path| file("--report", path))
}

/// A file, or standard output.
fn text(option: &str, path: Option<&Path>) -> Outcome {
    path.filter(|path| *path != Path::new(STDOUT)).map_or(Ok(()), |path| file(option, path))
}

fn file(option: &str, path: &Path) -> Outcome {
    refuse_stdout(option, path, "file")?;
    let text = format!("cannot write {}: it is a folder\nhint: {option} names a file here", path.display());
    if path.is_dir() { Err(Failure::Files(anyhow::anyhow!(text))) } else { Ok(()) }
}

fn folder(option: &str, path: &Path) -> Outcome {
    refuse_stdout(option, path, "folder")?;
    refuse_file(path, "cannot make the folder", "a file is in its place", &format!("{option} names a folder here"))
}

/// The folder of a bake that is read.
fn baked(path: &Path) -> Outcome {
    refuse_file(path, "cannot read", "it is a file", "--out names the folder of a bake here")
}

fn refuse_file(path: &Path, action: &str, why: &str, hint: &str) -> Outcome {
    let text = format!("{action} {}: {why}\nhint: {hint}", path.display());
    if path.is_file() { Err(Failure::Files(anyhow::anyhow!(text))) } else { Ok(()) }
}

fn refuse_stdout(option: &str, path: &Path, what: &str) -> Outcome {
    let text = format!(
        "{option} names a {what}, and `-` is none: nothing but words goes to standard output here\nhint: for a {what} of that name write ./-"
    );
    if path == Path::new(STDOUT) { Err(Failure::Usage(anyhow::anyhow!(text))) } else { Ok(()) }
}
