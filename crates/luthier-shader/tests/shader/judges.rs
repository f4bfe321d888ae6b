//! Independent judges: the Khronos reference compiler and SPIR-V validator on everything that is emitted as GLSL.

use std::fs;
use std::process::{Command, Output};

use crate::scenes::{sets, tables};
use luthier_shader::{Form, MaterialSet, Target, complete};

/// Whether a program can be started. On a build server it must be.
fn is_installed(program: &str, package: &str) -> bool {
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

#[test]
fn khronos_tools_accept_complete_shaders() {
    if !is_installed("glslangValidator", "glslang-tools") {
        return;
    }
    let has_spirv_val = is_installed("spirv-val", "spirv-tools");
    let folder = tempfile::tempdir().unwrap();
    for (name, materials) in sets() {
        let set = MaterialSet { materials: &materials, tables: tables() };
        for form in Form::ALL {
            for target in [Target::Glsl450, Target::GlslEs300] {
                let what = format!("{name} {form} {target}");
                let source = complete(&set, form, target).unwrap();
                let path = folder.path().join("shader.frag");
                fs::write(&path, &source).unwrap();
                let parsed = Command::new("glslangValidator").args(["-S", "frag"]).arg(&path).output().unwrap();
                expect_success(&parsed, &what, &source);
                if target == Target::GlslEs300 {
                    continue;
                }
                for (client, environment) in [("-V", "vulkan1.1"), ("-G", "opengl4.5")] {
                    let spirv = folder.path().join("shader.spv");
                    let mut compile = Command::new("glslangValidator");
                    compile.args([client, "-S", "frag", "-o"]).arg(&spirv).arg(&path);
                    expect_success(&compile.output().unwrap(), &format!("{what} {client}"), &source);
                    if has_spirv_val {
                        let check =
                            Command::new("spirv-val").args(["--target-env", environment]).arg(&spirv).output().unwrap();
                        expect_success(&check, &format!("{what} {environment}"), &source);
                    }
                }
            }
        }
    }
}
