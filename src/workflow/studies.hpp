#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "study/campaign.hpp"
#include "study/map.hpp"
#include "study/study.hpp"
#include "workflow/attendance.hpp"

namespace ejecta {

struct StudyOptions {
  std::string path{};                    ///< case file
  std::vector<std::string> overrides{};  ///< "section.key=value"
  std::string out{};                     ///< directory; empty: the name of the case with ".study" or ".map"
  std::filesystem::path program;         ///< `ejecta`, which runs the tasks
  int at_once = 0;                       ///< runs side by side; 0: as many as cores and memory allow
  bool force = false;                    ///< start anew
  bool retry = false;                    ///< also what diverged or was refused
  bool print_commands = false;           ///< only say what a scheduler would have to run
  bool slurm = false;                    ///< job arrays instead of processes here
  std::vector<std::string> sbatch{};     ///< options of theirs
};

/// What became of a study, map or campaign.
enum class StudyEnd { finished, failures, stopped, commands_left };

// Each works in its directory and goes on with what is there; throws InputError before the first run where
// one cannot be made.
StudyEnd compute_study(const StudyOptions& options, const Attendance& who);
/// failures: the map contradicts some of its runs.
StudyEnd compute_map(const StudyOptions& options, const Attendance& who);
/// Runs tasks of a study that are not done, in this process; the ExitCode of the last that failed, or that it
/// was stopped.
int compute_tasks(const std::string& directory, const std::vector<std::size_t>& tasks, int threads,
                  const Attendance& who);
/// Gives commands to `program`. Returns the exit code of run_campaign.
int compute_campaign(const std::string& path, CampaignOptions options, const std::filesystem::path& program,
                     const Attendance& who);
/// Throws InputError with all that is wrong with any run of a [study]. `root`: the tree of the case `c`.
void check_study(const Node& root, const Case& c);
/// The parts of a campaign; throws InputError where one cannot be run.
std::string campaign_checked(const Case& c);

std::filesystem::path study_directory(const StudyOptions& options, const char* kind);
/// Writes runs.csv, result.json and the report of a study from what is done. Throws InputError for a map.
void collect_study(const TaskStore& store);

}  // namespace ejecta
