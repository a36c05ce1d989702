#!/usr/bin/env bash
# The vendored browser libraries: copies of the packages that .ci/javascript/package-lock.json names, by version and hash.
#   update.sh            takes the newest release of each, and writes its version into the table of README.md
#   update.sh --locked   copies the locked versions again
#   update.sh --check    changes nothing; fails where a file here is not what its package gives
# Needs the project's environment (make setup). Afterwards run the tests.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
tools=$here/../../.ci/javascript
packages=$here/../../.stamps/javascript/node_modules
libraries=(preact htm uplot swagger-ui-dist)

version() { sed -n 's/^ *"version": "\(.*\)",*$/\1/p' "$packages/$1/package.json" | head -n 1; }

# Browsers resolve only relative names without an import map, and a source map that is not there is a 404.
served() {
  sed -e 's#from *"preact"#from"./preact.mjs"#' -e '/^\/\/# sourceMappingURL=/d' -e 's#/\*\# sourceMappingURL=.*\*/$##' "$1"
}

# Writes everything into a folder: library files, and the licence of each beside it.
fill() {
  local to=$1
  mkdir -p "$to"/{preact,htm,uplot,swagger}
  served "$packages/preact/dist/preact.mjs" >"$to/preact/preact.mjs"
  served "$packages/preact/hooks/dist/hooks.mjs" >"$to/preact/hooks.mjs"
  served "$packages/htm/dist/htm.mjs" >"$to/htm/htm.mjs"
  # Its only small build is a script that names one thing: as a module it exports that.
  { cat "$packages/uplot/dist/uPlot.iife.min.js" && echo "export default uPlot;"; } >"$to/uplot/uPlot.mjs"
  served "$packages/uplot/dist/uPlot.min.css" >"$to/uplot/uPlot.min.css"
  for file in swagger-ui-bundle.js swagger-ui.css; do
    served "$packages/swagger-ui-dist/$file" >"$to/swagger/$file"
  done
  for library in preact htm uplot; do cp "$packages/$library/LICENSE" "$to/$library/LICENSE"; done
  for file in LICENSE NOTICE swagger-ui-bundle.js.LICENSE.txt; do cp "$packages/swagger-ui-dist/$file" "$to/swagger/"; done
}

list_versions() {
  for library in "${libraries[@]}"; do
    echo "$library $(version "$library")"
    sed -i -E "s#^(\| \[$library\]\([^|]*\| )[^|]*\|#\1$(version "$library") |#" "$here/README.md"
  done
}

case ${1:-} in
  --check)
    [ -d "$packages" ] || bash "$tools/install"
    fresh=$(mktemp -d)
    trap 'rm -rf "$fresh"' EXIT
    fill "$fresh"
    # What is only here is ours: the README, the declarations of types, the page of the API.
    changed=$(diff -rq "$fresh" "$here" | grep -v "^Only in $here" || true)
    if [ "$changed" ]; then
      echo "$changed" >&2
      echo "not what the packages give; web/vendor/update.sh --locked copies them again" >&2
      exit 1
    fi
    ;;
  --locked | "")
    [ "${1:-}" ] || (cd "$tools" && bash npm install --package-lock-only --save-exact "${libraries[@]/%/@latest}")
    bash "$tools/install"
    fill "$here"
    list_versions
    ;;
  *)
    echo "update.sh takes --locked, --check or nothing, and got: $*" >&2
    exit 2
    ;;
esac
