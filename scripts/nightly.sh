#!/usr/bin/env bash
# Checks that take too long for every change, and a page with their results: docs/pages/nightly.md.
#   scripts/nightly.sh            all: an hour and a half on two cores; scripts/pages.sh makes the long pages
#   scripts/nightly.sh STEP...    some, by the names of the functions below
#   scripts/nightly.sh --check    lists the steps that are out of date, and fails where a cheap one is, or where a row was not written by a run
#   scripts/nightly.sh --page     writes the page anew, from the rows
# A step is out of date when anything that it depends on is not as it was when the step passed. It runs on what is committed: where the work
# tree differs there, it is refused. Wants what scripts/test.sh installs, GNU time, a C++ compiler (Debian: g++), and the packages that
# scripts/farm/*.sh, scripts/mitsuba.sh and scripts/other-architecture.sh name.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/steps.sh
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

steps=(tests random fuzz release examples c bevy babylon playcanvas materialx godot engines formats kind packages installed promises python mitsuba scale crash farm gpu book)
# By its name only, because an emulator takes half an hour.
named=(architecture)
# Steps that take less than a minute of a processor: they are kept up to date with every change.
cheap=(book)
declare -A says=(
  [tests]='tests that are ignored elsewhere: the whole stability suite, and audits of tables with planted mistakes'
  [random]='property tests with new random seeds'
  [fuzz]='ten minutes of search for inputs that bring a parser down (`docs/fuzzing.md`)'
  [release]='release builds write the bytes of debug builds, and name the Cargo feature of a verb that they lack'
  [examples]='the renderers in `examples` show the shipped tables, in a browser too'
  [c]='C programs read bakes and faulty files, their ball in OpenGL is that of `preview`, and fragment shaders around baked texts in Vulkan GLSL and HLSL draw it, too'
  [bevy]='the crate for Bevy draws the balls of `luthier preview`, shadows and fog, and a bake that is written anew'
  [babylon]='the package for Babylon.js draws the balls of `luthier preview` in a browser, by WebGL 2 and by WebGPU'
  [playcanvas]='the package for PlayCanvas draws the balls of `luthier preview` in a browser, by WebGL 2 and by WebGPU'
  [materialx]='MaterialX generates shaders of a bake as a library of nodes for all its targets, glslang compiles them, and one draws the balls of `luthier preview`'
  [godot]='the addon for Godot draws the balls of `luthier preview`'
  [engines]='three.js and Babylon.js read the tables of `luthier table`, in furnaces in a browser'
  [formats]='the validator of Khronos and the libraries of MaterialX find no fault in exported materials, and Blender draws those that glTF says well as luthier does'
  [kind]='a kind of table is added by the six files of CONTRIBUTING.md, and a reflectance model by a folder and a row; both are baked and judged'
  [packages]='every crate is packed, and built from its package'
  [installed]='`cargo install` makes the program from the packed crates with an empty cargo home, and a static one tells the verbs that it lacks by exit code 4'
  [promises]='every crate compiles with the Rust that Cargo.toml states, and `luthier` keeps the interface of the last tag'
  [python]='the wheel of the Python module installs in a new environment, and its notebook, examples and tests run there'
  [mitsuba]='the plugin for Mitsuba 3 passes its chi-square test, returns the albedo in a white furnace, and draws the ball of `luthier preview --simulated`'
  [crash]='bakes are killed at every call that changes files and at random moments, interrupted, run side by side, and given faulty files'
  [scale]='libraries of 100 and 1,000 generated materials are baked'
  [farm]='Slurm, Ninja, CMake and Make bake shares and merge them, a Slurm node is killed, jobs for Kubernetes and OpenCue are checked, and machines share a store of the S3 protocol that lies, refuses and is gone'
  [gpu]='the programs that measure on a GPU are packed, and run on the software adapter out of sight of the sources'
  [book]='mdBook builds the book of `docs/`; tests of every change follow its links, samples and tutorial'
  [architecture]='a program for aarch64, emulated, writes the bytes of one for x86-64'
)

