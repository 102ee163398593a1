#!/bin/bash
# Installs packages into the system that this runs in, and uses each as its users would. tools/packages --try runs it in
# a Debian that has nothing but its base system.
#
#   try_packages.sh DEBS WORK     WORK: this folder as WORK/install, docs/reference/library.md, and maybe ../source
set -euo pipefail
debs=$1 work=$2
source "$(dirname "$0")/try_programs.sh"

rm -rf "$work/made"
mkdir -p "$work/made"
cd "$work/made"
sed -i '/^\(path-exclude\|path-include\)/d' /etc/dpkg/dpkg.cfg.d/* 2>/dev/null || true
apt-get update -q

said "the programs, without what is only recommended"
apt-get install -q -y --no-install-recommends "$debs"/nutik-modules_*.deb "$debs"/nutik-cl_*.deb
nutik-cl --version
nutik-cl devices

use_program

said "the manual pages, the completions, the type of a .tik"
test -s /usr/share/man/man1/nutik-cl.1.gz
bash -c 'source /usr/share/bash-completion/completions/nutik-cl'
apt-get install -q -y --no-install-recommends shared-mime-info libglib2.0-bin desktop-file-utils
gio info -a standard::content-type clip.tik | grep image/x-nutik-capture
cp clip.tik without-its-ending
gio info -a standard::content-type without-its-ending | grep image/x-nutik-capture

said "the studio, on a screen that nobody sees"
apt-get install -q -y --no-install-recommends "$debs"/nutik-studio_*.deb
desktop-file-validate /usr/share/applications/nutik-studio.desktop
QT_QPA_PLATFORM=offscreen nutik-studio --version
apt-get install -q -y --no-install-recommends xvfb xauth imagemagick
xvfb-run -a -s '-screen 0 1280x800x24' bash -c '
  nutik-studio clip.tik & studio=$!
  sleep 12
  kill -0 $studio
  import -window root studio.png
  kill $studio'

said "Python"
apt-get install -q -y --no-install-recommends "$debs"/python3-nutik_*.deb
use_python python3

said "the plotters"
apt-get install -q -y --no-install-recommends "$debs"/nutik-plotters_*.deb
nutik-cl shutter hann --start 10ms --exposure 50ms > hann.fn
FnPlotter.py hann.fn -o hann.png
test -s hann.png

said "a program that is linked to the library"
apt-get install -q -y --no-install-recommends "$debs"/libnutik-dev_*.deb cmake make
cmake -S "$work/install/consumer" -B "$work/consumer" -DPAGE="$work/library.md" -DNUTIK_EVERY_HEADER=OFF
cmake --build "$work/consumer"
"$work/consumer/consumer"
"$work/consumer/example"
test -s picture.png

if [ -d "$work/../source" ]; then
  said "the wheel, from its source"
  source "$work/../source/tools/setup.sh"
  set_up test
  apt-get purge -q -y python3-nutik
  (cd "$work/../source" && pip wheel . --no-build-isolation --no-deps -w "$work/made")
  python3 -m venv --system-site-packages environment
  environment/bin/pip install --no-deps --no-index nutik-*.whl
  environment/bin/python -c 'import nutik; print(nutik.__file__, nutik.open("clip.tik").render(start="10f", exposure="20f").array.mean())'
fi

said "and gone again"
# dpkg passes over one that is gone already, where apt-get ends.
dpkg --purge nutik-cl nutik-modules nutik-studio python3-nutik nutik-plotters libnutik-dev
test ! -e /usr/share/nutik -a ! -e /usr/lib/python3/dist-packages/nutik -a ! -e /usr/bin/nutik-cl
said "everything worked"
