#!/bin/bash
# Unpacks an archive and uses its programs, in a system that has nothing but its base. tools/archive --try runs it there.
#
#   try_archive.sh ARCHIVE      wheels beside it are tried, too
set -euo pipefail
archive=$1
source "$(dirname "$0")/try_programs.sh"

mkdir "$(dirname "$archive")/made"
cd "$(dirname "$archive")/made"
said "unpacked"
if command -v xz >/dev/null; then tar -xJf "$archive"; else apt-get install -q -y xz-utils && tar -xJf "$archive"; fi
PATH=$PWD/$(basename "$archive" .tar.xz)/bin:$PATH
nutik-cl --version
nutik-cl devices
use_program
first=$(sha256sum < blur.png)

said "beside a driver of the system that is broken"
mkdir -p /etc/OpenCL/vendors
echo /usr/lib/no-such-driver.so > /etc/OpenCL/vendors/absent.icd
echo "no library" > /usr/lib/broken-driver.so
echo /usr/lib/broken-driver.so > /etc/OpenCL/vendors/broken.icd
nutik-cl --start 10f --exposure 20f clip.tik blur.png --overwrite
[ "$first" = "$(sha256sum < blur.png)" ]

if ls ../nutik-*.whl 2>/dev/null; then
  said "the wheel, in an environment of its own"
  apt-get install -q -y --no-install-recommends python3-venv python3-numpy
  wheel=$(ls ../nutik-*-"$(python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')"-*.whl || true)
  if [ -n "$wheel" ]; then
    python3 -m venv --system-site-packages environment
    environment/bin/pip install --no-deps --no-index "$wheel"
    use_python environment/bin/python
  else
    echo "none is for this system's Python"
  fi
fi

said "the studio, without a screen"
QT_QPA_PLATFORM=offscreen nutik-studio --version

said "moved to another folder, and called by a link"
mv nutik-cl-*/ moved
PATH=${PATH#*:}
ln -s "$PWD/moved/bin/nutik-cl" linked
./linked --start 10f --exposure 20f clip.tik again.png
cmp blur.png again.png
said "everything worked"
