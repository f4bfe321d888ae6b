#!/usr/bin/env bash
# Builds the book from docs/ into out/book/, with mdBook. Without an mdBook of this version on the PATH, cargo builds one into target/mdbook/, once.
set -euo pipefail
cd "$(dirname "$0")/.."

version=0.5.4
mdbook=$(command -v mdbook || true)
if [ -z "$mdbook" ] || [ "$("$mdbook" --version)" != "mdbook v$version" ]; then
  mdbook=target/mdbook/bin/mdbook
  [ -x "$mdbook" ] && [ "$("$mdbook" --version)" = "mdbook v$version" ] ||
    cargo install --locked --quiet --root target/mdbook --version "$version" --no-default-features --features search mdbook
fi

"$mdbook" build docs
echo "out/book/index.html"
