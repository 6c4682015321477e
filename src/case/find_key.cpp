#include "case/find_key.hpp"

#include <fmt/format.h>

#include "base/text.hpp"
#include "case/schema.hpp"

namespace ejecta {
namespace {

/// visit(path of the key, the key) for every key of every element, elements with a name twice: by number and
/// by name.
template <class Visit>
void for_each_key(Case& c, const Visit& visit) {
  for (const Section& s : sections(c))
    for (std::size_t n = 0; n < s.count(); ++n) {
      const std::vector<Key> keys = s.keys(n);
      std::string element = s.name, named;
      if (s.repeated) {
        element = fmt::format("{}.{}", s.name, n);
        for (const Key& key : keys)
          if (const auto* name = std::get_if<std::string*>(&key.slot); name && key.name == "name")
            named = s.name + "." + **name;
      }
      for (const Key& key : keys) {
        visit(element + "." + key.name, key);
        if (!named.empty()) visit(named + "." + key.name, key);
      }
    }
}

}  // namespace

std::optional<Key> find_key(Case& c, const std::string& path) {
  std::optional<Key> found;
  for_each_key(c, [&](const std::string& known, const Key& key) {
    if (!found && known == path) found = key;
  });
  return found;
}

std::string nearest_key(Case& c, const std::string& path) {
  std::vector<std::string> all;
  for_each_key(c, [&](const std::string& known, const Key&) { all.push_back(known); });
  return nearest(path, all);
}

}  // namespace ejecta
