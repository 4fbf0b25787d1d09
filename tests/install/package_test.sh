#!/usr/bin/env bash
# The Debian package: built, unpacked, complete, and usable from where it was unpacked.
#   package_test.sh BUILD SCRATCH CPACK
set -euo pipefail
build=$1 scratch=$2 cpack=$3

refuse() {
  printf 'FAILED: %s\n' "$*" >&2
  exit 1
}
if ! command -v dpkg-deb >/dev/null; then
  echo "skipped: dpkg-deb is not installed"
  exit 77
fi

rm -rf -- "$scratch"
mkdir -p "$scratch"
(cd "$build" && "$cpack" -G DEB -D CPACK_DEBIAN_COMPRESSION_TYPE=none -B "$scratch/made") >"$scratch/cpack.log" 2>&1 ||
  { cat "$scratch/cpack.log"; refuse "cpack -G DEB"; }
package=("$scratch"/made/eomgen_*.deb)
[[ ${#package[@]} == 1 && -s ${package[0]} ]] || refuse "cpack made no package, or several"

echo "-- its metadata describe it and its dependencies"
field() { dpkg-deb -f "${package[0]}" "$1"; }
[[ $(field Package) == eomgen && -n $(field Maintainer) && -n $(field Description) ]] || refuse "fields of the package"
for needed in libginac libcln libfmt libc6; do
  [[ $(field Depends) == *"$needed"* ]] || refuse "it does not depend on $needed: $(field Depends)"
done

echo "-- the installed program works, and finds its models and documents"
dpkg-deb -x "${package[0]}" "$scratch/unpacked"
prefix=$scratch/unpacked/usr
cd "$scratch" # outside the source tree, whose models would be found
"$prefix/bin/eomgen" check P7_moving_sphere >checked.txt || refuse "check of an installed model, by its name"
for file in share/doc/eomgen/copyright share/doc/eomgen/commands.md include/eom/ode.hpp share/man/man1/eomgen.1 \
  share/bash-completion/completions/eomgen share/zsh/site-functions/_eomgen share/fish/vendor_completions.d/eomgen.fish; do
  [[ -s $prefix/$file ]] || refuse "the package has no $file"
done
while read -r command _; do
  [[ -s $prefix/share/man/man1/eomgen-$command.1 ]] || refuse "there is no page of the manual about $command"
done < <("$prefix/bin/eomgen" --help | sed -n '/^Subcommands:/,/^$/p' | sed -e 1d -e '/^$/d')

echo "-- its content: no file outside /usr, none of the tests and of the build, nothing that all may write"
dpkg-deb -c "${package[0]}" >content.txt
if grep -vE ' \./$| \./usr/' content.txt; then refuse "these files are not in /usr"; fi
if grep -E '/(tests|build|\.git|CMakeFiles|__pycache__)(/|$)|\.(o|a\.tmp|pyc)$' content.txt; then refuse "these files are no part of the package"; fi
if grep -E '^-.{7}w' content.txt; then refuse "everyone may write these files"; fi
if grep -E '^d.{7}w' content.txt; then refuse "everyone may write these folders"; fi
for file in bin/eomgen 'lib/(.*/)?libeomgen[.]' 'lib/(.*/)?libeomgen_hybrid[.]a' share/eomgen/models/P7_moving_sphere.toml include/eom/hybrid/run.hpp \
  'lib/(.*/)?cmake/eomgen/eomgenConfig.cmake' share/doc/eomgen/LICENSE share/doc/eomgen/LICENSE.runtime; do
  grep -qE " \./usr/$file" content.txt || refuse "the package has no $file"
done

echo "-- man renders every page without warnings"
if command -v groff >/dev/null; then
  for page in "$prefix"/share/man/man1/*.1; do
    complaints=$(groff -man -Tutf8 -ww "$page" 2>&1 >"$scratch/page.txt") || refuse "groff on $page"
    [[ -z $complaints ]] || refuse "$page: $complaints"
  done
fi

echo "-- bash completes commands, options, and words of an option"
# completes WORDS...: the completions of the last word.
completes() {
  bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _eomgen; printf "%s\n" "${COMPREPLY[@]}"' \
    - "$prefix/share/bash-completion/completions/eomgen" "$@"
}
[[ $(completes eomgen equi) == equilibria ]] || refuse "bash does not complete a command"
[[ $(completes eomgen run P --rto) == --rtol ]] || refuse "bash does not complete an option"
[[ $(completes eomgen emit P --target pyth) == python ]] || refuse "bash does not complete a target"
[[ $(completes eomgen derive P --show equations,constr) == equations,constraints ]] || refuse "bash does not complete in a list"
[[ $(completes eomgen bench P --solver dop8) == dop853 ]] || refuse "bash does not complete a solver"
touch pendulum.toml
[[ $(completes eomgen run pend) == pendulum.toml ]] || refuse "bash does not complete a model"
for shell in zsh fish; do
  if ! command -v "$shell" >/dev/null; then continue; fi
  file=$(find "$prefix/share/$shell" -type f)
  "$shell" -n "$file" || refuse "$shell does not read $file"
done
echo "all is well"
