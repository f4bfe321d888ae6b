//! `luthier table`: what it bakes is read back, and judged by `luthier audit`.

use serde_json::Value;

use crate::workshop::Workshop;

/// Baked tables are as their preset states, in the eyes of the audit.
#[test]
fn presets_pass_the_audit() {
    let workshop = Workshop::new();
    workshop.run(&["table", "dfg", "--preset", "bevy", "-o", "dfg.ktx2"]).exits(0);
    let value = workshop.run(&["audit", "dfg.ktx2", "--preset", "bevy", "--json"]).exits(0).json();
    assert_eq!(value["line"], "as stated");
    workshop.run(&["table", "dfg", "--preset", "unreal", "-o", "gf.bin"]).exits(0);
    let raw = ["--size", "128x32", "--channels", "2", "--samples", "unorm16"];
    let audit = workshop.run(&[&["audit", "gf.bin", "--preset", "unreal"][..], &raw].concat()).exits(0);
    assert!(audit.stdout.contains("\nas stated\n"), "{}", audit.stdout);
}

/// The module of three.js has one word for every channel, and the first is that of grazing light on a smooth surface.
#[test]
fn the_module_of_three_js_holds_the_table() {
    let workshop = Workshop::new();
    workshop.run(&["table", "dfg", "--preset", "three", "-o", "DFGLUTData.js"]).exits(0);
    let text = std::fs::read_to_string(workshop.path("DFGLUTData.js")).unwrap();
    assert!(text.contains("export const DFG_LUT_DATA = new Uint16Array( ["), "{text}");
    assert_eq!(text.matches("0x").count(), 16 * 16 * 2);
}

/// A searched table holds its limit, also in the eyes of the audit, and is smaller for a larger limit.
#[test]
fn searched_tables_hold_their_limit() {
    let workshop = Workshop::new();
    let found = |limit: &str, file: &str| -> Value {
        workshop.run(&["table", "dfg", "--max-abs", limit, "-o", file, "--json"]).exits(0).json()
    };
    let (coarse, fine) = (found("1e-2", "coarse.ktx2"), found("1e-3", "fine.ktx2"));
    let texels =
        |value: &Value| value["table"]["size"][0].as_u64().unwrap() * value["table"]["size"][1].as_u64().unwrap();
    assert!(texels(&coarse) < texels(&fine));
    assert!(fine["error"]["max_abs_err"].as_f64().unwrap() <= 1e-3);
    // The audit knows no loss: it judges the bias.
    let axes = fine["table"]["axes"].as_str().unwrap();
    let statement =
        ["--model", "ggx-correlated", "--axes", axes, "--nodes", "ends", "--values", "bias", "--channel", "r"];
    let limits = ["--min-alpha", "0.01", "--max-error", "1e-3"];
    workshop.run(&[&["audit", "fine.ktx2"][..], &statement, &limits].concat()).exits(0);
}

#[test]
fn what_cannot_be_baked_is_refused() {
    let workshop = Workshop::new();
    let refused = |arguments: &[&str], code: i32, words: &str| {
        workshop.run(&[&["table", "dfg", "-o", "x.ktx2"][..], arguments].concat()).fails(code, &[words]);
        assert!(!workshop.path("x.ktx2").exists());
    };
    refused(&["--preset", "hdrp"], 2, "luthier audit --preset hdrp");
    refused(&["--preset", "nothing"], 2, "babylon, bevy");
    refused(&["--max-abs", "1e-3", "--masking", "smith"], 2, "correlated");
    refused(&["--max-abs", "0"], 2, "--max-abs");
    refused(&[], 2, "required");
}
