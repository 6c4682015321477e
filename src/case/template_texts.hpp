#pragma once
#include <string>
#include <vector>

namespace ejecta {

/// A short case that `ejecta new` enlarges with comments and the keys left out.
struct TemplateText {
  std::string kind, help, text;
};
const std::vector<TemplateText>& template_texts();

}  // namespace ejecta
