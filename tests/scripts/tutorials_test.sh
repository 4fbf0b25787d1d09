#!/usr/bin/env bash
# Follows a tutorial word by word in an empty folder: blocks with a caption are written to the file of that name, blocks of
# a console are run, and what they print is compared with what the page shows.
#   tutorials_test.sh PROGRAM PAGE
set -euo pipefail
# shellcheck source=tests/scripts/shown.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/shown.sh"
program=$(realpath -- "$1") page=$2
scratch=$(mktemp -d)
trap 'rm -rf -- "$scratch"' EXIT
mkdir "$scratch/steps" "$scratch/bin" "$scratch/work"
ln -s "$program" "$scratch/bin/eomgen"
PATH=$scratch/bin:$PATH

# NNN.write: the name of a file, then its text; NNN.call: a command, with its output in NNN.shown.
awk -v folder="$scratch/steps" '
  function begin(kind) { step = sprintf("%s/%03d.", folder, ++n); file = step kind }
  /^```/ { if (inside) { inside = 0; file = "" } else { inside = 1; console = /console/; captioned = /code-block/ }; next }
  captioned && /^:caption: / { begin("write"); print $2 >file; captioned = 0; next }
  /^:[a-z]+:/ && inside && !console { next }
  inside && console && /^\$ / { begin("call"); print substr($0, 3) >file; file = step "shown"; printf "" >file; next }
  inside && file != "" { print >file }' "$page"

failed=0 calls=0
shopt -s nullglob  # a page may write no file
cd "$scratch/work"
for step in "$scratch"/steps/*.{write,call}; do printf '%s\n' "$step"; done | sort >"$scratch/order"
while read -r step; do
  if [[ $step == *.write ]]; then
    name=$(head -n 1 "$step")
    tail -n +2 "$step" >"$name"
    continue
  fi
  calls=$((calls + 1))
  bash -euo pipefail "$step" >"$step.out" 2>&1 </dev/null || printf '(exit code %d)\n' $? >>"$step.out"
  shown=${step%.call}.shown
  if ! difference=$(as_shown "$shown" "$step.out"); then
    printf 'FAILED: "%s" does not print what the page shows\n%s\n' "$(<"$step")" "$difference" >&2
    failed=1
  fi
done <"$scratch/order"
((calls >= 4)) || { echo "FAILED: the page has $calls commands only" >&2; failed=1; }
((failed == 0)) || exit 1
echo "$calls commands print what ${page##*/} shows"
