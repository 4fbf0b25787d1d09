#!/usr/bin/env bash
# Checks docs/commands.md against the program: every command has a section, every option a row, every row an option, and
# examples print what is shown.
#   commands_test.sh PROGRAM DOCUMENT
set -euo pipefail
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
plain() {
  LC_ALL=C awk '
    NF == 0 { next }
    $1 == "seconds" { print $1; next }
    { sub(/ worst .*/, "")
      for (i = 1; i <= NF; ++i) if ($i ~ /^-?[0-9]+\.[0-9]+(e[-+]?[0-9]+)?,?$/) $i = sprintf("%.6g", $i)
      $1 = $1
      print }' "$1"
}
# as_shown SHOWN PRINTED: whether PRINTED has exactly the lines of SHOWN, in order.
as_shown() {
  awk 'NR == FNR { shown[++n] = $0; next }
    { while (at < n && shown[at + 1] == "...") { ++at; any = 1 }
      if (at < n && shown[at + 1] == $0) { ++at; any = 0 } else if (!any) { print "  printed: " $0; exit bad = 1 } }
    END { while (!bad && at < n && shown[at + 1] == "...") ++at
      if (!bad && at < n) { print "  not printed: " shown[at + 1]; bad = 1 }
      exit bad }' <(plain "$1") <(plain "$2")
}
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
