#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "case/load.hpp"
#include "jet/source.hpp"
#include "sorter/company.hpp"
#include "sorter/particle_class.hpp"

using namespace ejecta;

/// Bodies that fly together (src/sorter/company.hpp).
namespace {

class TwoCubes : public testing::Test {
 protected:
  TwoCubes()
      : case_(load_case(EJECTA_SOURCE_DIR "/cases/sorter/tutorial.toml")),
        source_(make_jet_source(case_)),
        field_(case_, *source_),
        kind_(cube(), "", 1) {
    case_.classes = {cube()};
    particle_.prototype = &kind_.prototype(0.5);
    particle_.mass = kind_.mass_of(*particle_.prototype, 1.0);
    // Over the jet while that is open.
    blow_ = {0.0, {.from = -4e-3, .to = 4e-3}};
  }
  static ParticleClassSpec cube() {
    ParticleClassSpec k;
    k.name = "cube";
    k.share = 1.0;
    k.size = 10e-3;
    k.form = ParticleForm::box;
    return k;
  }
  Flyer at(double along, double across) const {
    return {.particle = &particle_, .at = -along / case_.launch.belt_speed, .y = across, .blows = {blow_}};
  }
  std::vector<FlightEnd> together(const std::vector<Flyer>& flyers) const {
    const FastFlight flight(case_, field_);
    return Company(case_, flight).fly(flyers);
  }
  std::vector<FlightEnd> alone(const std::vector<Flyer>& flyers) const {
    const FastFlight flight(case_, field_);
    std::vector<FlightEnd> ends;
    for (const Flyer& f : flyers) ends.push_back(flight.fly(f));
    return ends;
  }

  Case case_;
  std::unique_ptr<JetSource> source_;
  JetField field_;
  ParticleClass kind_;
  FeedParticle particle_;
  Blow blow_;
};

TEST_F(TwoCubes, FarFromEachOtherFlyAsAlone) {
  const std::vector<Flyer> flyers{at(0, 0), at(0, 40e-3), at(-60e-3, 2e-3)};
  const auto found = together(flyers), single = alone(flyers);
  for (std::size_t n = 0; n < flyers.size(); ++n) {
    EXPECT_FALSE(found[n].in_company);
    EXPECT_EQ(found[n].clearance, single[n].clearance);
    EXPECT_EQ(found[n].y, single[n].y);
  }
}

/// The first is blown against the second, which hardly any air reaches: it goes with it, and their momentum
/// across the belt is what the air gave.
TEST_F(TwoCubes, OneThatTheAirThrowsAtAnotherTakesItAlong) {
  const std::vector<Flyer> flyers{at(0, 5e-3), at(0, 15.2e-3)};
  const auto found = together(flyers), single = alone(flyers);
  ASSERT_TRUE(found[0].in_company && found[1].in_company);
  EXPECT_TRUE(found[0].met && found[1].met);
  ASSERT_GT(single[0].y - flyers[0].y, 1e-3);  // alone it goes aside ...
  EXPECT_LT(found[0].y, single[0].y);          // ... and less where the other stands in its way,
  EXPECT_GT(found[1].y, single[1].y);          // which it pushes.
}

TEST_F(TwoCubes, AreTheSameInAnyOrderAndOnEitherSide) {
  const std::vector<Flyer> flyers{at(0, 5e-3), at(1e-3, 15.2e-3)}, turned{flyers[1], flyers[0]},
      mirrored{at(0, -5e-3), at(1e-3, -15.2e-3)};
  const auto found = together(flyers), swapped = together(turned), mirror = together(mirrored);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_NEAR(found[n].y, swapped[1 - n].y, 1e-5);
    EXPECT_NEAR(found[n].clearance, swapped[1 - n].clearance, 1e-5);
    EXPECT_NEAR(found[n].y, -mirror[n].y, 1e-5);
    EXPECT_NEAR(found[n].clearance, mirror[n].clearance, 1e-5);
  }
}

/// By contacts alone.
TEST_F(TwoCubes, PushOneThatNoAirReaches) {
  std::vector<Flyer> flyers{at(0, 5e-3), at(0, 15.2e-3)};
  flyers[1].blows.clear();
  const auto found = together(flyers);
  ASSERT_TRUE(found[1].met);
  const Vec3 second = found[1].track.end.velocity;
  EXPECT_GT(second.y(), 0.01);
  EXPECT_LT(second.y(), found[0].track.at(0.0).velocity.y() + 0.5);
}

TEST_F(TwoCubes, ThatLieInEachOtherFlyThroughEachOther) {
  const std::vector<Flyer> flyers{at(0, 0), at(0, 6e-3)};
  const auto found = together(flyers), single = alone(flyers);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_TRUE(found[n].in_another);
    EXPECT_EQ(found[n].clearance, single[n].clearance);
  }
}

TEST_F(TwoCubes, FlyAloneWhereThatIsAsked) {
  case_.sorter.encounters = false;
  const auto found = together({at(0, 5e-3), at(0, 15.2e-3)});
  EXPECT_FALSE(found[0].in_company);
}

}  // namespace
