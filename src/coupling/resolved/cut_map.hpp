#pragma once
#include <array>
#include <span>
#include <vector>

#include "dem/body.hpp"
#include "flow/cut_cells.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// What bodies leave of the cells of a grid. Where a surface crosses the edges of cells is found on its
/// signed distance; parts of faces are polygons between these points, and parts of cells follow from their
/// faces, so that all of them are exact for plane surfaces and continuous as bodies move.
class CutMap {
 public:
  /// `periodic`: axes along which bodies have images.
  CutMap(const Grid& grid, const std::array<bool, 3>& periodic);

  void map(std::span<const Body> bodies, std::span<const double> roughness, CutCells& out);

 private:
  /// The cells around one body or one of its periodic images.
  struct Region {
    const Body* body = nullptr;
    int index = 0;
    double roughness = 0.0;
    Vec3 shift{0, 0, 0};  ///< of this image, m
    std::array<int, 3> low{}, n{};
    std::vector<float>
        node;  ///< distance of the corners of its cells; far from the surface only its sign is right, m
    std::vector<float> distance;  ///< of the centres; away from the surface the mean of their corners, m
    std::size_t at(int i, int j, int k) const {
      return static_cast<std::size_t>((k - low[2]) * n[1] + j - low[1]) * static_cast<std::size_t>(n[0]) +
             static_cast<std::size_t>(i - low[0]);
    }
    bool holds(int i, int j, int k) const {
      return i >= low[0] && i < low[0] + n[0] && j >= low[1] && j < low[1] + n[1] && k >= low[2] &&
             k < low[2] + n[2];
    }
  };
  /// A cell as one body leaves it.
  struct Record {
    int i, j, k, region;
    std::array<float, 6> closed;
    float distance;
    float edge;  ///< how much of an edge of the body runs through it: 0 a smooth surface, 1 sharp
    std::array<float, 3> tip;  ///< a point on that edge, parts of the cell's widths
  };
  /// Where an edge of the body meets a face, parts of its widths.
  struct Tip {
    float sharp = 0;  ///< 0: no edge
    float x = 0, y = 0;
  };

  bool find_region(const Body& body, const Vec3& shift, Region& r) const;
  void measure(Region& r);
  void cut_edges(const Region& r);
  void close_faces(const Region& r);
  Tip find_tip(const Region& r, const std::array<int, 3>& node, std::size_t a, std::size_t b, float x0,
               float y0, float x1, float y1) const;
  void record(const Region& r, int region);
  void collect_faces(CutCells& out) const;
  void collect_cells(CutCells& out);
  void add_cut_cell(std::span<const Record> records, CutCells& out);
  void add_ghost(const Record& r, CutCells& out);
  template <class Visit>
  void for_each_neighbour(const CutCell& c, const CutCells& out, const Visit& visit) const;
  void lock_in(CutCells& out) const;
  void choose_carriers(CutCells& out) const;
  int carrier_of(const CutCell& c, CutCells& out) const;
  int add_plain(const int (&at)[3], CutCells& out) const;
  void close_dead_ends(CutCells& out) const;
  void list_members(CutCells& out) const;
  void find_donors(CutCells& out) const;
  void list_near(CutCells& out) const;
  void clear(CutCells& out) const;

  double coordinate(int d, int node) const;
  double part_fluid(const Record& r) const;
  Vec3 normal_at(const Region& r, int i, int j, int k) const;
  double width_along(const Vec3& normal, int i, int j, int k) const;
  std::int64_t face_key(const CutFace& f) const {
    return ((std::int64_t(f.k) * (grid_.ny() + 1) + f.j) * (grid_.nx() + 1) + f.i) * 3 + f.d;
  }
  std::int64_t key(int i, int j, int k) const { return (std::int64_t(k) * grid_.ny() + j) * grid_.nx() + i; }

  const Grid& grid_;
  std::array<bool, 3> periodic_;
  std::vector<Region> regions_;
  int used_ = 0;                            // regions in use
  std::array<std::vector<float>, 3> edge_;  // fluid part of its edges
  std::array<std::vector<float>, 3> face_;  // closed part of its faces
  std::array<std::vector<Tip>, 3> tip_;
  std::vector<std::vector<Record>> planes_;  // scratch, one list a plane
  std::vector<Record> records_;
  std::vector<int> ghost_region_;  // of every ghost of the map
  struct FacePart {
    std::int64_t key;
    CutFace face;
  };
  mutable std::vector<FacePart> face_parts_;
};

}  // namespace ejecta
