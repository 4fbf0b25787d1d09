#!/usr/bin/env bash
# Tests the scripts without installing or building: usage, missing packages (with stand-ins for Debian's tools), ledger.
#   scripts_test.sh SOURCE SCRATCH
set -euo pipefail
source=$1 scratch=$2
rm -rf -- "$scratch"
mkdir -p "$scratch"
cd "$scratch"
count=0

refuse() {
  printf 'FAILED: %s\n' "$*" >&2
  [[ ! -s $scratch/output ]] || sed 's/^/  | /' "$scratch/output" >&2
  exit 1
}

# expect CODE CLAIM COMMAND...: runs the command and stores its output in $scratch/output.
expect() {
  local wanted=$1 claim=$2 code=0
  shift 2
  "$@" >"$scratch/output" 2>&1 </dev/null || code=$?
  ((code == wanted)) || refuse "$claim: exit code $code, not $wanted"
  count=$((count + 1))
}
says() { grep -qF -- "$1" "$scratch/output" || refuse "does not say: $1"; }

# --- usage
expect 2 "setup refuses an unknown group" "$source/scripts/setup" --with everything
says "not 'everything'"
expect 2 "setup refuses an unknown argument" "$source/scripts/setup" now
expect 2 "test refuses an unknown argument" "$source/scripts/test" --fast
says "unknown argument '--fast'"
for seconds in 0 -3 1.5 ten ''; do
  expect 2 "test refuses '$seconds' seconds of fuzzing" "$source/scripts/test" --fuzz "$seconds"
done
expect 2 "test refuses options that contradict each other" "$source/scripts/test" --fuzz 5 --asan
expect 2 "the ledger is of every test only" "$source/scripts/test" --time --only lib
expect 2 "demo refuses an option" "$source/scripts/demo" --fast
expect 2 "demo refuses two folders" "$source/scripts/demo" a b
expect 2 "wasm refuses an option" "$source/scripts/wasm" --fast
expect 2 "wasm refuses two folders" "$source/scripts/wasm" a b
for script in setup test demo wasm; do
  expect 0 "$script shows how it is used" "$source/scripts/$script" --help
  says "usage: scripts/$script"
done

# --- setup, with stand-ins: dpkg-query knows the packages of the file "installed"; apt-get install adds to it, unless
# the file "refusals" states how often it fails first.
mkdir stand_ins
cat >stand_ins/dpkg-query <<'TEXT'
#!/bin/bash
for name in "${@:3}"; do
  grep -qx "$name" installed && echo "installed $name"
done
exit 1
TEXT
cat >stand_ins/apt-get <<'TEXT'
#!/bin/bash
printf '%s\n' "$*" >>calls
[[ $* == *' install '* ]] || exit 0
left=$(cat refusals)
if ((left > 0)); then echo $((left - 1)) >refusals; exit 100; fi
for name in "${@##-*}"; do printf '%s\n' "$name"; done >>installed
TEXT
printf '#!/bin/bash\nexit 0\n' | tee stand_ins/sleep >stand_ins/dpkg
cat >stand_ins/sudo <<'TEXT'
#!/bin/bash
[[ $1 != -n ]] || shift
exec "$@"
TEXT
chmod +x stand_ins/*
with_stand_ins() { PATH="$scratch/stand_ins:$PATH" "$@"; }
try_setup() { : >calls && with_stand_ins "$source/scripts/setup" "$@"; }

"$source/scripts/setup" --list >installed
echo 0 >refusals
expect 0 "setup does nothing where all is there" try_setup
[[ ! -s calls ]] || refuse "setup called apt-get for nothing"

grep -vx doctest-dev installed >fewer && mv fewer installed
expect 0 "setup installs what is missing" try_setup
grep -q 'install .*doctest-dev' calls || refuse "doctest-dev was not installed"
if grep -q 'install .*cmake' calls; then refuse "cmake was there already"; fi

grep -vx doctest-dev installed >fewer && mv fewer installed
echo 2 >refusals
expect 0 "setup tries again, with lists of its own" try_setup
grep -q 'Dir::State::Lists=.*doctest-dev' calls || refuse "the lists were not its own"

grep -vx doctest-dev installed >fewer && mv fewer installed
echo 100 >refusals
expect 4 "setup gives up in the end, and says what is missing" try_setup
says "these packages could not be installed: doctest-dev"

"$source/scripts/setup" --list | grep -vx ccache >installed
expect 0 "setup does without what is only a comfort" try_setup

mkdir elsewhere
for tool in bash env dirname cat; do ln -s "$(command -v "$tool")" elsewhere/; done
expect 4 "setup on another system says what is needed" env PATH="$scratch/elsewhere" bash "$source/scripts/setup"
says "libginac-dev"

# --- the ledger
mkdir -p build/Testing/Temporary
cat >build/Testing/Temporary/LastTest.log <<'TEXT'
1/2 Testing: lib
1/2 Test: lib
[doctest] test cases:  6 |  6 passed | 0 failed | 0 skipped
[doctest] assertions: 80 | 80 passed | 0 failed |
Test time =   1.25 sec
2/2 Testing: install
2/2 Test: install
Test time =   3.00 sec
TEXT
begin='<!-- ledger: written by scripts/test --time -->'
end='<!-- end of the ledger -->'
printf 'before\n%s\nold\n%s\nafter\n' "$begin" "$end" >document.md
cat >wanted.md <<TEXT
before
$begin
| entry | cases | assertions | seconds |
|---|---:|---:|---:|
| install | 1 |  | 3.0 |
| lib | 6 | 80 | 1.2 |
| all 2 entries | 7 | 80 | 4.2 |
$end
after
TEXT
for _ in once again; do
  expect 0 "the ledger replaces itself" "$source/scripts/ledger" build document.md
  diff wanted.md document.md || refuse "the ledger is not as wanted"
done
echo "no markers" >plain.md
expect 2 "a document without a place for the ledger is refused" "$source/scripts/ledger" build plain.md
[[ $(cat plain.md) == "no markers" ]] || refuse "the document was changed"

# --- style
if command -v shellcheck >/dev/null; then
  mapfile -t shell_scripts < <(grep -LE '^#!.*python' "$source"/scripts/*)
  expect 0 "shellcheck has nothing to say" shellcheck -x -P "$source" "${shell_scripts[@]}" "$source/.ci/run" "$source/.ci/nightly" \
    "$source/tests/scripts/scripts_test.sh" "$source/tests/scripts/commands_test.sh" "$source/tests/install/install_test.sh" \
    "$source/docs/images/make"
fi
echo "$count claims hold"
