#!/usr/bin/env bash
# tools/build.sh PRESET [TARGET...]: configures (once) and builds. Shows how far it is, on one line in a terminal and
# every tenth part elsewhere; the compiler's words only if something fails.
set -euo pipefail
preset=$1
shift
log=build/$preset.log
mkdir -p build
if [[ ! -f build/$preset/build.ninja ]]; then
  options=()
  if [[ $preset == sanitize ]]; then  # clang compiles it in two thirds of the time, and fuzzers need its library
    compiler=$(command -v clang++ clang++-14 clang++-15 clang++-16 | head -n 1 || true)
    [[ -z $compiler ]] || options=("-DCMAKE_CXX_COMPILER=$compiler")
  fi
  cmake --preset "$preset" "${options[@]}" -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache > "$log" 2>&1 || { cat "$log"; exit 1; }
fi
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=1  # a clone elsewhere finds what this one compiled
export CCACHE_DEPEND=1  # what the compiler read is taken from its own list: nothing is preprocessed twice
targets=()
(($# > 0)) && targets=(--target "$@")

show_progress() {  # ninja's lines "[3/120] ..." in; everything goes to the log
  local line tenth shown=-1
  while IFS= read -r line; do
    echo "$line" >> "$log"
    [[ $line =~ ^\[([1-9][0-9]*)/([0-9]+)\] ]] || continue
    if [[ -t 1 ]]; then
      printf '\rbuilding %s: %d of %d ' "$preset" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
    else
      tenth=$((10 * BASH_REMATCH[1] / BASH_REMATCH[2]))
      ((tenth == shown)) || printf 'building %s: %d of %d\n' "$preset" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
      shown=$tenth
    fi
  done
  if [[ -t 1 ]]; then echo; fi
}

echo "building $preset ..."
: > "$log"
cmake --build "build/$preset" -j "$(nproc)" "${targets[@]}" 2>&1 | show_progress || { tail -n 60 "$log"; exit 1; }
grep -A 8 'report page was not built' "$log" || true
