#!/usr/bin/env bash
# tools/setup.sh [PACKAGE...]: installs what the build needs from Debian's packages, and the packages named, if
# anything is missing.
set -euo pipefail
packages=(build-essential cmake ninja-build ccache git python3 python3-dev python3-numpy pybind11-dev libeigen3-dev libfmt-dev libtoml11-dev libcli11-dev
          nlohmann-json3-dev libhdf5-dev zlib1g-dev libcpp-httplib-dev libxlsxwriter-dev libgtest-dev libgmock-dev librapidcheck-dev nodejs npm "$@")
missing=()
for p in "${packages[@]}"; do
  [[ $p == nodejs || $p == npm ]] && command -v "${p/nodejs/node}" > /dev/null && continue
  dpkg-query -W -f='${Status}' "$p" 2> /dev/null | grep -q 'ok installed' || missing+=("$p")
done
if ((${#missing[@]} > 0)); then
  sudo=""
  [[ $(id -u) == 0 ]] || sudo=sudo
  echo "installing: ${missing[*]}"
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get update -qq
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" > /dev/null
fi
