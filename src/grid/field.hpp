#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>

#include "base/parallel.hpp"
#include "base/real.hpp"
#include "base/storage.hpp"

namespace ejecta {

/// Ghost layers around the cells of every field.
inline constexpr int kGhosts = 2;

/// Non-owning view of a field: what kernels hold. Cell (0,0,0) is the first inner cell; ghosts are at
/// -1, -2 and n, n+1. x is contiguous.
template <class T>
struct View {
  T* origin = nullptr;
  std::ptrdiff_t sy = 0, sz = 0;
  T& operator()(int i, int j, int k) const { return origin[i + j * sy + k * sz]; }
  T* row(int j, int k) const { return origin + j * sy + k * sz; }
  operator View<const T>() const requires(!std::is_const_v<T>) { return {origin, sy, sz}; }
};

/// One value a cell of an nx x ny x nz grid plus ghosts, rows aligned to 64 bytes.
/// Face fields use the same layout: entry i of an x-face field is the face between cells i-1 and i.
template <class T>
class Array3 {
 public:
  Array3() = default;
  Array3(int nx, int ny, int nz) : nx_(nx), ny_(ny), nz_(nz) {
    constexpr std::ptrdiff_t lanes = 64 / sizeof(T);
    pad_ = lanes;  // the first inner cell of a row is aligned
    sy_ = (pad_ + nx + kGhosts + 1 + lanes - 1) / lanes * lanes;
    sz_ = sy_ * (ny + 2 * kGhosts + 1);
    size_ = static_cast<std::size_t>(sz_) * static_cast<std::size_t>(nz + 2 * kGhosts + 1);
    data_ = allocate_storage(size_ * sizeof(T));
    fill(T(0));
  }
  Array3(const Array3& o) : Array3(o.nx_, o.ny_, o.nz_) { std::copy_n(o.data(), size_, data()); }
  Array3& operator=(const Array3& o) {
    Array3 copy(o);
    *this = std::move(copy);
    return *this;
  }
  Array3(Array3&&) noexcept = default;
  Array3& operator=(Array3&&) noexcept = default;

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int nz() const { return nz_; }
  Range3 cells() const { return {0, nx_, 0, ny_, 0, nz_}; }
  View<T> view() { return {data() + offset(), sy_, sz_}; }
  View<const T> view() const { return {data() + offset(), sy_, sz_}; }
  T& operator()(int i, int j, int k) { return view()(i, j, k); }
  const T& operator()(int i, int j, int k) const { return view()(i, j, k); }
  void fill(T value) { std::fill_n(data(), size_, value); }
  /// Raw storage, ghosts and padding included (checkpoints).
  T* data() { return static_cast<T*>(data_.get()); }
  const T* data() const { return static_cast<const T*>(data_.get()); }
  std::size_t size() const { return size_; }

 private:
  std::ptrdiff_t offset() const { return pad_ + kGhosts * sy_ + kGhosts * sz_; }
  int nx_ = 0, ny_ = 0, nz_ = 0;
  std::ptrdiff_t pad_ = 0, sy_ = 0, sz_ = 0;
  std::size_t size_ = 0;
  std::unique_ptr<void, FreeStorage> data_;
};

using Field = Array3<Real>;
/// Part of a state that is saved and restored.
struct NamedField {
  std::string name;
  Field* field = nullptr;
};
using FieldView = View<Real>;
using ConstFieldView = View<const Real>;

}  // namespace ejecta
