#include "output/pvd_series.hpp"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <utility>

#include "base/error.hpp"
#include "output/output_file.hpp"
#include "output/vtk_appended.hpp"

namespace ejecta::output {
namespace {

/// Value of an XML attribute in one line that we wrote.
std::string attribute(const std::string& line, const std::string& name) {
  const std::string mark = name + "=\"";
  const std::size_t begin = line.find(mark);
  if (begin == std::string::npos) return {};
  const std::size_t from = begin + mark.size();
  return line.substr(from, line.find('"', from) - from);
}

}  // namespace

PvdSeries::PvdSeries(std::filesystem::path directory, std::string name)
    : directory_(std::move(directory)), name_(std::move(name)) {
  write();
}

PvdSeries::PvdSeries(std::filesystem::path directory, std::string name, double time)
    : directory_(std::move(directory)), name_(std::move(name)) {
  const std::filesystem::path path = directory_ / (name_ + ".pvd");
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    const std::string at = attribute(line, "timestep");
    if (at.empty()) continue;
    Entry entry{0.0, attribute(line, "file")};
    if (std::from_chars(at.data(), at.data() + at.size(), entry.time).ec != std::errc())
      throw Error(fmt::format("{}: \"{}\" is not a time", path.string(), at));
    if (entry.time <= time) entries_.push_back(std::move(entry));
  }
  write();
}

std::filesystem::path PvdSeries::next(const std::string& extension) const {
  return directory_ / fmt::format("{}-{:06}{}", name_, entries_.size(), extension);
}

void PvdSeries::add(double time, const std::filesystem::path& file) {
  entries_.push_back({time, file.filename().string()});
  write();
}

void PvdSeries::write() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const Entry& e : entries_)
    text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", e.time, xml_escaped(e.file));
  write_file(directory_ / (name_ + ".pvd"), text + "</Collection>\n</VTKFile>\n");
}

}  // namespace ejecta::output
