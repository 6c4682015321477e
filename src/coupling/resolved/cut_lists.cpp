#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "coupling/resolved/cut_map.hpp"

/// From what each body closes of cells and faces to the lists that the flow reads.
namespace ejecta {
namespace {

/// A cell keeps its own momentum when at least this part of it is fluid; less would shorten the stable step.
constexpr float kOwnFluid = 0.5f;
/// ... and its centre lies outside by this part of a cell.
constexpr double kOwnDistance = 0.05;
/// Open part of a face that counts as a way out for fluid between bodies.
constexpr double kPassage = 0.02;
/// Depth, in widths of a cell, below which no stencil of the fluid looks.
constexpr double kDeep = 2.6;
/// Closed or open up to round-off.
constexpr float kWhole = 1.0f - 1e-5f, kNothing = 1e-5f;

/// How far the wall behind a face is, widths of the cell: of the part of the face (open) through which one
/// does not come to the one across (through).
double room_behind(double fluid, double open, double through) {
  return std::clamp((fluid - through) / (open - through), 0.0, 1.0);
}

/// Middle of a cell's fluid along an axis from that of the cell, widths: columns through both its faces, and
/// columns from the more open one to a wall.
Real middle_of(Real fluid, Real below, Real above) {
  const double open = std::max(double(below), double(above)),
               through = std::min(double(below), double(above));
  if (open - through < double(kNothing)) return 0;
  const double room = room_behind(double(fluid), open, through);
  const double moved = (open - through) * room * 0.5 * (1.0 - room) / double(fluid);
  return static_cast<Real>(above > below ? moved : -moved);
}

}  // namespace

/// Faces that several bodies close are one face: closed by their sum, with their mean velocity.
void CutMap::collect_faces(CutCells& out) const {
  face_parts_.clear();
  for (const Record& r : records_) {
    const Region& region = regions_[static_cast<std::size_t>(r.region)];
    const int at[3] = {r.i, r.j, r.k};
    for (int side = 0; side < 6; ++side) {
      const int d = side / 2, upper = side % 2;
      const float closed = r.closed[static_cast<std::size_t>(side)];
      if (closed < kNothing || !grid_.active(d)) continue;
      // Of the two cells of a face the upper one tells of it, unless it lies beyond the region.
      int beyond[3] = {r.i, r.j, r.k};
      beyond[d] += 1;
      if (upper && beyond[d] < grid_.n(d) && region.holds(beyond[0], beyond[1], beyond[2])) continue;
      CutFace f;
      f.d = d;
      f.i = r.i, f.j = r.j, f.k = r.k;
      (d == 0 ? f.i : d == 1 ? f.j : f.k) += upper;
      f.closed = closed;
      Vec3 x = grid_.centre(r.i, r.j, r.k);
      x[d] = coordinate(d, at[d] + upper);
      f.velocity = static_cast<Real>(region.body->velocity_at(x - region.shift)[d]);
      face_parts_.push_back({face_key(f), f});
    }
  }
  if (used_ > 1)
    std::stable_sort(face_parts_.begin(), face_parts_.end(),
                     [](const FacePart& a, const FacePart& b) { return a.key < b.key; });
  for (std::size_t n = 0; n < face_parts_.size();) {
    CutFace f = face_parts_[n].face;
    Real sum = f.closed, moved = f.closed * f.velocity;
    std::size_t m = n + 1;
    for (; m < face_parts_.size() && face_parts_[m].key == face_parts_[n].key; ++m) {
      sum += face_parts_[m].face.closed;
      moved += face_parts_[m].face.closed * face_parts_[m].face.velocity;
    }
    f.closed = sum > Real(kWhole) ? Real(1) : sum;
    f.velocity = moved / sum;
    out.faces.push_back(f);
    out.closed[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = f.closed;
    n = m;
  }
}

void CutMap::collect_cells(CutCells& out) {
  for (std::size_t n = 0; n < records_.size();) {
    std::size_t m = n + 1;
    while (m < records_.size() && records_[m].i == records_[n].i && records_[m].j == records_[n].j &&
           records_[m].k == records_[n].k)
      ++m;
    const std::span<const Record> all(records_.data() + n, m - n);
    bool open = false;
    for (std::size_t side = 0; side < 6; ++side) {
      float closed = 0;
      for (const Record& r : all) closed += r.closed[side];
      open = open || (closed < kWhole && grid_.active(int(side / 2)));
    }
    const Record& nearest = *std::min_element(
        all.begin(), all.end(), [](const Record& a, const Record& b) { return a.distance < b.distance; });
    if (open) add_cut_cell(all, out);
    else add_ghost(nearest, out);
    n = m;
  }
}

void CutMap::add_cut_cell(std::span<const Record> records, CutCells& out) {
  const Record& nearest =
      *std::min_element(records.begin(), records.end(),
                        [](const Record& a, const Record& b) { return a.distance < b.distance; });
  const Region& region = regions_[static_cast<std::size_t>(nearest.region)];
  CutCell c;
  c.i = nearest.i, c.j = nearest.j, c.k = nearest.k;
  c.distance = nearest.distance;
  const Vec3 normal = normal_at(region, c.i, c.j, c.k);
  for (int d = 0; d < 3; ++d) c.normal[static_cast<std::size_t>(d)] = static_cast<Real>(normal[d]);
  double solid = 0.0;
  for (const Record& r : records) solid += 1.0 - part_fluid(r);
  c.edge = records.size() == 1 ? nearest.edge : 0.0f;
  c.fluid = static_cast<Real>(std::max(1.0 - solid, 1e-4));
  c.first_wall = static_cast<int>(out.walls.size());
  const std::array<Metrics, 3>& m = grid_.metrics();
  const double volume = grid_.volume(c.i, c.j, c.k);
  const int at[3] = {c.i, c.j, c.k};
  for (std::size_t d = 0; d < 3; ++d) {
    if (!grid_.active(int(d))) continue;
    float closed[2] = {0, 0};
    for (const Record& r : records)
      for (std::size_t up = 0; up < 2; ++up) closed[up] += r.closed[2 * d + up];
    c.middle[d] = middle_of(c.fluid, Real(1) - closed[0], Real(1) - closed[1]) * m[d].width[at[d]];
  }
  Vec3 whole{0, 0, 0}, sum{0, 0, 0};  // what closes the open faces; what the bodies say
  double total = 0.0;
  for (int d = 0; d < 3; ++d) {
    if (!grid_.active(d)) continue;
    const double area = volume / double(m[d].width[at[d]]);
    int up[3] = {c.i, c.j, c.k};
    ++up[d];
    const Field& closed = out.closed[static_cast<std::size_t>(d)];
    whole[d] = area * double(closed(up[0], up[1], up[2]) - closed(c.i, c.j, c.k));
  }
  for (const Record& r : records) {
    CutWall w;
    const Region& of = regions_[static_cast<std::size_t>(r.region)];
    w.cell = static_cast<int>(out.cells.size());
    w.body = of.index;
    w.roughness = static_cast<Real>(of.roughness);
    for (std::size_t d = 0; d < 3; ++d) {
      const double area = grid_.active(int(d)) ? volume / double(m[d].width[at[d]]) : 0.0;
      w.area[d] = static_cast<Real>(area * double(r.closed[2 * d + 1] - r.closed[2 * d]));
    }
    const Vec3 n = &r == &nearest ? normal : normal_at(of, c.i, c.j, c.k);
    const Vec3 x = grid_.centre(c.i, c.j, c.k) - of.shift;
    w.point = x - double(r.distance) * n;
    const Vec3 v = of.body->velocity_at(w.point);
    for (int d = 0; d < 3; ++d) {
      w.velocity[static_cast<std::size_t>(d)] = static_cast<Real>(v[d]);
      w.spin[static_cast<std::size_t>(d)] = static_cast<Real>(of.body->angular_velocity[d]);
    }
    const Vec3 area(w.area[0], w.area[1], w.area[2]);
    sum += area;
    total += area.norm();
    out.walls.push_back(w);
    ++c.walls;
  }
  // Where bodies touch their parts overlap: what closes the cell is shared out among them.
  if (records.size() > 1 && (sum - whole).norm() > 1e-6 * total && total > 0.0)
    for (int w = c.first_wall; w < c.first_wall + c.walls; ++w) {
      CutWall& wall = out.walls[static_cast<std::size_t>(w)];
      const double share = Vec3(wall.area[0], wall.area[1], wall.area[2]).norm() / total;
      for (int d = 0; d < 3; ++d)
        wall.area[static_cast<std::size_t>(d)] += static_cast<Real>(share * (whole - sum)[d]);
    }
  ghost_region_.push_back(nearest.region);  // of cells first; see find_donors
  out.cells.push_back(c);
  out.index(c.i, c.j, c.k) = static_cast<int>(out.cells.size());
}

void CutMap::add_ghost(const Record& r, CutCells& out) {
  GhostCell g;
  g.i = r.i, g.j = r.j, g.k = r.k;
  g.ratio = r.distance;  // until its donors are known
  g.donors = r.region;
  out.ghosts.push_back(g);
  out.index(r.i, r.j, r.k) = -static_cast<int>(out.ghosts.size());
}

/// visit(index of the cell beyond as in CutCells::index, side, that cell, open part of the face) for the
/// faces of a cell within the box and periodic ones of the box.
template <class Visit>
void CutMap::for_each_neighbour(const CutCell& c, const CutCells& out, const Visit& visit) const {
  for (int side = 0; side < 6; ++side) {
    const int d = side / 2, up = side % 2;
    int cell[3] = {c.i, c.j, c.k}, face[3] = {c.i, c.j, c.k};
    cell[d] += up ? 1 : -1;
    face[d] += up;
    if (!grid_.active(d)) continue;
    if (periodic_[static_cast<std::size_t>(d)]) cell[d] = (cell[d] + grid_.n(d)) % grid_.n(d);
    if (cell[d] < 0 || cell[d] >= grid_.n(d)) continue;
    const double open = 1.0 - double(out.closed[static_cast<std::size_t>(d)](face[0], face[1], face[2]));
    visit(out.index(cell[0], cell[1], cell[2]), side, cell, open);
  }
}

void CutMap::choose_carriers(CutCells& out) const {
  const auto keeps = [&](const CutCell& c) {
    const Vec3 n(c.normal[0], c.normal[1], c.normal[2]);
    return !c.locked && c.fluid >= Real(kOwnFluid) &&
           c.distance > kOwnDistance * width_along(n, c.i, c.j, c.k);
  };
  const std::size_t cut = out.cells.size();
  for (std::size_t n = 0; n < cut; ++n)
    if (keeps(out.cells[n])) out.cells[n].carrier = static_cast<int>(n);
  for (std::size_t n = 0; n < cut; ++n)
    if (out.cells[n].carrier < 0 && !out.cells[n].locked)
      out.cells[n].carrier = carrier_of(CutCell(out.cells[n]), out);
  // Small cells that have none beside them are carried by what carries a neighbour: from all ends at once, so
  // that a gap thinner than a cell belongs to both sides that it joins.
  std::vector<std::pair<std::size_t, int>> found;
  do {
    found.clear();
    for (std::size_t n = 0; n < cut; ++n) {
      if (out.cells[n].carrier >= 0 || out.cells[n].locked) continue;
      double widest = 0.0;
      int carrier = -1;
      for_each_neighbour(out.cells[n], out, [&](int index, int side, const int* cell, double open) {
        const int at[3] = {out.cells[n].i, out.cells[n].j, out.cells[n].k};
        if (std::abs(cell[side / 2] - at[side / 2]) > 1) return;  // at the other end of a periodic box
        if (index <= 0 || out.cells[static_cast<std::size_t>(index - 1)].carrier < 0 || open <= widest)
          return;
        widest = open;
        carrier = out.cells[static_cast<std::size_t>(index - 1)].carrier;
      });
      if (carrier >= 0) found.push_back({n, carrier});
    }
    for (const auto& [n, carrier] : found) out.cells[n].carrier = carrier;
  } while (!found.empty());
}

/// Fluid that bodies lock in between them moves with them and has no pressure: its cells are told apart, and
/// what is left open of the faces around them is closed.
void CutMap::lock_in(CutCells& out) const {
  for (CutCell& c : out.cells) c.locked = true;
  for (bool more = true; more;) {
    more = false;
    for (CutCell& c : out.cells) {
      if (!c.locked) continue;
      for_each_neighbour(c, out, [&](int index, int, const int*, double open) {
        if (open < kPassage || index < 0 ||
            (index > 0 && out.cells[static_cast<std::size_t>(index - 1)].locked))
          return;
        c.locked = false;
      });
      more = more || !c.locked;
    }
  }
  for (CutFace& f : out.faces) {
    if (f.closed >= Real(1)) continue;
    int low[3] = {f.i, f.j, f.k}, high[3] = {f.i, f.j, f.k};
    --low[f.d];
    if (periodic_[static_cast<std::size_t>(f.d)]) {
      low[f.d] = (low[f.d] + grid_.n(f.d)) % grid_.n(f.d);
      high[f.d] %= grid_.n(f.d);
    }
    if (low[f.d] < 0 || high[f.d] >= grid_.n(f.d)) continue;
    const int below = out.index(low[0], low[1], low[2]), above = out.index(high[0], high[1], high[2]);
    if (below <= 0 || above <= 0) continue;
    const CutCell &b = out.cells[static_cast<std::size_t>(below - 1)],
                  &a = out.cells[static_cast<std::size_t>(above - 1)];
    if (a.locked == b.locked) continue;
    const auto close = [&](const CutCell& c, double sign) {
      const int at[3] = {c.i, c.j, c.k};
      const double area =
          grid_.volume(c.i, c.j, c.k) / grid_.axis(f.d).width[static_cast<std::size_t>(at[f.d])];
      out.walls[static_cast<std::size_t>(c.first_wall)].area[static_cast<std::size_t>(f.d)] +=
          static_cast<Real>(sign * area * (1.0 - double(f.closed)));
    };
    const int along[3] = {f.i, f.j, f.k};  // a periodic face of the box stands twice, once for either cell
    if (along[f.d] > 0) close(b, 1.0);
    if (along[f.d] < grid_.n(f.d)) close(a, -1.0);
    f.closed = 1;
    out.closed[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = 1;
  }
}

/// A cell of plain fluid becomes one that carries itself; returns its index.
int CutMap::add_plain(const int (&at)[3], CutCells& out) const {
  CutCell plain;
  plain.i = at[0], plain.j = at[1], plain.k = at[2];
  plain.carrier = static_cast<int>(out.cells.size());
  out.cells.push_back(plain);
  out.index(at[0], at[1], at[2]) = static_cast<int>(out.cells.size());
  return plain.carrier;
}

/// The neighbour through an open face that lies most along the normal.
int CutMap::carrier_of(const CutCell& c, CutCells& out) const {
  double best = 0.02;
  int at[3] = {-1, -1, -1};
  for (int side = 0; side < 6; ++side) {
    const int d = side / 2, up = side % 2;
    int cell[3] = {c.i, c.j, c.k}, face[3] = {c.i, c.j, c.k};
    cell[d] += up ? 1 : -1;
    face[d] += up;
    if (!grid_.active(d) || cell[d] < 0 || cell[d] >= grid_.n(d)) continue;
    const double open = 1.0 - double(out.closed[static_cast<std::size_t>(d)](face[0], face[1], face[2]));
    const int index = out.index(cell[0], cell[1], cell[2]);
    if (index < 0 || (index > 0 && out.cells[static_cast<std::size_t>(index - 1)].carrier != index - 1))
      continue;
    const double along = (up ? 1.0 : -1.0) * double(c.normal[static_cast<std::size_t>(d)]);
    const double score = open * (1.0 + along);
    if (score > best) {
      best = score;
      std::copy_n(cell, 3, at);
    }
  }
  if (at[0] < 0) return -1;
  if (const int index = out.index(at[0], at[1], at[2]); index != 0) return index - 1;
  const int added = add_plain(at, out);
  CutCell& plain = out.cells[static_cast<std::size_t>(added)];
  plain.distance = c.distance;
  plain.normal = c.normal;
  for (int r = 0; r < used_; ++r) {
    const Region& region = regions_[static_cast<std::size_t>(r)];
    if (!region.holds(at[0], at[1], at[2])) continue;
    const float distance = region.distance[region.at(at[0], at[1], at[2])];
    if (plain.distance == c.distance || distance < plain.distance) plain.distance = distance;
  }
  return added;
}

/// A cell at an edge of a body: its faces may be open although a wall stands right behind them. The part of a
/// face that has a wall behind it counts as open in the measure of the room between both; the rest is closed,
/// and is wall to the cell beyond. Not so the face towards the carrier, or where there is none along the
/// normal. (An air stream turned round the edges of a box through such faces: its drag fell by half as its
/// faces went from a face of the grid to just behind it.)
void CutMap::close_dead_ends(CutCells& out) const {
  struct Change {
    CutFace face;
    int cell;  // at the edge
    int beyond[3];
    Real sign;  // +1: the face is its upper one
  };
  std::vector<Change> changes;
  for (std::size_t n = 0; n < out.cells.size(); ++n) {
    const CutCell& c = out.cells[n];
    if (!(c.edge > Real(0)) || c.locked) continue;
    for_each_neighbour(c, out, [&](int index, int side, const int* cell, double open) {
      if (index < 0 || open < kPassage) return;
      if (index > 0 && out.cells[static_cast<std::size_t>(index - 1)].carrier == c.carrier) return;
      int across[3] = {c.i, c.j, c.k};
      across[side / 2] += 1 - side % 2;
      const double through =
          1.0 - double(out.closed[static_cast<std::size_t>(side / 2)](across[0], across[1], across[2]));
      const double ends = open - through;  // this part has a wall behind it
      if (ends < double(kNothing)) return;
      const double room = room_behind(double(c.fluid), open, through);
      const double along = double(c.normal[static_cast<std::size_t>(side / 2)]);
      const double share = double(c.edge) * (out.small(n) ? 1.0 : 1.0 - along * along);
      CutFace f;
      f.d = side / 2;
      f.i = c.i, f.j = c.j, f.k = c.k;
      (f.d == 0 ? f.i : f.d == 1 ? f.j : f.k) += side % 2;
      f.closed = static_cast<Real>(1.0 - open + share * ends * (1.0 - room));
      f.velocity = out.walls[static_cast<std::size_t>(c.first_wall)].velocity[static_cast<std::size_t>(f.d)];
      changes.push_back({f, static_cast<int>(n), {cell[0], cell[1], cell[2]}, side % 2 ? Real(1) : Real(-1)});
    });
  }
  for (Change& change : changes) {
    const CutFace& f = change.face;
    Real& closed = out.closed[static_cast<std::size_t>(f.d)](f.i, f.j, f.k);
    if (closed >= f.closed) continue;  // two small cells share it
    const CutCell small = out.cells[static_cast<std::size_t>(change.cell)];
    const int at[3] = {small.i, small.j, small.k};
    const Real area =
        (f.closed - closed) * static_cast<Real>(grid_.volume(small.i, small.j, small.k) /
                                                grid_.axis(f.d).width[static_cast<std::size_t>(at[f.d])]);
    CutWall wall = out.walls[static_cast<std::size_t>(small.first_wall)];
    out.walls[static_cast<std::size_t>(small.first_wall)].area[static_cast<std::size_t>(f.d)] +=
        change.sign * area;
    wall.area = {};
    wall.area[static_cast<std::size_t>(f.d)] = -change.sign * area;
    const int index = out.index(change.beyond[0], change.beyond[1], change.beyond[2]);
    wall.cell = index > 0 ? index - 1 : add_plain(change.beyond, out);
    CutCell& beyond = out.cells[static_cast<std::size_t>(wall.cell)];
    if (index == 0) {
      beyond.distance =
          static_cast<Real>(0.5 * grid_.axis(f.d).width[static_cast<std::size_t>(change.beyond[f.d])]);
      beyond.normal[static_cast<std::size_t>(f.d)] = change.sign;
    }
    if (beyond.walls == 0) {
      beyond.first_wall = static_cast<int>(out.walls.size());
      beyond.walls = 1;
      out.walls.push_back(wall);
    } else {
      CutWall& first = out.walls[static_cast<std::size_t>(beyond.first_wall)];
      for (std::size_t d = 0; d < 3; ++d) first.area[d] += wall.area[d];
    }
    const bool is_listed = closed > Real(0);
    const auto close = [&] {
      out.closed[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = f.closed;
      if (!is_listed) out.faces.push_back(f);
    };
    close();
    int& along = f.d == 0 ? change.face.i : f.d == 1 ? change.face.j : change.face.k;
    if (along != 0 && along != grid_.n(f.d)) continue;
    along = grid_.n(f.d) - along;  // a periodic face of the box stands twice
    close();
  }
  if (changes.empty()) return;
  for (CutFace& f : out.faces) f.closed = out.closed[static_cast<std::size_t>(f.d)](f.i, f.j, f.k);
}

void CutMap::list_members(CutCells& out) const {
  for (const CutCell& c : out.cells)
    if (c.carrier >= 0) ++out.cells[static_cast<std::size_t>(c.carrier)].members;
  int first = 0;
  for (CutCell& c : out.cells) {
    c.first_member = first;
    first += c.members;
    c.members = 0;
  }
  out.members.resize(static_cast<std::size_t>(first));
  const auto add = [&](std::size_t n) {
    CutCell& c = out.cells[static_cast<std::size_t>(out.cells[n].carrier)];
    out.members[static_cast<std::size_t>(c.first_member + c.members++)] = static_cast<int>(n);
    const CutCell& m = out.cells[n];
    c.carried +=
        static_cast<Real>(double(m.fluid) * grid_.volume(m.i, m.j, m.k) / grid_.volume(c.i, c.j, c.k));
  };
  for (std::size_t n = 0; n < out.cells.size(); ++n)
    if (out.cells[n].carrier == static_cast<int>(n)) add(n);
  for (std::size_t n = 0; n < out.cells.size(); ++n)
    if (out.cells[n].carrier >= 0 && out.cells[n].carrier != static_cast<int>(n)) add(n);
}

/// The whole cells of the regions; where those of two bodies overlap the list has both distances.
void CutMap::list_near(CutCells& out) const {
  for (int n = 0; n < used_; ++n) {
    const Region& r = regions_[static_cast<std::size_t>(n)];
    for (int k = r.low[2]; k < r.low[2] + r.n[2]; ++k)
      for (int j = r.low[1]; j < r.low[1] + r.n[1]; ++j)
        for (int i = r.low[0]; i < r.low[0] + r.n[0]; ++i)
          if (out.index(i, j, k) >= 0)
            out.near.push_back({i, j, k, static_cast<Real>(r.distance[r.at(i, j, k)])});
  }
}

/// Ghosts are the cells inside solids and those whose momentum another carries.
void CutMap::find_donors(CutCells& out) const {
  for (std::size_t n = 0; n < ghost_region_.size(); ++n) {
    const CutCell& c = out.cells[n];
    if (c.carrier == static_cast<int>(n)) continue;
    GhostCell g;
    g.i = c.i, g.j = c.j, g.k = c.k;
    g.ratio = c.distance;
    g.donors = ghost_region_[n];
    out.ghosts.push_back(g);
  }
  for_each_index(static_cast<int>(out.ghosts.size()), [&](int n) {
    GhostCell& g = out.ghosts[static_cast<std::size_t>(n)];
    const Region& r = regions_[static_cast<std::size_t>(g.donors)];
    const double distance = g.ratio;
    const Vec3 x = grid_.centre(g.i, g.j, g.k), v = r.body->velocity_at(x - r.shift);
    for (int d = 0; d < 3; ++d) g.solid[static_cast<std::size_t>(d)] = static_cast<Real>(v[d]);
    g.donors = 0;
    g.ratio = 0;
    double deepest = 0.0;
    const int at[3] = {g.i, g.j, g.k};
    for (int d = 0; d < 3; ++d)
      if (grid_.active(d)) deepest = std::max(deepest, grid_.axis(d).width[static_cast<std::size_t>(at[d])]);
    if (distance < -kDeep * deepest) return;
    const Vec3 normal = normal_at(r, g.i, g.j, g.k);
    const double across = width_along(normal, g.i, g.j, g.k);
    if (!(across > 0.0)) return;
    for (int d = 0; d < 3; ++d) g.normal[static_cast<std::size_t>(d)] = static_cast<Real>(normal[d]);
    for (double beyond = 1.0; beyond < 2.6 && g.donors == 0; beyond += 0.5) {
      const Vec3 image = x + (beyond * across - distance) * normal;
      int low[3] = {g.i, g.j, g.k};
      double part[3] = {0, 0, 0};
      for (int d = 0; d < 3; ++d) {
        if (!grid_.active(d)) continue;
        const Axis& axis = grid_.axis(d);
        int cell = axis.cell_at(image[d]);
        if (image[d] < axis.centre[static_cast<std::size_t>(cell)]) --cell;
        low[d] = std::clamp(cell, 0, axis.n - 2);
        const std::size_t l = static_cast<std::size_t>(low[d]);
        part[d] = std::clamp((image[d] - axis.centre[l]) / (axis.centre[l + 1] - axis.centre[l]), 0.0, 1.0);
      }
      double sum = 0.0, from = 0.0;
      int donors = 0;
      for (int corner = 0; corner < 8; ++corner) {
        int cell[3];
        double weight = 1.0;
        bool there = true;
        for (int d = 0; d < 3; ++d) {
          const int up = (corner >> d) & 1;
          cell[d] = low[d] + up;
          there = there && (grid_.active(d) || !up);
          if (grid_.active(d)) weight *= up ? part[d] : 1.0 - part[d];
        }
        if (!there || weight < 1e-3 || !r.holds(cell[0], cell[1], cell[2])) continue;
        const int index = out.index(cell[0], cell[1], cell[2]);
        if (index < 0 || (index > 0 && out.cells[static_cast<std::size_t>(index - 1)].carrier != index - 1))
          continue;
        const std::size_t slot = static_cast<std::size_t>(donors++);
        g.donor[slot] = &out.closed[0](cell[0], cell[1], cell[2]) - &out.closed[0](g.i, g.j, g.k);
        g.weight[slot] = static_cast<Real>(weight);
        sum += weight;
        from += weight * double(r.distance[r.at(cell[0], cell[1], cell[2])]);
      }
      if (sum < 0.2 || !(from / sum > 0.2 * across)) continue;
      g.donors = donors;
      g.image = static_cast<Real>(from / sum);
      g.ratio = static_cast<Real>(std::max(distance / (from / sum), -2.0));
      for (int m = 0; m < donors; ++m) g.weight[static_cast<std::size_t>(m)] /= static_cast<Real>(sum);
    }
  });
}

}  // namespace ejecta
