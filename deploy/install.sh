#!/usr/bin/env bash
# Installs what building and testing Holdfast needs, from the packages of Debian 12.
# Calls apt only when something is missing, so it costs nothing on a machine that is ready.
set -euo pipefail

usage() {
  cat <<'USAGE'
usage: deploy/install.sh [--tools] [--tests] [--list | --check] [--help]

  (no option)  install the missing packages among those that build and test Holdfast
  --tools      also those for checking the source: clang-format, clang-tidy, shellcheck
  --tests      also those for the tests that are skipped without them: other languages, a browser
  --list       print the packages and do nothing
  --check      print the missing packages and do nothing; exit 1 if there are any
USAGE
}

# What to build with.
packages=(
  build-essential g++ cmake ninja-build ccache git pkg-config python3
  # protocol and service
  libgrpc++-dev libprotobuf-dev protobuf-compiler protobuf-compiler-grpc
  prometheus-cpp-dev libspdlog-dev
  # images, ray tracing, numbers
  libopenexr-dev libopenimageio-dev openimageio-tools libembree-dev libglm-dev libtbb-dev
  # its headers folder is named by the CMake target OpenImageIO::OpenImageIO
  libopencv-core-dev
  # codecs, pictures of the live page, command line, JSON
  liblz4-dev libzstd-dev zlib1g-dev libcli11-dev nlohmann-json3-dev
  # tests and benchmarks
  libgtest-dev libgmock-dev libbenchmark-dev
)
# What checks the source; tests/format.sh, tests/tidy.sh.
tools=(clang-format clang-tidy shellcheck)
# What tests of clients and pages use: tests/service/python_client_test.py, live_page_test.py.
tests=(python3-grpcio python3-protobuf chromium)

fail() {
  echo "install.sh: $*" >&2
  exit 1
}

mode=install
while (($#)); do
  case $1 in
    --tools) packages+=("${tools[@]}") ;;
    --tests) packages+=("${tests[@]}") ;;
    --list) mode=list ;;
    --check) mode=check ;;
    -h | --help)
      usage
      exit 0
      ;;
    *)
      usage >&2
      echo "install.sh: unknown option $1" >&2
      exit 2
      ;;
  esac
  shift
done

if [[ $mode == list ]]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

command -v dpkg-query >/dev/null ||
  fail "needs Debian 12 or a distribution made from it: there is no dpkg-query here." \
    "Install the equivalents of: ${packages[*]}"

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done

if ((${#missing[@]} == 0)); then
  echo "install.sh: all ${#packages[@]} packages are installed"
  exit 0
fi
if [[ $mode == check ]]; then
  printf '%s\n' "${missing[@]}"
  exit 1
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null ||
    fail "missing: ${missing[*]}. Installing them needs root, and there is no sudo:" \
      "run deploy/install.sh as root once"
  as_root=(sudo)
fi

apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o Dpkg::Use-Pty=0 "$@"
}

# Named on failure, because package names differ between releases.
# shellcheck source=/dev/null
release=$(. /etc/os-release 2>/dev/null && echo "${PRETTY_NAME:-unknown}" || echo unknown)
echo "install.sh: installing ${#missing[@]} of ${#packages[@]} packages: ${missing[*]}"
apt update || fail "apt-get update failed; see its message above"
apt install -y --no-install-recommends "${missing[@]}" ||
  fail "apt-get install failed on $release; the package names are those of Debian 12"
