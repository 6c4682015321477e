#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ejecta::output {

/// A ParaView series: NAME.pvd lists the files of the moments and their times. It is rewritten and renamed at
/// every addition, so it is valid at any moment.
class PvdSeries {
 public:
  /// A new series DIR/NAME.pvd.
  PvdSeries(std::filesystem::path directory, std::string name);
  /// Goes on with an existing series after dropping the moments later than `time`, s.
  PvdSeries(std::filesystem::path directory, std::string name, double time);

  /// File for the next moment, e.g. DIR/air-000012.vtr; write it, then call add().
  std::filesystem::path next(const std::string& extension) const;
  void add(double time, const std::filesystem::path& file);

 private:
  void write() const;
  struct Entry {
    double time;
    std::string file;
  };
  std::filesystem::path directory_;
  std::string name_;
  std::vector<Entry> entries_;
};

}  // namespace ejecta::output
