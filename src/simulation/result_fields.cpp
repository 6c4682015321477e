#include "simulation/result_fields.hpp"

#include <map>

namespace ejecta {
namespace {

const std::map<std::string, std::string> kFieldUnits{
    {"velocity", "m/s"},        {"pressure", "Pa"},   {"density", "kg/m3"},       {"k", "m2/s2"},
    {"omega", "1/s"},           {"epsilon", "m2/s3"}, {"eddy_viscosity", "m2/s"}, {"void_fraction", ""},
    {"drag_coefficient", "1/s"}};

ResultField copied_field(const CellField& f, const Grid& grid) {
  ResultField copy{f.name, kFieldUnits.at(f.name), f.components, {}};
  copy.values.resize(static_cast<std::size_t>(grid.cells()) * static_cast<std::size_t>(f.components));
  for_each_index(grid.nz(), [&](int k) {
    Real* to = copy.values.data() + std::ptrdiff_t(k) * grid.ny() * grid.nx() * f.components;
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i)
        for (int c = 0; c < f.components; ++c)
          *to++ = static_cast<Real>(f.scale * f.component[static_cast<std::size_t>(c)](i, j, k) + f.offset);
  });
  return copy;
}

}  // namespace

std::optional<ResultFields> copied_fields(Model& model) {
  const FieldsOnGrid now = model.fields();
  if (!now.grid) return std::nullopt;
  ResultFields copy;
  for (int d = 0; d < 3; ++d) copy.faces[static_cast<std::size_t>(d)] = now.grid->axis(d).face;
  for (const CellField& f : now.fields) copy.fields.push_back(copied_field(f, *now.grid));
  return copy;
}

}  // namespace ejecta
