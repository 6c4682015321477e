#include "jet/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <numbers>
#include <string_view>

#include "base/error.hpp"

namespace ejecta {
namespace {

constexpr std::string_view kMagic = "ejecta jet profile 1\n";
constexpr double kMostNumbers = 1e9;

/// FNV-1a, 64 bits (Fowler, Noll & Vo): finds damage, not malice.
std::uint64_t checksum(const std::vector<double>& numbers) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  for (std::size_t n = 0; n < numbers.size() * sizeof(double); ++n) hash = (hash ^ bytes[n]) * 0x100000001b3u;
  return hash;
}

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

JetProfile::JetProfile(double height, std::vector<double> radii)
    : height_(height), radii_(std::move(radii)) {}

void JetProfile::add(const Moment& moment) {
  for (const auto* values : {&moment.axial, &moment.radial, &moment.k, &moment.epsilon})
    for (const double v : *values)
      if (!std::isfinite(v)) throw Error(fmt::format("the jet holds no number at t = {} s", moment.time));
  moments_.push_back(moment);
}

void JetProfile::write(const std::filesystem::path& file) const {
  std::vector<double> numbers{height_, double(radii_.size()), double(moments_.size())};
  append(numbers, radii_);
  for (const Moment& m : moments_) {
    numbers.push_back(m.time);
    for (const auto* values : {&m.axial, &m.radial, &m.k, &m.epsilon}) append(numbers, *values);
  }
  const std::uint64_t sum = checksum(numbers);
  std::filesystem::create_directories(file.parent_path());
  const std::filesystem::path partial = file.string() + ".partial";
  {
    std::ofstream out(partial, std::ios::binary);
    out.write(kMagic.data(), std::streamsize(kMagic.size()));
    out.write(reinterpret_cast<const char*>(&sum), sizeof sum);
    out.write(reinterpret_cast<const char*>(numbers.data()),
              std::streamsize(numbers.size() * sizeof(double)));
    out.flush();
    if (!out) throw Error(fmt::format("cannot write {}", partial.string()));
  }
  std::filesystem::rename(partial, file);
}

JetProfile JetProfile::read(const std::filesystem::path& file) {
  const auto damaged = [&](std::string_view what) {
    return Error(fmt::format("the stored jet {} is damaged: {}", file.string(), what));
  };
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw Error(fmt::format("cannot read the stored jet {}", file.string()));
  const auto size = static_cast<std::size_t>(in.tellg());
  const std::size_t head = kMagic.size() + sizeof(std::uint64_t);
  if (size < head + 3 * sizeof(double) || (size - head) % sizeof(double) != 0) throw damaged("wrong length");
  in.seekg(0);
  std::string magic(kMagic.size(), ' ');
  std::uint64_t sum = 0;
  std::vector<double> numbers((size - head) / sizeof(double));
  in.read(magic.data(), std::streamsize(magic.size()));
  in.read(reinterpret_cast<char*>(&sum), sizeof sum);
  in.read(reinterpret_cast<char*>(numbers.data()), std::streamsize(numbers.size() * sizeof(double)));
  if (!in || magic != kMagic) throw damaged("not a jet profile");
  if (sum != checksum(numbers)) throw damaged("its checksum does not match");
  const double radii = numbers[1], times = numbers[2];
  if (!(radii >= 1 && times >= 1 && radii * times < kMostNumbers)) throw damaged("impossible sizes");
  const auto nr = static_cast<std::size_t>(radii), nt = static_cast<std::size_t>(times);
  if (numbers.size() != 3 + nr + nt * (1 + 4 * nr)) throw damaged("wrong length");
  auto at = numbers.begin() + 3;
  const auto take = [&] {
    std::vector<double> values(at, at + std::ptrdiff_t(nr));
    at += std::ptrdiff_t(nr);
    return values;
  };
  JetProfile profile(numbers[0], take());
  for (std::size_t n = 0; n < nt; ++n) {
    Moment m;
    m.time = *at++;
    for (auto* values : {&m.axial, &m.radial, &m.k, &m.epsilon}) *values = take();
    profile.moments_.push_back(std::move(m));
  }
  return profile;
}

JetProfile::Between JetProfile::moment_at(double t) const {
  const auto above = std::upper_bound(moments_.begin(), moments_.end(), t,
                                      [](double time, const Moment& m) { return time < m.time; });
  if (above == moments_.begin() || moments_.size() == 1) return {0, 0.0};
  if (above == moments_.end()) return {moments_.size() - 2, 1.0};
  const auto n = static_cast<std::size_t>(above - moments_.begin()) - 1;
  return {n, (t - moments_[n].time) / (moments_[n + 1].time - moments_[n].time)};
}

InflowState JetProfile::at(const Vec3& from_axis, double t) const {
  const double r = std::hypot(from_axis.x(), from_axis.y());
  InflowState s;
  if (moments_.empty() || r > radii_.back()) return s;
  const auto above = std::upper_bound(radii_.begin(), radii_.end(), r);
  const bool inner = above == radii_.begin();
  const std::size_t i =
      inner ? 0 : std::min(static_cast<std::size_t>(above - radii_.begin()) - 1, radii_.size() - 2);
  const double x = inner ? 0.0 : (r - radii_[i]) / (radii_[i + 1] - radii_[i]);
  const Between m = moment_at(t);
  const auto value = [&](std::vector<double> Moment::*member) {
    const auto along = [&](const Moment& moment) {
      const std::vector<double>& v = moment.*member;
      return (1.0 - x) * v[i] + x * v[std::min(i + 1, v.size() - 1)];
    };
    const double first = along(moments_[m.low]);
    return m.share > 0.0 ? (1.0 - m.share) * first + m.share * along(moments_[m.low + 1]) : first;
  };
  // Inside the first radius the radial velocity falls to zero on the axis.
  const double near = inner && radii_[0] > 0.0 ? r / radii_[0] : 1.0;
  const double radial = near * value(&Moment::radial);
  s.velocity.z() = value(&Moment::axial);
  if (r > 0.0) {
    s.velocity.x() = radial * from_axis.x() / r;
    s.velocity.y() = radial * from_axis.y() / r;
  }
  s.k = value(&Moment::k);
  s.epsilon = value(&Moment::epsilon);
  return s;
}

double JetProfile::momentum(double t, double density) const {
  double sum = 0.0, low = 0.0;
  for (std::size_t i = 0; i < radii_.size(); ++i) {
    const double high = i + 1 < radii_.size() ? 0.5 * (radii_[i] + radii_[i + 1]) : radii_[i];
    const double w = at({radii_[i], 0, 0}, t).velocity.z();
    sum += density * w * w * std::numbers::pi * (high * high - low * low);
    low = high;
  }
  return sum;
}

double JetProfile::fastest(double t) const {
  double most = 0.0;
  for (const double r : radii_) most = std::max(most, at({r, 0, 0}, t).velocity.z());
  return most;
}

}  // namespace ejecta
