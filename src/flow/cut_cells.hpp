#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "base/real.hpp"
#include "base/vec.hpp"
#include "grid/grid.hpp"

/// What solids leave of the cells and faces of a grid: the seam between bodies and incompressible flow.
/// Coupling fills everything above the line "results"; plain data, SI units.
namespace ejecta {

/// A cell that a surface cuts, or that carries the momentum of such a cell.
struct CutCell {
  int i = 0, j = 0, k = 0;
  Real fluid = 1;                ///< fluid part of its own volume, 0..1
  std::array<Real, 3> middle{};  ///< of its fluid, from that of the cell, m
  Real distance = 0;             ///< of its centre from the nearest surface, m; > 0 in the fluid
  std::array<Real, 3> normal{};  ///< of that surface, into the fluid
  Real edge = 0;                 ///< how much of an edge of a body runs through it: 0 none, 1 a sharp one
  bool locked = false;           ///< bodies lock its fluid in: it has neither momentum nor pressure
  int carrier = -1;  ///< index of the cell that carries its momentum: itself, or of a small cell a
                     ///< neighbour; -1: none does (fluid locked in)
  Real carried = 0;  ///< volume of fluid whose momentum it carries over that of the cell
  int first_wall = 0, walls = 0;      ///< range of CutCells::walls
  int first_member = 0, members = 0;  ///< range of CutCells::members: the cells it carries, itself first
};

/// The part of a body's surface within a cell.
struct CutWall {
  int cell = 0;  ///< index into CutCells::cells
  int body = 0;
  std::array<Real, 3> area{};      ///< m2, vector out of the fluid
  std::array<Real, 3> velocity{};  ///< of the surface, m/s
  std::array<Real, 3> spin{};      ///< of the body, rad/s
  Vec3 point{0, 0, 0};             ///< where forces act, m
  Real roughness = 0;              ///< sand-grain height, m
};

/// A face that solids close in part or as a whole: the lower d-face of cell (i, j, k).
struct CutFace {
  int d = 0, i = 0, j = 0, k = 0;
  Real closed = 0;    ///< part of its area, 0..1
  Real velocity = 0;  ///< of the solid along d, m/s
};

/// A cell without momentum of its own, in a solid or small: it takes on what the stencils around it should
/// see, extended from cells in the fluid along the normal.
struct GhostCell {
  int i = 0, j = 0, k = 0;
  int donors = 0;                         ///< 0: deep inside, it moves with the solid
  std::array<std::ptrdiff_t, 8> donor{};  ///< from this cell, in entries of a field
  std::array<Real, 8> weight{};
  Real ratio = 0;                         ///< distance of this cell over that of its donors: < 0 inside
  Real image = 0;                         ///< distance of its donors from the surface, m
  std::array<Real, 3> normal{}, solid{};  ///< of the surface, into the fluid; m/s
};

/// A whole cell near a solid, for models that ask how far the next wall is.
struct NearCell {
  int i = 0, j = 0, k = 0;
  Real distance = 0;  ///< m
};

struct CutCells {
  std::vector<CutCell> cells;
  std::vector<int> members;
  std::vector<CutWall> walls;
  std::vector<CutFace> faces;
  std::vector<GhostCell> ghosts;
  std::vector<NearCell> near;
  /// Of every cell of the grid: 0 plain fluid, n + 1 for cells[n], -1 - n for ghosts[n] that are not in
  /// `cells`. Empty as long as there was no solid.
  Array3<int> index;
  /// Closed part of every face, as in `faces`.
  std::array<Field, 3> closed;

  // Results of the last flow step, one entry a wall: what the fluid gave to the solid there, N s.
  std::vector<Vec3> pressure_impulse, friction_impulse;

  bool empty() const { return cells.empty() && ghosts.empty(); }
  /// Whether another cell carries the momentum of cells[n].
  bool small(std::size_t n) const { return cells[n].carrier >= 0 && cells[n].carrier != static_cast<int>(n); }
  /// The small cell there; null: none is.
  const CutCell* small_at(int i, int j, int k) const {
    const int n = index(i, j, k) - 1;
    return n >= 0 && small(static_cast<std::size_t>(n)) ? &cells[static_cast<std::size_t>(n)] : nullptr;
  }
};

}  // namespace ejecta
