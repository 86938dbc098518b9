// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every status has a name of its own, and what is none says so.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "base/status.hpp"

namespace steerid {
namespace {

TEST(Status, EveryOneHasANameOfItsOwn) {
  std::set<std::string> names;
  for (const Status status : {Status::kOk, Status::kEndOfStream, Status::kNoData, Status::kLate, Status::kOutOfRange,
                              Status::kCorrupt, Status::kIoError}) {
    names.insert(name(status));
  }
  EXPECT_EQ(names.size(), 7U);
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_STREQ(name(static_cast<Status>(200)), "unknown");
}

}  // namespace
}  // namespace steerid
