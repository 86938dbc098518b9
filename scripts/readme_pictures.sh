#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Takes the README's pictures of the two pages that ./run.sh has left in out/, with Chromium.
set -euo pipefail
cd "$(dirname "$0")/.."

# picture PAGE HEIGHT FILE
picture() {
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --virtual-time-budget=5000 \
    --window-size="1180,$2" --screenshot="docs/images/$3" "file://$PWD/$1" 2>/dev/null
}

picture out/report.html 700 identify.png
picture out/diagnosis/report.html 960 diagnosis.png
