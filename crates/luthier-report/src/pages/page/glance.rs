//! The first screen: how accurate, how fast and how large, all materials in one chart, and their pictures.

use std::fmt::Write;

use base64::Engine;
use base64::prelude::BASE64_STANDARD as STANDARD;

use luthier_manifest::Form;

use super::summary::shown;
use super::trade::{FAMILY, of_shaders};
use super::{anchor, of_material};
use crate::judge::evidence::Exhibits;
use crate::judge::report::{Compared, MaterialReport, Report};
use crate::pages::chart;
use crate::svg::{Spot, field, legend};
use crate::text::format::{bytes, error, escape, none, number, rounded};

pub(super) fn write(out: &mut String, report: &Report, exhibits: &Exhibits) {
    facts(out, report);
    chart(out, report);
    thumbnails(out, report, exhibits);
}

/// Error and cost of a material in a line.
pub(super) fn line(report: &Report, material: &MaterialReport) -> String {
    let found = material.comparison(judged(report)).map_or_else(none, |c| error(c.max_error()));
    let paid = match cycles(report, material, "baked") {
        Some(cycles) => format!("{} cycles", number(cycles)),
        None => bytes(table_bytes(report, material) as u64),
    };
    format!("{found} · {paid}")
}

/// The comparison whose error stands for a material: the baked shader, or, without a device, its tables.
fn judged(report: &Report) -> Compared {
    shown(report)[0]
}

/// Cycles of the shader that ships, in a form: its own if costs were given, else those of a shader for layers of equal kinds.
fn cycles(report: &Report, material: &MaterialReport, form: &str) -> Option<f64> {
    let Some(costs) = &report.costs else {
        let cost = material.shape_cost?;
        return (if form == "full" { cost.full } else { Some(cost.baked) }).map(f64::from);
    };
    let shaders = of_shaders(report, material, costs);
    let ships = shaders.iter().find(|s| s.row.model == material.model && s.row.form == form)?;
    Some(ships.row.inverse_throughput.max(1) as f64)
}

/// Bytes of the tiles that a material reads.
fn table_bytes(report: &Report, material: &MaterialReport) -> f64 {
    let bytes = report.tables.iter().map(|table| {
        let read = table.tiles.iter().filter(|tile| tile.is_read_by(&material.name)).count();
        table.texel_bytes as f64 * read as f64 / table.tiles.len().max(1) as f64
    });
    bytes.sum()
}

/// Least, median and largest.
fn spread(mut values: Vec<f64>) -> Option<[f64; 3]> {
    values.sort_by(f64::total_cmp);
    Some([*values.first()?, values[values.len() / 2], *values.last()?])
}

fn facts(out: &mut String, report: &Report) {
    let errors = report.materials.iter().filter_map(|m| m.comparison(judged(report))).map(|c| c.max_error()).collect();
    let [baked, full] =
        ["baked", "full"].map(|form| spread(report.materials.iter().filter_map(|m| cycles(report, m, form)).collect()));
    let total: u64 = report.tables.iter().map(|t| t.texel_bytes).sum();
    let accurate = spread(errors).map_or((none(), "no material".to_owned()), |[least, median, largest]| {
        let most = format!(
            "median of the largest errors of all materials; they range from {} to {}",
            error(least),
            error(largest)
        );
        (error(median), most)
    });
    let fast = baked.map_or_else(
        || ("not measured".to_owned(), "run luthier cost --json, then luthier report --cost FILE".to_owned()),
        |[least, median, most]| {
            let full =
                full.map_or_else(String::new, |[_, full, _]| format!("; median of the full form {}", number(full)));
            let family = FAMILY.to_uppercase();
            let range =
                format!("median; {} to {} per wave of 64 threads on {family}{full}", number(least), number(most));
            (format!("{} cycles", number(median)), range)
        },
    );
    let fast = (fast.0, [fast.1, timed(report)].concat());
    let (samples, not_finite) = samples(report);
    let large = format!("{} tables for {} materials", report.tables.len(), report.materials.len());
    let boxes = [
        ("how accurate", accurate),
        ("how fast", fast),
        ("how large", (bytes(total), large)),
        ("values judged", (samples.to_string(), format!("{not_finite} not finite"))),
    ];
    out.push_str("<dl class=\"facts glance\">");
    for (name, (figure, note)) in boxes {
        let [figure, note] = [figure, note].map(|text| escape(&text));
        let _ = write!(out, "<div><dt>{name}</dt><dd>{figure}</dd><dd class=\"sub\">{note}</dd></div>");
    }
    out.push_str("</dl>\n");
}

