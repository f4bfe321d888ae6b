//! The page of `ladder`.

use std::fmt::Write as _;

use luthier_cost::DeviceCost;
use luthier_export::GENERATOR;
use luthier_report::Spread;

use super::steps::{Ask, Costs, FORMS, LIGHTS, Taken, words};
use super::{Group, Measured};
use crate::cli::{LadderOptions, call};
use crate::lobes::{QUANTITIES, ranks};

/// Random stacks with the largest errors that the page lists.
const WORST: usize = 12;

/// Aims for the errors of random stacks: at the 95th percentile and the largest, of the form with the least error.
const AIMS: [f64; 2] = [0.035, 0.06];

const INTRODUCTION: &str = "\nWhere a file or the command line limits the errors of `lobes` (`max_lobe_err`, `max_albedo_err`), a bake takes the form with the lowest cost that holds: no lobe, \
    one short lobe, one lobe of one width, one lobe, two, or three, each with a [polynomial reflectance](../manifest.md#reflectance) of the first interface where one is near. Without limits it takes the fewest lobes that fit as well as two. This page takes each material by itself, with a limit on the albedo of .4 times that on the lobe error. \
    Where no form holds a limit, a bake refuses; the page takes the form with the least error there: the one that holds the tightest limit, which *least error* has for every material. \
    Errors of the first tables are those that the bake states: the largest of five views that no fit saw, and of the albedo at rows that were left out, with the noise of the judge in them (.006 to .009). Costs are picoseconds of a light on one view, medians over the \
    materials; in brackets is the median over the cost of `gltf-clearcoat` for as many lights. \
    *No lobe* is the first bounce in closed form and a wide rest; *one short lobe* has the tail of GGX and no rest, for stacks over metal ([what it has](../manifest.md#short-lobe)); *one lobe of one width* has a width that is the same for all views. A *row* is the table of a material over the cosine of the view; *rows over more than the view* are over a slope parameter, a factor or the azimuth, too.\n";

const OF_RANDOM: &str = "\nRandom stacks are those of [lobes.md](lobes.md), by the same numbers, as far as they have two interfaces that refract or mirror light: up to four coats over a metal, or two to four over a diffuse base.\n";

const OF_TWINS: &str = "\nA twin is the stack of a material with GGX in place of Beckmann's distribution, or the reverse, and without textures.\n";

const OF_FAMILIES: &str = "\nTextures vary the slope parameters of single layers: rows are those of a family, which always has two lobes. A limit takes fewer nodes over the slope parameters, which are fewer bytes at the same cost.\n";

const OF_COATS: &str =
    "\nThese are the coats of [coats.md](coats.md): clear, over metals, plastics and mixtures of both.\n";

const BESIDE: &str = "The tables that ship, read as a shader reads them, stand here beside published models and formulas of engines, on the same stacks. Errors are those of [lobes.md](lobes.md): against its judge, the largest of nine angles of the eye, 0 to 85 degrees, and three \
    channels. They are lower than those of the first tables, which have the noise of a bake in them (.006 to .009). [coats.md](coats.md) has the median over its views instead. Lobes within a limit are the tables of that row above: where no form holds the limit, the one with the least error, so that a row may lie above its limit. \
    A formula without costs was not counted yet. *Base changed* is the formula over a base that is widened and darkened once for its coat ([coats.md](coats.md#what-each-could-change)), at the same cost. The Filament of `coats` compensates the specular lobe of its base for light lost between facets, by a table; the shader whose cost stands here does not read one. *Lobe error* is the light that has to move to another direction and half of what is missing or too much, over all light: a black surface has 0.5 ([models.md](models.md)).\n";

/// Median of costs by number of lights.
pub(super) fn medians<'a>(all: impl Iterator<Item = &'a Costs>) -> Costs {
    let all: Vec<&Costs> = all.collect();
    std::array::from_fn(|i| Spread::of(&all.iter().map(|costs| costs[i]).collect::<Vec<_>>()).median)
}

