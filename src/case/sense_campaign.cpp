#include <fmt/format.h>

#include <filesystem>

#include "case/findings.hpp"
#include "case/load.hpp"
#include "case/sense.hpp"

/// [campaign]: whether there are parts, and their files. What stands in these is for the command.
namespace ejecta {

void sense_campaign(const Case& c, Findings& found) {
  if (c.campaign.parts.empty())
    found.error("campaign", "a campaign without parts", "[[campaign.part]]",
                "[[campaign.part]] kind = \"run\", case = \"10mm-cubic.toml\"");
  for (const std::string& key : c.given)
    if (section_of(key) != "campaign")
      found.error(key, "does nothing here: a campaign only names cases, each with keys of its own",
                  "[campaign] and [[campaign.part]] alone", "[[campaign.part]] set = [\"run.courant=0.8\"]");
  for (std::size_t n = 0; n < c.campaign.parts.size(); ++n) {
    const std::string file = beside_case(c, c.campaign.parts[n].file);
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none))
      found.error(fmt::format("campaign.part.{}.case", n), fmt::format("there is no file \"{}\"", file),
                  "a case file, relative to the folder of this one", "case = \"10mm-cubic.toml\"");
  }
}

}  // namespace ejecta
