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

/// Claims a directory for as long as it lives, or until its process dies: nobody else on this machine has it
/// meanwhile. Leaves nothing behind in it.
class DirectoryClaim {
 public:
  explicit DirectoryClaim(const std::filesystem::path& directory);
  ~DirectoryClaim();
  DirectoryClaim(const DirectoryClaim&) = delete;
  DirectoryClaim& operator=(const DirectoryClaim&) = delete;
  /// False: somebody else has it. True also where the file system knows no locks.
  bool held() const { return held_; }

 private:
  int descriptor_;
  bool held_ = true;
};
/// Somebody has claimed it.
bool is_claimed(const std::filesystem::path& directory);

}  // namespace ejecta
