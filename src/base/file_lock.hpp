#pragma once
#include <filesystem>

namespace ejecta {

/// Waits until nobody else holds the lock of this name, in this process or another on the machine, and holds
/// it as long as it lives. The file stays, empty. Throws Error where it cannot be made. A process that dies
/// lets go.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace ejecta
