//! Machines without a graphics driver.

use std::process::Command;

use luthier_workshop::Program as _;
use luthier_workshop::material_texts::matte;

use crate::workshop::{Luthier, Workshop};

/// Each verb that wants a driver ends with 4 and one line, which says what to install; nothing is written.
#[test]
fn a_missing_driver_is_one_line() {
    let workshop = Workshop::with(&[("m.toml", &matte("m"))]);
    workshop.run(&["bake", "m.toml", "--out", "out"]).exits(0);
    let before = workshop.files("");
    for words in [
        &["preview", "m.toml", "-o", "m.png"][..],
        &["preview", "m.toml", "-o", "m.png", "--simulated", "16"],
        &["gallery", "m.toml", "-o", "m.png"],
        &["gallery", "m.toml", "--html", "m.html", "--simulated", "16"],
        &["compare", "m.toml", "-o", "compared"],
        &["bench", "m.toml"],
        &["report", "--out", "out"],
    ] {
        let mut command = Command::new(Luthier::PATH);
        // Neither Vulkan nor EGL finds a driver.
        for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "__EGL_VENDOR_LIBRARY_FILENAMES"] {
            command.env(name, workshop.path("none"));
        }
        command.env("LUTHIER_CACHE", "").env_remove("XDG_RUNTIME_DIR");
        let output = command.args(words).current_dir(workshop.path(".")).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(4), "{words:?}: {said}");
        assert_eq!(said.lines().count(), 1, "{words:?}: {said}");
        for part in ["apt-get install mesa-vulkan-drivers libvulkan1", "dnf install", "pacman -S", "apk add"] {
            assert!(said.contains(part), "{words:?}: {said}");
        }
        assert_eq!(said.contains("--no-device"), words[0] == "report", "{said}");
    }
    assert_eq!(workshop.files(""), before);
}
