#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Does what run.sh does, then runs every check; the last lines are ctest's summary of the tests in build/.
cd "$(dirname "$0")"
. scripts/steps.sh

install_missing "${BUILD_PACKAGES[@]}" "${TEST_PACKAGES[@]}"
build host
main_job

step "Checking the format"
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror

build host headers
build tidy tidy-firmware

build asan-ubsan asan-ubsan-input
step "Running the tests of what reads input from outside, and of the diagnosis, under the sanitizers"
ctest --preset asan-ubsan-input -j2

build mcdc
step "Comparing the firmware's MC/DC with the list of gaps"
python3 -B tests/coverage/mcdc.py build-mcdc

build fuzz
step "Fuzzing for a fixed number of runs"
ctest --test-dir build-fuzz --tests-regex '^fuzz\.' --output-on-failure -j2

step "Running every test"
ctest --test-dir build --output-on-failure -j2
