// Fuzzes the checkpoint reader (libFuzzer). Whatever is in the file, it is read or refused with Error;
// everything else is a finding. Twice:
// - the bytes as a file: no further than the seal, which damage does not pass;
// - the bytes as changes to a whole checkpoint (arrays renamed, retyped, reshaped, resized, their numbers
//   replaced), written by HDF5 and sealed: what another version of the program might have left. Raw bytes
//   behind a valid seal would only try HDF5's own parser, which is not ours and not made for hostile files.
#include <fmt/format.h>
#include <fuzzer/FuzzedDataProvider.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/state_reader.hpp"
#include "output/checkpoint.hpp"
#include "output/checkpoint_seal.hpp"
#include "output/hdf5_handle.hpp"

namespace {

using namespace ejecta;
using namespace ejecta::output;

struct Array {
  std::string name;
  std::vector<hsize_t> shape;
  hid_t type = H5T_NATIVE_DOUBLE;
  std::vector<double> values;
  bool whole = true;  ///< all of it is written
};

/// Arrays as a run leaves them, small.
std::vector<Array> whole_checkpoint() {
  std::vector<Array> arrays{
      {"model/numbers_0", {}, H5T_NATIVE_DOUBLE, {0.5, 3, 1, 2, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}},
      {"flow/field_00", {}, H5T_NATIVE_FLOAT, std::vector<double>(20, 1.0)},
      {"wall_time", {}, H5T_NATIVE_DOUBLE, {2.5}}};
  for (Array& a : arrays) a.shape = {a.values.size()};
  return arrays;
}

hid_t pick_type(FuzzedDataProvider& in) {
  const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_FLOAT, H5T_NATIVE_INT64, H5T_NATIVE_UINT8,
                         H5T_IEEE_F64BE,    H5T_C_S1,         H5T_STD_REF_OBJ};
  return types[in.ConsumeIntegralInRange<std::size_t>(0, std::size(types) - 1)];
}

double pick_number(FuzzedDataProvider& in) {
  switch (in.ConsumeIntegralInRange(0, 4)) {
    case 0:
      return in.ConsumeIntegralInRange(-2, 40);
    case 1:
      return std::numeric_limits<double>::quiet_NaN();
    case 2:
      return in.ConsumeBool() ? 1e300 : -1e300;
    case 3:
      return in.ConsumeIntegral<std::int32_t>();
    default:
      return in.ConsumeFloatingPoint<double>();
  }
}

void change(std::vector<Array>& arrays, FuzzedDataProvider& in) {
  if (arrays.empty()) return;
  Array& a = arrays[in.ConsumeIntegralInRange<std::size_t>(0, arrays.size() - 1)];
  const auto place = [&] { return in.ConsumeIntegralInRange<std::size_t>(0, a.values.size()); };
  switch (in.ConsumeIntegralInRange(0, 7)) {
    case 0:
      a.name = in.ConsumeRandomLengthString(20);
      return;
    case 1:
      a.type = pick_type(in);
      return;
    case 2:
      a.shape.resize(in.ConsumeIntegralInRange<std::size_t>(0, 4));
      for (hsize_t& n : a.shape)
        n = in.ConsumeBool() ? in.ConsumeIntegralInRange(0, 9) : in.ConsumeIntegral<std::uint64_t>();
      a.whole = in.ConsumeBool();
      return;
    case 3:
      a.values.resize(place());
      a.shape = {a.values.size()};
      return;
    case 4: {
      const std::size_t at = place();
      a.values.insert(a.values.begin() + static_cast<std::ptrdiff_t>(at), in.ConsumeIntegralInRange(1, 40),
                      pick_number(in));
      a.shape = {a.values.size()};
      return;
    }
    case 5:
      a.values = arrays.back().values;
      return;
    default:
      if (const std::size_t at = place(); at < a.values.size()) a.values[at] = pick_number(in);
  }
}

/// The arrays as HDF5 keeps them, without the first 512 bytes.
std::vector<std::uint8_t> written(const std::vector<Array>& arrays) {
  const Hdf5Silence silence;
  const Hdf5Handle layout(H5Pcreate(H5P_FILE_CREATE), H5Pclose), access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose),
      links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_userblock(layout, kSealBytes);
  H5Pset_fapl_core(access, 1 << 16, false);
  H5Pset_create_intermediate_group(links, 1);
  const Hdf5Handle file(H5Fcreate("in memory", H5F_ACC_TRUNC, layout, access), H5Fclose);
  for (const Array& a : arrays) {
    const Hdf5Handle space(a.shape.empty()
                               ? H5Screate(H5S_SCALAR)
                               : H5Screate_simple(static_cast<int>(a.shape.size()), a.shape.data(), nullptr),
                           H5Sclose);
    if (!space) continue;
    const Hdf5Handle data(H5Dcreate2(file, a.name.c_str(), a.type, space, links, H5P_DEFAULT, H5P_DEFAULT),
                          H5Dclose);
    const hssize_t n = H5Sget_simple_extent_npoints(space);
    if (data && a.whole && n <= static_cast<hssize_t>(a.values.size()))
      H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, a.values.data());
  }
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::vector<std::uint8_t> image(
      static_cast<std::size_t>(std::max<ssize_t>(H5Fget_file_image(file, nullptr, 0), 0)));
  H5Fget_file_image(file, image.data(), image.size());
  return image;
}

/// As a run that is resumed reads it; false when it is refused with a message.
bool read(const std::filesystem::path& path) {
  try {
    const CheckpointReader reader(path);
    std::vector<float> field(20);
    reader.get("flow/field_00", std::span<float>(field));
    double wall_time = 0.0;
    reader.get("wall_time", std::span<double>(&wall_time, 1));
    const std::vector<double> numbers = reader.numbers("model/numbers_0");
    StateReader state(numbers, "model");
    state.number();
    const int things = state.whole(0, 5);
    const bool known = state.whole(0, 1) == 1;
    for (std::size_t n = state.count(3); n > 0; --n)
      if (state.vec3().size() != 3) std::abort();
    if (known && things > 0) state.end();
    if (reader.has("nothing/of/this/name")) std::abort();
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// A real file: HDF5 opens nothing without a name.
struct CheckpointFile {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("checkpoint-{}.fuzz", ::getpid());
  ~CheckpointFile() { std::filesystem::remove(path); }
  void hold(std::initializer_list<std::span<const std::uint8_t>> parts) const {
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    for (const auto& part : parts)
      out.write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
    if (!out.flush()) std::abort();
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const CheckpointFile file;
  file.hold({{data, size}});
  read(file.path);

  static const std::vector<Array> whole = whole_checkpoint();
  std::vector<Array> arrays = whole;
  FuzzedDataProvider in(data, size);
  while (in.remaining_bytes() > 0) change(arrays, in);
  const std::vector<std::uint8_t> image = written(arrays);
  file.hold({make_seal({1e-3, 7}, image), image});
  if (!read(file.path) && size == 0) std::abort();  // the unchanged one
  return 0;
}
