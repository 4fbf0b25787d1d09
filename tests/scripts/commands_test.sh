#!/usr/bin/env bash
# docs/commands.md against the program: every command has its chapter, every option its row, and no row is invented.
#   commands_test.sh PROGRAM DOCUMENT
set -euo pipefail
program=$1 document=$2
failed=0
refuse() {
  printf 'FAILED: %s\n' "$*" >&2
  failed=1
}

# Words like --option, one a line, sorted.
options() { grep -oE -- '(^|[ ,`])(-o|--[a-z][a-z-]*)' | grep -oE -- '-.*' | LC_ALL=C sort -u; }
chapter() { awk -v title="## $1" '$0 == title { on = 1; next } /^## / { on = 0 } on' "$document"; }

common=$(awk '/^## / { exit } 1' "$document" | options)
mapfile -t commands < <("$program" --help | awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { print $1 }')
((${#commands[@]} >= 7)) || refuse "the program shows ${#commands[@]} commands only"
for command in "${commands[@]}"; do
  if [[ -z $(chapter "$command") ]]; then
    refuse "$command has no chapter"
    continue
  fi
  # Of the help only what stands at the beginning of a line is an option; the rest is words about it.
  there=$("$program" "$command" --help | grep -E '^ +-' | sed -E 's/^ +//; s/(  ).*//' | options)
  told=$(printf '%s\n%s\n' "$common" "$(chapter "$command" | grep -E '^\| `' | awk -F'|' '{ print $2 }' | options)" | LC_ALL=C sort -u)
  while read -r option; do
    [[ -z $option ]] || refuse "$command: the document does not tell of $option"
  done < <(LC_ALL=C comm -23 <(echo "$there") <(echo "$told"))
  while read -r option; do
    [[ -z $option ]] || grep -qxF -- "$option" <<<"$common" || refuse "$command has no option $option"
  done < <(LC_ALL=C comm -13 <(echo "$there") <(echo "$told"))
done
((failed == 0)) || exit 1
echo "${#commands[@]} commands are told as they are"
