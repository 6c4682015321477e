#pragma once
#include <cstdint>
#include <filesystem>

#include "output/checkpoint.hpp"

namespace ejecta::output {

inline constexpr std::size_t kSealBytes = 512;

/// Writes the seal (magic, version, clock, length, SHA-256 of the rest) into the first 512 bytes of a closed
/// file.
void write_seal(const std::filesystem::path& path, CheckpointTime at);

/// Checks the seal; throws Error that names the file and what is wrong with it.
CheckpointTime check_seal(const std::filesystem::path& path);

}  // namespace ejecta::output
