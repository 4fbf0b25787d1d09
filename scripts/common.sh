# shellcheck shell=bash
# Functions shared by the scripts; sourced, never run. Defines: root, say, fail, jobs, configure, build.
# Exit codes are those of docs/commands.md: 1 a check failed, 2 bad usage, 4 a tool is missing or failed.

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)
program=${0##*/}

say() { printf '%s: %s\n' "$program" "$*" >&2; }

# fail CODE MESSAGE...: prints the message and exits with CODE.
fail() {
  local code=$1
  shift
  printf '%s: error: %s\n' "$program" "$*" >&2
  exit "$code"
}

# Number of parallel compilers or tests: one per core, but at most one per 1.5 GiB of free memory (files that include
# GiNaC need about 1 GiB under a sanitizer).
jobs() {
  local cores memory
  cores=$(nproc 2>/dev/null || echo 1)
  memory=$(awk '/^MemAvailable:/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || true)
  if [[ -n $memory && $memory -lt $cores ]]; then cores=$((memory > 0 ? memory : 1)); fi
  echo "$cores"
}

# configure PRESET: takes about a second if nothing changed. Always run, since only configuring finds a new folder.
# A first build of the preset release takes half the processor time in groups of files (docs/testing.md); a folder that
# exists keeps its way. EOMGEN_UNITY=ON or OFF in the environment decides for any.
configure() {
  local preset=$1 folder="$root/build/$1" fresh=() log unity=${EOMGEN_UNITY-}
  [[ $preset != release || -f $folder/CMakeCache.txt ]] || unity=${unity:-ON}
  local options=(${unity:+"-DEOMGEN_UNITY=$unity"})
  # The build folder of a moved or copied source tree cannot be reused.
  if [[ -f $folder/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
    say "build/$preset was configured for another folder: configuring afresh"
    fresh=(--fresh)
  fi
  mkdir -p "$folder"
  log="$folder/configure.log"
  say "configuring (cmake --preset $preset)"
  if ! (cd "$root" && cmake --preset "$preset" "${options[@]}" "${fresh[@]}") >"$log" 2>&1; then
    cat "$log" >&2
    fail 4 "configuring failed; build/$preset/configure.log has the whole of it"
  fi
}

# build PRESET [TARGET...]: ninja's progress goes to standard error, so that standard output has results only.
build() {
  local preset=$1
  shift
  local targets=()
  if (($# > 0)); then targets=(--target "$@"); fi
  say "building (cmake --build --preset $preset${*:+ --target $*}), $(jobs) at once"
  (cd "$root" && cmake --build --preset "$preset" --parallel "$(jobs)" "${targets[@]}") >&2 ||
    fail 4 "the build failed: the first error stands above"
}