# What each depends on, beside its function below: paths of the repository, and crates. `crate:NAME` is a crate with those that it uses, `lean:NAME`
# without those that only features bring, both without their tests; `tests:WORD` the crates whose sources have the word, with their tests, and
# those that these use. What is compiled depends on the versions of other crates, too.
built='Cargo.toml Cargo.lock .cargo'
# What examples in a browser share, and the three that are compared with each other.
browsers='examples/wgpu examples/three examples/plain-webgl examples/web examples/scene.json examples/browser.mjs scripts/patience.mjs'
declare -A reads=(
  [tests]="tests:#\\[ignore materials docs/measurements/stability.json $built"
  [random]="tests:proptest! materials tests/broken tests/broken-surfaces scripts/random-tests.sh $built"
  [fuzz]="crate:luthier-fuzz materials tests/broken tests/broken-surfaces scripts/fuzz.sh $built"
  [release]="crate:luthier-cli materials $built"
  [examples]="lean:luthier-cli lean:luthier-build crates/luthier-material/examples materials $browsers scripts/run-examples.sh $built"
  [c]="lean:luthier-cli materials examples/c examples/shaders scripts/c-host.sh $built"
  [bevy]="lean:luthier-cli crate:luthier-manifest materials examples/bevy scripts/bevy.sh $built"
  [babylon]="lean:luthier-cli materials examples/babylon examples/web examples/browser.mjs scripts/babylon.sh scripts/patience.mjs $built"
  [playcanvas]="lean:luthier-cli materials examples/playcanvas examples/web examples/browser.mjs scripts/playcanvas.sh scripts/patience.mjs $built"
  [materialx]="lean:luthier-cli materials examples/materialx examples/c/difference.py scripts/materialx.sh $built"
  [godot]="lean:luthier-cli materials examples/godot examples/web/difference.mjs examples/web/workshop.mjs scripts/godot.sh $built"
  [engines]="crate:luthier-table crate:luthier-texture crates/luthier-cli/src scripts/engines scripts/patience.mjs $built"
  [formats]="crate:luthier-gpu lean:luthier-cli materials examples/materialx/tables.py examples/mitsuba/sky.py scripts/formats.sh scripts/formats $built"
  [kind]="lean:luthier-cli lean:luthier-gpu scripts/add-kind.sh scripts/add-kind.patch scripts/add-model.sh scripts/add-model.patch scripts/patched.sh $built"
  [packages]="crates README.md scripts/package.sh $built"
  [installed]="crates README.md scripts/package.sh scripts/installed.sh $built"
  [promises]="crates scripts/promises.sh $built"
  [python]="crate:luthier-python crates/luthier-python lean:luthier-cli materials scripts/python.sh $built"
  [mitsuba]="crate:luthier-python crates/luthier-python crate:luthier-gpu lean:luthier-cli examples/mitsuba scripts/mitsuba.sh $built"
  [scale]="lean:luthier-cli crates/luthier-material/examples scripts/many.sh $built"
  [crash]="lean:luthier-cli tests/crash $built"
  [farm]="lean:luthier-cli materials examples/farm scripts/farm $built"
  [gpu]="lean:luthier-cli crate:luthier-lab crates/luthier-gpu crates/luthier-material/examples materials scripts/gpu.sh $built"
  [book]="docs scripts/book.sh"
  [architecture]="lean:luthier-cli materials scripts/other-architecture.sh $built"
)

# released SCRIPT OPTION...: with the program of a release build.
released() {
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier "./$1" "${@:2}"
}
tests() { CI=true cargo test --locked --workspace --features luthier-cli/view --tests -- --ignored; }
random() { ./scripts/random-tests.sh 1; }
fuzz() { ./scripts/fuzz.sh 600; }
release() {
  local work said
  work=$(mktemp -d)
  cargo build --locked --release -p luthier-cli
  cargo build --locked --workspace --features luthier-cli/view
  said=$(./target/release/luthier view 2>&1) && return 1
  grep -q -- '--features view' <<<"$said"
  for profile in debug release; do
    "./target/$profile/luthier" bake materials --out "$work/$profile" --quiet 2>/dev/null
  done
  diff -r "$work/debug" "$work/release"
  rm -rf "$work"
}
examples() { released scripts/run-examples.sh; }
# host NAME SCRIPT: what it says is what scripts/hosts.sh makes its page of.
host() {
  mkdir -p target/hosts
  released "$2" | tee "target/hosts/$1.log"
}
c() { host c scripts/c-host.sh; }
bevy() { host bevy scripts/bevy.sh; }
babylon() { host babylon scripts/babylon.sh; }
playcanvas() { host playcanvas scripts/playcanvas.sh; }
materialx() { host materialx scripts/materialx.sh; }
godot() { host godot scripts/godot.sh; }
engines() { released scripts/engines/furnace.sh; }
formats() { released scripts/formats.sh; }
kind() { ./scripts/add-kind.sh && ./scripts/add-model.sh; }
book() { ./scripts/book.sh; }
packages() { ./scripts/package.sh --verify; }
installed() { ./scripts/installed.sh; }
promises() { ./scripts/promises.sh; }
python() { released scripts/python.sh --install; }
mitsuba() { released scripts/mitsuba.sh; }
crash() { released tests/crash/all.sh; }
scale() { ./scripts/many.sh 100 1000 >/dev/null; }
farm() {
  cargo build --locked --release -p luthier-cli
  for script in slurm builds descriptions; do LUTHIER=$PWD/target/release/luthier "./scripts/farm/$script.sh"; done
  ./scripts/farm/s3.sh
}
# The profile of the tests, which is built already, and as fast.
gpu() { ./scripts/gpu.sh try dev; }
architecture() { released scripts/other-architecture.sh; }

