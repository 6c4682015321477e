#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.hpp"

/// What the simulation hands over so that a run can be shown. Plain data, SI units, world axes unless said
/// otherwise; the files these become are described in docs/files.md.
namespace ejecta::output {

/// A uniform raster in a plane normal to `axis` onto which the air speed is resampled. The raster's first
/// direction is the lower of the two other axes, its second the higher (axis 1: x to the right, z up).
struct SliceRaster {
  std::string name;
  int axis = 1;                       ///< normal: 0 x, 1 y, 2 z
  double position = 0.0;              ///< m, along `axis`
  std::array<double, 2> lower{0, 0};  ///< m, corner of the first pixel
  std::array<double, 2> upper{0, 0};  ///< m, opposite corner
  std::array<int, 2> pixels{200, 150};
  /// The grid holds only x >= 0 (y >= 0): a symmetry plane or an axis; pixels on the other side see its
  /// mirror.
  bool mirror_x = false, mirror_y = false;
};

/// Air speed on one raster: speed = q / 255 * full_scale; rows along the first direction.
struct SliceFrame {
  int raster = 0;           ///< index into ReplayHeader::rasters
  double full_scale = 0.0;  ///< m/s
  std::vector<std::uint8_t> speed;
};

/// Surface triangles in body axes, m (the centre of mass is the origin).
struct BodySurface {
  std::string name;
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct BodyPose {
  Vec3 position{0, 0, 0};        ///< m, centre of mass
  Quat orientation{1, 0, 0, 0};  ///< body axes -> world
  bool there = true;             ///< not drawn before it has come and after it has gone
};

/// A flat obstacle drawn in the views: its edge line in side view and a slab in 3D.
struct PlateGeometry {
  std::string name;
  Vec3 edge{0, 0, 0};      ///< m, centre of the leading edge
  Vec3 along{1, 0, 0};     ///< unit, from the edge downstream
  Vec3 across{0, 1, 0};    ///< unit
  double length = 0.0;     ///< m, along
  double width = 0.0;      ///< m, across
  double thickness = 0.0;  ///< m
};

/// One nozzle, drawn as a marker with the direction of its jet.
struct NozzleGeometry {
  Vec3 position{0, 0, 0};   ///< m, centre of the orifice
  Vec3 direction{0, 0, 1};  ///< unit
  double diameter = 0.0;    ///< m
};

/// Grains among the bodies: too many to be drawn all.
struct GrainCloud {
  std::size_t count = 0;  ///< of all
  std::size_t shown = 0;  ///< every so-manieth of them
  double diameter = 0.0;  ///< m, of the middle one
};

/// What stays the same during a replay. First line of replay.jsonl.
struct ReplayHeader {
  std::array<Vec3, 2> domain{Vec3::Zero(), Vec3::Zero()};  ///< m, box in which the air is computed
  std::vector<SliceRaster> rasters;
  std::vector<BodySurface> bodies;
  std::vector<PlateGeometry> plates;
  std::vector<NozzleGeometry> nozzles;
  GrainCloud grains;
  /// Centre of each body without any air, one polyline a body (may be empty), m
  std::vector<std::vector<Vec3>> undisturbed;
  /// Openings of the valves, s: start of the command, end of the command
  std::vector<std::array<double, 2>> valve_open;
  /// How far they open: time (s), 0 to 1
  std::vector<std::array<double, 2>> valve_opening;
};

/// One moment of the replay. A frame without slices is a moment at which no air is computed.
struct ReplayFrame {
  double time = 0.0;  ///< s
  std::vector<BodyPose> bodies;
  std::vector<SliceFrame> slices;
  std::vector<Vec3> grains{};  ///< m, those shown; not finite: not there
};

/// Something the run takes for granted that the user should know: result.json key "assumptions".
struct Assumption {
  std::string what;    ///< e.g. "Diameter of the orifice"
  std::string value;   ///< with unit, e.g. "1.8 mm"
  std::string reason;  ///< why this value, and its source
  std::string key;     ///< of the case file that changes it, e.g. "valve.orifice_diameter"
};

/// A key that the case sets: result.json key "inputs".
struct Input {
  std::string what;   ///< e.g. "Diameter of the orifice"
  std::string value;  ///< with unit, e.g. "1.8 mm"
  std::string key;    ///< "valve.orifice_diameter"
};

}  // namespace ejecta::output
