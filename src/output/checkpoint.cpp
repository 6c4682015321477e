#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "output/checkpoint_seal.hpp"
#include "output/hdf5_handle.hpp"
#include "output/output_file.hpp"

namespace fs = std::filesystem;

namespace ejecta::output {

// The file is made in memory and written by us: HDF5 1.10 cannot close a file on a full disk, and crashes
// over it when the program ends.
struct CheckpointWriter::Impl {
  OutputFile out;
  fs::path path;
  CheckpointTime at;
  Hdf5Handle file;

  Error error(const std::string& what) const {
    return Error(fmt::format("checkpoint {}: {}", path.string(), what));
  }

  template <class T>
  void put(const std::string& name, std::span<const T> values) {
    const Hdf5Silence silence;
    const hsize_t length = values.size();
    const Hdf5Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
    const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);  // the same state gives the same bits at any time of day
    const Hdf5Handle data(H5Dcreate2(file, name.c_str(), hdf5_type<T>(), space, links, creation, H5P_DEFAULT),
                          H5Dclose);
    if (!data || H5Dwrite(data, hdf5_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      throw error(fmt::format("HDF5 cannot take \"{}\" (the name twice, or no memory)", name));
  }

  /// The finished file after its first 512 bytes; lets go of HDF5's copy.
  std::vector<std::uint8_t> take_image() {
    const ssize_t size = H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 ? -1 : H5Fget_file_image(file, nullptr, 0);
    std::vector<std::uint8_t> image(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    if (size <= 0 || H5Fget_file_image(file, image.data(), image.size()) != size || !file.reset())
      throw error("HDF5 cannot finish it");
    return image;
  }
};

CheckpointWriter::CheckpointWriter(fs::path path, CheckpointTime at)
    : impl_(new Impl{OutputFile(path), path, at, {}}) {
  const Hdf5Silence silence;
  constexpr std::size_t kGrowth = std::size_t(1) << 22;
  const Hdf5Handle layout(H5Pcreate(H5P_FILE_CREATE), H5Pclose), access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_userblock(layout, kSealBytes);
  H5Pset_fapl_core(access, kGrowth, false);
  impl_->file = Hdf5Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, layout, access), H5Fclose);
  if (!impl_->file) throw impl_->error("HDF5 cannot begin it");
}

CheckpointWriter::~CheckpointWriter() = default;

void CheckpointWriter::put(const std::string& name, std::span<const double> values) {
  impl_->put(name, values);
}
void CheckpointWriter::put(const std::string& name, std::span<const float> values) {
  impl_->put(name, values);
}
void CheckpointWriter::put(const std::string& name, std::span<const std::int64_t> values) {
  impl_->put(name, values);
}
void CheckpointWriter::put(const std::string& name, std::span<const std::uint8_t> values) {
  impl_->put(name, values);
}

void CheckpointWriter::commit() {
  const Hdf5Silence silence;
  const std::vector<std::uint8_t> rest = impl_->take_image();
  const auto seal = make_seal(impl_->at, rest);
  impl_->out.write(seal.data(), seal.size());
  impl_->out.write(rest.data(), rest.size());
  impl_->out.commit_durably();
}

struct CheckpointReader::Impl {
  fs::path path;
  CheckpointTime at;
  Hdf5Handle file;

  Error error(const std::string& what) const {
    return Error(fmt::format("checkpoint {}: {}", path.string(), what));
  }

  Hdf5Handle open(const std::string& name) const {
    Hdf5Handle data(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!data) throw error(fmt::format("there is no array \"{}\"", name));
    return data;
  }

  /// What an array claims to hold must be there: it is trusted when memory is taken for it.
  std::size_t size(const Hdf5Handle& data, const std::string& name) const {
    const Hdf5Handle space(H5Dget_space(data), H5Sclose), type(H5Dget_type(data), H5Tclose);
    const hsize_t stored = H5Dget_storage_size(data);
    const hssize_t n = H5Sget_simple_extent_npoints(space);
    if (n < 0 || stored / std::max<std::size_t>(H5Tget_size(type), 1) != static_cast<hsize_t>(n))
      throw error(fmt::format("\"{}\" is not stored in full", name));
    return static_cast<std::size_t>(n);
  }

