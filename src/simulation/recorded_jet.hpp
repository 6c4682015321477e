#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jet/measured.hpp"
#include "jet/momentum.hpp"
#include "jet/records.hpp"
#include "jet/settled.hpp"
#include "jet/store.hpp"
#include "output/figures.hpp"
#include "simulation/jet_files.hpp"
#include "simulation/model.hpp"

namespace ejecta {

/// The jet when it blows its strongest: at the end of the valve's command.
struct JetAtFull {
  double time = 0.0;  ///< s
  Centreline centreline;
  std::vector<LineProfile> lines;  ///< as the case lists them
  output::Picture schlieren;
  nlohmann::ordered_json figures;  ///< shocks, far field, what arrives at the stand-off: parts of result.json
};

/// A jet from its nozzle with everything that is recorded of it.
class RecordedJet : public Model {
 public:
  /// The jet is kept as it crosses the plane `kept_at`, m above the orifice. Throws InputError when the case
  /// computes no jet or
  /// a measurement cannot be read.
  RecordedJet(const Case& c, double kept_at);

  double stable_dt(double time) override { return jet_.stable_dt(time); }
  void advance(const Step& step) override;
  std::vector<double> events() const override;
  bool finished() const override { return false; }
  /// Stores the jet, and computes the incompressible one that the case wants to compare it with.
  bool conclude(const std::function<bool()>& stop, const Note& note) override;
  void require_finite(double time) const override;
  std::int64_t cells() const override { return jet_.grid().cells(); }
  std::size_t bodies() const override { return 0; }
  double courant() const override { return jet_.scenario().run.courant; }
  double busy_until() const override { return jet_.scenario().run.end_time; }
  std::vector<OperatorTime> operator_times() const override { return {advance_, record_}; }
  FieldsOnGrid fields() override { return {}; }
  std::vector<NamedField> state_fields() override;
  StateNumbers state_numbers() const override;
  void restore_numbers(const StateNumbers& numbers, double time) override;
  nlohmann::ordered_json result(double time, std::int64_t steps, double wall_time,
                                std::span<const OperatorTime> operators) const override;
  std::optional<double> later_end(double) const override { return std::nullopt; }
  std::vector<std::string> warnings() const override { return {}; }

  const JetModel& jet() const { return jet_; }
  const OrificeRecord& orifice() const { return orifice_; }
  const MomentumRecord& momentum() const { return momentum_; }
  const std::vector<JetProbe>& probes() const { return probes_; }
  const std::vector<MeasuredCurve>& measured() const { return measured_; }  ///< as the case lists them
  /// Null before that moment.
  const JetAtFull* at_full() const { return at_full_ ? &*at_full_ : nullptr; }
  const SettledJet* incompressible() const { return incompressible_ ? &*incompressible_ : nullptr; }

 private:
  void observe();
  void look_at_full();
  std::vector<double> records() const;

  JetModel jet_;
  std::vector<MeasuredCurve> measured_;
  OrificeRecord orifice_;
  MomentumRecord momentum_;
  ProfileRecorder profile_;
  std::vector<JetProbe> probes_;
  double not_yet_observed_ = 0.0;                           ///< s, since the probes looked last
  double fully_open_from_ = -1.0, momentum_seen_at_ = 0.0;  ///< s
  double full_at_ = 0.0;                                    ///< s
  std::optional<JetAtFull> at_full_;
  /// The air of that moment: what was seen then is seen again when the run is resumed.
  std::vector<Field> air_at_full_;
  std::vector<double> numbers_at_full_;
  std::optional<SettledJet> incompressible_;
  OperatorTime advance_{"jet.advance", "one step of the air from the orifice on", 0.0, 0},
      record_{"jet.record", "orifice, momentum, probes, the plane that is kept", 0.0, 0};
};

}  // namespace ejecta
