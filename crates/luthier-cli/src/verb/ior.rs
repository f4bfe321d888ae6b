//! `ior`: the built-in optical constants.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::constants::{Dataset, dataset, datasets};
use luthier_optics::f0_table::{DIELECTRIC_F0, F0_TABLE};
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_terminal::{Failure, Outcome, print};
use serde_json::{Value, json};

use crate::cli::IorOptions;

/// Lists the built-in optical constants, or shows one set.
pub(crate) fn run(options: &IorOptions) -> Outcome {
    if options.f0 {
        return print(&if options.json { format!("{:#}", f0_tables()) } else { f0_text() });
    }
    let Some(name) = &options.name else {
        let text = if options.json { format!("{:#}", Value::from_iter(datasets().iter().map(head))) } else { list() };
        return print(&text);
    };
    let set = named(name)?;
    print(&if options.json { format!("{:#}", whole(set)) } else { show(set) })
}

/// The data set of a name.
pub(super) fn named(name: &str) -> Outcome<&'static Dataset> {
    dataset(name).ok_or_else(|| {
        let known: Vec<&str> = datasets().iter().map(|d| d.id).collect();
        Failure::unknown("data set", name, &known)
    })
}

/// Normal-incidence reflectance in air, linear Rec.709 under D65.
fn f0(set: &Dataset) -> Rgb {
    let interface = Interface { above: Ior::vacuum(), films: Vec::new(), below: set.ior.clone() };
    interface.sampled(&Color::Spectral).rgb(1.0)
}

fn range(set: &Dataset) -> [f64; 2] {
    set.ior.range_nm().map_or([0.0, 0.0], |(a, b)| [a, b])
}

fn list() -> String {
    let mut out =
        format!("{:<18} {:<36} {:<10} {:>7}  {}\n", "id", "name", "range nm", "n, k at 589.3 nm", "F0 (linear sRGB)");
    for set in datasets() {
        let [a, b] = range(set);
        let index = set.ior.at(589.3);
        let [r, g, bl] = f0(set);
        let at = if set.k_given { format!("{:.4} {:.4}", index.re, index.im) } else { format!("{:.4} -", index.re) };
        out.push_str(&format!("{:<18} {:<36} {a:>4}-{b:<5} {at:>16}  {r:.3} {g:.3} {bl:.3}\n", set.id, set.name));
    }
    out
}

fn show(set: &Dataset) -> String {
    let [r, g, b] = f0(set);
    let mut out = format!("{} ({}), {}\nsource: {}\n", set.name, set.id, set.class, set.citation);
    if !set.doi.is_empty() {
        out.push_str(&format!("doi: {}\n", set.doi));
    }
    out.push_str(&format!("licence: {}\n", set.licence));
    if !set.note.is_empty() {
        out.push_str(&format!("note: {}\n", set.note));
    }
    if !set.k_given {
        out.push_str("k: not given by the source, taken as 0\n");
    }
    out.push_str(&format!("F0 in air, linear sRGB: {r:.4} {g:.4} {b:.4}\n\nwavelength_nm         n         k\n"));
    for s in set.ior.samples() {
        out.push_str(&format!("{:>13} {:>9} {:>9}\n", s.wavelength_nm, s.n, s.k));
    }
    out
}

fn head(set: &Dataset) -> Value {
    json!({
        "id": set.id,
        "name": set.name,
        "class": set.class,
        "citation": set.citation,
        "doi": set.doi,
        "licence": set.licence,
        "note": set.note,
        "k_given": set.k_given,
        "range_nm": range(set),
        "f0_linear_srgb": f0(set),
    })
}

fn whole(set: &Dataset) -> Value {
    let mut value = head(set);
    value["samples"] =
        set.ior.samples().iter().map(|s| json!({"wavelength_nm": s.wavelength_nm, "n": s.n, "k": s.k})).collect();
    value
}

/// The index in vacuum of a dielectric of some F0.
fn index_of(f0: f64) -> f64 {
    let r = f0.sqrt();
    (1.0 + r) / (1.0 - r)
}

fn f0_text() -> String {
    let mut out = format!(
        "F0 in air, linear sRGB\n{:<18} {:<22} {:<8} {:<22} difference\n",
        "metal", "printed in the lecture", "data set", "computed under D65"
    );
    for entry in F0_TABLE {
        let [computed, difference] =
            [entry.computed(), entry.difference()].map(|rgb| rgb.map_or_else(String::new, triple));
        let printed = triple(entry.linear);
        out.push_str(&format!("{:<18} {printed:<22} {:<8} {computed:<22} {difference}\n", entry.name, entry.dataset));
    }
    out.push_str(&format!("\n{:<18} {:<22} index that belongs to it\n", "dielectric", "printed in the lecture"));
    for class in DIELECTRIC_F0 {
        let [[low, high], [from, to]] = [class.linear, class.linear.map(index_of)];
        let printed = format!("{low:>7.3} to {high:.3}");
        out.push_str(&format!("{:<18} {printed:<22} {from:.3} to {to:.3}\n", class.name));
    }
    out
}

fn f0_tables() -> Value {
    let metals = F0_TABLE.iter().map(|entry| {
        json!({
            "name": entry.name,
            "printed_linear": entry.linear,
            "printed_srgb": entry.srgb,
            "dataset": entry.dataset,
            "computed_linear": entry.computed(),
            "difference": entry.difference(),
        })
    });
    let dielectrics = DIELECTRIC_F0.iter().map(|class| {
        let index = class.linear.map(index_of);
        json!({"name": class.name, "printed_linear": class.linear, "printed_srgb": class.srgb, "index": index})
    });
    json!({ "metals": metals.collect::<Value>(), "dielectrics": dielectrics.collect::<Value>() })
}

fn triple(rgb: Rgb) -> String {
    format!("{:>7.3} {:>6.3} {:>6.3}", rgb[0], rgb[1], rgb[2])
}
