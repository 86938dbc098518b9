// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/packed_bytes.hpp"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>

namespace steerid {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 18;

/// `step` unpacks some of `packed` into a block: it takes what it used off `packed`, says how much it made, and is
/// false where that is not packed bytes.
template <class Step>
std::optional<std::string> unpack(std::string_view packed, std::uint64_t size, Step step) {
  std::string out;
  while (out.size() < size) {
    const std::size_t before = out.size();
    out.resize(before + std::min<std::uint64_t>(size - before, kBlockBytes));
    const std::size_t had = packed.size();
    std::size_t made = out.size() - before;
    if (!step(packed, out.data() + before, made)) return std::nullopt;
    out.resize(before + made);
    if (made == 0 && packed.size() == had) return std::nullopt;
  }
  return out;
}

std::optional<std::string> unpacked_lz4(std::string_view packed, std::uint64_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> owned(context, LZ4F_freeDecompressionContext);
  return unpack(packed, size, [&](std::string_view& rest, char* to, std::size_t& made) {
    std::size_t used = rest.size();
    const std::size_t more = LZ4F_decompress(context, to, &made, rest.data(), &used, nullptr);
    rest.remove_prefix(used);
    return LZ4F_isError(more) == 0;
  });
}

std::optional<std::string> unpacked_zstd(std::string_view packed, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  return unpack(packed, size, [&](std::string_view& rest, char* to, std::size_t& made) {
    ZSTD_inBuffer in{rest.data(), rest.size(), 0};
    ZSTD_outBuffer out{to, made, 0};
    const std::size_t more = ZSTD_decompressStream(context.get(), &out, &in);
    rest.remove_prefix(in.pos);
    made = out.pos;
    return ZSTD_isError(more) == 0;
  });
}

}  // namespace

std::optional<std::string> unpacked(std::string_view method, std::string_view packed, std::uint64_t size) {
  if (method == "lz4") return unpacked_lz4(packed, size);
  if (method == "zstd") return unpacked_zstd(packed, size);
  if (!method.empty() || packed.size() != size) return std::nullopt;
  return std::string(packed);
}

std::string packed_by_zstd(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes are bytes
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  return static_cast<std::uint32_t>(::crc32_z(before, data, bytes.size()));
}

}  // namespace steerid
