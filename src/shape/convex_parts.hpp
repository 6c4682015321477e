#pragma once
#include <string>
#include <vector>

#include "shape/polytope.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {

/// Convex solids that share no space and together hold the solid that `mesh` (closed, not crossing itself)
/// bounds; its surface lies nowhere deeper below theirs than `error` (m; 0: round-off, the division is
/// exact). The solid is cut along planes, the most hollow piece first, until every piece is its own convex
/// hull within the error. Of the planes of its hollow faces and nine across the piece the one after which the
/// hulls hold least is taken (the greedy scheme of Mamou & Ghorbel 2009, ICIP, and Wei et al. 2022, ACM
/// Trans. Graph. 41:42, with exact cuts in place of voxels or sampled distances). Throws InputError where
/// that would take more than 100 parts, with an error that does not.
std::vector<Polytope> convex_parts(const TriangleMesh& mesh, double error, const std::string& name);

/// The hulls of the pieces of a closed mesh, each of which hangs together, if all their corners lie on them;
/// else nothing. (A hole through a piece can leave all corners on the hull: its volume tells.)
std::vector<Polytope> convex_pieces(const TriangleMesh& mesh);

}  // namespace ejecta
