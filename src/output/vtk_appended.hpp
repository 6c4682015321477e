#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ejecta::output {

/// Collects a VTK XML file: header text with <DataArray> elements, then the numbers as one raw appended block
/// (uncompressed, UInt64 lengths), which ParaView opens fastest and which costs a copy to write. Storage is
/// reused from file to file.
class VtkAppended {
 public:
  /// Starts a file; `type` is the VTK data set, e.g. "RectilinearGrid".
  void begin(std::string_view type);
  void text(std::string_view xml) { head_ += xml; }
  /// <FieldData> with the time, which ParaView shows when a single file is opened.
  void time(double seconds);
  template <class T>
  void array(std::string_view name, int components, std::span<const T> values) {
    std::memcpy(begin_array(type_name(T{}), name, components, values.size_bytes()), values.data(),
                values.size_bytes());
  }
  /// Room for `count` floats to be filled in by the caller, before the next call.
  float* float_array(std::string_view name, int components, std::size_t count);
  void write(const std::filesystem::path& path);

 private:
  static std::string_view type_name(float) { return "Float32"; }
  static std::string_view type_name(double) { return "Float64"; }
  static std::string_view type_name(std::int64_t) { return "Int64"; }
  void* begin_array(std::string_view type, std::string_view name, int components, std::size_t bytes);
  std::string type_, head_;
  std::vector<char> data_;
  std::size_t used_ = 0;
};

/// "a < b" with the characters XML reserves written as entities.
std::string xml_escaped(std::string_view text);

}  // namespace ejecta::output
