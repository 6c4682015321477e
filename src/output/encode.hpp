#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ejecta::output {

/// Appends the base64 (RFC 4648) of `bytes` to `out`.
void append_base64(std::string& out, const void* bytes, std::size_t count);

/// zlib stream (RFC 1950) of `bytes`, into `out`, whose storage is reused.
void compress_zlib(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out);

}  // namespace ejecta::output
