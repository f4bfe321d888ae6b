//! A process of its own for each family: the driver reads its environment once, when the Vulkan loader loads.

use std::ffi::OsString;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use crate::{Compiled, CostError, FOREIGN_VARIABLES, Family, Kernel, assembly, compile};

/// First word of the command line of a process that compiles.
const PROBE: &str = "cost-probe";

/// Word that asks for machine code in place of counts.
const ASSEMBLY: &str = "--assembly";

/// Exit code of a process that could not compile.
const DEVICE_FAILURE: u8 = 4;

/// Folders where drivers of Vulkan register themselves.
const DRIVER_FOLDERS: [&str; 4] =
    ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d"];

/// Answers as a probe: compiles the kernels of standard input and returns the exit code, if [`compile_apart`] or [`assembly_apart`] started this
/// process. Returns `None` in every other process. The `main` of a program that calls these two calls this first.
pub fn answer() -> Option<ExitCode> {
    let mut words = std::env::args_os().skip(1);
    if words.next()? != PROBE {
        return None;
    }
    let words: Vec<String> = words.map(|word| word.to_string_lossy().into_owned()).collect();
    Some(match reply(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // A closed standard error leaves the exit code alone to tell.
            let _ = writeln!(io::stderr().lock(), "error: {error}");
            ExitCode::from(DEVICE_FAILURE)
        }
    })
}

fn reply(words: &[String]) -> Result<(), CostError> {
    let (family, wants_assembly) = match words {
        [family] => (family, false),
        [family, word] if word == ASSEMBLY => (family, true),
        _ => return Err(CostError::Probe(format!("`{PROBE}` is for this program's own use"))),
    };
    let family: Family = family.parse()?;
    let kernels: Vec<Kernel> = serde_json::from_reader(io::stdin().lock())?;
    let text = if wants_assembly {
        kernels.iter().map(assembly).collect::<Result<Vec<String>, _>>()?.join("\n")
    } else {
        serde_json::to_string(&compile(family, &kernels)?)?
    };
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(failed_to("answer"))
}

/// The error of a step with the probe that the system refuses.
fn failed_to(action: &'static str) -> impl FnOnce(io::Error) -> CostError {
    move |source| CostError::Process { action, source }
}

/// [`compile`] in a process of its own: this program, started anew. Its `main` has to call [`answer`] first.
///
/// # Errors
/// Those of [`compile`], and [`CostError::Process`] or [`CostError::Probe`] if the process cannot be started or does not answer.
pub fn compile_apart(family: Family, kernels: &[Kernel]) -> Result<Compiled, CostError> {
    let compiled: Compiled = serde_json::from_str(&ask(family, &[], kernels)?)?;
    if compiled.counts.len() != kernels.len() {
        return Err(CostError::Probe(format!("{} counts came for {} kernels", compiled.counts.len(), kernels.len())));
    }
    Ok(compiled)
}

/// [`assembly`] in a process of its own, as [`compile_apart`].
///
/// # Errors
/// As [`compile_apart`].
pub fn assembly_apart(family: Family, kernel: &Kernel) -> Result<String, CostError> {
    ask(family, &[ASSEMBLY], std::slice::from_ref(kernel))
}

/// Standard output of this program as the probe of a family.
fn ask(family: Family, words: &[&str], kernels: &[Kernel]) -> Result<String, CostError> {
    let program = std::env::current_exe().map_err(failed_to("find this program"))?;
    let mut command = Command::new(program);
    command.args([PROBE, family.name()]).args(words).envs(family.environment());
    for variable in FOREIGN_VARIABLES {
        command.env_remove(variable);
    }
    if let Some(drivers) = drivers() {
        command.env("VK_DRIVER_FILES", &drivers).env("VK_ICD_FILENAMES", &drivers);
    }
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(failed_to("start the probe"))?;
    let input = serde_json::to_vec(kernels)?;
    if let Some(mut stdin) = child.stdin.take() {
        // A probe that ended early reports the reason on standard error, which is read below.
        let _ = stdin.write_all(&input);
    }
    let output = child.wait_with_output().map_err(failed_to("wait for the probe"))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(CostError::Probe(match said.lines().find_map(|line| line.strip_prefix("error: ")) {
        Some(error) => error.to_owned(),
        None => format!("the probe of {family} ended with {}: {said}", output.status),
    }))
}

/// Paths of the descriptions of RADV, so that the loader loads no other driver. `None` if the user's own variables choose drivers, or if none is
/// found.
fn drivers() -> Option<OsString> {
    if ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].iter().any(|name| std::env::var_os(name).is_some()) {
        return None;
    }
    let mut found = Vec::new();
    for folder in DRIVER_FOLDERS {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut here: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| is_radv(path)).collect();
        here.sort();
        found.extend(here);
    }
    if found.is_empty() { None } else { std::env::join_paths(found).ok() }
}

/// Whether a file is by its name a description of RADV.
fn is_radv(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with("radeon_icd") && name.ends_with(".json")
}
