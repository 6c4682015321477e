#include "output/figures.hpp"

#include "output/encode.hpp"
#include "output/output_file.hpp"

namespace ejecta::output {

void Figures::add(const Picture& picture) {
  std::vector<std::uint8_t> packed;
  compress_zlib(picture.pixels, packed);
  std::string data;
  append_base64(data, packed.data(), packed.size());
  pictures_.push_back({{"title", picture.title},
                       {"width", picture.width},
                       {"height", picture.height},
                       {"data", std::move(data)}});
}

void Figures::write(const std::filesystem::path& file) const {
  nlohmann::ordered_json charts = nlohmann::ordered_json::array();
  for (const Figure& f : figures_) {
    nlohmann::ordered_json series = nlohmann::ordered_json::array();
    for (const FigureSeries& s : f.series)
      series.push_back(
          {{"label", s.label}, {"x", s.x}, {"y", s.y}, {"dashed", s.dashed}, {"points", s.points}});
    charts.push_back(
        {{"title", f.title}, {"x_label", f.x_label}, {"y_label", f.y_label}, {"series", series}});
  }
  OutputFile out(file);
  out.write(nlohmann::ordered_json{{"charts", charts}, {"pictures", pictures_}}.dump());
  out.commit();
}

}  // namespace ejecta::output
