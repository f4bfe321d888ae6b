#!/bin/sh
# Compares split-sum tables of luthier with those of the crate forge-ibl-bake and prints a Markdown page:
#   ./scripts/bench-dfg.sh > docs/pages/dfg.md
# Takes a minute after the first build, which fetches that crate. Times are processor time of one thread.
set -eu
cd "$(dirname "$0")/.."

# Without --locked: crates of luthier may have come to need others since the lock file was written.
cargo build --release --quiet --manifest-path scripts/bench-dfg/Cargo.toml

cpu=$(sed -n 's/^model name[[:space:]]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1)
[ -n "$cpu" ] || cpu=$(sysctl -n machdep.cpu.brand_string 2>/dev/null) || cpu=$(uname -m)

cat <<TEXT
# Split sums: time and error

Made by \`scripts/bench-dfg.sh > docs/pages/dfg.md\`, in one run. $cpu; $(rustc --version); profile \`release\`.

The other baker is the crate \`forge-ibl-bake\` 0.1.0: importance sampling in f32, with Schlick's fit of Smith's masking, k = alpha/2.
Its table is compared with that function, not with another masking term. luthier integrates by quadrature and interpolates a polynomial.

Times are processor time of one thread. Bakes take turns; *times as fast* is the median over the rounds of the ratio within a round.
Errors as sampled are those of reads, bilinear with weights of 8 bits, over cos_theta >= 0.01 and alpha >= 0.01: the largest, the 99th
percentile, the root mean square. Axes have their nodes at texel centres, or in rows that give a range at the ends of that range.

TEXT

scripts/bench-dfg/target/release/luthier-bench-dfg
