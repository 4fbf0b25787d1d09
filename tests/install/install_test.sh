#!/usr/bin/env bash
# The installed tree: complete, movable, and usable without the generator's libraries.
#   install_test.sh BUILD SOURCE SCRATCH CMAKE CXX [FLAG]
# FLAG: the sanitizer flag of the build; programs that link its library need it too.
set -euo pipefail
build=$1 source=$2 scratch=$3 cmake=$4 cxx=$5 sanitizers=${6-}

refuse() {
  printf 'FAILED: %s\n' "$*" >&2
  exit 1
}

rm -rf -- "$scratch"
mkdir -p "$scratch"
# Outside the source tree, because eomgen searches the parent folders for models.
elsewhere=$(mktemp -d)
trap 'rm -rf -- "$elsewhere"' EXIT
"$cmake" --install "$build" --prefix "$scratch/first" >"$scratch/install.log" || { cat "$scratch/install.log"; refuse "cmake --install"; }
# The installed tree is moved first: it must be relocatable.
prefix="$scratch/prefix"
mv "$scratch/first" "$prefix"

echo "-- the package contains no path of the source or build tree"
if grep -rIlF -e "$source" -e "$build" -e "$scratch/first" -- "$prefix"; then refuse "these files name folders of the build"; fi

echo "-- a user's program builds with it and links neither GiNaC nor CLN"
cp -R "$source/tests/install/consumer" "$scratch/source"
cp "$source/examples/hybrid/rough_sphere.cpp" "$scratch/source"
"$cmake" -S "$scratch/source" -B "$scratch/consumer" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O0 $sanitizers" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF >"$scratch/configure.log" 2>&1 ||
  { cat "$scratch/configure.log"; refuse "find_package(eomgen)"; }
grep -q "^eomgen_DIR:PATH=$prefix/" "$scratch/consumer/CMakeCache.txt" || refuse "another eomgen was found than the one installed here"
"$cmake" --build "$scratch/consumer"
for program in oscillator pendulum; do "$scratch/consumer/$program" || refuse "$program"; done
library=$(find "$prefix" -name libeomgen_hybrid.a)
[[ -n $library ]] || refuse "the compiled runtime is not installed"
warnings=(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)
EOMGEN="$prefix/bin/eomgen" EOMGEN_CACHE_DIR="$scratch/hybrid-cache" RUNTIME="$prefix/include" LIBRARY="$library" CXX="$cxx" \
  CXXFLAGS="-O0 ${warnings[*]} $sanitizers" "$source/examples/hybrid/run" "$scratch/hybrid" ||
  refuse "emitted code and the runtime alone do not give the table of eomgen run"
"$scratch/consumer/rough_sphere" "$scratch/consumer.csv" || refuse "a program that links eomgen::hybrid"
cmp "$scratch/consumer.csv" "$scratch/hybrid/run.csv" || refuse "a program that links eomgen::hybrid does not give the table of eomgen run"

echo "-- the headers alone compile where they are included"
"$cxx" -std=c++20 -fsyntax-only "${warnings[@]}" -I "$prefix/include" -isystem "${EIGEN:-/usr/include/eigen3}" -I "$scratch/hybrid" \
  "$source/examples/hybrid/rough_sphere.cpp" || refuse "the headers of the runtime without its library"

echo "-- headers of another version do not link with the compiled runtime"
cp -R "$prefix/include/eom" "$scratch/other" && mkdir "$scratch/headers" && mv "$scratch/other" "$scratch/headers/eom"
sed -i 's/^#define EOM_VERSION_PATCH .*/#define EOM_VERSION_PATCH 99/' "$scratch/headers/eom/version.hpp"
said=$(EOMGEN="$prefix/bin/eomgen" EOMGEN_CACHE_DIR="$scratch/hybrid-cache" RUNTIME="$scratch/headers" LIBRARY="$library" CXX="$cxx" \
  CXXFLAGS="-O0 $sanitizers" "$source/examples/hybrid/run" "$scratch/hybrid" 2>&1) && refuse "headers of another version link with the library"
grep -q 'eom::hybrid::run(.*Layout<' <<<"$said" || refuse "the linker does not name the function of the other version: $said"
cmp "$scratch/hybrid/P5_rough_sphere_run.hpp" "$scratch/consumer/rough_sphere_equations_eom/P5_rough_sphere_run.hpp" ||
  refuse "eom_generate writes another header of a run than eomgen emit"
