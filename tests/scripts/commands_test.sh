#!/usr/bin/env bash
# Checks docs/commands.md against the program: every command has a section, every option a row, every row an option, and
# examples print what is shown.
#   commands_test.sh PROGRAM DOCUMENT
set -euo pipefail
# shellcheck source=tests/scripts/shown.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/shown.sh"
program=$(realpath -- "$1") document=$2
failed=0
refuse() {
  printf 'FAILED: %s\n' "$*" >&2
  failed=1
}

# Words like --option, one a line, sorted.
options() { grep -oE -- '(^|[ ,`])(-o|--[a-z][a-z-]*)' | grep -oE -- '-.*' | LC_ALL=C sort -u; }
section() { awk -v title="## $1" '$0 == title { on = 1; next } /^## / { on = 0 } on' "$document"; }

common=$(awk '/^## / { exit } 1' "$document" | options)
mapfile -t commands < <("$program" --help | awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { print $1 }')
((${#commands[@]} >= 7)) || refuse "the program shows ${#commands[@]} commands only"
for command in "${commands[@]}"; do
  if [[ -z $(section "$command") ]]; then
    refuse "$command has no section"
    continue
  fi
  # In the help, only flags at the beginning of a line are options; the rest is description.
  there=$("$program" "$command" --help | grep -E '^ +-' | sed -E 's/^ +//; s/(  ).*//' | options)
  documented=$(printf '%s\n%s\n' "$common" "$(section "$command" | grep -E '^\| `' | awk -F'|' '{ print $2 }' | options)" | LC_ALL=C sort -u)
  while read -r option; do
    [[ -z $option ]] || refuse "$command: the document does not tell of $option"
  done < <(LC_ALL=C comm -23 <(echo "$there") <(echo "$documented"))
  while read -r option; do
    [[ -z $option ]] || grep -qxF -- "$option" <<<"$common" || refuse "$command has no option $option"
  done < <(LC_ALL=C comm -13 <(echo "$there") <(echo "$documented"))
done

# Examples with shipped models: the output is as shown, except for blanks, digits beyond the sixth, the differences in the
# certificate, and times. `...` stands for any lines.
models=$(cd -- "$(dirname -- "$document")/../models" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf -- "$scratch"' EXIT
awk -v folder="$scratch" '
  /^```/ { inside = !inside; file = ""; next }
  inside && /^\$ / { file = sprintf("%s/%03d", folder, ++n); print substr($0, 3) >(file ".call"); printf "" >file; next }
  file != "" { print >file }' "$document"
examples=0
for call in "$scratch"/*.call; do
  read -r _ command model options <"$call"
  [[ -f $models/$model.toml ]] || continue
  read -ra options <<<"$options"
  (cd "$scratch" && EOMGEN_MODELS=$models "$program" "$command" "$model" "${options[@]}") >"${call%.call}.out" 2>&1 || true
  [[ ! -s ${call%.call} ]] || difference=$(as_shown "${call%.call}" "${call%.call}.out") ||
    refuse "$(<"$call") does not print what the page shows"$'\n'"$difference"
  examples=$((examples + 1))
done
((examples >= 8)) || refuse "the page has $examples examples of shipped models only"
((failed == 0)) || exit 1
echo "${#commands[@]} commands and $examples examples are documented as they are"
