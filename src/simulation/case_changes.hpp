#pragma once
#include <string>
#include <vector>

namespace ejecta {

/// The keys that differ between two resolved cases (as write_case writes them) and that a run cannot change
/// on its way: all but where it ends ([run] end_time, until, title), its checkpoints and what it is compared
/// with. E.g. "valve.rise_time", "body.1.diameter".
std::vector<std::string> changed_keys(const std::string& before, const std::string& after);

}  // namespace ejecta
