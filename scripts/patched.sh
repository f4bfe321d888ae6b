# Sourced by scripts that walk steps of CONTRIBUTING.md: `patched NAME [FLAG...]` applies scripts/NAME.patch to a copy of the last commit, in the
# folder $work; `luthier ARGUMENT...` then builds the command of that copy, with these flags for cargo, and runs it.

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

patched() {
  name=$1
  flags=("${@:2}")
  git archive HEAD | tar -x -C "$work"
  patch --directory "$work" --strip 1 --quiet <"scripts/$name.patch"
}

luthier() {
  cargo run --quiet --locked --manifest-path "$work/Cargo.toml" --target-dir "target/$name" -p luthier-cli "${flags[@]}" -- "$@"
}
