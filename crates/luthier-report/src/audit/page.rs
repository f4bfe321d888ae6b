//! Text of an audit.

use luthier_lut::ErrorStats;

use super::{Audit, AuditVerdict, Candidate};
use crate::text::format::{error, number};

impl Audit {
    /// The verdict in a line: `as stated`, `fits better as: flipped in y, masking separable`, `fits nothing that was tried`.
    pub fn verdict_line(&self) -> String {
        match self.verdict {
            AuditVerdict::AsStated => "as stated".to_owned(),
            AuditVerdict::FitsBetterAs => {
                format!("fits better as: {}", self.candidates.first().map_or_else(String::new, words))
            }
            AuditVerdict::FitsNothing => "fits nothing that was tried".to_owned(),
        }
    }

    /// The whole outcome as text.
    pub fn to_text(&self) -> String {
        let mut out = format!("{}\n\n", self.verdict_line());
        out.push_str(&line("error as sampled, as stated", &self.stated));
        if let Some(remaining) = &self.remaining {
            out.push_str(&line("error that remains", remaining));
        }
        out.push_str(&format!(
            "  over cos_theta >= {}, alpha >= {}; bilinear, 8-bit weights\n",
            number(self.min_cos),
            number(self.min_alpha)
        ));
        for (count, what) in [(self.not_finite, "not finite"), (self.negative, "below 0")] {
            if count > 0 {
                out.push_str(&format!("{count} values {what}\n"));
            }
        }
        out.push_str("\nrms of texels  hypothesis\n");
        for candidate in &self.candidates {
            out.push_str(&format!("{:>13}  {}\n", error(candidate.rms), words(candidate)));
        }
        out
    }
}

fn words(candidate: &Candidate) -> String {
    let texts: Vec<&str> = candidate.mistakes.iter().map(|mistake| mistake.text.as_str()).collect();
    if texts.is_empty() { "as stated".to_owned() } else { texts.join(", ") }
}

fn line(what: &str, stats: &ErrorStats) -> String {
    let names = ["cos_theta", "alpha"];
    let at: Vec<String> = names.iter().zip(&stats.worst.at).map(|(name, v)| format!("{name} {}", number(*v))).collect();
    format!(
        "{what}: max {}, p99 {}, rms {}\n  worst at {}, channel {}: {} where {} belongs\n",
        error(stats.max_abs_err),
        error(stats.p99_abs_err),
        error(stats.rms_err),
        at.join(", "),
        stats.worst.channel,
        number(stats.worst.sampled),
        number(stats.worst.expected),
    )
}
