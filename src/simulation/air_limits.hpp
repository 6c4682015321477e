#pragma once

/// Limits that the run keeps and its forecast must know.
namespace ejecta {

/// Share of its greatest kinetic energy below which the air counts as dead once the valve is closed.
inline constexpr double kDeadAir = 1e-3;

}  // namespace ejecta
