#include "jet/profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "base/error.hpp"

namespace ejecta {
namespace {

JetProfile cone() {
  JetProfile profile(0.04, {1e-3, 2e-3, 4e-3});
  for (const double t : {1e-3, 2e-3}) {
    const double u = 1e5 * t;
    profile.add({t, {u, 0.5 * u, 0.0}, {2.0, 4.0, 6.0}, {10, 5, 1}, {100, 50, 10}});
  }
  return profile;
}

std::filesystem::path file(const std::string& name) {
  return std::filesystem::temp_directory_path() / "ejecta_profiles" / name;
}

std::string complaint(const std::filesystem::path& path) {
  try {
    JetProfile::read(path);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(JetProfile, IsLinearInRadiusAndTime) {
  const JetProfile p = cone();
  EXPECT_NEAR(p.at({1e-3, 0, 0}, 1.5e-3).velocity.z(), 150.0, 1e-9);
  EXPECT_NEAR(p.at({0, 1.5e-3, 0}, 1e-3).velocity.z(), 75.0, 1e-9);
  EXPECT_NEAR(p.at({0, 3e-3, 0}, 2e-3).velocity.y(), 5.0, 1e-9);
  EXPECT_NEAR(p.at({0, 3e-3, 0}, 2e-3).k, 3.0, 1e-9);
}

TEST(JetProfile, BlowsAwayFromTheAxisAndNotOnIt) {
  const JetProfile p = cone();
  const InflowState s = p.at({-6e-4, 8e-4, 0}, 1e-3);
  EXPECT_NEAR(s.velocity.x(), -1.2, 1e-9);
  EXPECT_NEAR(s.velocity.y(), 1.6, 1e-9);
  EXPECT_EQ(p.at({0, 0, 0}, 1e-3).velocity.x(), 0.0);
  EXPECT_NEAR(p.at({5e-4, 0, 0}, 1e-3).velocity.x(), 1.0, 1e-9);
}

TEST(JetProfile, HoldsItsEndsInTimeAndIsStillOutside) {
  const JetProfile p = cone();
  EXPECT_NEAR(p.at({0, 0, 0}, 0.0).velocity.z(), 100.0, 1e-9);
  EXPECT_NEAR(p.at({0, 0, 0}, 1.0).velocity.z(), 200.0, 1e-9);
  EXPECT_EQ(p.at({5e-3, 0, 0}, 1e-3).velocity.norm(), 0.0);
  EXPECT_NEAR(p.fastest(2e-3), 200.0, 1e-9);
}

TEST(JetProfile, SurvivesItsFileBitForBit) {
  const JetProfile p = cone();
  p.write(file("cone.jet"));
  const JetProfile q = JetProfile::read(file("cone.jet"));
  EXPECT_EQ(q.height(), p.height());
  EXPECT_EQ(q.radii(), p.radii());
  ASSERT_EQ(q.moments().size(), p.moments().size());
  EXPECT_EQ(q.moments()[1].radial, p.moments()[1].radial);
  EXPECT_EQ(q.at({1.7e-3, 0, 0}, 1.3e-3).velocity, p.at({1.7e-3, 0, 0}, 1.3e-3).velocity);
}

TEST(JetProfile, DamageIsNamed) {
  using testing::HasSubstr;
  const auto path = file("damaged.jet");
  cone().write(path);
  const auto size = std::filesystem::file_size(path);
  {
    std::fstream f(path, std::ios::in | std::ios::out | std::ios::binary);
    f.seekp(std::streamoff(size) - 9);
    f.put('x');
  }
  EXPECT_THAT(complaint(path), HasSubstr("checksum"));
  cone().write(path);
  std::filesystem::resize_file(path, size - 8);
  EXPECT_THAT(complaint(path), HasSubstr("damaged"));
  std::filesystem::resize_file(path, 10);
  EXPECT_THAT(complaint(path), HasSubstr("wrong length"));
  std::ofstream(path) << std::string(400, 'a');
  EXPECT_THAT(complaint(path), HasSubstr("damaged"));
  EXPECT_THAT(complaint(file("missing.jet")), HasSubstr("cannot read"));
}

TEST(JetProfile, RefusesNoNumbers) {
  JetProfile p(0.04, {1e-3});
  EXPECT_THROW(p.add({0.0, {std::numeric_limits<double>::quiet_NaN()}, {0.0}, {0.0}, {0.0}}), Error);
}

}  // namespace
}  // namespace ejecta