impl Group {
    /// Forms that all stacks take for an [`Ask`], by its number.
    pub(super) fn taken(&self, ask: usize) -> impl Iterator<Item = &Taken> + Clone {
        self.stacks.iter().map(move |stack| &stack.taken[ask])
    }
}

pub(super) fn page(
    groups: &[Group],
    device: &DeviceCost,
    yardstick: &Costs,
    options: &LadderOptions,
) -> Result<String, std::fmt::Error> {
    let mut command = call("ladder", &options.sources.paths);
    if options.stacks > 0 {
        write!(command, " --stacks {}", options.stacks)?;
    }
    if let Some(path) = &options.chart {
        write!(command, " --chart {}", path.display())?;
    }
    if let Some(coats) = options.coats {
        write!(command, " --coats {coats}")?;
    }
    let mut page = String::new();
    writeln!(
        page,
        "# A ladder of lobes\n\nMade by `{command}`, {GENERATOR}. Costs are predicted {}: they come from counts of the shaders' sources and costs that were fitted to times of other shaders, and are not measurements.",
        device.label()
    )?;
    if !device.assumed.is_empty() {
        writeln!(
            page,
            "No shader that was timed there has {}: their costs are assumed ([devices.md](devices.md)).",
            device.assumed.join(" or ").replace('_', " ")
        )?;
    }
    page.push_str(INTRODUCTION);
    let chart = options.chart.as_ref().and_then(|path| path.file_name());
    if let Some(name) = chart {
        writeln!(
            page,
            "\n![Lobe error against predicted time on an H100, of lobes, published models and coats of engines]({})",
            name.display()
        )?;
    }
    for group in groups {
        writeln!(page, "\n## {}", group.title)?;
        page.push_str(match group.title {
            "Random stacks" => OF_RANDOM,
            "Coats of engines" => OF_COATS,
            "Twins in the other distribution" => OF_TWINS,
            "Materials with textures" => OF_FAMILIES,
            _ => "",
        });
        asked(&mut page, group, yardstick)?;
        if group.title.starts_with("Materials") {
            let names: Vec<&str> = group.stacks.iter().map(|stack| stack.name.as_str()).collect();
            writeln!(page, "\nThese are {}.", names.join(", "))?;
        }
    }
    let words = LIGHTS.iter().zip(yardstick).map(|(lights, cost)| format!("{cost:.1} ps for each of {lights}"));
    writeln!(page, "\n`gltf-clearcoat` by the same costs: {}.", words.collect::<Vec<_>>().join(", "))?;
    if chart.is_some() {
        write!(page, "\n## Beside models and engines\n\n{BESIDE}")?;
        for group in groups.iter().filter(|group| group.is_judged) {
            beside(&mut page, group)?;
        }
        if let Some(group) = groups.iter().find(|group| group.title == "Random stacks") {
            worst(&mut page, group)?;
        }
    }
    Ok(page)
}

/// The table of limits.
fn asked(page: &mut String, group: &Group, yardstick: &Costs) -> std::fmt::Result {
    writeln!(
        page,
        "\n| limit | stacks that hold it | {} | lobe error: median | 95th percentile | largest | albedo error: median | 95th percentile | largest | one light | each of 4 | each of 16 |\n\
         |--:|--:|{}--:|--:|--:|--:|--:|--:|--:|--:|--:|",
        FORMS.map(words).join(" | "),
        "--:|".repeat(FORMS.len())
    )?;
    for (number, ask) in Ask::ALL.into_iter().enumerate() {
        let taken = || group.taken(number);
        let held = taken().filter(|taken| taken.holds).count();
        write!(page, "| {} | {held} of {} |", ask.words(), group.stacks.len())?;
        for form in FORMS {
            write!(page, " {} |", taken().filter(|taken| taken.form == form).count())?;
        }
        errors(page, |quantity| ranks(taken().map(|taken| taken.stated[quantity])))?;
        for (median, yardstick) in medians(taken().map(|taken| &taken.costs)).iter().zip(yardstick) {
            write!(page, " {median:.1} ({:.2}) |", median / yardstick)?;
        }
        page.push('\n');
    }
    Ok(())
}

