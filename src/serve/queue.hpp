#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ejecta {

/// One command of the program on one case: a run, a study, a map, a sorter, a campaign.
struct Job {
  std::string name;       ///< of its directory in the folder, "flat-2.run"
  std::string kind;       ///< the command: "run", "study", "map", "sort", "campaign"
  std::string case_name;  ///< in the folder
  std::string digest;     ///< of the case, and what it reads, when it was asked for; "": of one that goes on
  bool resumes = false;
  std::uintmax_t said = 0;  ///< bytes of its log before it
};

/// What is to be run in a folder, on disk (.ejecta/queue.json), so that servers may die and others go on.
class Queue {
 public:
  explicit Queue(const std::filesystem::path& folder) : place_(folder / ".ejecta") {}

  static constexpr int kMostAtOnce = 64;
  struct State {
    int at_once = 1;
    std::vector<Job> waiting;  ///< the first is the next
    std::vector<Job> started;  ///< that have not been seen to have ended
  };
  /// Throws Error where the file is damaged.
  State read() const;
  /// Lets `act` change it while no other server of the folder does. What it keeps by `keep()` on the way, and
  /// what it leaves, is on the disk.
  using Keep = std::function<void()>;
  void change(const std::function<void(State&, const Keep& keep)>& act) const;

 private:
  std::filesystem::path file() const { return place_ / "queue.json"; }
  std::filesystem::path place_;
};

}  // namespace ejecta
