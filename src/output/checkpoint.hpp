#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The state of a run as an HDF5 file of named arrays. Names may have groups: "flow/velocity_x".
///
/// The first 512 bytes (HDF5's user block) hold a magic word, the format's version, the file's length and the
/// SHA-256 of everything after them. The reader checks these before HDF5 sees a byte, so that a damaged file
/// is reported as such and never parsed. Other programs open the file as plain HDF5.
namespace ejecta::output {

inline constexpr std::uint32_t kCheckpointVersion = 6;

/// Where the clock stood.
struct CheckpointTime {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
};

class CheckpointWriter {
 public:
  CheckpointWriter(std::filesystem::path path, CheckpointTime at);
  ~CheckpointWriter();  ///< without commit(): leaves nothing behind
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  void put(const std::string& name, std::span<const double> values);
  void put(const std::string& name, std::span<const float> values);
  void put(const std::string& name, std::span<const std::int64_t> values);
  void put(const std::string& name, std::span<const std::uint8_t> values);
  /// Closes, adds the checksum, flushes to the disk, renames.
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class CheckpointReader {
 public:
  /// Throws Error that names the file and the damage.
  explicit CheckpointReader(const std::filesystem::path& path);
  ~CheckpointReader();
  CheckpointReader(CheckpointReader&&) noexcept;
  CheckpointReader& operator=(CheckpointReader&&) noexcept;

  const std::filesystem::path& path() const;
  CheckpointTime at() const;
  bool has(const std::string& name) const;
  /// Number of values; throws Error when there is no such array, or not all of it is in the file.
  std::size_t size(const std::string& name) const;
  /// Fills `values`; throws Error unless the array has this type and length.
  void get(const std::string& name, std::span<double> values) const;
  void get(const std::string& name, std::span<float> values) const;
  void get(const std::string& name, std::span<std::int64_t> values) const;
  void get(const std::string& name, std::span<std::uint8_t> values) const;
  /// All values of an array of doubles.
  std::vector<double> numbers(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The checkpoints of one run: DIR/step-000001234.h5.
class CheckpointStore {
 public:
  explicit CheckpointStore(std::filesystem::path directory, int keep = 2);

  CheckpointWriter begin(CheckpointTime at) const;
  /// Commits and removes all but the newest `keep`.
  void commit(CheckpointWriter& writer) const;

  struct Newest {
    std::optional<CheckpointReader> reader;
    std::vector<std::string> damaged;  ///< what was found wrong with newer files
  };
  /// The newest checkpoint that is whole.
  Newest newest() const;

 private:
  std::vector<std::filesystem::path> newest_first() const;
  std::filesystem::path directory_;
  int keep_;
};

}  // namespace ejecta::output
