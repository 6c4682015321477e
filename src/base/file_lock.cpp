#include "base/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/error.hpp"

namespace ejecta {

FileLock::FileLock(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw Error("cannot open " + file.string() + ": " + std::strerror(errno));
  int failed = 0;
  do failed = ::flock(descriptor_, LOCK_EX);
  while (failed != 0 && errno == EINTR);
  if (failed == 0) return;
  const std::string reason = std::strerror(errno);
  ::close(descriptor_);
  throw Error("cannot lock " + file.string() + ": " + reason);
}

FileLock::~FileLock() { ::close(descriptor_); }

namespace {

int open_directory(const std::filesystem::path& directory) {
  return ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

bool taken_by_another(int descriptor, int kind) {
  return ::flock(descriptor, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace

DirectoryClaim::DirectoryClaim(const std::filesystem::path& directory)
    : descriptor_(open_directory(directory)) {
  // Who only asks, see is_claimed(), holds it for a moment.
  for (int tries = 0; tries < 10 && (held_ = !taken_by_another(descriptor_, LOCK_EX), !held_); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

DirectoryClaim::~DirectoryClaim() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool is_claimed(const std::filesystem::path& directory) {
  const int descriptor = open_directory(directory);
  if (descriptor < 0) return false;
  const bool taken = taken_by_another(descriptor, LOCK_SH);
  ::close(descriptor);
  return taken;
}

}  // namespace ejecta
