//! Machine code as text, line by line.

use crate::Family;

/// Mnemonics of instructions that issue at a quarter of the rate.
const QUARTER_RATE: [&str; 11] = [
    "v_rcp_",
    "v_rsq_",
    "v_sqrt_",
    "v_exp_",
    "v_log_",
    "v_sin_",
    "v_cos_",
    "v_mul_lo_u32",
    "v_mul_hi_u32",
    "v_mul_hi_i32",
    "v_mad_u64_u32",
];

/// Counts from the text of a kernel.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Code {
    /// Vector instructions at full rate.
    pub(crate) plain: i64,
    /// Vector instructions at a quarter of it.
    pub(crate) quarter_rate: i64,
    pub(crate) texture_reads: i64,
    pub(crate) buffer_reads: i64,
}

impl Code {
    /// Counts mnemonics. A line `(then repeated N times)` stands for N more of the line above it.
    pub(crate) fn of(assembly: &str) -> Self {
        let mut code = Self::default();
        let mut mnemonic = "";
        for line in assembly.lines().map(str::trim_start) {
            let repeated = line.strip_prefix("(then repeated ").and_then(|rest| rest.split(' ').next()?.parse().ok());
            let times = repeated.unwrap_or_else(|| {
                mnemonic = line.split_whitespace().next().unwrap_or_default();
                1
            });
            *match mnemonic {
                m if QUARTER_RATE.iter().any(|name| m.starts_with(name)) => &mut code.quarter_rate,
                m if m.starts_with("v_") => &mut code.plain,
                m if ["image_sample", "image_load", "image_gather"].iter().any(|name| m.starts_with(name)) => {
                    &mut code.texture_reads
                }
                m if ["s_buffer_load", "buffer_load", "global_load"].iter().any(|name| m.starts_with(name)) => {
                    &mut code.buffer_reads
                }
                _ => continue,
            } += times;
        }
        code
    }

    pub(crate) fn issue_cycles(&self, family: Family) -> i64 {
        family.issue_cycles(self.plain, self.quarter_rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINES: &str = "BB0:
\tv_rsq_f32_e32 v9, v6 ; 7e126706
\tv_mul_f32_e32 v5, v5, v8
\t(then repeated 3 times)
\ts_buffer_load_dwordx4 s[12:15], s[8:11], s12
\timage_sample_lz v[11:13], v[12:13], s[24:31], s[20:23] dmask:0x7
\ts_endpgm
";

    #[test]
    fn mnemonics_are_counted_with_their_repeats() {
        let code = Code::of(LINES);
        assert_eq!(code, Code { plain: 4, quarter_rate: 1, texture_reads: 1, buffer_reads: 1 });
        assert_eq!(Family::ALL.map(|family| code.issue_cycles(family)), [32, 10, 10]);
    }
}
