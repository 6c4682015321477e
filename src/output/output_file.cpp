#include "output/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.hpp"

namespace ejecta::output {
namespace {

void write_all(int fd, const void* data, std::size_t bytes, const std::filesystem::path& path) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t n = ::write(fd, at, bytes);
    if (n < 0) {
      if (errno == EINTR) continue;
      throw_system_error("cannot write", path);
    }
    at += n;
    bytes -= static_cast<std::size_t>(n);
  }
}

}  // namespace

void throw_system_error(std::string_view what, const std::filesystem::path& path) {
  const int code = errno;
  std::string hint;
  if (code == ENOSPC || code == EDQUOT)
    hint = " (free some space; --resume goes on from the last checkpoint)";
  if (code == EACCES || code == EROFS || code == EPERM) hint = " (choose another place with --out DIR)";
  std::error_code unknown;
  if (code == ENOENT && !std::filesystem::exists(path.parent_path(), unknown))
    hint = " (its directory is gone: was it removed while the run was going?)";
  throw Error(fmt::format("{} {}: {}{}", what, path.string(), std::strerror(code), hint));
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)), temporary_(path_) {
  temporary_ += ".tmp";
  fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd_ < 0) throw_system_error("cannot create", temporary_);
}

OutputFile::~OutputFile() {
  if (fd_ < 0) return;
  ::close(fd_);
  ::unlink(temporary_.c_str());
}

void OutputFile::write(const void* data, std::size_t bytes) { write_all(fd_, data, bytes, temporary_); }

void OutputFile::commit() {
  // Some file systems report a full disk only here.
  if (::close(std::exchange(fd_, -1)) != 0) throw_system_error("cannot close", temporary_);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) throw_system_error("cannot rename to", path_);
}

void OutputFile::commit_durably() {
  if (::fsync(fd_) != 0) throw_system_error("cannot flush", temporary_);
  commit();
  const std::filesystem::path directory = path_.has_parent_path() ? path_.parent_path() : ".";
  const int fd = ::open(directory.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) throw_system_error("cannot open", directory);
  const int failed = ::fsync(fd);  // the new name
  const int code = errno;
  ::close(fd);
  errno = code;
  if (failed != 0) throw_system_error("cannot flush", directory);
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

std::string read_file(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) throw_system_error("cannot read", path);
  std::string text;
  char buffer[1 << 16];
  ssize_t n = 0;
  while ((n = ::read(fd, buffer, sizeof buffer)) > 0) text.append(buffer, static_cast<std::size_t>(n));
  const int code = errno;
  ::close(fd);
  errno = code;
  if (n < 0) throw_system_error("cannot read", path);
  return text;
}

bool holds_no_file(const std::filesystem::path& directory, std::string_view head, std::error_code& failed) {
  if (!std::filesystem::exists(directory, failed)) return true;
  for (auto entry = std::filesystem::recursive_directory_iterator(directory, failed);
       !failed && entry != std::filesystem::recursive_directory_iterator(); entry.increment(failed))
    if (!entry->is_directory() && entry->path().filename() != std::string(head) + ".tmp") return false;
  return true;
}

LineFile::LineFile(std::filesystem::path path) : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) throw_system_error("cannot create", path_);
}

LineFile::LineFile(std::filesystem::path path, std::size_t bytes) : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (fd_ < 0) throw_system_error("cannot open", path_);
  if (::ftruncate(fd_, static_cast<off_t>(bytes)) != 0) {
    const int code = errno;
    ::close(fd_);
    errno = code;
    throw_system_error("cannot shorten", path_);
  }
}

LineFile::LineFile(LineFile&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}

LineFile::~LineFile() {
  if (fd_ >= 0) ::close(fd_);
}

void LineFile::append(std::string_view lines) {
  struct stat status {};
  if (::fstat(fd_, &status) != 0) throw_system_error("cannot write", path_);
  // Writing to a deleted file succeeds and is lost; the user shall hear of it.
  if (status.st_nlink == 0)
    throw Error(fmt::format("{} was removed while the run was going", path_.string()));
  write_all(fd_, lines.data(), lines.size(), path_);
}

}  // namespace ejecta::output
