#!/bin/sh
# Times every evaluation and prints a Markdown table: ./scripts/bench-table.sh > docs/pages/speed.md
# Takes half a minute to two. Other work on the machine shows as spread, and in the rows of milliseconds as time.
set -eu
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cargo bench --locked -p luthier-optics -p luthier-layers --bench optics --bench models --bench layered_mc > "$work/benches"

cpu=$(sed -n 's/^model name[[:space:]]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1)
[ -n "$cpu" ] || cpu=$(sysctl -n machdep.cpu.brand_string 2>/dev/null) || cpu=$(uname -m)

cat <<TEXT
# Speed of the evaluations in f64

Made by \`scripts/bench-table.sh > docs/pages/speed.md\`. One thread; $cpu; $(rustc --version); profile \`bench\`.

Each row is a benchmark. *Median* and *fastest* are those of its samples, in nanoseconds per call. *Spread* is the mean of the samples over
the fastest. *Phong* is the median over that of \`functions/bare_conductor/phong\` in the same run. All models, Phong's too, compute their
coefficients from the stack at every call. A call takes the next of 1024 pseudo-random pairs of directions, both uniform on the
hemisphere. The row \`loop\` is the cost of taking that pair, and is part of every other row. Only the samples of the quickest benchmarks
go through all pairs. The spread of the slower ones includes that between directions.

Stacks: \`bare_conductor\` is rough gold; \`coated_conductor\` is rough gold under a rough coat that absorbs; \`film_slab_diffuse\` is that
coat with a film on it, over a rough diffuse base. \`functions\` are values at one wavelength, \`spectral\` colours from 95
wavelengths, \`estimates\` values at 4096 samples. In \`layered_mc\` a call is one path (\`paths\`) or one sample of a value
(\`values\`), and the arguments are alpha of the coat and the mode.
TEXT

awk '
  # Nanoseconds from a cell such as "12.3 us"; per item from "4.5 Mitem/s".
  function ns(cell,  part, scale) {
    split(cell, part, " ")
    if (part[2] ~ /item\/s$/) {
      scale = part[2]; sub(/item\/s$/, "", scale)
      return 1e9 / (part[1] * (scale == "G" ? 1e9 : scale == "M" ? 1e6 : scale == "K" ? 1e3 : 1))
    }
    return part[1] * (part[2] == "ps" ? 1e-3 : part[2] == "ns" ? 1 : part[2] == "us" ? 1e3 : part[2] == "ms" ? 1e6 : 1e9)
  }
  function cells(text,  part) {
    split(text, part, "|")
    fastest[rows] = ns(part[1]); median[rows] = ns(part[3]); mean[rows] = ns(part[4])
  }
  function number(x) {
    return sprintf(x < 10 ? "%.2f" : x < 1000 ? "%.1f" : "%.0f", x)
  }
  {
    gsub(/│/, "|"); gsub(/├─|╰─/, "+-"); gsub(/µ/, "u")
  }
  # A table begins: its bench and the names of the columns.
  / fastest +\| slowest +\| median / { bench = $1; next }
  # A branch of the tree, three characters per level, with or without values.
  match($0, /^[| ]*\+- /) {
    depth = RLENGTH / 3
    text = substr($0, RLENGTH + 1)
    values = match(text, /  +[0-9.]+ (ps|ns|us|ms|s) /)
    name = values ? substr(text, 1, RSTART - 1) : text
    sub(/[ |]+$/, "", name)
    path[depth] = name
    if (!values) next
    full = path[1]
    for (i = 2; i <= depth; i++) full = full "/" path[i]
    rows++
    of[rows] = bench; label[rows] = full
    cells(substr(text, RSTART))
    if (full == "functions/bare_conductor/phong") phong = median[rows]
    next
  }
  # Where a bench counts items, they are its calls.
  /item\/s/ { sub(/^[| ]+/, ""); cells($0) }
  END {
    if (!phong) { print "no row functions/bare_conductor/phong" > "/dev/stderr"; exit 1 }
    for (r = 1; r <= rows; r++) {
      if (of[r] != of[r - 1])
        printf "\n## %s\n\n| evaluation | median ns | fastest ns | spread | phong |\n|---|--:|--:|--:|--:|\n", of[r]
      ratio = median[r] / phong
      printf "| %s | %s | %s | %.2f | %s |\n", label[r], number(median[r]), number(fastest[r]),
        mean[r] / fastest[r], sprintf(ratio < 10 ? "%.2f" : ratio < 100 ? "%.1f" : "%.0f", ratio)
    }
  }
' "$work/benches"
