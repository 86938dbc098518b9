// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/peeked_stream.hpp"

#include <ios>
#include <utility>

namespace steerid {

PeekedStream::Buffer::Buffer(std::unique_ptr<std::istream> stream) : in(std::move(stream)), first(kPeekedBytes) {
  in->read(first.data(), static_cast<std::streamsize>(first.size()));
  first.resize(static_cast<std::size_t>(in->gcount()));
  setg(first.data(), first.data(), first.data() + first.size());
}

PeekedStream::Buffer::int_type PeekedStream::Buffer::underflow() {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 16;
  block.resize(kBlockBytes);
  in->read(block.data(), static_cast<std::streamsize>(block.size()));
  const std::streamsize got = in->gcount();
  // A stream turns what its buffer throws into badbit: that is how a read error goes on.
  if (in->bad()) throw std::ios_base::failure("read error");
  if (got == 0) return traits_type::eof();
  setg(block.data(), block.data(), block.data() + got);
  return traits_type::to_int_type(*gptr());
}

PeekedStream::Buffer::pos_type PeekedStream::Buffer::seekpos(pos_type position, std::ios_base::openmode) {
  const pos_type nowhere(off_type(-1));
  if (position != pos_type(0)) return nowhere;
  const std::ios_base::iostate before = in->rdstate();
  in->clear();
  if (!in->seekg(0)) {
    in->clear(before);
    return nowhere;
  }
  setg(block.data(), block.data(), block.data());
  return position;
}

PeekedStream::PeekedStream(std::unique_ptr<std::istream> stream) : std::istream(nullptr), buffer_(std::move(stream)) {
  rdbuf(&buffer_);
  if (buffer_.in->bad()) setstate(std::ios_base::badbit);
}

}  // namespace steerid
