#!/usr/bin/env bash
# Installs what is missing on a Debian 12, builds, and runs the main job on built-in data. Outputs go to ./out.
cd "$(dirname "$0")"
. scripts/steps.sh

install_missing "${BUILD_PACKAGES[@]}"
build host command
main_job
