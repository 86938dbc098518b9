// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A CAN controller that is not there yet. A file of its own, so that the compiler cannot know that nothing ever comes.
#include "can/frame.hpp"

bool take_frame(steerid::can::Frame& frame);
bool send_frame(const steerid::can::Frame& frame);

bool take_frame(steerid::can::Frame&) { return false; }
bool send_frame(const steerid::can::Frame&) { return false; }
