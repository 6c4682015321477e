#include "output/vtk_appended.hpp"

#include <fmt/format.h>

#include "output/output_file.hpp"

namespace ejecta::output {

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

void VtkAppended::begin(std::string_view type) {
  type_ = type;
  head_ = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<{0}",
      type);
  used_ = 0;
}

void VtkAppended::time(double seconds) {
  head_ += fmt::format(
      "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}"
      "</DataArray></FieldData>\n",
      seconds);
}

void* VtkAppended::begin_array(std::string_view type, std::string_view name, int components,
                               std::size_t bytes) {
  head_ += fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
      type, xml_escaped(name), components, used_);
  const std::uint64_t length = bytes;
  const std::size_t end = used_ + sizeof length + bytes;
  if (data_.size() < end) data_.resize(end);
  std::memcpy(data_.data() + used_, &length, sizeof length);
  void* room = data_.data() + used_ + sizeof length;
  used_ = end;
  return room;
}

float* VtkAppended::float_array(std::string_view name, int components, std::size_t count) {
  return static_cast<float*>(begin_array("Float32", name, components, count * sizeof(float)));
}

void VtkAppended::write(const std::filesystem::path& path) {
  OutputFile file(path);
  file.write(fmt::format("{}</{}>\n<AppendedData encoding=\"raw\">\n_", head_, type_));
  file.write(data_.data(), used_);
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.commit();
}

}  // namespace ejecta::output
