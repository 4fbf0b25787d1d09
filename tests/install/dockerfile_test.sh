#!/usr/bin/env bash
# The Dockerfile: what it names exists, and, where a Docker daemon and its base images are to be had, its image works.
#   dockerfile_test.sh SOURCE
set -euo pipefail
source=$1
file=$source/Dockerfile

refuse() {
  printf 'FAILED: %s\n' "$*" >&2
  exit 1
}

echo "-- its scripts, presets and options exist"
while read -r script; do
  [[ -x $source/$script ]] || refuse "the Dockerfile runs $script, which is no program"
done < <(grep -oE 'scripts/[a-z-]+' "$file")
while read -r preset; do
  grep -qF "{ \"name\": \"$preset\"" "$source/CMakePresets.json" || refuse "there is no preset $preset"
done < <(grep -oE -- '--preset [a-z]+' "$file" | cut -d' ' -f2)
while read -r option; do
  grep -qF "option($option " "$source/CMakeLists.txt" || refuse "there is no option $option"
done < <(grep -oE -- '-DEOMGEN_[A-Z_]+' "$file" | cut -c3-)
recommended=$(grep CPACK_DEBIAN_PACKAGE_RECOMMENDS "$source/cmake/eomgen_package.cmake")
for package in gcc libeigen3-dev; do
  [[ $recommended == *"$package"* ]] || refuse "the package does not recommend $package"
  grep -qE "apt-get install .* $package( |\$)" "$file" || refuse "the image does not install $package"
done

echo "-- nothing of a build folder is copied into the image"
grep -qx '/build/' "$source/.dockerignore" || refuse ".dockerignore does not name the build folders"

if ! docker image inspect debian:bookworm debian:bookworm-slim >/dev/null 2>&1; then
  echo "all is well; the image itself was not built: there is no Docker daemon with its base images"
  exit 0
fi
echo "-- the image is built and checks a model"
docker build -q -t eomgen-test "$source" >/dev/null || refuse "docker build"
docker run --rm eomgen-test check P7_moving_sphere >/dev/null || refuse "docker run"
echo "all is well"
