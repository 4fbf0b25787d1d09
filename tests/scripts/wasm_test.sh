#!/usr/bin/env bash
# Builds the program as WebAssembly and compares its output with that of the native one; exit code 77: there is no
# emscripten, or EOMGEN_WASM_PREFIX does not name the folder of an earlier scripts/wasm, whose libraries take minutes.
#   wasm_test.sh SOURCE PROGRAM SCRATCH
set -euo pipefail
source=$1 native=$2 scratch=$3
if [[ -z ${EOMGEN_WASM_PREFIX-} ]]; then
  echo "skipped: EOMGEN_WASM_PREFIX does not name the folder of an earlier scripts/wasm"
  exit 77
fi
for tool in emcc node; do
  command -v "$tool" >/dev/null && continue
  echo "skipped: there is no $tool (scripts/setup --with wasm)"
  exit 77
done
if [[ ! -e $EOMGEN_WASM_PREFIX/prefix/lib/libginac.a ]]; then
  echo "skipped: there is no $EOMGEN_WASM_PREFIX/prefix/lib/libginac.a (scripts/wasm FOLDER builds it)"
  exit 77
fi
"$source/scripts/wasm" "$EOMGEN_WASM_PREFIX"
export EOMGEN_MODELS=$source/models EOMGEN_CACHE_DIR=$scratch/cache
unset NODE_OPTIONS NODE_PATH
count=0

# run_both CODE CLAIM ARGUMENT...: runs both programs in new folders, which receive their files, output and errors.
run_both() {
  local wanted=$1 claim=$2 code kind command
  shift 2
  for kind in native wasm; do
    rm -rf -- "${scratch:?}/$kind"
    mkdir -p "$scratch/$kind"
    command=("$native")
    [[ $kind == native ]] || command=(node "$EOMGEN_WASM_PREFIX/bin/eomgen.js")
    code=0
    (cd "$scratch/$kind" && "${command[@]}" "$@" >output 2>errors </dev/null) || code=$?
    if ((code != wanted)); then
      echo "FAILED: $claim ($kind): exit code $code, not $wanted"
      cat "$scratch/$kind/errors"
      exit 1
    fi
  done
  count=$((count + 1))
}
# equal CLAIM FILE...: both programs wrote the same bytes.
equal() {
  local claim=$1 file
  shift
  for file in "$@"; do
    diff "$scratch/native/$file" "$scratch/wasm/$file" || { echo "FAILED: $claim: $file differs"; exit 1; }
  done
}

for model in cart_pendulum R8_pendulum_body n_four_bar_2 P8_rough_helix bouncing_ball R3_sphere_on_incline; do
  run_both 0 "check $model" check "$model" --json
  equal "check $model" output errors
  run_both 0 "derive $model" derive "$model" --document "$model.tex"
  equal "derive $model" output errors "$model.tex"
done

# Motions of models whose functions come from the program itself: several angles at once, a body with a second chart,
# contacts, resets.
for model in S5_double_pendulum S6_chain_6 R1_free_body P6_rough_circle bouncing_ball clock_escapement; do
  run_both 0 "run $model" run "$model" --tier jit --out "$model.csv"
  equal "run $model" "$model.csv"
done

run_both 0 "verify cart_pendulum" verify cart_pendulum --no-compile
grep -q '^pass: 20 points, 50 digits' "$scratch/wasm/output" || { echo "FAILED: verify passes"; exit 1; }

# What WebAssembly has not is refused with a reason.
code=0
node "$EOMGEN_WASM_PREFIX/bin/eomgen.js" run cart_pendulum --tier compiled >"$scratch/output" 2>&1 || code=$?
((code == 4)) || { echo "FAILED: --tier compiled: exit code $code, not 4"; exit 1; }
grep -q 'there is no C compiler' "$scratch/output" || { echo "FAILED: --tier compiled does not say why"; exit 1; }
echo "$count comparisons"
