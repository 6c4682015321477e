#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "output/pvd_series.hpp"
#include "output/replay.hpp"
#include "output/run_directory.hpp"
#include "output/slice_sampler.hpp"
#include "output/vtk_bodies.hpp"
#include "output/vtk_rectilinear.hpp"
#include "simulation/coupled_model.hpp"
#include "simulation/probe.hpp"

namespace ejecta {

/// Everything a run writes while it goes. Observes the model, never changes it.
class RunOutputs {
 public:
  /// `resume_time`: go on with existing files, dropping what is later.
  RunOutputs(const Case& c, const CoupledModel& model, const output::RunDirectory& directory,
             const std::vector<std::string>& provenance, std::optional<double> resume_time);

  /// Called after every step; writes what is due.
  void observe(double time, std::int64_t step);
  /// Output times the clock must land on.
  void add_events(class Clock& clock, double end) const;
  /// The last row of the histories, whatever their interval.
  void finish(double time);
  /// Greatest value each probe saw of each quantity, with its time; last values; lines: for result.json.
  void report(nlohmann::ordered_json& result) const;

  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  struct Line {
    std::vector<Vec3> points;
    std::vector<double> position;  ///< m, from its first end
    std::unique_ptr<output::HistoryFile> file;
  };
  void write_histories(double time);
  void write_fields(double time);
  void write_slices(double time);
  void write_lines(double time);
  void write_replay(double time);
  void update_probes(double time);
  std::vector<CellField> written_fields() const;

  const Case& case_;
  const CoupledModel& model_;
  output::RunDirectory directory_;
  std::vector<std::unique_ptr<output::HistoryFile>> bodies_;
  std::vector<Probe> probes_;
  std::vector<Line> lines_;
  std::vector<std::string> provenance_;
  std::unique_ptr<output::HistoryFile> energy_;
  std::optional<output::PvdSeries> air_, bodies_series_;
  std::vector<output::PvdSeries> slices_;
  std::optional<output::RectilinearWriter> writer_;
  std::optional<output::BodiesWriter> bodies_writer_;
  std::unique_ptr<output::ReplayFile> replay_;
  output::ReplayHeader header_;
  std::vector<output::SliceSampler> samplers_;
  // When each was last written, s.
  double last_history_ = -1e300, last_fields_ = -1e300, last_slices_ = -1e300, last_replay_ = -1e300;
  double last_probe_time_ = 0.0, replay_interval_ = 0.0;
};

}  // namespace ejecta
