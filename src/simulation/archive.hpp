#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/file_lock.hpp"
#include "base/text.hpp"
#include "output/checkpoint.hpp"
#include "output/run_directory.hpp"
#include "simulation/histories.hpp"
#include "simulation/model.hpp"
#include "simulation/run.hpp"

namespace ejecta {

/// The case as a run keeps it: what it needs from elsewhere by absolute paths.
std::string input_of(const Case& c);

/// Makes what records a run there.
using OutputsMaker = std::function<std::unique_ptr<Outputs>(const OutputPlace&)>;

/// The files of a run: its directory, its outputs, its checkpoints.
class Archive {
 public:
  /// Refuses at once a place where the run could not be kept: its model may take minutes to build.
  static void require_place(const RunFiles& files);
  /// Makes the directory, or takes the model back to the last good checkpoint there. Throws InputError when
  /// it is of another case, its files have changed or a run goes on there; nothing in it is touched before.
  Archive(const Case& c, Model& model, const RunFiles& files, const OutputsMaker& make_outputs,
          const Note& note);

  Outputs& outputs() { return *outputs_; }
  const output::RunDirectory& directory() const { return directory_; }
  void write_checkpoint(Model& model, const Clock& clock, double wall_time) const;
  /// After the model: what the outputs and the clock knew, and how long it took, s.
  void restore(Clock& clock, double& wall_time);

 private:
  void refuse_another_case(const std::string& input) const;
  void refuse_changed_files(const std::vector<std::string>& files) const;
  double find_checkpoint(const Note& note);
  void restore_model(Model& model) const;

  RunFiles files_;
  DirectoryClaim claim_;
  output::RunDirectory directory_;
  output::CheckpointStore store_;
  std::unique_ptr<Outputs> outputs_;
  std::optional<output::CheckpointReader> reader_;
};

}  // namespace ejecta
