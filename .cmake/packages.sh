#!/usr/bin/env bash
# Debian 12 packages, by what needs them, and a function that installs the missing ones. To be sourced:
#   . .cmake/packages.sh; need_packages "${core_packages[@]}" ...
core_packages=(g++ cmake ninja-build ccache libeigen3-dev)
bind_packages=(libcgal-dev)
test_packages=(libgtest-dev libopenmesh-dev libboost-dev libgmp-dev doxygen)
scene_packages=(nlohmann-json3-dev libvalijson-dev)
# What the collision accuracy suite compares with, where it is found.
accuracy_packages=(pkg-config libfcl-dev libccd-dev libgts-dev libbullet-dev libode-dev)
runner_packages=("${scene_packages[@]}" libcli11-dev libembree-dev libpng-dev zlib1g-dev)
# What fetches the player's three.js and esbuild, and what tests ask beside; where npm is not Debian's, its Debian packages
# are not asked for.
npm_packages=()
command -v npm >/dev/null || npm_packages+=(nodejs npm)
# What the long tests of players ask.
player_packages=(chromium)

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# Says nothing and does nothing when every package is there, or when this is no Debian (CMake then names what it lacks).
need_packages() {
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0
  local package missing=()
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
    echo "missing packages; as root: apt-get install --no-install-recommends ${missing[*]}" >&2
    return 1
  fi
  echo "installing ${missing[*]}"
  as_root apt-get update -qq </dev/null
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 "${missing[@]}" </dev/null >/dev/null
}
