#!/bin/sh
# Fetches the vendored browser libraries again, at the newest release of each; needs npm and a registry.
# Afterwards: write the printed versions into README.md and run the browser tests.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

unpack() {
  npm pack --silent "$1" >/dev/null
  mkdir "$1" && tar xzf "$1"-*.tgz -C "$1" --strip-components=1
  echo "$1 $(sed -n 's/^ *"version": "\(.*\)",*$/\1/p' "$1/package.json" | head -n 1)"
}

# Browsers resolve only relative module names without an import map, and a source map that is not there is a 404.
module() {
  sed -e 's#from *"preact"#from"./preact.mjs"#' -e '/^\/\/# sourceMappingURL=/d' "$1" >"$2"
}

for package in preact htm uplot; do unpack "$package"; done
module preact/dist/preact.mjs "$here/preact/preact.mjs"
module preact/hooks/dist/hooks.mjs "$here/preact/hooks.mjs"
cp preact/LICENSE "$here/preact/LICENSE"
module htm/dist/htm.mjs "$here/htm/htm.mjs"
cp htm/LICENSE "$here/htm/LICENSE"
module uplot/dist/uPlot.esm.js "$here/uplot/uPlot.esm.js"
cp uplot/dist/uPlot.min.css uplot/LICENSE "$here/uplot/"
