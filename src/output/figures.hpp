#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ejecta::output {

/// A line (or measured points) of a figure; each has places of its own.
struct FigureSeries {
  std::string label;
  std::vector<double> x, y;
  bool dashed = false;
  bool points = false;  ///< marks instead of a line
};

/// A diagram; labels name quantity and unit, as "z [mm]".
struct Figure {
  std::string title, x_label, y_label;
  std::vector<FigureSeries> series{};
};

/// A grey picture, rows from the top, 0 black to 255 white.
struct Picture {
  std::string title;
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels{};
};

/// figures.json: the diagrams and pictures of a run that the report shows as they are (docs/files.md).
class Figures {
 public:
  void add(Figure figure) { figures_.push_back(std::move(figure)); }
  void add(const Picture& picture);
  /// Throws Error when the file cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<Figure> figures_;
  nlohmann::ordered_json pictures_ = nlohmann::ordered_json::array();
};

}  // namespace ejecta::output
