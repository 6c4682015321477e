#pragma once

namespace ejecta {

/// What a command tells the shell.
enum ExitCode : int {
  exit_done = 0,
  exit_failure = 1,
  exit_bad_input = 2,
  exit_diverged = 3,    ///< the last good checkpoint is kept
  exit_stopped = 4,     ///< by a signal or a time limit; `--resume` continues
  exit_validation = 5,  ///< a validation case failed
  exit_undecided = 6    ///< ended before every body had its verdict; `--resume` with a later end goes on
};

}  // namespace ejecta
