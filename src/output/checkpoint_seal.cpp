#include "output/checkpoint_seal.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "output/output_file.hpp"

namespace ejecta::output {
namespace {

struct Seal {
  std::array<char, 16> magic{'E', 'J', 'E', 'C', 'T', 'A', ' ', 'C', 'H', 'E', 'C', 'K', 'P', 'O', 'I', 'N'};
  std::uint32_t version = kCheckpointVersion;
  std::uint32_t reserved = 0;
  std::uint64_t bytes = 0;  // of the whole file
  double time = 0.0;
  std::int64_t step = 0;
  std::array<std::uint8_t, 32> digest{};  // of the seal with an empty digest, then of all after its 512 bytes
};
static_assert(sizeof(Seal) == 80 && std::is_trivially_copyable_v<Seal>);

struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File open(const std::filesystem::path& path) {
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw_system_error("cannot open", path);
  return file;
}

/// Digest of the seal with an empty digest, to which the rest of the file is added.
Sha256 begin_digest(Seal seal) {
  seal.digest = {};
  Sha256 hash;
  hash.update(&seal, sizeof seal);
  return hash;
}

}  // namespace

std::array<std::uint8_t, kSealBytes> make_seal(CheckpointTime at, std::span<const std::uint8_t> rest) {
  Seal seal;
  seal.bytes = kSealBytes + rest.size();
  seal.time = at.time;
  seal.step = at.step;
  Sha256 hash = begin_digest(seal);
  hash.update(rest.data(), rest.size());
  seal.digest = hash.digest();
  std::array<std::uint8_t, kSealBytes> bytes{};
  std::memcpy(bytes.data(), &seal, sizeof seal);
  return bytes;
}

CheckpointTime check_seal(const std::filesystem::path& path) {
  const auto damaged = [&](const std::string& what) {
    return Error(fmt::format("checkpoint {} is damaged: {}", path.string(), what));
  };
  const File file = open(path);
  Seal seal;
  const Seal expected;
  if (std::fread(&seal, sizeof seal, 1, file.get()) != 1) throw damaged("it is too short");
  if (seal.magic != expected.magic) throw damaged("it is not a checkpoint of Ejecta");
  if (seal.version != kCheckpointVersion)
    throw Error(fmt::format("checkpoint {} has format {}, this program reads format {}", path.string(),
                            seal.version, kCheckpointVersion));
  std::error_code failed;
  const std::uint64_t bytes = std::filesystem::file_size(path, failed);
  if (failed) throw damaged(failed.message());
  if (bytes != seal.bytes) throw damaged(fmt::format("it has {} bytes instead of {}", bytes, seal.bytes));
  std::fseek(file.get(), kSealBytes, SEEK_SET);
  Sha256 hash = begin_digest(seal);
  std::vector<std::uint8_t> buffer(1 << 18);
  std::size_t n = 0;
  while ((n = std::fread(buffer.data(), 1, buffer.size(), file.get())) > 0) hash.update(buffer.data(), n);
  if (hash.digest() != seal.digest) throw damaged("its checksum does not fit");
  return {seal.time, seal.step};
}

}  // namespace ejecta::output
