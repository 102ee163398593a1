# Sourced by tools/demo and tools/test: installs what is missing, configures and builds.
#
#   set_up demo|test      packages from apt (of Debian 12 or 13; as root, else through sudo)
#   build_program PRESET [CMAKE OPTIONS]

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# What the program is built with and needs to run.
program_packages=(
  g++ cmake ninja-build pkg-config
  ocl-icd-opencl-dev opencl-headers opencl-clhpp-headers pocl-opencl-icd
  libopencv-dev libavfilter-dev libavformat-dev libavcodec-dev libavutil-dev libswscale-dev
  libexif-dev libdeflate-dev libpng-dev libjpeg-dev libtiff-dev libopenexr-dev libraw-dev liblcms2-dev
  libzstd-dev liblz4-dev libxxhash-dev libcairo2-dev fonts-dejavu-core
  libeigen3-dev nlohmann-json3-dev
  qt6-base-dev qt6-l10n-tools qt6-translations-l10n
)
# The scene generator and the plotter.
script_packages=(python3 python3-numpy python3-opencv python3-matplotlib)
# What only tests and benchmarks use. clang checks the kernels while building and, with libFuzzer, builds what tools/fuzz
# runs; llvm names functions in what sanitizers report; oclgrind checks kernels while they run; Mesa has a second OpenCL
# driver for the processor, which shows itself where RUSTICL_ENABLE=llvmpipe is set.
test_packages=(clang clang-tidy libclang-rt-dev llvm mesa-opencl-icd libgtest-dev libboost-dev zlib1g-dev netpbm time
  ffmpeg python3-mpmath zsh fish groff)
# The website; and what locales with a decimal comma are made of.
test_packages+=(mkdocs locales)
# Schedulers that the job files of tools/farm are run by.
test_packages+=(slurmctld slurmd slurm-client munge parallel)
# The Python package, its wheel and its notebooks.
test_packages+=(pybind11-dev python3-dev python3-pip python3-setuptools python3-wheel python3-venv
  python3-nbclient python3-nbformat python3-ipykernel python3-xarray python3-imageio mypy)
# A screen that nobody sees, for the studio.
test_packages+=(xvfb xauth)
# What packages and archives are made and looked at with; reuse reads licences.
test_packages+=(dpkg-dev lintian desktop-file-utils appstream shared-mime-info patchelf reuse)

# Debian 12 has no <format> yet, 13 no oclgrind any more.
if [ "$(. /etc/os-release && echo "${VERSION_CODENAME:-}")" = bookworm ]; then
  program_packages+=(libfmt-dev)
  test_packages+=(oclgrind)
fi

# Debian's own Python, which the packages above belong to, even where another one comes first in PATH.
python=/usr/bin/python3

missing_packages() {
  local package
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || echo "$package"
  done
}

set_up() {
  local packages=("${program_packages[@]}" "${script_packages[@]}")
  [ "$1" = test ] && packages+=("${test_packages[@]}")
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This system has no apt (tested: Debian 12 and 13). Install what these packages hold, then go on with" >&2
    echo "  cmake --preset release && cmake --build --preset release" >&2
    printf '  %s\n' "${packages[@]}" >&2
    exit 1
  fi
  local missing
  mapfile -t missing < <(missing_packages "${packages[@]}")
  [ ${#missing[@]} -eq 0 ] && return
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "These packages are missing, and there is neither root nor sudo to install them with:" >&2
      printf '  %s\n' "${missing[@]}" >&2
      exit 1
    fi
    as_root=(sudo)
  fi
  echo "Installing with apt: ${missing[*]}"
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

build_program() {
  local preset=$1
  shift
  local folder=$root/build
  [ "$preset" = release ] || folder=$root/build-$preset
  cmake --preset "$preset" -S "$root" -B "$folder" "$@"
  cmake --build "$folder"
}
