//! Costs of shaders on devices: a number for each kind of operation, fitted to times.

use luthier_shader::StaticCounts;
use serde::{Deserialize, Serialize};

use crate::fit::{self, FitQuality, KINDS, Numbers, Timing};
use crate::{CostError, Family};

/// Version of the JSON.
const SCHEMA: u32 = 1;

/// Name of the device by whose costs models are chosen where none is named.
pub const DEFAULT_DEVICE: &str = "h100";

/// The files that ship, by the names of their devices.
const SHIPPED: [(&str, &str); 5] = [
    ("h100", include_str!("../data/h100.json")),
    ("gcn5", include_str!("../data/gcn5.json")),
    ("rdna2", include_str!("../data/rdna2.json")),
    ("rdna3", include_str!("../data/rdna3.json")),
    ("llvmpipe", include_str!("../data/llvmpipe.json")),
];

/// Operations on components that make four values of 16 bytes: two halves from each word, and a product and a sum for each value.
const UNPACKED: f64 = 16.0;

luthier_lut::named! {
    /// Unit of costs.
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum CostUnit("unit of costs") {
        /// Picoseconds of a device for one evaluation among many.
        Picoseconds = "ps",
        /// Cycles of a compute unit for a wave of 64 evaluations, by the compiler's model of the chip.
        Cycles = "cycles",
    }
}

/// Cost of each kind of operation, as [`StaticCounts`] has them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coefficients {
    /// A read through a sampler of at most 4 bytes a texel.
    pub filtered_reads: f64,
    /// A read through a sampler of more bytes a texel.
    pub wide_reads: f64,
    /// A read of a texture without a sampler.
    pub texel_fetches: f64,
    /// 16 bytes of a record of a material.
    pub record_reads: f64,
    /// A read of another storage buffer.
    pub buffer_reads: f64,
    /// A root, exponential, logarithm, reciprocal or sine.
    pub special: f64,
    /// Another operation on one component.
    pub plain: f64,
    /// A branch.
    pub branches: f64,
}

impl Coefficients {
    /// In the order of [`StaticCounts::values`].
    pub fn values(&self) -> [f64; KINDS] {
        let &Self { filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches } =
            self;
        [filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches]
    }

    fn of_values(values: [f64; KINDS]) -> Self {
        let [filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches] = values;
        Self { filtered_reads, wide_reads, texel_fetches, record_reads, buffer_reads, special, plain, branches }
    }
}

/// Costs of shaders on one device, from [`Coefficients`] times [`StaticCounts`].
///
/// Reads of textures have units of their own. The cost is the longer of their time and that of all other operations, and what of the shorter one
/// [`Self::hidden`] leaves. Caches and registers, which limit how many threads run at once, are not modelled; [`Self::fit`] has what that costs.
///
/// ```
/// use luthier_cost::DeviceCost;
/// use luthier_shader::StaticCounts;
///
/// let h100 = DeviceCost::shipped("h100").unwrap();
/// let row = StaticCounts { filtered_reads: 1, plain: 10, ..StaticCounts::default() };
/// assert!(h100.cost(&row) > h100.cost(&StaticCounts { filtered_reads: 0, ..row }));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceCost {
    /// Version of the file, 1.
    pub schema: u32,
    /// Program and version that made it.
    pub generator: String,
    /// Short name.
    pub name: String,
    /// The device, in the words of its driver.
    pub device: String,
    /// Driver and version.
    pub driver: String,
    /// Unit of the costs.
    pub unit: CostUnit,
    /// The measurement that the coefficients were fitted to, in words.
    pub source: String,
    /// The family whose compiler counted the cycles of shapes, where one did. Scenes take its counts in place of the coefficients.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<Family>,
    /// Cost of each kind of operation.
    pub coefficients: Coefficients,
    /// Share of the shorter of reads of textures and the rest that hides behind the longer: 0 for their sum, 1 for the longer one alone.
    pub hidden: f64,
    /// Kinds of operations that no row had: their coefficients are derived from that of a wide read.
    pub assumed: Vec<String>,
    /// Quality of the fit.
    pub fit: FitQuality,
}

/// The measurement behind a fit.
#[derive(Debug, Clone)]
pub struct FitSource {
    /// Program and version.
    pub generator: String,
    /// Short name of the device.
    pub name: String,
    /// The device, in the words of its driver.
    pub device: String,
    /// Driver and version.
    pub driver: String,
    /// Unit of the times.
    pub unit: CostUnit,
    /// The measurement, in words.
    pub source: String,
    /// The family whose compiler counted, where one did.
    pub family: Option<Family>,
}

