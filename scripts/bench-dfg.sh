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

cat <<TEXT

## Tables, closed forms, and tables beside forms

Made by \`cargo run --release -p luthier-table --example dfg_sizes\`: GGX with correlated masking, errors as sampled over cos_theta >= 0.01 and
alpha >= 0.01. Cells have the size, the bytes of texels and the operations of a look-up beside the fetch: a multiply-add or a clamp counts 1, a
division, root or exponential 4. Plain tables are half floats (\`luthier table dfg --max-abs\`); those beside a form, in as many bytes as the column
says, have two bytes a texel (\`--max-bytes\`, output .bin); the last column is a form alone (\`--closed\`). A dash: none holds.

| error | table | form, table <= 512 B | <= 1,024 B | <= 2,048 B | form |
|--:|--:|--:|--:|--:|--:|
TEXT
cargo run --quiet --release --locked -p luthier-table --example dfg_sizes
