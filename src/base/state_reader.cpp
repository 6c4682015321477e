#include "base/state_reader.hpp"

#include <fmt/format.h>

#include <cmath>

namespace ejecta {

StateReader::StateReader(std::span<const double> numbers, std::string name)
    : all_(numbers), name_(std::move(name)) {}

std::span<const double> StateReader::numbers(std::size_t count) {
  if (count > all_.size() - at_)
    throw unfit(fmt::format("{} numbers are needed after the first {}", count, at_));
  const auto taken = all_.subspan(at_, count);
  at_ += count;
  return taken;
}

int StateReader::whole(int least, int most) {
  const double v = number();
  if (!(v >= least && v <= most) || v != std::floor(v))
    throw unfit(fmt::format("number {} is {} instead of a whole number from {} to {}", at_, v, least, most));
  return static_cast<int>(v);
}

std::size_t StateReader::count(std::size_t numbers_each) {
  const double v = number();
  const std::size_t room = (all_.size() - at_) / numbers_each;
  if (!(v >= 0.0 && v <= static_cast<double>(room)) || v != std::floor(v))
    throw unfit(fmt::format("number {} counts {} where there is room for {}", at_, v, room));
  return static_cast<std::size_t>(v);
}

void StateReader::end() const {
  if (at_ != all_.size()) throw unfit(fmt::format("only {} are needed", at_));
}

Error StateReader::unfit(const std::string& what) const {
  return Error(
      fmt::format("the saved state of the {} ({} numbers) does not fit: {}", name_, all_.size(), what));
}

}  // namespace ejecta
