#!/usr/bin/env bash
# tools/package.sh: build/package/ejecta.deb and ejecta.tar.gz, for every x86-64-v2 processor, with faster kernels for
# x86-64-v3 and x86-64-v4, of which the loader takes the best that the processor can run.
#   sudo apt install ./build/package/ejecta.deb
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh dpkg-dev file
tools/build.sh package-v3 libejecta
tools/build.sh package-v4 libejecta
tools/build.sh package
cmake build/package "-DEJECTA_KERNEL_BUILDS=$PWD/build/package-v3;$PWD/build/package-v4" > /dev/null
(cd build/package && cpack > ../package.log) || { tail -n 30 build/package.log; exit 1; }
ls -l build/package/ejecta.deb build/package/ejecta.tar.gz
