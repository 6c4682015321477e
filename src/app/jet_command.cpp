#include "app/exit_code.hpp"
#include "app/jet_run.hpp"
#include "app/jet_sweep.hpp"
#include "base/parallel.hpp"
#include "case/extent.hpp"
#include "jet/computed.hpp"
#include "jet/store.hpp"

namespace ejecta {

int jet_case(const Case& c, const RunOptions& options) {
  if (options.threads > 0) set_thread_count(options.threads);
  // A box that is fed with a computed jet stands for the case that computes it.
  const bool box = c.flow.solver != FlowSolver::compressible && !c.jet.source_case.empty();
  const Case jet = box ? computed_jet_case(c) : c;
  if (options.sweep) return sweep_jet(jet, options);
  JetRun run(jet, box ? jet_height(c) : kBoxHeight, options);
  if (options.dry_run) return exit_done;
  run.advance_to_end();
  run.write_result();
  return exit_done;
}

}  // namespace ejecta
