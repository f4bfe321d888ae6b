//! Independent judges: the Khronos reference compiler on GLSL and HLSL, the Khronos validator and linker on SPIR-V, Tint on
//! WGSL. Nothing here can judge MSL.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;

use luthier_manifest::FunctionGroup;
use luthier_shader::{Form, MaterialSet, Target, bindings, complete, complete_spirv, emit_spirv};
use tempfile::TempDir;

use crate::examples;
use crate::scenes::{Part, clear, conductor, forms, material, sets, stepped_tables, tables, text};

/// Environment that SPIR-V emitted here is for.
const VULKAN: &str = "vulkan1.1";

/// Whether a program can be started. On a build server it must be.
pub(crate) fn is_installed(program: &str, package: &str) -> bool {
    if Command::new(program).arg("--version").output().is_ok() {
        return true;
    }
    assert!(std::env::var_os("CI").is_none(), "`{program}` is missing: install the package {package}");
    eprintln!("skipped: `{program}` is not installed (Debian package {package})");
    false
}

fn expect_success(output: &Output, what: &str, source: &str) {
    let (stdout, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{what}:\n{stdout}{stderr}\n{source}");
}

/// A set of materials with functions, in a form, for a judge to work on in a folder.
struct Case<'c> {
    name: &'static str,
    set: MaterialSet<'c>,
    form: Form,
    folder: &'c Path,
}

impl Case<'_> {
    fn complete(&self, target: Target) -> Arc<str> {
        text((self.name, &self.set), self.form, target, Part::Complete)
    }

    fn what(&self) -> String {
        format!("{} {} {:?}", self.name, self.form, self.set.functions)
    }
}

/// Judges that start programs for each case take turns with every change: each case is for one of them, and for all of them at night.
const TURNS: usize = 4;

