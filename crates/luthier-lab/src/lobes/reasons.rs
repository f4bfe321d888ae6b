//! Reasons for the error of a fit, found by fitting again with one thing changed at a time.

use luthier_layers::models::lobes::{EXCESS, FitSettings, LOBES, Lobes, most_lobes, shown};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::JointPaths;
use luthier_optics::stack::{Base, Stack};
use luthier_report::{ModelSubject, Reference, Shown, ViewError};

use super::{JUDGE_SEED, Judged, QUANTITIES, THETAS_DEG, fit_settings, judge_settings, largest, simulated};
use crate::cli::LobesOptions;

/// A change of the fit or of the judge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    /// Four times the paths for each row.
    Paths,
    /// Half the distance between the rows.
    Rows,
    /// As many lobes as a bake may have, where it took fewer.
    AllLobes,
    /// One lobe more than a bake may have.
    OneMore,
    /// Every channel by itself.
    Channels,
    /// Other random numbers of the judge.
    Judge,
}

impl Change {
    pub(super) const ALL: [Self; 6] =
        [Self::Paths, Self::Rows, Self::AllLobes, Self::OneMore, Self::Channels, Self::Judge];

    /// Head of its column.
    pub(super) fn head(self) -> &'static str {
        match self {
            Self::Paths => "4x paths",
            Self::Rows => "2x rows",
            Self::AllLobes => "2 lobes",
            Self::OneMore => "3 lobes",
            Self::Channels => "channels alone",
            Self::Judge => "other judge",
        }
    }

    /// The reason that it stands for.
    pub(super) fn reason(self) -> &'static str {
        match self {
            Self::Paths => "noise of the fit",
            Self::Rows => "rows too far apart",
            Self::AllLobes => "fewer lobes than two were taken",
            Self::OneMore => "two lobes too few",
            Self::Channels => "one shape for three channels",
            Self::Judge => "noise of the judge",
        }
    }
}

/// Least share of an error that a change takes away if it is the reason.
pub(super) const GAIN_MIN: f64 = 0.25;

/// Errors of a stack with one thing changed.
pub(super) struct Reasons {
    /// Largest errors by quantity with each change; `None` where it changes nothing.
    changed: Vec<(Change, Option<[f64; QUANTITIES]>)>,
}

impl Reasons {
    /// The errors of a judged stack with each change.
    pub(super) fn of(subject: &ModelSubject, judged: &Judged, reference: &Reference, options: &LobesOptions) -> Self {
        let settings = fit_settings(options);
        let nm = subject.wavelengths_nm;
        let stack = &subject.stack;
        let lobes = judged.lobes.rows[0].lobes.len();
        let changed = Change::ALL.map(|change| {
            let fitted = match change {
                Change::Paths => fewest(stack, nm, FitSettings { paths: 4 * settings.paths, ..settings }),
                Change::Rows => fewest(stack, nm, FitSettings { rows: 2 * settings.rows - 1, ..settings }),
                Change::AllLobes if lobes == LOBES => return (change, None),
                Change::AllLobes => simulated(stack, nm, settings).fit(LOBES),
                Change::OneMore => simulated(stack, nm, settings).fit(LOBES + 1),
                Change::Channels => {
                    let views = (0..3).flat_map(|c| alone(subject, c, reference, settings));
                    return (change, Some(largest(&views.collect::<Vec<_>>())));
                }
                Change::Judge => {
                    let settings = judge_settings(&options.precision, 2 * JUDGE_SEED);
                    let other = Reference::new(subject, &THETAS_DEG, settings);
                    return (change, Some(largest(&other.errors(Shown::Lobes(&judged.lobes)))));
                }
            };
            (change, Some(largest(&reference.errors(Shown::Lobes(&fitted)))))
        });
        Self { changed: changed.to_vec() }
    }

