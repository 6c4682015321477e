#pragma once
#include <span>
#include <utility>
#include <vector>

#include "dem/ball_contacts.hpp"
#include "dem/domain.hpp"
#include "dem/neighbours.hpp"
#include "dem/parts.hpp"
#include "dem/solid_contacts.hpp"

namespace ejecta {

/// Pairs of parts nearer than the skin, sorted: what the narrow phase looks at until something has moved half
/// of it. Pairs of which neither side can be pushed are left out. Keeps its buffers.
class CandidateSearch {
 public:
  /// `balls`: the contacts that were there before; none: all are new.
  void find(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
            const Domain& domain, double skin, const BallContacts* balls = nullptr);
  /// Only those of one body with walls, whether it is there or not.
  void find_walls(int body, const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
                  const Domain& domain);
  std::span<const std::pair<int, int>> balls() const { return balls_; }    ///< indices of balls
  std::span<const std::pair<int, int>> planes() const { return planes_; }  ///< ball, wall plane
  std::vector<SolidPair>& solids() { return solids_; }
  std::span<const SolidPair> solids() const { return solids_; }

 private:
  /// A part, or its image across a periodic side.
  struct Part {
    int index = 0;  // of a ball, or of a polytope after all balls
    bool can_be_pushed = true, only_ball = false, image = false;
    Vec3 shift{0, 0, 0};               // m, from the part to its image
    Eigen::Vector3i periods{0, 0, 0};  // by which it is moved
  };
  void list_parts(const Parts& parts, std::span<const Body> bodies);
  void add_images(const Domain& domain, double skin);
  void list_body(int body, const Parts& parts, const Body& at);
  void list_walls(std::span<const Wall> walls, const Domain& domain, int balls, double skin,
                  const BallContacts* before);
  void list_surface(const Wall& wall, int index, const Domain& domain, std::size_t item, int balls,
                    double skin, bool as_plane, const BallContacts* before);
  void drop_doubles(std::span<const Wall> walls, const Domain& domain, std::size_t item, int balls,
                    double skin, const BallContacts* before, std::size_t first_plane,
                    std::size_t first_solid);
  bool list_plane(const Wall& wall, int region, const Domain& domain, std::size_t item, double reach,
                  const BallContacts* before);
  void put(std::size_t item, const PartKey& wall, int balls);

  NeighbourSearch search_;
  std::vector<NeighbourSearch::Item> items_;
  std::vector<Part> part_of_;  // each item
  std::vector<std::pair<int, int>> balls_, planes_;
  std::vector<SolidPair> solids_;
  std::vector<int> near_;
  std::vector<double> gaps_;  // m, between a ball and the triangles near it
  /// A plane that a ball is listed with.
  struct Flat {
    Vec3 normal;
    double height = 0.0;  // m, of the ball's centre above it
    int wall = 0, plane = 0;
    bool kept = true;
  };
  std::vector<Flat> flats_;
};

}  // namespace ejecta