  template <class T>
  void get(const std::string& name, std::span<T> values) const {
    const Hdf5Silence silence;
    const Hdf5Handle data = open(name);
    const Hdf5Handle type(H5Dget_type(data), H5Tclose);
    if (H5Tequal(type, hdf5_type<T>()) <= 0)
      throw error(fmt::format("\"{}\" has another type (float or double build?)", name));
    if (const std::size_t n = size(data, name); n != values.size())
      throw error(fmt::format("\"{}\" has {} values instead of {}", name, n, values.size()));
    if (H5Dread(data, hdf5_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      throw error(fmt::format("\"{}\" cannot be read", name));
  }
};

CheckpointReader::CheckpointReader(const fs::path& path) : impl_(std::make_unique<Impl>()) {
  const Hdf5Silence silence;
  impl_->path = path;
  impl_->at = check_seal(path);
  impl_->file = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!impl_->file) throw impl_->error("HDF5 cannot open it");
}

CheckpointReader::~CheckpointReader() = default;
CheckpointReader::CheckpointReader(CheckpointReader&&) noexcept = default;
CheckpointReader& CheckpointReader::operator=(CheckpointReader&&) noexcept = default;

const fs::path& CheckpointReader::path() const { return impl_->path; }
CheckpointTime CheckpointReader::at() const { return impl_->at; }

bool CheckpointReader::has(const std::string& name) const {
  const Hdf5Silence silence;
  // Every group on the way must exist before HDF5 may be asked for the last name.
  for (std::size_t end = name.find('/'); end != std::string::npos; end = name.find('/', end + 1))
    if (end > 0 && H5Lexists(impl_->file, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(impl_->file, name.c_str(), H5P_DEFAULT) > 0;
}

std::size_t CheckpointReader::size(const std::string& name) const {
  const Hdf5Silence silence;
  return impl_->size(impl_->open(name), name);
}

void CheckpointReader::get(const std::string& name, std::span<double> v) const { impl_->get(name, v); }
void CheckpointReader::get(const std::string& name, std::span<float> v) const { impl_->get(name, v); }
void CheckpointReader::get(const std::string& name, std::span<std::int64_t> v) const { impl_->get(name, v); }
void CheckpointReader::get(const std::string& name, std::span<std::uint8_t> v) const { impl_->get(name, v); }

std::vector<double> CheckpointReader::numbers(const std::string& name) const {
  std::vector<double> values(size(name));
  get(name, std::span<double>(values));
  return values;
}

CheckpointStore::CheckpointStore(fs::path directory, int keep)
    : directory_(std::move(directory)), keep_(keep) {}

CheckpointWriter CheckpointStore::begin(CheckpointTime at) const {
  return CheckpointWriter(directory_ / fmt::format("step-{:09}.h5", at.step), at);
}

void CheckpointStore::commit(CheckpointWriter& writer) const {
  writer.commit();
  const std::vector<fs::path> all = newest_first();
  for (std::size_t n = static_cast<std::size_t>(keep_); n < all.size(); ++n) {
    std::error_code ignored;  // an old file that stays does no harm
    fs::remove(all[n], ignored);
  }
}

CheckpointStore::Newest CheckpointStore::newest() const {
  Newest result;
  for (const fs::path& path : newest_first()) {
    try {
      result.reader.emplace(path);
      return result;
    } catch (const Error& e) {
      result.damaged.push_back(e.what());
    }
  }
  return result;
}

std::vector<fs::path> CheckpointStore::newest_first() const {
  std::vector<fs::path> all;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(directory_, none))
    if (entry.path().extension() == ".h5" && entry.path().filename().string().starts_with("step-"))
      all.push_back(entry.path());
  std::sort(all.rbegin(), all.rend());
  return all;
}

}  // namespace ejecta::output
