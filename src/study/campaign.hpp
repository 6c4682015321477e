#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "case/case.hpp"

namespace ejecta {

struct CampaignOptions {
  std::filesystem::path out;
  bool force = false;  ///< start anew
  bool print_commands = false;
  bool quiet = false;
};

/// What a campaign needs of those who know the whole program.
struct CampaignHands {
  /// The case of a part; throws InputError where it cannot be run.
  std::function<Case(const std::string& path, const std::vector<std::string>& overrides)> load;
  /// Gives a command of the program and waits: its exit code.
  std::function<int(std::vector<std::string> words)> command{};
  Note note{};    ///< progress
  Note result{};  ///< what was asked for
};

/// What the parts of a campaign are, a line each. Throws InputError where one cannot be run.
std::string check_campaign(const Case& c, const CampaignHands& hands);

/// Gives the command of each part that is not done, one after the other, and writes result.json and the
/// report after each. Returns the exit code of the first part that failed, after which the others are run all
/// the same, or of one that was stopped.
int run_campaign(const Case& c, const CampaignOptions& options, const CampaignHands& hands);

}  // namespace ejecta
