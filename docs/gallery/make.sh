#!/usr/bin/env bash
# Makes the README's pictures by the README's own commands: those in the code block after
# `<!-- gallery -->`. DURER names another `durer` than the one in target/release.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
durer=${DURER:-$root/target/release/durer}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$root/samples" "$work/samples"
cd "$work"

durer() { "$durer" "$@" --compression small; }
commands=$(awk '/^<!-- gallery -->$/ { here = 1; next }
                here && /^```$/ { exit }
                here && /^durer / { print }' "$root/README.md")
eval "$commands"

rm -f shaded.png # shown as teapot.png already
mv -- *.png "$root/docs/gallery/"