rows=docs/measurements/nightly.tsv
page=docs/pages/nightly.md
# What steps write down, on which none depends.
own=("$rows" "$page" docs/pages/scale.md docs/fuzzing.md docs/measurements/fuzzing.tsv)
but_own=("${own[@]/#/:!}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# crates COMMIT ALL NAME...: some crates and those that they use; with ALL=no without those that only features bring.
crates() {
  local commit=$1 all=$2 list=$work/uses-$1
  [ -e "$list" ] || git grep -E '^(\[|luthier-)' "$commit" -- 'crates/*/Cargo.toml' | cut -d: -f2- >"$list"
  shift 2
  awk -v start="$*" -v all="$all" '
    { split($0, at, "/"); line = substr($0, index($0, ":") + 1); crate = at[2] }
    line ~ /^\[/ { on = line ~ /dependencies/ && line !~ /dev-dependencies/; next }
    on && (all == "yes" || line !~ /optional *= *true/) { match(line, /^[a-z-]+/); uses[crate] = uses[crate] " " substr(line, 1, RLENGTH) }
    END {
      count = split(start, queue, " ")
      for (i = 1; i <= count; i++) {
        if (seen[queue[i]]++) continue
        print queue[i]
        found = split(uses[queue[i]], next_ones, " ")
        for (j = 1; j <= found; j++) queue[++count] = next_ones[j]
      }
    }' "$list" | sort -u
}
# sources COMMIT CRATE...: what of crates a program is made of.
sources() {
  local commit=$1
  shift
  git ls-tree --name-only "$commit" $(printf 'crates/%s/ ' "$@") | grep -vE '/(tests|benches|examples|proptest-regressions|README\.md)$'
}
# paths COMMIT STEP: all that a step depends on, one to a line.
paths() {
  [ -e "$work/$1-$2" ] || list "$@" >"$work/$1-$2"
  cat "$work/$1-$2"
}
list() {
  local commit=$1 word found
  set -f
  for word in ${reads[$2]}; do
    case $word in
      crate:*) sources "$commit" $(crates "$commit" yes "${word#*:}") ;;
      lean:*) sources "$commit" $(crates "$commit" no "${word#*:}") ;;
      tests:*)
        found=$(git grep -l -e "${word#*:}" "$commit" -- 'crates/*.rs' | cut -d/ -f2 | sort -u)
        printf 'crates/%s\n' $found
        sources "$commit" $(crates "$commit" yes $found)
        ;;
      *) echo "$word" ;;
    esac
  done
  set +f
}
# key COMMIT STEP: a name for the state of all that a step depends on.
key() {
  local list
  mapfile -t list < <(paths "$@")
  { declare -f "$2"; git ls-tree -r "$1" -- "${list[@]}" | grep -vE "	($(IFS='|' && echo "${own[*]}"))\$"; } | sha256sum | cut -c1-16
}
# changed STEP: files in the work tree that are not as in the last commit, among those that a step depends on.
changed() {
  local list
  mapfile -t list < <(paths HEAD "$1")
  git status --porcelain -- "${list[@]}" "${but_own[@]}"
}
# behind COMMIT STEP: commits since then that changed what the step depends on.
behind() {
  local list
  mapfile -t list < <(paths HEAD "$2")
  git rev-list --count "$1..HEAD" -- "${list[@]}" "${but_own[@]}"
}
known() { git cat-file -e "$1^{commit}" 2>/dev/null; }

# A row has the step, its key, the commit, seconds of processor time, the day, and the hash of its log, which stays in target/nightly/. The last
# word is the hash of the others: who changes a row by hand is seen.
seal() { printf '%s' "$1" | sha256sum | cut -c1-16; }
row() { grep "^$1	" "$rows" || true; }

