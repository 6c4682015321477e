#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "case/csv_table.hpp"
#include "case/load.hpp"
#include "sorter/flight.hpp"
#include "sorter/particle_class.hpp"

using namespace ejecta;

/// The fast tier against resolved runs of single bodies (tests/sorter/resolved_gains.csv,
/// docs/theory/sorter.md).
namespace {

struct ResolvedRun {
  double across = 0.0, along = 0.0;  ///< m, as launch.offset_along, launch.offset_across
  double gain = 0.0;                 ///< m/s
};

/// One body of the paper on its jet.
class PaperBody {
 public:
  PaperBody(double size, double flatness, ParticleForm form)
      : case_(load_case(EJECTA_SOURCE_DIR "/cases/paper/10mm-cubic.toml")),
        source_(make_jet_source(case_)),
        field_(case_, *source_),
        flight_(case_, field_),
        kind_(spec(size, flatness, form), "", 1) {
    particle_.prototype = &kind_.prototype(0.5);
    particle_.mass = kind_.mass_of(*particle_.prototype, 1.0);
  }
  double gain(double along, double across) const {
    const Blow blow{0.0, {.from = case_.valve.opens_at, .to = case_.valve.opens_at + case_.valve.duration}};
    return flight_
        .fly({.particle = &particle_,
              .at = case_.launch.arrives_at - along / case_.launch.belt_speed,
              .y = across,
              .blows = {blow}})
        .gain;
  }

 private:
  static ParticleClassSpec spec(double size, double flatness, ParticleForm form) {
    ParticleClassSpec k;
    k.share = 1.0;
    k.size = size;
    k.flatness = flatness;
    k.form = form;
    return k;
  }
  Case case_;
  std::unique_ptr<JetSource> source_;
  JetField field_;
  FastFlight flight_;
  ParticleClass kind_;
  FeedParticle particle_;
};

/// By number of the body in the table.
std::map<int, std::vector<ResolvedRun>> resolved_runs() {
  std::vector<Problem> problems;
  const CsvTable table = read_csv(EJECTA_SOURCE_DIR "/tests/sorter/resolved_gains.csv",
                                  {.kind = "gains",
                                   .columns = {{"body", Dimension::none},
                                               {"along", Dimension::length},
                                               {"across", Dimension::length},
                                               {"gain", Dimension::velocity}},
                                   .ascends = false,
                                   .example_head = "body, along [mm], across [mm], gain [m/s]",
                                   .example_row = "0, 0, 0, 0.68"},
                                  problems);
  EXPECT_TRUE(problems.empty());
  std::map<int, std::vector<ResolvedRun>> runs;
  for (const auto& row : table.rows) runs[static_cast<int>(row[0])].push_back({row[2], row[1], row[3]});
  return runs;
}

struct GainError {
  double rms = 0.0, bias = 0.0;
  int count = 0;
};

/// Of gains above 0.1 m/s. The coarse grid they were computed on adds as much everywhere as in the middle,
/// where that of the paper's is known, m/s.
GainError error_of(const PaperBody& body, const std::vector<ResolvedRun>& runs, double paper_middle) {
  double middle = 0.0;
  for (const ResolvedRun& r : runs)
    if (r.along == 0.0 && r.across == 0.0) middle = r.gain;
  EXPECT_GT(middle, 0.0);
  GainError e;
  for (const ResolvedRun& r : runs) {
    if (r.gain < 0.1) continue;
    const double error = body.gain(r.along, r.across) / (r.gain * paper_middle / middle) - 1.0;
    e.rms += error * error;
    e.bias += error;
    ++e.count;
  }
  e.rms = std::sqrt(e.rms / e.count);
  e.bias /= e.count;
  return e;
}

/// To all of them its five coefficients were fitted (docs/theory/sorter.md).
TEST(FastFlight, HasTheResolvedGains) {
  const struct {
    const char* name;
    double size, flatness;
    ParticleForm form;
    double middle;  ///< m/s, on the paper's grid (docs/status.md)
    double most;    ///< root mean square error that is no step back from docs/theory/sorter.md
  } bodies[] = {{"10 mm cube", 10e-3, 1.0, ParticleForm::box, 1.213, 0.05},
                {"20 mm cube", 20e-3, 1.0, ParticleForm::box, 0.412, 0.05},
                {"20 mm flat box", 20e-3, 0.5, ParticleForm::box, 0.622, 0.13},
                {"10 mm cluster", 10e-3, 1.0, ParticleForm::cluster, 0.606, 0.08},
                {"10 mm flat cluster", 10e-3, 0.5, ParticleForm::cluster, 1.089, 0.08},
                {"20 mm cluster", 20e-3, 1.0, ParticleForm::cluster, 0.158, 0.12},
                {"20 mm flat cluster", 20e-3, 0.5, ParticleForm::cluster, 0.284, 0.14}};
  const auto runs = resolved_runs();
  GainError all;
  int n = 0;
  for (const auto& b : bodies) {
    const auto found = runs.find(n++);
    ASSERT_NE(found, runs.end());
    const GainError e = error_of(PaperBody(b.size, b.flatness, b.form), found->second, b.middle);
    std::printf("%-18s %2d gains: root mean square %4.1f %%, bias %+5.1f %%\n", b.name, e.count, 100 * e.rms,
                100 * e.bias);
    EXPECT_GE(e.count, 3) << b.name;
    EXPECT_LT(e.rms, b.most) << b.name;
    all.rms += e.count * e.rms * e.rms;
    all.bias += e.count * e.bias;
    all.count += e.count;
  }
  std::printf("all                %2d gains: root mean square %4.1f %%, bias %+5.1f %%\n", all.count,
              100 * std::sqrt(all.rms / all.count), 100 * all.bias / all.count);
}

}  // namespace