impl DeviceCost {
    /// The costs that meet some times best: not negative, with the least sum of squared relative errors. Times that are not positive are left out: the noise of
    /// a clock may be larger than a short shader.
    ///
    /// A fetch of a texel that no row has costs as much as a wide read, and a read of a buffer a sixth of it. On an NVIDIA H200 five reads of 16 bytes from a
    /// buffer added 2.2 ps to a shader, and five wide reads alone took 13.9 ps.
    ///
    /// # Errors
    /// [`CostError::Fit`] for fewer rows than kinds of operations.
    pub fn fitted(source: FitSource, rows: &[Timing]) -> Result<Self, CostError> {
        let kept = rows.iter().filter(|row| row.time.is_finite() && row.time > 0.0);
        let (given, rows): (usize, &[Timing]) = (rows.len(), &kept.cloned().collect::<Vec<_>>());
        if rows.len() < KINDS {
            let hint = match given - rows.len() {
                0 => String::new(),
                count => format!("; {count} more took no longer than the harness: raise the number of evaluations"),
            };
            return Err(CostError::Fit(format!("{} shaders are too few to fit {KINDS} numbers to{hint}", rows.len())));
        }
        let Numbers { values, hidden } = fit::numbers(&rows.iter().collect::<Vec<_>>());
        let mut values = values.map(rounded);
        let quality =
            FitQuality { left_out: (given - rows.len()) as u32, ..fit::quality(rows, &Numbers { values, hidden }) };
        let mut assumed = Vec::new();
        for (kind, share) in [(2, 1.0), (4, 1.0 / 6.0)] {
            if rows.iter().all(|row| row.counts.values()[kind] == 0) {
                values[kind] = rounded(share * values[1]);
                assumed.push(StaticCounts::NAMES[kind].to_owned());
            }
        }
        let FitSource { generator, name, device, driver, unit, source, family } = source;
        let coefficients = Coefficients::of_values(values);
        Ok(Self {
            schema: SCHEMA,
            generator,
            name,
            device,
            driver,
            unit,
            source,
            family,
            coefficients,
            hidden,
            assumed,
            fit: quality,
        })
    }

    /// Cost of an evaluation with some counts, in [`Self::unit`].
    pub fn cost(&self, counts: &StaticCounts) -> f64 {
        Numbers { values: self.coefficients.values(), hidden: self.hidden }.cost(counts)
    }

    /// Whether 16 bytes of a buffer, turned into four values on the way between two others, cost less than a filtered read of four halves. Only
    /// times tell: a compiler counts both reads as an instruction, and sees the arithmetic of the first alone.
    ///
    /// ```
    /// use luthier_cost::DeviceCost;
    ///
    /// let devices = ["h100", "llvmpipe", "rdna2"].map(|name| DeviceCost::shipped(name).unwrap());
    /// // A program on the CPU was timed, too, and reads buffers more slowly than textures; nothing was timed on rdna2.
    /// assert_eq!(devices.map(|costs| costs.has_cheap_buffers()), [true, false, false]);
    /// ```
    pub fn has_cheap_buffers(&self) -> bool {
        let Coefficients { wide_reads, buffer_reads, plain, .. } = self.coefficients;
        self.unit == CostUnit::Picoseconds && buffer_reads + UNPACKED * plain < wide_reads
    }

