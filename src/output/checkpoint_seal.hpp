#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "output/checkpoint.hpp"

namespace ejecta::output {

inline constexpr std::size_t kSealBytes = 512;

/// The first 512 bytes of a checkpoint (magic, version, clock, length, SHA-256) whose other bytes are `rest`.
std::array<std::uint8_t, kSealBytes> make_seal(CheckpointTime at, std::span<const std::uint8_t> rest);

/// Checks the seal; throws Error that names the file and what is wrong with it.
CheckpointTime check_seal(const std::filesystem::path& path);

}  // namespace ejecta::output
