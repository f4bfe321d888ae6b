use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::constants::{Dataset, dataset, datasets};
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use serde_json::{Value, json};

use crate::cli::IorOptions;
use crate::failure::{Failure, Outcome};
use crate::output::print;

/// Lists the built-in optical constants, or shows one set.
pub(crate) fn run(options: &IorOptions) -> Outcome {
    let Some(name) = &options.name else {
        let text = if options.json { format!("{:#}", Value::from_iter(datasets().iter().map(head))) } else { list() };
        return print(&text);
    };
    let set = dataset(name).ok_or_else(|| {
        let known: Vec<&str> = datasets().iter().map(|d| d.id).collect();
        Failure::Input(anyhow::anyhow!("no data set `{name}`; known: {}", known.join(", ")))
    })?;
    print(&if options.json { format!("{:#}", whole(set)) } else { show(set) })
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