for program in consumer/oscillator consumer/pendulum consumer/rough_sphere; do
  linked=$(ldd "$scratch/$program")
  if grep -Ei 'ginac|libcln|libgmp' <<<"$linked"; then refuse "$program links computer algebra"; fi
done
grep -q 'int__rhs(' "$scratch/consumer/reserved_equations_eom/int_.h" || refuse "a model called int.toml is not int_"
if grep -rIlE '#include *<(ginac|cln)/' -- "$prefix/include"; then refuse "these installed headers include computer algebra"; fi

echo "-- a user's program builds a model with the library, prints its LaTeX, emits C and runs it"
cp -R "$source/examples/library" "$scratch/library"
"$cmake" -S "$scratch/library" -B "$scratch/library/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O0 $sanitizers" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF >"$scratch/library.log" 2>&1 ||
  { cat "$scratch/library.log"; refuse "find_package(eomgen) for the library"; }
"$cmake" --build "$scratch/library/build"
said=$(cd "$scratch/library/build" && EOMGEN_CACHE_DIR="$scratch/library-cache" ./pendulum) || refuse "the library's example"
grep -qF '\frac{d}{dt}' <<<"$said" || refuse "the library's example printed no LaTeX: $said"
grep -q '^done at t = 10: phi = ' <<<"$said" || refuse "the library's example did not run: $said"
[[ -s $scratch/library/build/pendulum.c ]] || refuse "the library's example emitted no C"
said=$(cd "$scratch/library/build" && EOMGEN_CACHE_DIR="$scratch/library-cache" ./controller) ||
  refuse "the library's example of a controller: $said"

echo "-- eom_generate runs again when the model or eomgen changes, and only then"
generated="$scratch/consumer/pendulum_equations_eom/pendulum.c"
rebuilds() { # what a build generates now
  "$cmake" --build "$scratch/consumer" | grep -o 'Generating the equations of motion of .*' || true
}
before=$(stat -c %y "$generated")
[[ -z $(rebuilds) ]] || refuse "a build without a change generated code"
touch "$scratch/source/pendulum.cpp"
[[ -z $(rebuilds) && $(stat -c %y "$generated") == "$before" ]] || refuse "a source file that is no model made it generate code"
sed -i 's/l = "1 m"/l = "2 m"/' "$scratch/source/pendulum.toml"
touch "$scratch/source/pendulum.toml"
[[ $(rebuilds | grep -v ' int_$') == "Generating the equations of motion of pendulum" ]] || refuse "a changed model did not generate its code, or others did"
grep -q 'p\[1\] = 2.0' "$generated" || refuse "the generated code does not have the changed parameter"
"$scratch/consumer/pendulum" || refuse "the program of the changed model"
touch "$prefix/bin/eomgen"
due=$("$cmake" --build "$scratch/consumer" -- -n | grep -c 'Generating the equations of motion of ') # documented, not made: all would be compiled again
((due == 4)) || refuse "a newer eomgen would not generate all code"

echo "-- licences are installed with the files"
[[ -n $(find "$prefix" -path '*doc*' -name 'LICENSE*') ]] || refuse "no licence is installed"
for page in commands.md model-format.md linking.md schema/run.schema.json; do
  [[ -s "$prefix/share/doc/eomgen/$page" ]] || refuse "the page $page is not installed"
done
documented=$("$prefix/bin/eomgen" --help) # read to its end, or the pipe closes while it writes
grep -qF "$prefix/share/doc/eomgen/commands.md" <<<"$documented" || refuse "eomgen --help does not tell where the installed documentation is"

echo "-- the program runs from the prefix, with its models"
[[ -x $prefix/bin/eomgen ]] || refuse "there is no bin/eomgen"
[[ $(cat "$scratch/consumer/cli_path.txt") == "$prefix/bin/eomgen" ]] || refuse "eomgen::cli is not bin/eomgen"
cd "$elsewhere"
# The output is read to the end first: grep -q stops at its match, and the writer would then fail.
says_format() { [[ $("$@" --json) == *'"format": 1'* ]]; }
says_format "$prefix/bin/eomgen" list || refuse "eomgen list"
says_format "$prefix/bin/eomgen" check P7_moving_sphere || refuse "eomgen check of an installed model, by its name"
[[ -z $(ls -A) ]] || refuse "eomgen left files where it was called"
echo "all is well"
