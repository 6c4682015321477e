#include "simulation/model.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace ejecta {

const std::vector<double>& numbers_of(const StateNumbers& numbers, const std::string& name) {
  const auto at = numbers.find(name);
  if (at == numbers.end()) throw Error(fmt::format("the saved state has no \"{}\"", name));
  return at->second;
}

nlohmann::ordered_json operators_json(std::span<const OperatorTime> operators) {
  auto list = nlohmann::ordered_json::array();
  for (const OperatorTime& op : operators)
    list.push_back(
        {{"name", op.name}, {"equation", op.equation}, {"seconds", op.seconds}, {"calls", op.calls}});
  return list;
}

}  // namespace ejecta