# Paths that are not there are mistakes of this file.
for step in "${steps[@]}" "${named[@]}"; do
  for path in ${reads[$step]}; do
    case $path in
      tests:*) continue ;;
      *:*) path=crates/${path#*:} ;;
    esac
    git cat-file -e "HEAD:$path" 2>/dev/null && continue
    echo "error: the nightly step \`$step\` depends on $path, which is not in the last commit" >&2
    exit 1
  done
done

check() {
  local step key commit seconds day log sealed was failed=0 line stale=0
  while IFS= read -r line; do
    if [ "${line##*	}" != "$(seal "${line%	*}")" ]; then
      echo "error: no run wrote the row of the nightly step \`${line%%	*}\` in $rows"
      failed=1
    fi
  done <"$rows"
  for step in "${steps[@]}"; do
    IFS=$'\t' read -r _ key commit seconds day log sealed <<<"$(row "$step")"
    was="has not passed since its row began"
    if [ -n "$key" ]; then
      # The key must be that of the commit, too, where the commit is in this history.
      if [ "$(key HEAD "$step")" = "$key" ] && { ! known "$commit" || [ "$(key "$commit" "$step")" = "$key" ]; }; then continue; fi
      was="passed at $commit, which is not in this history"
      ! known "$commit" || was="passed at $commit, $(behind "$commit" "$step") changes ago"
    fi
    stale=1
    case " ${cheap[*]} " in
      *" $step "*) failed=1 && echo "error: the nightly step \`$step\` $was; run scripts/nightly.sh $step and commit $rows and $page" ;;
      *) echo "out of date: the nightly step \`$step\` $was" ;;
    esac
  done
  [ $stale = 1 ] || echo "every nightly step has passed on what it depends on"
  return $failed
}

write() {
  cat <<HEAD
# Nightly checks

\`scripts/nightly.sh\` writes this page. Each step takes too long for every change. It is out of date when anything that it depends on has
changed since it passed: the key stands for all of that, \`crate:\` for a crate with those that it uses and \`lean:\` for the same without those
that only features bring. Seconds are of processor time. The last column counts the commits since then, up to \`$(git rev-parse --short=12 HEAD)\`, that changed
what the step depends on. The tests list steps that are out of date, and fail for those of less than a minute (\`$(IFS=' ' && echo "${cheap[*]}")\`). They also fail where a row of
\`$rows\` was not written by a run.

| step | check | depends on | seconds | passed on | at | key | changes since |
|---|---|---|--:|---|---|---|--:|
HEAD
  local step key commit seconds day changes
  for step in "${steps[@]}" "${named[@]}"; do
    IFS=$'\t' read -r _ key commit seconds day _ <<<"$(row "$step")"
    changes=-
    if [ -n "$commit" ] && known "$commit"; then changes=$(behind "$commit" "$step"); fi
    printf '| `%s` | %s | %s | %s | %s | %s | %s | %s |\n' "$step" "${says[$step]}" "\`${reads[$step]// /\` \`}\`" "${seconds:--}" "${day:-never}" \
      "${commit:+\`$commit\`}" "${key:+\`$key\`}" "$changes"
  done
}

# run STEP: runs it, and writes its row.
run() {
  local step=$1 commit key log=target/nightly/$1.log fresh
  if [ -n "$(changed "$step")" ]; then
    echo "error: the nightly step \`$step\` runs on what is committed; these differ:"
    changed "$step"
    return 1
  fi
  commit=$(git rev-parse --short=12 HEAD)
  key=$(key "$commit" "$step")
  sed -i "/^$step	/d" "$rows"
  mkdir -p target/nightly
  ("$step") 2>&1 | tee "$log"
  times >"$work/times"
  if [ -n "$(changed "$step")" ] || [ "$(key HEAD "$step")" != "$key" ]; then
    echo "error: what the nightly step \`$step\` depends on has changed while it ran:"
    changed "$step"
    return 1
  fi
  # Of the second line, user and system time of all that this shell has run: `0m0.123s 0m0.456s`.
  fresh=$(printf '%s\t%s\t%s\t%s\t%s\t%s' "$step" "$key" "$commit" "$(awk -F'[ms ]+' 'NR == 2 { printf "%.0f", 60 * ($1 + $3) + $2 + $4 }' "$work/times")" \
    "$(date -u +%F)" "$(sha256sum <"$log" | cut -c1-16)")
  printf '%s\t%s\n' "$fresh" "$(seal "$fresh")" >>"$rows"
}

touch "$rows"
case ${1-} in
  --check) check && exit || exit 1 ;;
  --page) write >"$page" && exit ;;
  "") chosen=("${steps[@]}") ;;
  *) chosen=("$@") ;;
esac
for step in "${chosen[@]}"; do
  [ -n "${reads[$step]-}" ] || { echo "error: there is no nightly step \`$step\`; there are ${steps[*]} ${named[*]}" >&2; exit 2; }
done
for step in "${chosen[@]}"; do attempt "$step" run "$step"; done
write >"$page"
summary
