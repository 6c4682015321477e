#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"
#include "study/campaign.hpp"
#include "study/perform.hpp"

namespace ejecta {

struct StudyOptions {
  std::string path;                    ///< case file
  std::vector<std::string> overrides;  ///< "section.key=value"
  std::string out;                     ///< directory; empty: the name of the case with ".study" or ".map"
  int at_once = 0;                     ///< runs side by side; 0: as many as cores and memory allow
  bool force = false;                  ///< start anew
  bool retry = false;                  ///< also what diverged or was refused
  bool quiet = false;
  bool print_commands = false;      ///< only say what a scheduler would have to run
  bool slurm = false;               ///< job arrays instead of processes here
  std::vector<std::string> sbatch;  ///< options of theirs
};

/// One run as a study asks for it: goes on from its last checkpoint, or takes the result that is there.
RunAnswer run_for_study(const Case& c, const RunRequest& request);

// The commands. Each returns an ExitCode.
int study_case(const StudyOptions& options);
int map_case(const StudyOptions& options);
int campaign_case(const std::string& path, CampaignOptions options);
/// The parts of a campaign; throws InputError where one cannot be run.
std::string campaign_checked(const Case& c);
int study_tasks(const std::string& directory, const std::vector<std::size_t>& tasks, int threads);
int study_tell(const std::string& directory);
int study_stop(const std::string& directory);
int study_collect(const std::string& directory);

}  // namespace ejecta
