#include "base/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

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

}  // namespace ejecta
