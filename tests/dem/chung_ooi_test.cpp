#include <gtest/gtest.h>

#include <cmath>

#include "scene.hpp"

/// Benchmarks of Chung & Ooi 2011, Granular Matter 13:643.
namespace ejecta {
namespace {

MaterialSpec material(double youngs, double poisson, double density, double restitution, double friction) {
  MaterialSpec m = stone();
  m.youngs_modulus = youngs;
  m.poisson_ratio = poisson;
  m.density = density;
  m.restitution = restitution;
  m.friction = friction;
  return m;
}

MaterialSpec rigid(MaterialSpec m) {
  m.name = "rigid";
  m.youngs_modulus *= 1e6;
  return m;
}

struct Impact {
  double overlap = 0, force = 0, time = 0;
};

/// Advances to the end of the first contact.
Impact follow(Particles& p, double dt) {
  Impact impact;
  bool touched = false;
  double begin = 0;
  for (int n = 0; n < 10000000; ++n) {
    p.advance(dt);
    const auto contacts = p.contacts();
    if (contacts.empty()) {
      if (touched) return impact;
      continue;
    }
    const ContactRecord& c = contacts.front();
    if (!touched) begin = p.time() - dt;
    touched = true;
    impact.overlap = std::max(impact.overlap, c.overlap);
    impact.force = std::max(impact.force, c.force.dot(c.normal));
    impact.time = p.time() - begin;
  }
  return impact;
}

TEST(ChungOoi, Test1ElasticNormalImpactOfTwoSpheres) {
  struct {
    MaterialSpec m;
    double overlap, force, time;
  } const rows[] = {{material(48e9, 0.20, 2800, 1, 0.35), 274.113e-6, 10.6969e3, 40.338e-6},
                    {material(20e9, 0.25, 2500, 1, 0.35), 368.304e-6, 7.1082e3, 54.200e-6}};
  for (const auto& row : rows) {
    Case c = scene(row.m);
    c.bodies = {ball("a", 20e-3, Vec3(-10e-3, 0, 0), Vec3(10, 0, 0)),
                ball("b", 20e-3, Vec3(10e-3, 0, 0), Vec3(-10, 0, 0))};
    Particles p = make_particles(c);
    const Impact i = follow(p, 1e-8);
    EXPECT_NEAR(i.overlap, row.overlap, 1e-3 * row.overlap);
    EXPECT_NEAR(i.force, row.force, 1e-3 * row.force);
    EXPECT_NEAR(i.time, row.time, 1e-3 * row.time);
    EXPECT_NEAR(p.bodies()[0].velocity.x(), -10, 1e-4);
    EXPECT_NEAR(p.peaks(0).overlap, row.overlap, 1e-3 * row.overlap);
    EXPECT_NEAR(p.peaks(0).force, row.force, 1e-3 * row.force);
    EXPECT_NEAR(p.peaks(1).time, row.time, 1e-3 * row.time);
  }
}

TEST(ChungOoi, Test2ElasticNormalImpactOnAPlane) {
  struct {
    MaterialSpec m;
    double overlap, force, time;
  } const rows[] = {{material(70e9, 0.30, 2699, 1, 0), 49.717e-6, 11.3699e3, 731.64e-6},
                    {material(40e9, 0.35, 1800, 1, 0), 52.123e-6, 7.2327e3, 767.05e-6}};
  for (const auto& row : rows) {
    Case c = scene(row.m);
    c.materials.push_back(rigid(row.m));
    c.bodies = {ball("a", 200e-3, Vec3(0, 0, 100e-3), Vec3(0, 0, -0.2))};
    c.walls = {floor_at(0, "rigid")};
    Particles p = make_particles(c);
    const Impact i = follow(p, 2e-7);
    EXPECT_NEAR(i.overlap, row.overlap, 1e-3 * row.overlap);
    EXPECT_NEAR(i.force, row.force, 1e-3 * row.force);
    EXPECT_NEAR(i.time, row.time, 1e-3 * row.time);
  }
}

TEST(ChungOoi, Test3RestitutionOutIsRestitutionIn) {
  for (const bool tension : {false, true})
    for (const double e : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0})
      for (const MaterialSpec& m : {material(380e9, 0.23, 4000, e, 0), material(100e9, 0.25, 7000, e, 0)}) {
        Case c = scene(m);
        c.contact.allow_tension = tension;
        c.materials.push_back(rigid(m));
        c.bodies = {ball("a", 5e-3, Vec3(0, 0, 2.5e-3), Vec3(0, 0, -3.9))};
        c.walls = {floor_at(0, "rigid")};
        Particles p = make_particles(c);
        follow(p, 1e-8);
        EXPECT_NEAR(p.bodies()[0].velocity.z() / 3.9, e, 0.005 * e) << tension;
      }
}

Particles oblique(double degrees) {
  const MaterialSpec m = material(380e9, 0.23, 4000, 0.98, 0.092);
  Case c = scene(m);
  c.materials.push_back(rigid(m));
  const double a = degrees * M_PI / 180;
  c.bodies = {ball("a", 5e-3, Vec3(0, 0, 2.5e-3), 3.9 * Vec3(std::sin(a), 0, -std::cos(a)))};
  c.walls = {floor_at(0, "rigid")};
  Particles p = make_particles(c);
  follow(p, 5e-9);
  return p;
}

TEST(ChungOoi, Test4ObliqueImpactGrossSliding) {
  const double degrees[] = {35, 40, 50, 60, 70, 80, 85};
  const double tangential[] = {0.7398, 0.7829, 0.8471, 0.8948, 0.9337, 0.9679, 0.9841};
  const double spin[] = {-582.0, -544.2, -456.7, -355.2, -243.0, -123.4, -61.9};
  const double rebound[] = {3.66, 11.62, 29.49, 48.16, 65.09, 78.98, 84.81};
  for (int n = 0; n < 7; ++n) {
    const Particles p = oblique(degrees[n]);
    const Body& b = p.bodies()[0];
    const double tan_in = std::tan(degrees[n] * M_PI / 180);
    EXPECT_NEAR(b.velocity.x() / (3.9 * std::sin(degrees[n] * M_PI / 180)), tangential[n],
                0.005 * tangential[n]);
    EXPECT_NEAR(-b.angular_velocity.y(), spin[n], 0.005 * std::abs(spin[n])) << degrees[n];
    const double surface = b.velocity.x() - 2.5e-3 * b.angular_velocity.y();
    EXPECT_NEAR(std::atan2(surface, b.velocity.z()) * 180 / M_PI, rebound[n], 0.3) << tan_in;
  }
}

/// Sticking branch: no exact solution; the paper's curves for aluminium oxide as digitised.
TEST(ChungOoi, Test4ObliqueImpactSticking) {
  const double degrees[] = {5, 10, 15, 20, 25, 30};
  const double tangential[] = {0.948, 0.687, 0.624, 0.616, 0.634, 0.684};
  const double spin[] = {-19, -213, -378, -511, -599, -617};
  for (int n = 0; n < 6; ++n) {
    const Particles p = oblique(degrees[n]);
    const Body& b = p.bodies()[0];
    EXPECT_NEAR(b.velocity.x() / (3.9 * std::sin(degrees[n] * M_PI / 180)), tangential[n], 0.03);
    EXPECT_NEAR(-b.angular_velocity.y(), spin[n], 25);
  }
}

TEST(ChungOoi, Test7OppositeSpinsDoNotSlip) {
  for (const MaterialSpec& m : {material(70e9, 0.33, 2700, 0.5, 0.4), material(120e9, 0.35, 8900, 0.5, 0.4)})
    for (const double spin : {0.175, 0.5, 1.0, 2.0}) {
      Case c = scene(m);
      c.bodies = {ball("a", 0.2, Vec3(-0.1, 0, 0), Vec3(0.2, 0, 0)),
                  ball("b", 0.2, Vec3(0.1, 0, 0), Vec3(-0.2, 0, 0))};
      c.bodies[0].spin = Vec3(0, spin, 0);
      c.bodies[1].spin = Vec3(0, -spin, 0);
      Particles p = make_particles(c);
      follow(p, 1e-6);
      EXPECT_NEAR(p.bodies()[0].angular_velocity.y(), spin, 1e-9);
      EXPECT_NEAR(p.bodies()[0].velocity.z(), 0, 1e-12);
    }
}

}  // namespace
}  // namespace ejecta