/// Measured times, behind the cycles; empty where none were asked for.
fn timed(report: &Report) -> String {
    let Some(times) = &report.times else { return String::new() };
    let of = |form| spread(times.rows.iter().filter(|row| row.form == form).map(|row| row.net_ns).collect());
    let words = [Form::Baked, Form::Full].into_iter().filter_map(|form| {
        let [_, median, _] = of(form)?;
        Some(format!("{} {form}", number(rounded(median, 3))))
    });
    let kind = if times.is_software { "a program on the CPU" } else { "this GPU" };
    let words: Vec<String> = words.collect();
    format!("; timed on {kind}, median ns: {}", words.join(", "))
}

/// Number of compared values, and number of values that are not finite.
pub(super) fn samples(report: &Report) -> (u64, u64) {
    let sets = report.materials.iter().flat_map(|m| report.judged(m)).flat_map(|c| &c.sets);
    sets.fold((0, 0), |(all, bad), (_, s)| (all + 3 * s.pairs, bad + s.not_finite))
}

fn chart(out: &mut String, report: &Report) {
    let has_costs = report.materials.iter().any(|m| cycles(report, m, "baked").is_some());
    let mut drawn = vec![(judged(report), "baked")];
    if report.device.is_some() && has_costs {
        drawn.push((Compared::FullDevice, "full"));
    }
    let mut spots = Vec::new();
    for (place, &(compared, form)) in drawn.iter().enumerate() {
        for (index, material) in report.materials.iter().enumerate() {
            let size = table_bytes(report, material);
            let price = if has_costs { cycles(report, material, form) } else { Some(size) };
            let found = material.comparison(compared).map(|c| c.max_error()).filter(|e| e.is_finite());
            let (Some(price), Some(found)) = (price, found) else { continue };
            let paid = if has_costs { format!("{} cycles, ", number(price)) } else { String::new() };
            let tables =
                if form == "full" { "no table".to_owned() } else { format!("{} of tables", bytes(size as u64)) };
            let tip = format!("{}, {}: error {}, {paid}{tables}", material.name, compared.name(), error(found));
            let (name, anchor, series) = (material.name.clone(), anchor(index), chart::series(compared));
            spots.push(Spot { material: name, anchor, price, error: found, tip, series, is_named: place == 0 });
        }
    }
    let limit = report.budget.map_or((report.target_max_rel_err, "target"), |budget| (budget, "limit"));
    let (x_title, note) = if has_costs {
        (
            format!(
                "cycles per wave of 64 threads, {}, inverse throughput; counted by the compiler, not timed",
                FAMILY.to_uppercase()
            ),
            match &report.costs {
                Some(_) => "Cost against largest error: the best materials are at the lower left.",
                None => {
                    "Cost against largest error: the best materials are at the lower left. The cost is that of a shader for layers of the same kinds, with D in \
                     closed form; it comes with luthier. luthier cost --json measures the cost of these shaders, and luthier report --cost shows it."
                }
            },
        )
    } else {
        (
            "bytes of the tables that a material reads".to_owned(),
            "The best materials are at the lower left. No cost of shaders was given (luthier report --cost); luthier report --times measures times.",
        )
    };
    out.push_str("<figure class=\"field\">");
    out.push_str(&legend(&drawn.iter().map(|(compared, _)| chart::series(*compared)).collect::<Vec<_>>()));
    let title = format!("All materials: error by {}", if has_costs { "cost" } else { "bytes" });
    let _ = writeln!(
        out,
        "<div class=\"scroll\">{}</div><figcaption>{} Hover over a mark for its figures; click it to go to its \
         material.</figcaption></figure>",
        field(&title, &x_title, &spots, limit),
        escape(note)
    );
}

/// A small picture of each material, linked to its section.
fn thumbnails(out: &mut String, report: &Report, exhibits: &Exhibits) {
    let mut links = String::new();
    for (index, (material, pictures)) in report.materials.iter().zip(&exhibits.pictures).enumerate() {
        let baked = pictures.iter().find(|e| e.caption == "baked");
        let Some(picture) = baked.or(pictures.first()) else { continue };
        let _ = write!(
            links,
            "<a href=\"#{}\"{} data-tip=\"{name}: {}\"><img alt=\"{name}\" src=\"data:image/png;base64,{}\"/></a>",
            anchor(index),
            of_material(&material.name),
            escape(&line(report, material)),
            STANDARD.encode(&picture.png),
            name = escape(&material.name)
        );
    }
    if !links.is_empty() {
        let _ = writeln!(out, "<div class=\"thumbs\">{links}</div>");
    }
}
