#pragma once
#include <string>
#include <vector>

#include "shape/mass_properties.hpp"
#include "shape/triangle_mesh.hpp"

namespace ejecta {

/// Spheres inside a closed mesh (convex or not) such that no point of its surface lies farther than `error`
/// (m) from theirs; they stick out nowhere. Candidates are the largest balls that touch the surface from
/// inside at points spread over it (shrinking balls, Ma, Bae & Choi 2012, Visual Computer 28:7); of these the
/// one that brings most of the surface within the error is taken, again and again. Throws InputError where
/// the mesh is not closed or the error so small that millions of candidates would be needed, with one that
/// works.
std::vector<Ball> fit_spheres(const TriangleMesh& mesh, double error, const std::string& name);

}  // namespace ejecta
