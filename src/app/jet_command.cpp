#include <filesystem>

#include "app/exit_code.hpp"
#include "app/jet_run.hpp"
#include "app/jet_sweep.hpp"
#include "base/parallel.hpp"
#include "case/load.hpp"

namespace ejecta {
namespace {

/// A box that is fed with a computed jet stands for the case that computes it.
Case jet_of(const Case& c) {
  if (c.flow.solver == FlowSolver::compressible || c.jet.source_case.empty()) return c;
  return load_case((std::filesystem::path(c.path).parent_path() / c.jet.source_case).string());
}

}  // namespace

int jet_case(const Case& c, const RunOptions& options) {
  if (options.threads > 0) set_thread_count(options.threads);
  if (options.sweep) return sweep_jet(jet_of(c), options);
  JetRun run(jet_of(c), options);
  if (options.dry_run) return exit_done;
  run.advance_to_end();
  run.write_result();
  return exit_done;
}

}  // namespace ejecta
