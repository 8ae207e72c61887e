#!/usr/bin/env bash
# Unpacks the meshes of Debian's package libcgal-demo:   cgal-meshes.sh DEST
# The package is fetched and unpacked, not installed; a copy already installed is used as it is. Nothing happens when
# DEST holds the meshes.
set -euo pipefail
dest=$1
[ ! -f "$dest/diplodocus.off" ] || exit 0
. "$(dirname "$0")/packages.sh"

room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
archive=/usr/share/doc/libcgal-demo/data.tar.gz
if [ ! -f "$archive" ]; then
  # As root, apt would fetch as the user _apt, who may not write here.
  options=(-qq)
  if [ "$(id -u)" -eq 0 ]; then options+=(-o APT::Sandbox::User=root); fi
  fetch() { (cd "$room" && apt-get download "${options[@]}" libcgal-demo </dev/null); }
  fetch 2>/dev/null || { as_root apt-get update -qq </dev/null; fetch; }
  dpkg -x "$room"/libcgal-demo_*.deb "$room/package"
  archive=$room/package/usr/share/doc/libcgal-demo/data.tar.gz
fi

mkdir -p "$(dirname "$dest")" "$room/meshes"
tar -xzf "$archive" -C "$room/meshes" --strip-components=2 data/meshes
# Whole or not at all: DEST appears in one rename.
unfinished=$(mktemp -d "$(dirname "$dest")/meshes-XXXXXX")
chmod 755 "$unfinished"
cp -r "$room/meshes/." "$unfinished"
rm -rf "$dest"
mv "$unfinished" "$dest"
