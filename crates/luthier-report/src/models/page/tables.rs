//! Tables of the page: one for each family of models, materials down, models across.

use luthier_model::ShadingModel;

use crate::models::{MaterialModels, ModelErrors, ModelsReport, Worst};

/// The heading of rows that are no models. It comes last.
const REFERENCE: &str = "The reference itself";

/// The heading of models without one.
const OTHERS: &str = "Others";

/// Kind of error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Albedo,
    Lobe,
}

impl Kind {
    pub(super) fn of(self, errors: &ModelErrors) -> &Worst {
        match self {
            Self::Albedo => &errors.albedo,
            Self::Lobe => &errors.lobe,
        }
    }
}

/// The model with the smallest error; the first of several that print as equal.
pub(super) fn best_model(material: &MaterialModels, kind: Kind) -> Option<&ModelErrors> {
    let models = material.models.iter().filter(|m| m.is_model);
    let printed = models.map(|m| ((kind.of(m).quantity.error * 1e3).round(), m));
    printed.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, m)| m)
}

/// The tables of an error.
pub(super) fn errors(report: &ModelsReport, kind: Kind) -> String {
    let models = report.materials.first().map_or(&[][..], |material| &material.models);
    let mut titles: Vec<&str> = Vec::new();
    for title in models.iter().map(heading) {
        if !titles.contains(&title) {
            titles.push(title);
        }
    }
    let mut out = String::new();
    for title in titles {
        let members: Vec<usize> = (0..models.len()).filter(|i| heading(&models[*i]) == title).collect();
        let mut head: Vec<String> = members.iter().map(|i| models[*i].name.to_owned()).collect();
        head.insert(0, "material".to_owned());
        head.push("±".to_owned());
        if kind == Kind::Lobe {
            head.push("noise".to_owned());
        }
        let rows = report.materials.iter().map(|material| row(material, &members, kind));
        out.push_str(&format!("\n### {title}\n\n{}", table(&head, rows)));
    }
    out
}

fn heading(row: &ModelErrors) -> &'static str {
    if row.is_model { ShadingModel::heading_of(row.name).unwrap_or(OTHERS) } else { REFERENCE }
}

fn row(material: &MaterialModels, members: &[usize], kind: Kind) -> Vec<String> {
    let best = best_model(material, kind).map(|m| m.name);
    let mut row = vec![material.name.clone()];
    let (mut uncertainty, mut floor) = (0.0, 0.0);
    for errors in members.iter().map(|i| &material.models[*i]) {
        let worst = kind.of(errors);
        let text = number(worst.quantity.error);
        row.push(if best == Some(errors.name) { format!("**{text}**") } else { text });
        uncertainty = f64::max(uncertainty, worst.quantity.uncertainty());
        floor = f64::max(floor, worst.floor);
    }
    row.push(number(uncertainty));
    if kind == Kind::Lobe {
        row.push(number(floor));
    }
    row
}

/// The best model of every material, by either error.
pub(super) fn best(report: &ModelsReport) -> String {
    let head = ["material", "by albedo ", "error", "by lobe ", "error"].map(str::to_owned);
    let rows = report.materials.iter().map(|material| {
        let mut row = vec![material.name.clone()];
        for kind in [Kind::Albedo, Kind::Lobe] {
            let Some(best) = best_model(material, kind) else { continue };
            row.extend([best.name.to_owned(), number(kind.of(best).quantity.error)]);
        }
        row
    });
    format!("\n## The best model of each material\n\n{}", table(&head, rows))
}

/// A table in Markdown. Numbers are aligned to the right; the first column, and columns whose head ends in a space, are text.
pub(super) fn table(head: &[String], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let rule: Vec<String> =
        (0..head.len()).map(|i| if i == 0 || head[i].ends_with(' ') { "---" } else { "---:" }.to_owned()).collect();
    let mut out = line(head) + &line(&rule);
    rows.into_iter().for_each(|row| out.push_str(&line(&row)));
    out
}

fn line(cells: &[String]) -> String {
    format!("| {} |\n", cells.iter().map(|cell| cell.trim_end()).collect::<Vec<_>>().join(" | "))
}

/// A number in three decimals, as many as the reference is good for; infinite errors in words.
pub(super) fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:.3}") } else { "infinite".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::rows;

    #[test]
    fn every_row_has_a_heading() {
        for row in rows().iter().map(|row| ModelErrors::new(row, Vec::new())) {
            assert_ne!(heading(&row), OTHERS, "{}", row.name);
        }
        assert_eq!(ShadingModel::heading_of("quite-new"), None);
    }
}
