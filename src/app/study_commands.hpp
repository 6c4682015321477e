#pragma once
#include <string>
#include <vector>

#include "workflow/studies.hpp"

namespace ejecta {

// The commands. Each returns an ExitCode.
int study_case(const StudyOptions& options, bool quiet);
int map_case(const StudyOptions& options, bool quiet);
int campaign_case(const std::string& path, const CampaignOptions& options);
int study_tasks(const std::string& directory, const std::vector<std::size_t>& tasks, int threads);
int study_tell(const std::string& directory);
int study_stop(const std::string& directory);
int study_collect(const std::string& directory);

}  // namespace ejecta