    /// The errors of a quantity with each change.
    pub(super) fn errors(&self, quantity: usize) -> impl Iterator<Item = (Change, Option<f64>)> {
        self.changed.iter().map(move |(change, errors)| (*change, errors.map(|errors| errors[quantity])))
    }

    /// The change that makes an error of a quantity the least, if it takes away [`GAIN_MIN`] of it.
    pub(super) fn reason(&self, quantity: usize, error: f64) -> Option<(Change, f64)> {
        let changed = self.errors(quantity).filter_map(|(change, error)| Some((change, error?)));
        changed.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, least)| *least <= (1.0 - GAIN_MIN) * error)
    }
}

fn fewest(stack: &Stack, nm: [f64; 3], settings: FitSettings) -> Lobes {
    simulated(stack, nm, settings).fit_fewest(most_lobes(stack), EXCESS)
}

/// Errors of one channel by lobes that are fitted to this channel alone, with as many paths of its wavelength as the joint fit has.
fn alone(subject: &ModelSubject, channel: usize, reference: &Reference, settings: FitSettings) -> Vec<ViewError> {
    let stack = shown(&subject.stack);
    let stacks = [0, 1, 2].map(|c: usize| Monochrome::new(&stack, subject.wavelengths_nm[c], c));
    let sets = JointPaths::new(&stacks).into_iter().map(|paths| paths.channels());
    let joined: u64 = sets.filter(|set| set[channel]).flatten().map(u64::from).sum();
    let settings = FitSettings { paths: settings.paths * joined / 3, ..settings };
    let nm = [subject.wavelengths_nm[channel]; 3];
    let lobes = simulated(&gray(&stack, channel), nm, settings).fit_fewest(most_lobes(&stack), EXCESS);
    let errors = reference.errors(Shown::Lobes(&lobes));
    errors.into_iter().skip(channel).step_by(3).collect()
}

/// The stack with the absorption and the albedo of one channel in all.
fn gray(stack: &Stack, channel: usize) -> Stack {
    let mut stack = stack.clone();
    for layer in &mut stack.layers {
        match &mut layer.base {
            Base::Dielectric { slab, .. } => slab.absorption_per_um = [slab.absorption_per_um[channel]; 3],
            Base::Diffuse(diffuse) => diffuse.albedo = [diffuse.albedo[channel]; 3],
            Base::Conductor { .. } => {}
        }
    }
    stack
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reason_is_the_change_that_leaves_least_if_it_is_enough() {
        let reasons = |left: [Option<f64>; 7]| {
            let changed = Change::ALL.into_iter().zip(left).map(|(change, left)| (change, left.map(|e| [e, 0.1 * e])));
            Reasons { changed: changed.collect() }
        };
        let found = reasons([Some(0.09), Some(0.05), None, Some(0.06), Some(0.1), Some(0.1), None]);
        assert_eq!(found.reason(0, 0.1), Some((Change::Rows, 0.05)));
        assert_eq!(found.reason(1, 0.02).map(|(change, _)| change), Some(Change::Rows));
        assert_eq!(found.reason(0, 0.06), None);
        assert_eq!(reasons([None; 7]).reason(0, 1.0), None);
    }

    #[test]
    fn a_gray_stack_has_one_channel_in_all() {
        for seed in 0..20 {
            let subject = super::super::random(seed);
            let gray = gray(&subject.stack, 1);
            for (layer, own) in gray.layers.iter().zip(&subject.stack.layers) {
                match (&layer.base, &own.base) {
                    (Base::Dielectric { slab, .. }, Base::Dielectric { slab: own, .. }) => {
                        assert_eq!(slab.absorption_per_um, [own.absorption_per_um[1]; 3]);
                    }
                    (Base::Diffuse(diffuse), Base::Diffuse(own)) => {
                        assert_eq!(diffuse.albedo, [own.albedo[1]; 3]);
                    }
                    (layer, own) => assert_eq!(layer, own),
                }
            }
        }
    }
}
