//! `cost`.

use std::process::Output;

use assert_cmd::cargo::cargo_bin_cmd;
use luthier_workshop::material_texts::{gold, lacquer};
use serde_json::Value;

use crate::workshop::Workshop;

/// Counts of a row, or of a harness.
const COUNTS: [&str; 11] = [
    "branches",
    "buffer_reads",
    "code_bytes",
    "inverse_throughput",
    "instructions",
    "issue_cycles",
    "latency",
    "spills",
    "texture_reads",
    "vgprs",
    "waves",
];

#[test]
fn counts_are_complete_plausible_and_the_same_again() {
    let workshop = Workshop::with(&[("m/lacquer.toml", &lacquer("lacquer")), ("m/gold.toml", &gold("gold"))]);
    let args = ["cost", "m", "--model", "elek", "--model", "phong", "--json"];
    let run = workshop.run(&args);
    if run.lacks_driver() {
        return;
    }
    let run = run.exits(0);
    assert_eq!(workshop.run(&args).exits(0).stdout, run.stdout);
    let report = run.json();
    assert!(report["driver"].as_str().unwrap().contains("Mesa"), "{report:#}");
    let families = report["families"].as_array().unwrap();
    assert_eq!(families.iter().map(|f| f["family"].as_str().unwrap()).collect::<Vec<_>>(), ["gcn5", "rdna2", "rdna3"]);
    let rows = report["rows"].as_array().unwrap();
    // Elek: two forms of baked and one of full; Phong: one each. Every one with a buffer and with constants.
    assert_eq!(rows.len(), 3 * 2 * (3 + 2) * 2);
    for counts in rows.iter().chain(families.iter().map(|family| &family["harness"])) {
        for name in COUNTS {
            assert!(counts[name].is_i64(), "{name} in {counts:#}");
        }
    }
    for row in rows {
        assert!(row["instructions"].as_i64().unwrap() > 20 && row["issue_cycles"].as_i64().unwrap() > 40, "{row:#}");
        assert_eq!(row["constant"] == true, row["buffer_reads"] == 0, "{row:#}");
        let reads = row["texture_reads"].as_i64().unwrap();
        assert_eq!(reads > 0, row["model"] == "elek" && row["form"] == "baked", "{row:#}");
    }
    // One table less to read for each interface.
    let reads = |closed: bool| {
        let wanted = |r: &&Value| r["material"] == "gold" && r["form"] == "baked" && r["closed"] == closed;
        rows.iter().filter(wanted).map(|r| r["texture_reads"].as_i64().unwrap()).max().unwrap()
    };
    assert_eq!((reads(false), reads(true)), (2, 1));
}

#[test]
fn the_harness_costs_nothing() {
    use luthier_cost::{Harness, Kernel};
    for harness in [Harness::Bare, Harness::NormalMapped] {
        let kernel = Kernel::empty(harness).unwrap();
        let kernels = serde_json::to_string(&[kernel.clone(), kernel]).unwrap();
        let output: Output = cargo_bin_cmd!("luthier")
            .args(["cost-probe", "rdna2"])
            .envs(luthier_cost::Family::Rdna2.environment())
            .write_stdin(kernels)
            .output()
            .unwrap();
        if output.status.code() == Some(4) && std::env::var_os("CI").is_none() {
            eprintln!("skipped: {}", String::from_utf8_lossy(&output.stderr));
            return;
        }
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let compiled: luthier_cost::Compiled = serde_json::from_slice(&output.stdout).unwrap();
        let [first, second] = compiled.counts.as_slice() else { panic!("{compiled:?}") };
        let rest = second.beyond(first);
        assert!(first.instructions > 10 && first.issue_cycles > 20, "{first:?}");
        assert_eq!((rest.instructions, rest.inverse_throughput, rest.issue_cycles, rest.latency), (0, 0, 0, 0));
        assert_eq!((rest.code_bytes, rest.texture_reads, rest.buffer_reads, rest.branches), (0, 0, 0, 0));
    }
}

#[test]
fn a_missing_driver_is_named() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.write("empty/README", "no driver");
    let output = cargo_bin_cmd!("luthier")
        .current_dir(workshop.path("."))
        .args(["cost", "gold.toml", "--model", "phong", "--json"])
        .env("VK_DRIVER_FILES", workshop.path("empty"))
        .env("VK_ICD_FILENAMES", workshop.path("empty"))
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(4), "{said}");
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(told["error"]["code"], 4, "{told}");
    assert!(said.contains("RADV") && said.contains("apt-get install mesa-vulkan-drivers"), "{said}");
}

#[test]
fn machine_code_is_that_of_one_kernel() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.run(&["cost", "gold.toml", "--model", "elek", "--assembly"]).fails(2, &["--assembly", "--family"]);
    let one = ["--model", "elek", "--form", "baked", "--closed", "--constant", "--family", "rdna2", "--assembly"];
    let run = workshop.run(&[&["cost", "gold.toml"], one.as_slice()].concat());
    if run.lacks_driver() {
        return;
    }
    let text = run.exits(0).stdout;
    assert_eq!(text.matches("image_sample").count(), 1, "{text}");
    assert!(text.contains("s_endpgm"), "{text}");
}

#[test]
fn the_page_has_every_model() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = workshop.run(&["cost", "lacquer.toml", "--model", "phong", "--family", "gcn5", "-o", "page.md"]);
    if run.lacks_driver() {
        return;
    }
    assert_eq!(run.exits(0).stdout, "");
    let page = workshop.text("page.md");
    for part in ["Made by `luthier cost lacquer.toml --model phong --family gcn5 -o page.md`", "## Every model on gcn5"]
    {
        assert!(page.contains(part), "no `{part}` in\n{page}");
    }
}

/// Models without the distribution of a file are left out and named, unless they are asked for; one that is, is refused.
#[test]
fn models_without_a_distribution_are_left_out() {
    let blinn = "schema = 1\nname = \"silver\"\n[[layer]]\ntype = \"conductor\"\nior = \"ag\"\nalpha = 0.2\ndistribution = \"blinn\"\n";
    let workshop = Workshop::with(&[("silver.toml", blinn)]);
    workshop.run(&["cost", "silver.toml", "--model", "belcour"]).fails(1, &["silver.toml", "`belcour`", "`blinn`"]);
    let run = workshop.run(&["cost", "silver.toml", "--family", "rdna2", "--json"]);
    if run.lacks_driver() {
        return;
    }
    let run = run.exits(0).says(&["silver is left out of belcour", "silver is left out of phong"]);
    let report = run.json();
    let models = report["rows"].as_array().unwrap().iter().map(|row| row["model"].as_str().unwrap());
    let models: std::collections::BTreeSet<&str> = models.collect();
    assert_eq!(models.into_iter().collect::<Vec<_>>(), ["elek", "weidlich-wilkie"]);
}