/// Cells of the ranks of each quantity.
fn errors(page: &mut String, ranks: impl Fn(usize) -> [f64; 3]) -> std::fmt::Result {
    (0..QUANTITIES).flat_map(ranks).try_for_each(|error| write!(page, " {error:.3} |"))
}

/// The table of lobes, models and engines.
fn beside(page: &mut String, group: &Group) -> std::fmt::Result {
    writeln!(
        page,
        "\n### {}\n\n| | lobe error: median | 95th percentile | largest | albedo error: median | 95th percentile | largest | one light | each of 4 | each of 16 |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
        group.title
    )?;
    for (number, ask) in Ask::ALL.into_iter().enumerate() {
        let words = match ask {
            Ask::Default => "lobes".to_owned(),
            Ask::Least => "lobes, least error".to_owned(),
            Ask::Limit(limit) => format!("lobes within {limit}"),
        };
        write!(page, "| {words} |")?;
        errors(page, |quantity| ranks(group.taken(number).map(|taken| taken.judged[quantity])))?;
        medians(group.taken(number).map(|taken| &taken.costs))
            .iter()
            .try_for_each(|cost| write!(page, " {cost:.1} |"))?;
        page.push('\n');
    }
    for (number, rival) in group.stacks[0].rivals.iter().enumerate() {
        let all = || group.stacks.iter().map(move |stack| &stack.rivals[number]);
        write!(page, "| {} |", rival.name)?;
        errors(page, |quantity| ranks(all().map(|rival| rival.judged[quantity])))?;
        match rival.costs {
            Some(_) => medians(all().filter_map(|rival| rival.costs.as_ref()))
                .iter()
                .try_for_each(|cost| write!(page, " {cost:.1} |"))?,
            None => page.push_str(" – | – | – |"),
        }
        page.push('\n');
    }
    Ok(())
}

/// The aims, and the stacks with the largest errors.
fn worst(page: &mut String, group: &Group) -> std::fmt::Result {
    let least = Ask::ALL.iter().position(|ask| *ask == Ask::Least).unwrap_or_default();
    let of = |stack: &Measured| stack.taken[least].judged[0];
    let [_, most, largest] = ranks(group.stacks.iter().map(of));
    let verdict = |found: f64, aim: f64| {
        let word = if found <= aim { "holds" } else { "does not hold" };
        format!("{found:.3}, where {aim} was the aim: it {word}")
    };
    writeln!(
        page,
        "\n## Aims, and the worst stacks\n\nWith all forms allowed, the 95th percentile of the lobe errors of random stacks is {}. The largest is {}. {} of {} stacks are beyond {}.",
        verdict(most, AIMS[0]),
        verdict(largest, AIMS[1]),
        group.stacks.iter().filter(|stack| of(stack) > AIMS[0]).count(),
        group.stacks.len(),
        AIMS[0]
    )?;
    page.push_str(
        "\nNumbers and names of stacks are those of [lobes.md](lobes.md), which traces its worst to reasons: index and slope parameter of each interface from the top. Where an error is far above what the bake states, none of the bake's five views is near the worst one: a limit does not bound the error there.\n\n\
         | stack | form with the least error | lobe error | albedo error | lobe error that the bake states | without limits |\n|---|---|--:|--:|--:|--:|\n",
    );
    let mut stacks: Vec<&Measured> = group.stacks.iter().collect();
    stacks.sort_by(|a, b| of(b).total_cmp(&of(a)));
    for stack in stacks.into_iter().take(WORST) {
        let taken = &stack.taken[least];
        let form = words(taken.form);
        writeln!(
            page,
            "| {} | {form} | {:.3} | {:.4} | {:.3} | {:.3} |",
            stack.name, taken.judged[0], taken.judged[1], taken.stated[0], stack.taken[0].judged[0]
        )?;
    }
    Ok(())
}
