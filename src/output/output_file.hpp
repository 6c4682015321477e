#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace ejecta::output {

/// A file that appears complete or not at all: written beside as PATH.tmp and renamed by commit(). Every
/// write is checked; a full disk, a missing directory or a missing permission throws Error with the path and
/// the system's reason, and what was there before stays.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();  ///< without commit(): removes the temporary file
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void commit();
  /// As commit(), and the content is on the disk before the file has its name.
  void commit_durably();

 private:
  std::filesystem::path path_, temporary_;
  int fd_ = -1;
};

void write_file(const std::filesystem::path& path, std::string_view text);

/// Whole content; throws Error with the system's reason.
std::string read_file(const std::filesystem::path& path);

/// Whether a directory holds no file, but for one that was being written under the name of its `head`, which
/// says what the directory is, when a process was killed. Folders do not count. A place that does not exist
/// holds nothing; `failed` says why one cannot be looked into.
bool holds_no_file(const std::filesystem::path& directory, std::string_view head, std::error_code& failed);

/// A file that grows by whole lines: each append is one write to the system, so that a killed run leaves at
/// most one torn last line. Appending to a file that was removed meanwhile throws.
class LineFile {
 public:
  /// Creates (or empties) the file.
  explicit LineFile(std::filesystem::path path);
  /// Opens an existing file and cuts it to its first `bytes` bytes.
  LineFile(std::filesystem::path path, std::size_t bytes);
  ~LineFile();
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&&) = delete;

  /// `lines` ends with a newline.
  void append(std::string_view lines);

 private:
  std::filesystem::path path_;
  int fd_ = -1;
};

/// "cannot write runs/a.run/result.json: No space left on device": throws Error from errno.
[[noreturn]] void throw_system_error(std::string_view what, const std::filesystem::path& path);

}  // namespace ejecta::output
