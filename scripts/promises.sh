#!/usr/bin/env bash
# Two promises of Cargo.toml: the oldest Rust that compiles every crate (`rust-version`), and the interface of the crates that programs use, which keeps
# what it had at the tag of the last release until the version says otherwise (cargo-semver-checks). Wants that toolchain (rustup toolchain install
# 1.95.0) and, where there is a tag, `cargo install cargo-semver-checks --locked`.
set -euo pipefail
cd "$(dirname "$0")/.."

oldest=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
echo "== every crate with Rust $oldest"
# The window, too. Tests may need a later Rust.
cargo "+$oldest.0" check --locked --workspace --features luthier-cli/view

# Programs in Rust use these; the others are parts of the command, whose interface is its options and the manifest. The tool sees that an item of another
# crate is given on, and not how that item changes: the examples of the library, which are tests, use those.
crates=(luthier luthier-build)
tag=$(git tag --list 'v[0-9]*' '[0-9]*' --sort=-version:refname | head -n 1)
echo "== the interface of ${crates[*]} since ${tag:-the last release}"
if [ -z "$tag" ]; then
  echo "there is no tag of a release to compare with"
  exit
fi
# A crate that is new since then has nothing to keep.
for crate in "${crates[@]}"; do
  git cat-file -e "$tag:crates/$crate/Cargo.toml" 2>/dev/null || { echo "$crate is new" && continue; }
  cargo semver-checks --package "$crate" --baseline-rev "$tag"
done
