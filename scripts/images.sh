#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Builds the images that `steerid hil --emulate` runs, after ./run.sh: build/firmware/steerid-an386.elf and
# steerid-an385.elf. Installs the cross compiler and the emulator where they are missing.
cd "$(dirname "$0")/.."
. scripts/steps.sh

install_missing "${BUILD_PACKAGES[@]}" "${IMAGE_PACKAGES[@]}"
build host images
