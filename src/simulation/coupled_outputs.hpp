#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "output/checkpoint.hpp"
#include "output/pvd_series.hpp"
#include "output/replay.hpp"
#include "output/slice_sampler.hpp"
#include "output/vtk_bodies.hpp"
#include "output/vtk_rectilinear.hpp"
#include "simulation/coupled_model.hpp"
#include "simulation/histories.hpp"
#include "simulation/probe.hpp"

namespace ejecta {

/// Everything a run records while it goes. Observes the model, never changes it.
class CoupledOutputs : public Outputs {
 public:
  /// `keep_histories` false: where there is no directory, none are kept in memory either.
  CoupledOutputs(const Case& c, const CoupledModel& model, const OutputPlace& place, bool keep_histories);

  void observe(double time, std::int64_t steps) override;
  void add_events(Clock& clock) const override;
  /// The last row of the histories, whatever their interval.
  void finish(double time) override;
  /// Greatest value each probe saw of each quantity, with its time; last values; lines.
  void report(nlohmann::ordered_json& result) override;
  output::NamedHistories histories() const override { return histories_.in_memory(); }

  std::vector<double> state() const override;
  void restore(const std::vector<double>& state) override;

 private:
  struct Line {
    std::vector<Vec3> points;
    std::vector<double> position;  ///< m, from its first end
    output::History* history;
  };
  void open_histories();
  void open_fields();
  void open_replay();
  void write_histories(double time);
  void write_fields(double time);
  void write_slices(double time);
  void write_lines(double time);
  void write_replay(double time);
  void write_grain_history(double time);
  void write_grains(double time);
  void update_probes(double time);
  std::vector<CellField> written_fields() const;

  const Case& case_;
  const CoupledModel& model_;
  OutputPlace place_;
  bool keep_histories_;
  Histories histories_;
  std::vector<output::History*> bodies_;  ///< of each, or of none
  std::vector<Probe> probes_;
  std::vector<Line> lines_;
  output::History *energy_ = nullptr, *grains_ = nullptr;
  std::optional<output::PvdSeries> air_, bodies_series_, grains_series_;
  std::vector<output::PvdSeries> slices_;
  std::optional<output::RectilinearWriter> writer_;
  std::optional<output::BodiesWriter> bodies_writer_;
  std::unique_ptr<output::ReplayFile> replay_;
  output::ReplayHeader header_;
  std::vector<output::SliceSampler> samplers_;
  Schedule histories_due_, fields_, slices_due_, replay_due_;
  double last_probe_time_ = 0.0;
};

}  // namespace ejecta
