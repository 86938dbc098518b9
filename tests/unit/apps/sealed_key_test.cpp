// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/sealed_key.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "fleet/file_hash.hpp"
#include "log/bad_input.hpp"
#include "support/temporary_folder.hpp"

namespace steerid {
namespace {

TEST(SealedKey, Sha256IsThatOfTheStandard) {
  // FIPS 180-4's examples.
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(SealedKey, OpensOnlyWhatWasSealed) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(seal(folder.path(), "the answers"), sha256("the answers"));
  EXPECT_EQ(open_seal(folder.path()), "the answers");
  std::ofstream(folder.path() / "sealed" / "key.json") << "the Answers";
  EXPECT_THROW((void)open_seal(folder.path()), BadInput);
}

TEST(SealedKey, SaysWhereThereIsNone) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)open_seal(folder.path()), BadInput);
}

}  // namespace
}  // namespace steerid