/// Every set of materials in both forms, with `luthier_eval` alone and with all functions; of [`TURNS`] only the given one, if any.
fn each(turn: Option<usize>, mut judge: impl FnMut(&Case<'_>)) {
    let folder = TempDir::new().unwrap();
    let mut count = 0;
    for (name, materials) in sets() {
        let of = |functions: &[FunctionGroup]| {
            let functions = functions.iter().copied().collect();
            MaterialSet { functions, ..MaterialSet::new(&materials, tables()) }
        };
        let (whole, plain, lit) = (of(&FunctionGroup::ALL), of(&[]), of(&[FunctionGroup::Environment]));
        let has_light = bindings(&lit, Form::Baked).iter().any(|entry| entry.name == "luthier_environment_map");
        let stepped = MaterialSet { tables: stepped_tables(), ..plain.clone() };
        let has_rows = bindings(&plain, Form::Baked).iter().any(|entry| entry.name == "luthier_lobes");
        let cases = forms(&materials).flat_map(|form| [(form, &whole), (form, &plain)]);
        let cases = cases.chain(has_light.then_some((Form::Baked, &lit)));
        for (form, set) in cases.chain(has_rows.then_some((Form::Baked, &stepped))) {
            if turn.is_none_or(|turn| count % TURNS == turn) {
                judge(&Case { name, set: set.clone(), form, folder: folder.path() });
            }
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

/// Compiles with glslang into `shader.spv` of the folder.
pub(crate) fn compile(text: &str, folder: &Path, what: &str, options: &[&str]) -> PathBuf {
    let (source, module) = (folder.join("shader.txt"), folder.join("shader.spv"));
    fs::write(&source, text).unwrap();
    let mut command = Command::new("glslangValidator");
    let output = command.args(options).args(["-S", "frag", "-o"]).arg(&module).arg(&source).output().unwrap();
    expect_success(&output, what, text);
    module
}

/// Has spirv-val judge a module.
pub(crate) fn validate_spirv(module: &Path, environment: &str, what: &str, source: &str) {
    let output = Command::new("spirv-val").args(["--target-env", environment]).arg(module).output().unwrap();
    expect_success(&output, &format!("{what} {environment}"), source);
}

#[test]
fn khronos_tools_accept_complete_glsl() {
    if has_khronos_tools() {
        each(Some(0), accept_complete_glsl);
    }
}

#[test]
#[ignore = "minutes: scripts/nightly.sh tests"]
fn khronos_tools_accept_all() {
    assert!(has_khronos_tools());
    let judges = [accept_complete_glsl, accept_complete_hlsl, accept_complete_spirv, accept_linked_spirv];
    for judge in judges {
        each(None, judge);
    }
}

fn has_khronos_tools() -> bool {
    is_installed("glslangValidator", "glslang-tools") && is_installed("spirv-val", "spirv-tools")
}

fn accept_complete_glsl(case: &Case<'_>) {
    let text = case.complete(Target::Glsl450);
    for (client, environment) in [("-V", VULKAN), ("-G", "opengl4.5")] {
        let module = compile(&text, case.folder, &case.what(), &[client]);
        validate_spirv(&module, environment, &case.what(), &text);
    }
    accept_glsl_es(&case.what(), &case.complete(Target::GlslEs300), case.folder);
}

/// Has glslang read a fragment shader. GLSL ES 3.00 has no locations for what the vertex shader hands over, so it makes no SPIR-V.
pub(crate) fn accept_glsl_es(what: &str, text: &str, folder: &Path) {
    let source = folder.join("shader.frag");
    fs::write(&source, text).unwrap();
    expect_success(&Command::new("glslangValidator").arg(&source).output().unwrap(), what, text);
}

#[test]
fn khronos_tools_accept_the_glsl_of_the_examples() {
    if !is_installed("glslangValidator", "glslang-tools") {
        return;
    }
    let folder = TempDir::new().unwrap();
    for (what, text) in examples::composed(Target::GlslEs300) {
        accept_glsl_es(&what, &text, folder.path());
    }
}

/// More than a uniform block holds, and more than a row of texels.
#[test]
fn khronos_tools_accept_glsl_of_many_materials() {
    if !is_installed("glslangValidator", "glslang-tools") {
        return;
    }
    let folder = TempDir::new().unwrap();
    for count in [33, 63, 1000] {
        let materials: Vec<_> = (0..count).map(|i| material(&format!("m-{i}"), &[clear(), conductor()])).collect();
        for form in Form::ALL {
            let text = complete(&MaterialSet::new(&materials, tables()), form, Target::GlslEs300).unwrap();
            accept_glsl_es(&format!("{count} materials, {form}"), &text, folder.path());
        }
    }
}

#[test]
fn khronos_tools_accept_complete_hlsl() {
    if has_khronos_tools() {
        each(Some(1), accept_complete_hlsl);
    }
}

fn accept_complete_hlsl(case: &Case<'_>) {
    let text = case.complete(Target::Hlsl);
    let module = compile(&text, case.folder, &case.what(), &["-D", "-V", "-e", "main"]);
    validate_spirv(&module, VULKAN, &case.what(), &text);
}

#[test]
fn khronos_tools_accept_spirv() {
    if is_installed("spirv-val", "spirv-tools") {
        each(Some(2), accept_complete_spirv);
    }
}

fn accept_complete_spirv(case: &Case<'_>) {
    let module = case.folder.join("module.spv");
    fs::write(&module, complete_spirv(&case.set, case.form).unwrap()).unwrap();
    validate_spirv(&module, VULKAN, &case.what(), "");
    fs::write(&module, emit_spirv(&case.set, case.form).unwrap()).unwrap();
    // No Vulkan environment has libraries.
    validate_spirv(&module, "spv1.3", &case.what(), "");
}

/// A shader made elsewhere, which imports `luthier_eval`, links with the library to one that Vulkan takes.
#[test]
fn a_shader_links_with_the_spirv_library() {
    if is_installed("spirv-link", "spirv-tools") {
        each(Some(3), accept_linked_spirv);
    }
}

fn accept_linked_spirv(case: &Case<'_>) {
    let path = |name: &str| case.folder.join(name);
    fs::write(path("user.spvasm"), include_str!("user.spvasm")).unwrap();
    fs::write(path("library.spv"), emit_spirv(&case.set, case.form).unwrap()).unwrap();
    let mut assemble = Command::new("spirv-as");
    assemble.args(["--target-env", "spv1.3", "-o"]).args([path("user.spv"), path("user.spvasm")]);
    expect_success(&assemble.output().unwrap(), &case.what(), "");
    let mut link = Command::new("spirv-link");
    link.args(["--target-env", "spv1.3", "-o"]).args([path("linked.spv"), path("user.spv"), path("library.spv")]);
    expect_success(&link.output().unwrap(), &case.what(), "");
    validate_spirv(&path("linked.spv"), VULKAN, &case.what(), "");
}

/// The script that has Tint compile files; `None` where it cannot run. On a build server it must.
fn tint() -> Option<PathBuf> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts/tint/validate.mjs");
    if script.with_file_name("node_modules").exists() && is_installed("node", "nodejs") {
        return Some(script);
    }
    let hint = "Tint is missing: run `npm install --prefix scripts/tint` (Debian packages nodejs, npm)";
    assert!(std::env::var_os("CI").is_none(), "{hint}");
    eprintln!("skipped: {hint}");
    None
}

#[test]
fn tint_accepts_wgsl() {
    let mut texts = Vec::new();
    each(None, |case| {
        for part in [Part::Snippet, Part::Complete] {
            let text = text((case.name, &case.set), case.form, Target::Wgsl, part);
            texts.push((format!("{} {part:?}", case.what()), text.to_string()));
        }
    });
    accept_wgsl(&texts);
}

#[test]
fn tint_accepts_the_wgsl_of_the_examples() {
    accept_wgsl(&examples::composed(Target::Wgsl));
}

/// Has Tint compile texts, each with a name.
fn accept_wgsl(texts: &[(String, String)]) {
    let Some(script) = tint() else { return };
    let folder = TempDir::new().unwrap();
    let mut files = Vec::new();
    for (what, text) in texts {
        let file = folder.path().join(format!("{}.wgsl", what.replace('/', "-")));
        fs::write(&file, text).unwrap();
        files.push(file);
    }
    let output = Command::new("node").arg(&script).args(&files).output().unwrap();
    expect_success(&output, "tint", "");
    let verdict = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(verdict.ends_with(&format!("tint: {} passed, 0 failed\n", files.len())), "{verdict}");
}

/// The judges can say no: each finds a fault in a text that is nearly right.
#[test]
fn judges_find_a_fault() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("shader.wgsl");
    let materials = sets().pop().unwrap().1;
    let faulty = |target| {
        complete(&MaterialSet::new(&materials, tables()), Form::Baked, target).unwrap().replacen("sqrt(", "sqrd(", 1)
    };
    if let Some(script) = tint() {
        fs::write(&file, faulty(Target::Wgsl)).unwrap();
        assert_eq!(Command::new("node").arg(&script).arg(&file).output().unwrap().status.code(), Some(1));
    }
    if is_installed("glslangValidator", "glslang-tools") {
        for (target, options) in [(Target::Glsl450, ["-V", "-g"]), (Target::Hlsl, ["-D", "-V"])] {
            fs::write(&file, faulty(target)).unwrap();
            let mut command = Command::new("glslangValidator");
            command.current_dir(folder.path()).args(options).args(["-S", "frag", "-e", "main"]).arg(&file);
            assert!(!command.output().unwrap().status.success(), "{target}");
        }
    }
    if is_installed("spirv-val", "spirv-tools") {
        let mut module = complete_spirv(&MaterialSet::new(&materials, tables()), Form::Baked).unwrap();
        module.truncate(module.len() - 4);
        fs::write(&file, module).unwrap();
        assert!(!Command::new("spirv-val").arg(&file).output().unwrap().status.success());
    }
}
