# Sourced by the scripts of this folder: --help prints what stands at a script's head.
if [ "${1:-}" = --help ]; then
  sed -n '2,/^[^#]/s/^#\( \|$\)//p' "$0"
  exit 0
fi
