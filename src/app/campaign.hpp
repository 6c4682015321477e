#pragma once
#include <string>

#include "case/case.hpp"

namespace ejecta {

struct CampaignOptions {
  std::string path;    ///< case file with [campaign]
  std::string out;     ///< directory; empty: the name of the case with ".campaign"
  bool force = false;  ///< start anew
  bool print_commands = false;
  bool quiet = false;
};

/// What the parts of a campaign are. Throws InputError where one cannot be run.
std::string check_campaign(const Case& c);

/// Gives the command of each part that is not done, one after the other, and writes the report after each.
/// Returns an ExitCode: of the first part that failed, the others are run all the same.
int run_campaign(const CampaignOptions& options);

}  // namespace ejecta
