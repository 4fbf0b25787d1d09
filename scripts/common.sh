# shellcheck shell=bash
# What the scripts share; sourced, never run. Gives: root, say, fail, jobs, configure, build.
# Exit codes are those of docs/commands.md: 1 a check came out negative, 2 bad usage, 4 a tool is missing or failed.

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)
program=${0##*/}

say() { printf '%s: %s\n' "$program" "$*" >&2; }

# fail CODE MESSAGE...: says why and ends.
fail() {
  local code=$1
  shift
  printf '%s: error: %s\n' "$program" "$*" >&2
  exit "$code"
}

# How many compilers or tests at once: one per core, but at most one per 1.5 GiB of free memory (files that include
# GiNaC need about 1 GiB under a sanitizer).
jobs() {
  local cores memory
  cores=$(nproc 2>/dev/null || echo 1)
  memory=$(awk '/^MemAvailable:/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || true)
  if [[ -n $memory && $memory -lt $cores ]]; then cores=$((memory > 0 ? memory : 1)); fi
  echo "$cores"
}

# configure PRESET: about a second where nothing changed; always run, since a new folder is found only by configuring.
configure() {
  local preset=$1 folder="$root/build/$1" fresh=() log
  # A build folder of a source tree that was moved or copied cannot be used again.
  if [[ -f $folder/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
    say "build/$preset was configured for another folder: configuring afresh"
    fresh=(--fresh)
  fi
  mkdir -p "$folder"
  log="$folder/configure.log"
  say "configuring (cmake --preset $preset)"
  if ! (cd "$root" && cmake --preset "$preset" "${fresh[@]}") >"$log" 2>&1; then
    cat "$log" >&2
    fail 4 "configuring failed; build/$preset/configure.log has the whole of it"
  fi
}

# build PRESET [TARGET...]: ninja's progress goes to standard error, so that results stay alone on standard output.
build() {
  local preset=$1
  shift
  local targets=()
  if (($# > 0)); then targets=(--target "$@"); fi
  say "building (cmake --build --preset $preset${*:+ --target $*}), $(jobs) at once"
  (cd "$root" && cmake --build --preset "$preset" --parallel "$(jobs)" "${targets[@]}") >&2 ||
    fail 4 "the build failed: the first error stands above"
}
