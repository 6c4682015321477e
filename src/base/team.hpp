#pragma once
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace ejecta::detail {

/// One piece of a loop; `kernel` is the loop's functor.
using PieceBody = void (*)(const void* kernel, int piece);

/// The threads of one caller. A loop is cut into pieces; each thread begins with a run of them of its own,
/// the same in every loop, so that its planes stay in its cache, and then takes what others have not begun. A
/// thread that another program keeps from its core so holds up a loop by the one piece it is at. Who waits
/// looks for a short while and then sleeps: it leaves the core to whoever holds the last piece.
class Team {
 public:
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return static_cast<int>(shares_.size()); }

  /// Returns when every piece of [0, pieces) is done; throws what the first piece that failed threw.
  void run(int pieces, PieceBody body, const void* kernel);

 private:
  /// Pieces [first, end) that nobody has begun, as one number: first in the lower half.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> pieces{0};
  };

  void work(int self);
  void take_pieces(int self);
  void run_piece(int piece);

  std::vector<Share> shares_;
  PieceBody body_ = nullptr;      // of the loop at work: only read by who holds one of its pieces
  const void* kernel_ = nullptr;  // likewise
  alignas(64) std::atomic<std::uint32_t> loops_{0};  // begun so far; workers wait for the next
  std::atomic<std::uint32_t> sleepers_{0};           // workers that must be woken for it
  std::atomic<bool> ends_{false};
  alignas(64) std::atomic<std::uint32_t> unfinished_{0};  // pieces; the caller waits for none
  std::atomic<bool> caller_sleeps_{false};
  std::mutex failing_;
  std::exception_ptr failure_;
  std::vector<std::thread> workers_;
};

}  // namespace ejecta::detail
