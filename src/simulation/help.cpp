#include "simulation/help.hpp"

#include "base/error.hpp"
#include "case/explain.hpp"
#include "output/result_words.hpp"

namespace ejecta {

std::string help_on(const std::string& topic) {
  const std::string results = output::explain_result(topic);
  if (results.empty()) return explain(topic);
  try {
    return results + "\n" + explain(topic);
  } catch (const InputError&) {  // no key is about it
    return results;
  }
}

}  // namespace ejecta
