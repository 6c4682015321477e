#include "output/replay.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "output/encode.hpp"

namespace ejecta::output {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

template <class T>
std::string base64(const std::vector<T>& values) {
  std::string out;
  append_base64(out, values.data(), values.size() * sizeof(T));
  return out;
}

std::string header_line(const ReplayHeader& h) {
  ordered_json json{{"domain", {to_json(h.domain[0]), to_json(h.domain[1])}}};
  json["rasters"] = ordered_json::array();
  for (const SliceRaster& r : h.rasters)
    json["rasters"].push_back({{"name", r.name},
                               {"axis", r.axis},
                               {"position", r.position},
                               {"lower", r.lower},
                               {"upper", r.upper},
                               {"pixels", r.pixels}});
  json["bodies"] = ordered_json::array();
  for (const BodySurface& b : h.bodies)
    json["bodies"].push_back(
        {{"name", b.name}, {"vertices", base64(b.vertices)}, {"triangles", base64(b.triangles)}});
  json["plates"] = ordered_json::array();
  for (const PlateGeometry& p : h.plates)
    json["plates"].push_back({{"name", p.name},
                              {"edge", to_json(p.edge)},
                              {"along", to_json(p.along)},
                              {"across", to_json(p.across)},
                              {"length", p.length},
                              {"width", p.width},
                              {"thickness", p.thickness}});
  json["nozzles"] = ordered_json::array();
  for (const NozzleGeometry& n : h.nozzles)
    json["nozzles"].push_back(
        {{"position", to_json(n.position)}, {"direction", to_json(n.direction)}, {"diameter", n.diameter}});
  if (h.grains.shown > 0)
    json["grains"] = {{"count", h.grains.count}, {"shown", h.grains.shown}, {"diameter", h.grains.diameter}};
  json["undisturbed"] = ordered_json::array();
  for (const auto& line : h.undisturbed) {
    ordered_json points = ordered_json::array();
    for (const Vec3& p : line) points.push_back(to_json(p));
    json["undisturbed"].push_back(std::move(points));
  }
  json["valve_open"] = h.valve_open;
  json["valve_opening"] = h.valve_opening;
  return json.dump() + '\n';
}

/// {"lower": ..., "upper": ..., "at": ...}: places in the box around them all, in parts of 65534; 65535: not
/// there.
std::string grains_text(const std::vector<Vec3>& grains) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& g : grains)
    if (g.allFinite()) low = low.cwiseMin(g), high = high.cwiseMax(g);
  if (!low.allFinite()) low = high = Vec3::Zero();
  const Vec3 size = (high - low).cwiseMax(1e-9);
  std::vector<std::array<std::uint16_t, 3>> at;
  for (const Vec3& g : grains) {
    at.push_back({65535, 65535, 65535});
    if (!g.allFinite()) continue;
    for (std::size_t d = 0; d < 3; ++d) {
      const auto c = static_cast<Eigen::Index>(d);
      at.back()[d] = static_cast<std::uint16_t>(std::lround(65534 * (g[c] - low[c]) / size[c]));
    }
  }
  const Vec3 top = low + size;
  return ordered_json{{"lower", to_json(low)}, {"upper", to_json(top)}, {"at", base64(at)}}.dump();
}

/// Time of a frame line, which starts with {"time":...,
double frame_time(const std::string& line) { return nlohmann::json::parse(line).at("time").get<double>(); }

std::size_t length_until(const std::filesystem::path& path, double time) {
  const std::vector<std::string> lines = read_replay_lines(path);
  if (lines.empty())
    throw Error(fmt::format("{} has lost its header; it cannot be continued", path.string()));
  std::size_t kept = lines.front().size() + 1;
  for (std::size_t n = 1; n < lines.size(); ++n) {
    if (frame_time(lines[n]) > time) break;
    kept += lines[n].size() + 1;
  }
  return kept;
}

}  // namespace

ReplayFile::ReplayFile(const std::filesystem::path& path, const ReplayHeader& header) : file_(path) {
  file_.append(header_line(header));
}

ReplayFile::ReplayFile(const std::filesystem::path& path, double time)
    : file_(path, length_until(path, time)) {}

void ReplayFile::add(const ReplayFrame& frame) {
  line_.clear();
  const auto out = std::back_inserter(line_);
  fmt::format_to(out, "{{\"time\":{},\"bodies\":[", frame.time);
  for (std::size_t n = 0; n < frame.bodies.size(); ++n) {
    line_ += n ? "," : "";
    if (!frame.bodies[n].there) {
      line_ += "null";
      continue;
    }
    const Vec3& p = frame.bodies[n].position;
    const Quat& q = frame.bodies[n].orientation;
    if (!p.allFinite() || !q.coeffs().allFinite())
      throw DivergedError(fmt::format("body {} has no finite position at t = {} s", n, frame.time));
    fmt::format_to(out, "[{},{},{},{},{},{},{}]", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
  line_ += "],\"slices\":[";
  for (std::size_t n = 0; n < frame.slices.size(); ++n) {
    const SliceFrame& slice = frame.slices[n];
    compress_zlib(slice.speed, packed_);
    fmt::format_to(out, "{}{{\"raster\":{},\"full_scale\":{},\"data\":\"", n ? "," : "", slice.raster,
                   slice.full_scale);
    append_base64(line_, packed_.data(), packed_.size());
    line_ += "\"}";
  }
  line_ += "]";
  if (!frame.grains.empty()) line_ += ",\"grains\":" + grains_text(frame.grains);
  line_ += "}\n";
  file_.append(line_);
}

std::vector<std::string> read_replay_lines(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  if (!std::filesystem::exists(path)) return lines;
  const std::string text = read_file(path);
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

}  // namespace ejecta::output
