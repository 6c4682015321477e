#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "grid/cell_field.hpp"
#include "grid/grid.hpp"
#include "output/history.hpp"

namespace ejecta {

/// What a state holds beside its fields, by whom it belongs to.
using StateNumbers = std::map<std::string, std::vector<double>>;
/// Throws Error where there are none of that name.
const std::vector<double>& numbers_of(const StateNumbers& numbers, const std::string& name);

/// As result.json lists them.
nlohmann::ordered_json operators_json(std::span<const OperatorTime> operators);

/// Fields with the grid on which they lie; null for none.
struct FieldsOnGrid {
  const Grid* grid = nullptr;
  std::vector<CellField> fields{};
};

/// What a run advances: a box with bodies in its air, or a jet from its nozzle. The loop knows no more of it.
class Model {
 public:
  virtual ~Model() = default;

  /// The longest step from `time` on, s.
  virtual double stable_dt(double time) = 0;
  virtual void advance(const Step& step) = 0;
  /// Times at which what drives it has kinks or is looked at, s.
  virtual std::vector<double> events() const = 0;
  /// Its own end has come, before run.end_time.
  virtual bool finished() const = 0;
  /// What follows the last step. False where `stop` (may be empty) ended it: it is done anew when the run
  /// goes on.
  virtual bool conclude(const std::function<bool()>& stop, const Note& note) = 0;

  /// Throws DivergedError with the place when it is no longer finite.
  virtual void require_finite(double time) const = 0;
  virtual std::int64_t cells() const = 0;  ///< that the next step computes
  virtual std::size_t bodies() const = 0;
  virtual double courant() const = 0;  ///< of the last step
  /// What comes after costs nothing, s.
  virtual double busy_until() const = 0;
  /// Operators of a step in their order, with what they cost so far.
  virtual std::vector<OperatorTime> operator_times() const = 0;

  /// What can be looked at now.
  virtual FieldsOnGrid fields() = 0;
  /// Everything a resume needs.
  virtual std::vector<NamedField> state_fields() = 0;
  virtual StateNumbers state_numbers() const = 0;
  /// Once the fields are back. Throws Error when the numbers are not those of such a model.
  virtual void restore_numbers(const StateNumbers& numbers, double time) = 0;

  /// result.json as it stands (docs/files.md). `operators`: those of the step and what else took time.
  virtual nlohmann::ordered_json result(double time, std::int64_t steps, double wall_time,
                                        std::span<const OperatorTime> operators) const = 0;
  /// run.end_time with which what is undecided now should be decided, s.
  virtual std::optional<double> later_end(double time) const = 0;
  /// What the user should know of the result.
  virtual std::vector<std::string> warnings() const = 0;
};

/// What a run writes while it goes. Looks at its model, never changes it.
class Outputs {
 public:
  virtual ~Outputs() = default;
  /// Times the clock must land on.
  virtual void add_events(Clock& clock) const = 0;
  /// Before the first step and after each: writes what is due.
  virtual void observe(double time, std::int64_t steps) = 0;
  /// After the last step.
  virtual void finish(double time) = 0;
  /// Adds what only the outputs know to the result of a run that has come to its end.
  virtual void report(nlohmann::ordered_json& result) = 0;
  /// Those that were kept in memory.
  virtual output::NamedHistories histories() const = 0;
  virtual std::vector<double> state() const = 0;
  virtual void restore(const std::vector<double>& state) = 0;
};

}  // namespace ejecta
