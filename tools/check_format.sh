#!/usr/bin/env bash
# tools/check_format.sh [--fix]: is every C++ file formatted as .clang-format says? Exits 77 (skipped) without it.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang-format > /dev/null || { echo "skipped: clang-format is not installed"; exit 77; }
mode=(--dry-run -Werror)
[[ ${1:-} == --fix ]] && mode=(-i)
find src tests fuzz python -name '*.[ch]pp' -print0 | xargs -0 clang-format "${mode[@]}"
