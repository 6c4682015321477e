#!/usr/bin/env bash
# tools/build.sh PRESET [TARGET...]: configures (once) and builds; quiet unless something fails.
set -euo pipefail
preset=$1
shift
log=build/$preset.log
mkdir -p build
if [[ ! -f build/$preset/build.ninja ]]; then
  cmake --preset "$preset" -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache > "$log" 2>&1 || { cat "$log"; exit 1; }
fi
targets=()
(($# > 0)) && targets=(--target "$@")
echo "building $preset ..."
cmake --build "build/$preset" -j "$(nproc)" "${targets[@]}" > "$log" 2>&1 || { tail -n 60 "$log"; exit 1; }