    /// Names of the devices whose costs ship.
    pub fn names() -> impl Iterator<Item = &'static str> {
        SHIPPED.into_iter().map(|(name, _)| name)
    }

    /// The shipped costs of a device; `None` for an unknown name.
    pub fn shipped(name: &str) -> Option<Self> {
        // A test reads all of them.
        SHIPPED.into_iter().find(|(known, _)| *known == name).and_then(|(_, text)| Self::parse(text).ok())
    }

    /// Costs from the text of a file.
    ///
    /// # Errors
    /// [`CostError::Exchange`] for a text that is no such file, [`CostError::Fit`] for another schema, and for coefficients that are negative or not finite.
    pub fn parse(text: &str) -> Result<Self, CostError> {
        let costs: Self = serde_json::from_str(text)?;
        if costs.schema != SCHEMA {
            return Err(CostError::Fit(format!("costs of schema {} are not read, only of {SCHEMA}", costs.schema)));
        }
        let values = costs.coefficients.values();
        if !(0.0..=1.0).contains(&costs.hidden) {
            return Err(CostError::Fit("the share that hides is not between 0 and 1".to_owned()));
        }
        if values.iter().any(|c| !(c.is_finite() && *c >= 0.0)) || values.iter().all(|c| *c == 0.0) {
            return Err(CostError::Fit("costs are not negative, and not all 0".to_owned()));
        }
        Ok(costs)
    }

    /// The file, as JSON.
    ///
    /// # Errors
    /// [`CostError::Exchange`], should a value have no JSON.
    pub fn to_json(&self) -> Result<String, CostError> {
        Ok(format!("{}\n", serde_json::to_string_pretty(self)?))
    }

    /// Device and unit in a few words, for texts that have its costs.
    pub fn label(&self) -> String {
        let unit = match self.unit {
            CostUnit::Picoseconds => "picoseconds an evaluation",
            CostUnit::Cycles => "cycles per wave of 64",
        };
        format!("{unit} on {} ({})", self.name, self.device)
    }

    /// The fit in lines: coefficients, and how well they meet the times.
    pub fn to_text(&self) -> String {
        let mut out = format!("{} ({}, {}): {}\n", self.name, self.device, self.driver, self.source);
        for (name, value) in StaticCounts::NAMES.iter().zip(self.coefficients.values()) {
            let mark = if self.assumed.iter().any(|kind| kind == name) { ", assumed: no shader has any" } else { "" };
            out.push_str(&format!("  {name:<15} {value:>10.4} {}{mark}\n", self.unit));
        }
        out.push_str(&format!(
            "  hidden          {:>10.2} of the shorter of reads of textures and the rest\n",
            self.hidden
        ));
        let FitQuality { rows, left_out, own, without_material, without_model, counts_alone } = &self.fit;
        let mut line = |what: &str, misfit: &fit::Misfit| {
            out.push_str(&format!(
                "  {what:<38} median {:>5.1} %, largest {:>6.1} %, pairs in order {:>5.1} %\n",
                100.0 * misfit.median,
                100.0 * misfit.largest,
                100.0 * misfit.in_order
            ));
        };
        line(&format!("error on the {rows} shaders of the fit:"), own);
        if let Some(misfit) = without_material {
            line("on materials that it has not seen:", misfit);
        }
        if let Some(misfit) = without_model {
            line("on models that it has not seen:", misfit);
        }
        line("of counts alone, on such models:", counts_alone);
        if *left_out > 0 {
            out.push_str(&format!("  {left_out} more shaders took no longer than the harness, and were left out.\n"));
        }
        if !self.fit.is_better_than_counts() {
            out.push_str("  The fit is not better than the counts alone.\n");
        }
        out
    }
}

/// Four digits: more say nothing, and make files that differ for no reason.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shipped_files_are_whole_and_named_as_their_devices() {
        for (name, text) in SHIPPED {
            let costs = DeviceCost::parse(text).unwrap();
            assert_eq!(costs.name, name);
            assert_eq!(DeviceCost::parse(&costs.to_json().unwrap()).unwrap(), costs);
            assert_eq!(costs.family.map(Family::name), (costs.unit == CostUnit::Cycles).then_some(name));
        }
        assert!(DeviceCost::shipped(DEFAULT_DEVICE).is_some() && DeviceCost::shipped("abacus").is_none());
    }

    #[test]
    fn files_that_are_no_costs_are_refused() {
        let [(_, text), ..] = SHIPPED;
        for (from, to, part) in [
            ("\"schema\": 1", "\"schema\": 2", "schema 2"),
            ("\"plain\": ", "\"plain\": -", "not negative"),
            ("\"unit\": \"ps\"", "\"unit\": \"pounds\"", "pounds"),
        ] {
            assert!(text.contains(from));
            let error = DeviceCost::parse(&text.replace(from, to)).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn too_few_rows_and_times_below_the_harness_are_refused() {
        let source = FitSource {
            generator: String::new(),
            name: "toy".to_owned(),
            device: String::new(),
            driver: String::new(),
            unit: CostUnit::Picoseconds,
            source: String::new(),
            family: None,
        };
        let row = |time| Timing {
            material: "a".to_owned(),
            model: "b".to_owned(),
            counts: StaticCounts { plain: 3, ..StaticCounts::default() },
            time,
        };
        let few = DeviceCost::fitted(source.clone(), &[row(1.0)]).unwrap_err();
        assert!(few.to_string().contains("too few"), "{few}");
        let mut rows = vec![row(1.5); 8];
        let costs = DeviceCost::fitted(source.clone(), &rows).unwrap();
        assert_eq!((costs.coefficients.plain, costs.assumed.len()), (0.5, 2));
        rows.push(row(-0.1));
        let costs = DeviceCost::fitted(source.clone(), &rows).unwrap();
        assert_eq!((costs.coefficients.plain, costs.fit.rows, costs.fit.left_out), (0.5, 8, 1));
        let few = DeviceCost::fitted(source, &rows[5..]).unwrap_err().to_string();
        assert!(few.contains("3 shaders are too few") && few.contains("1 more took no longer"), "{few}");
    }
}
