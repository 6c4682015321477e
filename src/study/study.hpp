#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/load.hpp"
#include "case/node.hpp"
#include "study/task_store.hpp"

namespace ejecta {

/// A study as it is asked for: what its directory says of it, and its runs.
struct StudySetup {
  nlohmann::ordered_json header;
  std::vector<NewTask> tasks;
};

/// The runs of [study]. `root`: the tree of the case file, `base`: the same as resolved. Throws InputError
/// with everything that is wrong with any of the runs, each with the place where it is written, before the
/// first one runs.
StudySetup set_up_study(const Node& root, const Case& base, const FurtherChecks& further = {});

/// The head of a study's directory: kind, title, case, and the hash by which it knows itself again.
nlohmann::ordered_json study_header(const std::string& kind, const Case& base);

/// A sentence for each asked-for quantity that no run has, where at least one is done.
std::vector<std::string> unknown_quantities(const TaskStore& store);
/// result.json of a study: one entry a run with the varied keys (SI units), the quantities and the state.
nlohmann::ordered_json study_result(const TaskStore& store);
/// The same as a table for Excel: units stand in the head.
std::string study_table(const nlohmann::ordered_json& result);

/// How far a study is.
struct StudyStatus {
  std::size_t tasks = 0, done = 0, running = 0, waiting = 0, failed = 0;
  double seconds_left = -1.0;      ///< at the pace of late; below 0: not known
  std::vector<std::string> lines;  ///< of what runs and what failed
};
StudyStatus study_status(const TaskStore& store);
/// On one line: "12 of 40 runs done, 2 running, 1 failed, about 3 min left".
std::string status_line(const StudyStatus& status);

}  // namespace ejecta
