#include "output/encode.hpp"

#include <zlib.h>

#include "base/error.hpp"

namespace ejecta::output {

void append_base64(std::string& out, const void* bytes, std::size_t count) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* p = static_cast<const std::uint8_t*>(bytes);
  out.reserve(out.size() + (count + 2) / 3 * 4);
  for (; count >= 3; count -= 3, p += 3) {
    const std::uint32_t v = std::uint32_t(p[0]) << 16 | std::uint32_t(p[1]) << 8 | p[2];
    for (int shift = 18; shift >= 0; shift -= 6) out += kDigits[v >> shift & 63];
  }
  if (count == 0) return;
  const std::uint32_t v = std::uint32_t(p[0]) << 16 | (count == 2 ? std::uint32_t(p[1]) << 8 : 0);
  out += kDigits[v >> 18 & 63];
  out += kDigits[v >> 12 & 63];
  out += count == 2 ? kDigits[v >> 6 & 63] : '=';
  out += '=';
}

void compress_zlib(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  out.resize(size);
  if (compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 6) != Z_OK)
    throw Error("zlib ran out of memory");
  out.resize(size);
}

}  // namespace ejecta::output
