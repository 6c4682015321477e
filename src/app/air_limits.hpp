#pragma once

/// Limits that the run keeps and its forecast must know.
namespace ejecta {

/// Share of its greatest kinetic energy below which the air counts as dead once the valve is closed.
inline constexpr double kDeadAir = 1e-3;
/// Longest step while a jet may blow, as a share of its pulse: it must not open and close unseen within one.
inline constexpr double kStepOfPulse = 0.01;

}  // namespace ejecta
