#include "simulation/case_changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "case/load.hpp"
#include "case/template.hpp"
#include "case/write.hpp"

using namespace ejecta;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

std::string resolved(const std::vector<std::string>& overrides = {}) {
  return write_case(parse_case(case_template("ejection"), "ejection.toml", overrides));
}

}  // namespace

TEST(ChangedKeys, NamesWhatARunCannotChangeOnItsWay) {
  EXPECT_THAT(changed_keys(resolved(), resolved()), IsEmpty());
  EXPECT_THAT(changed_keys(resolved(),
                           resolved({"valve.rise_time=5 ms", "body.0.size=[\"9 mm\", \"9 mm\", \"9 mm\"]"})),
              ElementsAre("body.0.size", "valve.rise_time"));
}

TEST(ChangedKeys, AnOptionalKeyThatAppearsOrGoesIsAChange) {
  EXPECT_THAT(changed_keys(resolved(), resolved({"run.time_step=2 us"})), ElementsAre("run.time_step"));
  EXPECT_THAT(changed_keys(resolved({"run.time_step=2 us"}), resolved()), ElementsAre("run.time_step"));
}

TEST(ChangedKeys, TheEndAndTheCheckpointsMayChange) {
  EXPECT_THAT(changed_keys(resolved(), resolved({"run.end_time=70 ms", "checkpoint.every_steps=5"})),
              IsEmpty());
}
