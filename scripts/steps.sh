# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Steps that run.sh and test.sh share. Sourced, never run; the caller has changed to the project's root.
# Every step looks first whether its work is done already, so that a second run takes seconds.
set -euo pipefail

# What configuring and building needs. Node.js makes the report page from npm packages.
BUILD_PACKAGES=(g++ cmake ninja-build ccache python3 libeigen3-dev libcli11-dev nlohmann-json3-dev libfmt-dev libssl-dev
  zlib1g-dev liblz4-dev libzstd-dev libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev pkg-config libgpiod-dev)
# What the emulated boards need: an emulator and a cross compiler for microcontrollers.
IMAGE_PACKAGES=(qemu-system-arm gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib)
# What only the tests need: formatter, linter, sanitizers, fuzzer, a compiler that measures MC/DC, a browser that opens the
# report, a decoder of CAN frames, the emulated boards, a cross compiler for the Linux guest, and what runs a fleet's shards.
TEST_PACKAGES=(clang clang-format clang-tidy cppcheck libclang-rt-14-dev clang-19 llvm-19 libclang-rt-19-dev
  chromium lz4 python3-can python3-canmatrix python3-jsonschema "${IMAGE_PACKAGES[@]}" g++-aarch64-linux-gnu
  slurmctld slurmd slurm-client parallel)

step() { printf '\n== %s\n' "$*"; }

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "Installing needs root: run this once as root, or install sudo." >&2
    return 1
  fi
}

# install_missing PACKAGE...: installs those of Debian's packages that are not there, and asks nothing.
install_missing() {
  local missing=() package
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  # Node.js may come from elsewhere than Debian; any will do. Debian's finds its certificates in ca-certificates.
  command -v node >/dev/null || missing+=(nodejs ca-certificates)
  command -v npm >/dev/null || missing+=(npm)
  [ ${#missing[@]} = 0 ] && return
  step "Installing ${missing[*]}"
  as_root apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "${missing[@]}"
}

# What one clone compiled serves the others: ccache takes paths below the clone as relative to it.
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1

# build CONFIGURE_PRESET [BUILD_PRESET]: configures and builds; the build preset says which targets.
build() {
  step "Building ${2:-$1}"
  cmake --preset "$1"
  cmake --build --preset "${2:-$1}"
}

# The main job on built-in data: a simulated drive through the firmware's loop, then what it tells about the driver.
main_job() {
  step "Simulating a drive of a whole steering column and identifying the driver's arm from its torsion bar"
  mkdir -p out
  build/steerid simulate --task drive --hands both_3_9 --steering 0.05 --probe 1 --duration 60 --seed 1 \
    --out out/drive.csv --truth out/truth.csv
  build/steerid identify out/drive.csv --batch \
    --json out/identification.json --trace out/trace.csv --report out/report.html

  step "Diagnosing a record that another simulation drew; the diagnosis is not told what is in it"
  rm -rf out/drawn out/diagnosis
  build/steerid study blind draw --cases 1 --seed 16 --out out/drawn
  build/steerid diagnose --real out/drawn/cases/case000/log.csv --sim out/drawn/cases/case000/sim.json \
    --out out/diagnosis
  printf 'What had been drawn (out/drawn/key.json): '
  python3 -c 'import json; print(*json.load(open("out/drawn/key.json"))["case000"]["effects"] or ["no effect"])'
  cat <<TEXT

Written to $PWD/out:
  drive.csv              the simulated record: torsion bar, motor, rim, probe and angle, as a car has them
  truth.csv              what no sensor sees: the arm above the bar, and the driver's own torque
  identification.json    the answer, recursive and batch
  trace.csv              the recursive estimate after every sample
  report.html            the whole of it as a page; open it in a browser
  diagnosis/report.html  why the drawn record differs from its simulation, as a page
TEXT
}
