#!/usr/bin/env bash
# Follows the page of cross compilation where its compilers are installed; exit code 77: they are not.
#   cross_test.sh PROGRAM PAGE
set -euo pipefail
for tool in aarch64-linux-gnu-gcc qemu-aarch64 arm-none-eabi-gcc x86_64-w64-mingw32-gcc; do
  command -v "$tool" >/dev/null && continue
  echo "skipped: there is no $tool (scripts/setup --with cross)"
  exit 77
done
# Equal names are in the order of bytes in every language of the system.
export LC_ALL=C
exec bash "$(dirname -- "${BASH_SOURCE[0]}")/tutorials_test.sh" "$1" "$2"
