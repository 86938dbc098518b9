#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Installs what is missing on a Debian 12, builds, and runs the main job on built-in data. Outputs go to ./out.
cd "$(dirname "$0")"
. scripts/steps.sh

install_missing "${BUILD_PACKAGES[@]}"
build host command
main_job
