#pragma once
#include <functional>
#include <span>

#include "base/text.hpp"
#include "study/task_store.hpp"

namespace ejecta {

/// Who is there while many runs are computed: is told, and may stop them. Empty parts are not called.
struct Attendance {
  Note note{};                                   ///< a line of progress
  Note command{};                                ///< a command that is left, where only these are asked for
  std::function<void(const TaskStore&)> look{};  ///< called now and then, and after each run
  std::function<void(double done, bool last)> share{};  ///< of a sorter: which part of the belt has passed
  std::function<bool()> stop{};  ///< true: no more runs, those that run end with a checkpoint

  void tell(const std::string& line) const {
    if (note) note(line);
  }
};

}  // namespace ejecta
